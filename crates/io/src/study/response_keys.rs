//! Keys of a response beside its question: where its values come from, their unit, and how they are fitted.

use plateau_study::effects::Transform;
use toml::Spanned;

use super::collected::unit_of;
use super::document::Response as Table;
use super::place::Place;
use super::response::{Question, Response, units};
use crate::scene::Problem;

/// Whether the values come from elsewhere.
pub(super) fn is_imported(table: &Table, place: &Place<'_>) -> Result<bool, Problem> {
    let is_imported = table.imported.as_ref().is_some_and(|imported| *imported.get_ref());
    match (&table.unit, is_imported) {
        (Some(unit), false) => {
            Err(place.problem(unit, "response.unit", "it belongs to imported = true: series have units of their own"))
        }
        _ => Ok(is_imported),
    }
}

/// The question of a response whose values come from elsewhere.
pub(super) fn imported(table: &Table, place: &Place<'_>) -> Result<Question, Problem> {
    let asks = table.dataset.is_some() || table.at.is_some() || table.mean.is_some();
    if asks || table.reaches.is_some() || table.event.is_some() {
        let message = "imported = true has no dataset, at, mean, reaches or event: its values come from a table";
        return Err(place.problem(&table.name, "response", message));
    }
    let unit = table.unit.as_ref().map_or("1", |unit| unit.get_ref().as_str());
    let known = units();
    match (known.iter().find(|known| **known == unit), &table.unit) {
        (None, Some(found)) => {
            let message = format!("\"{unit}\", expected an SI unit as in results.csv: {}", known.join(", "));
            Err(place.problem(found, "response.unit", message))
        }
        (found, _) => Ok(Question::Imported(found.copied().unwrap_or("1"))),
    }
}

/// The dataset that is asked.
pub(super) fn dataset<'a>(table: &'a Table, place: &Place<'_>) -> Result<&'a Spanned<String>, Problem> {
    table.dataset.as_ref().ok_or_else(|| {
        let message = "expected dataset = \"/series/...\", or imported = true for values that come from a table";
        place.problem(&table.name, "response", message)
    })
}

/// What is done to the values before a model is fitted to them.
pub(super) fn transform(table: &Table, response: &Response, place: &Place<'_>) -> Result<Option<Transform>, Problem> {
    let Some(found) = &table.transform else { return Ok(None) };
    let word = found.get_ref().as_str();
    let transform = Transform::of_name(word).ok_or_else(|| {
        let names = Transform::ALL.map(|transform| format!("\"{}\"", transform.name())).join(", ");
        place.problem(found, "response.transform", format!("\"{word}\", expected one of {names}"))
    })?;
    let unit = response.unit(unit_of(&response.series));
    if transform == Transform::Logit && unit != "1" {
        let message = format!("\"logit\" is for fractions between 0 and 1, and this response is in {unit}");
        return Err(place.problem(found, "response.transform", message));
    }
    Ok(Some(transform))
}
