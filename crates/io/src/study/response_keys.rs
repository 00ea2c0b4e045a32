//! From the tables of responses to what they ask: where values come from, their unit, and how they are fitted.

use std::collections::HashSet;

use plateau_core::observe::event::{EVENT_QUANTITIES, event_quantity};
use plateau_core::observe::{EXTRAS, TOTALS, quantities};
use toml::{Spanned, Value};

use super::document::{Mean, Response as Table};
use super::record::{EVENT, unit_of};
use super::response::{Question, Response, TRANSFORMS, WhichEvent, units};
use crate::scene::{Locator, Problem};
use crate::text::{self, MOST_PROBLEMS, short};
use crate::units::{Dimension, parse, parse_as};

/// The responses of a study.
pub(super) fn responses(tables: &[Table], locator: &Locator<'_>, problems: &mut Vec<Problem>) -> Vec<Response> {
    let mut responses: Vec<Response> = Vec::new();
    let mut names = HashSet::new();
    for table in tables {
        if problems.len() >= MOST_PROBLEMS {
            break;
        }
        let name = table.name.get_ref().clone();
        locator.check_label(&name, || locator.origin(table.name.span()), "response.name", problems);
        if !names.insert(name.clone()) {
            problems.push(locator.problem(
                &table.name,
                "response.name",
                format!("\"{}\" is the name of two", short(&name)),
            ));
        }
        let asked = match is_imported(table, locator) {
            Ok(true) => imported(table, locator).map(|question| (String::new(), question)),
            Ok(false) => dataset(table, locator).and_then(|dataset| {
                let series = match &table.event {
                    Some(_) => event_name(dataset, locator, problems),
                    None => series_name(dataset, "response.dataset", locator, problems),
                };
                let series = series.unwrap_or_default();
                let question = match &table.measured_file {
                    Some(file) => of_file(table, file, locator)?,
                    None => question(table, &series, locator)?,
                };
                Ok((series, question))
            }),
            Err(problem) => Err(problem),
        };
        let response = asked.and_then(|(series, question)| {
            let stated_unit = table.unit.as_ref().map(|unit| unit.get_ref().clone());
            let response = Response { name, series, question, transform: TRANSFORMS[0], stated_unit };
            let transform = transform(table, &response, locator)?;
            Ok(Response { transform, ..response })
        });
        match response {
            Ok(response) => responses.push(response),
            Err(problem) => problems.push(problem),
        }
    }
    responses
}

fn question(table: &Table, series: &str, locator: &Locator<'_>) -> Result<Question, Problem> {
    let time = |text: &Spanned<String>, key: &str| {
        let time = parse(text.get_ref(), Dimension::Time).map_err(|error| locator.problem(text, key, error))?;
        if time >= 0.0 {
            Ok(time)
        } else {
            Err(locator.problem(text, key, format!("\"{}\" is before the run", short(text.get_ref()))))
        }
    };
    let refused = || {
        let message = "expected one of at = \"end\", at = \"100 s\", mean = \"last tenth\", mean = [\"50 s\", \"100 s\"], \
                           reaches = 0.9; of /event/...: event = 3, event = \"last\", event = \"mean\"; for a fit to a whole \
                           series: measured_file = \"FILE.csv\"";
        locator.problem(&table.name, "response", message)
    };
    if let (Some(event), None, None, None) = (&table.event, &table.at, &table.mean, &table.reaches) {
        return which_event(event.get_ref()).map(Question::Event).ok_or_else(|| {
            locator.problem(event, "response.event", "expected the number of an event, \"last\" or \"mean\"")
        });
    }
    if table.event.is_some() {
        return Err(refused());
    }
    match (&table.at, &table.mean, &table.reaches) {
        (Some(at), None, None) if at.get_ref() == "end" => Ok(Question::End),
        (Some(at), None, None) => match time(at, "response.at") {
            Ok(time) => Ok(Question::At(time)),
            Err(Problem { message, .. }) => {
                Err(locator.problem(at, "response.at", format!("{message}; \"end\" is the end of the run")))
            }
        },
        (None, Some(mean), None) => {
            if TOTALS.contains(&series) {
                let message = format!(
                    "{series} is a total since the start of the run, and its mean says nothing: at = \"end\" is how much it is \
                     at the end, and the difference of two responses, such as at = \"50 s\" and at = \"100 s\", how much is added between"
                );
                return Err(locator.problem(mean, "response.mean", message));
            }
            let Mean::Between([from, to]) = mean.get_ref() else { return Ok(Question::MeanOfLastTenth) };
            let (start, end) = (time(from, "response.mean")?, time(to, "response.mean")?);
            if start < end {
                return Ok(Question::Mean(start, end));
            }
            Err(locator.problem(mean, "response.mean", "expected two times, the earlier one first"))
        }
        (None, None, Some(reaches)) if (0.0..1.0).contains(reaches.get_ref()) && *reaches.get_ref() > 0.0 => {
            Ok(Question::Reaches(*reaches.get_ref()))
        }
        (None, None, Some(reaches)) => Err(locator.problem(
            reaches,
            "response.reaches",
            format!("{}, expected more than 0 and less than 1", reaches.get_ref()),
        )),
        _ => Err(refused()),
    }
}

/// That a whole series is compared, at the times of a table that `plateau fit` reads.
fn of_file(table: &Table, file: &Spanned<String>, locator: &Locator<'_>) -> Result<Question, Problem> {
    if table.at.is_some() || table.mean.is_some() || table.reaches.is_some() || table.event.is_some() {
        let message = "a whole series is compared at its times: take out at, mean, reaches and event";
        return Err(locator.problem(file, "response.measured_file", message));
    }
    Ok(Question::Measured)
}

fn which_event(value: &Value) -> Option<WhichEvent> {
    match value {
        Value::Integer(number) => usize::try_from(*number).ok().filter(|number| *number > 0).map(WhichEvent::Number),
        Value::String(word) if word == "last" => Some(WhichEvent::Last),
        Value::String(word) if word == "mean" => Some(WhichEvent::Mean),
        _ => None,
    }
}

/// The dataset of a quantity of events.
fn event_name(found: &Spanned<String>, locator: &Locator<'_>, problems: &mut Vec<Problem>) -> Option<String> {
    let name = found.get_ref().trim_start_matches('/').trim_start_matches(EVENT);
    if event_quantity(name).is_some() {
        return Some(format!("{EVENT}{name}"));
    }
    let known: Vec<_> = EVENT_QUANTITIES.iter().map(|quantity| format!("/{EVENT}{}", quantity.name)).collect();
    let message =
        format!("\"{}\" is nothing that is reported of events; expected {}", short(found.get_ref()), known.join(", "));
    problems.push(locator.problem(found, "response.dataset", message));
    None
}

/// `/series/pool` or `pool`.
pub(super) fn series_name(
    found: &Spanned<String>,
    key: &str,
    locator: &Locator<'_>,
    problems: &mut Vec<Problem>,
) -> Option<String> {
    let name = found.get_ref().trim_start_matches("/series/");
    let known = || quantities(EXTRAS).map(|quantity| quantity.name);
    if known().any(|known| known == name) {
        return Some(name.to_owned());
    }
    if let Some(event) = name.trim_start_matches('/').strip_prefix(EVENT).filter(|name| event_quantity(name).is_some())
    {
        let message = format!(
            "/{EVENT}{event} is of events, which are asked for with event = 3, event = \"last\" or event = \"mean\""
        );
        problems.push(locator.problem(found, key, message));
        return None;
    }
    let nearest = text::nearest(name, known()).map_or_else(
        || format!("; the series are {}", known().collect::<Vec<_>>().join(", ")),
        |nearest| format!("; did you mean /series/{nearest}?"),
    );
    problems.push(locator.problem(
        found,
        key,
        format!("\"{}\" is not a series of a run{nearest}", short(found.get_ref())),
    ));
    None
}

/// Tells whether the values come from elsewhere.
fn is_imported(table: &Table, locator: &Locator<'_>) -> Result<bool, Problem> {
    let is_imported = table.imported.as_ref().is_some_and(|imported| *imported.get_ref());
    match (&table.unit, is_imported) {
        (Some(unit), false) => {
            Err(locator.problem(unit, "response.unit", "it belongs to imported = true: series have units of their own"))
        }
        _ => Ok(is_imported),
    }
}

/// The question of a response whose values come from elsewhere.
fn imported(table: &Table, locator: &Locator<'_>) -> Result<Question, Problem> {
    if let Some(file) = &table.measured_file {
        let message =
            "imported = true has values for each run; measured_file is one series that all runs are compared with";
        return Err(locator.problem(file, "response.measured_file", message));
    }
    let asks = table.dataset.is_some() || table.at.is_some() || table.mean.is_some();
    if asks || table.reaches.is_some() || table.event.is_some() {
        let message = "imported = true has no dataset, at, mean, reaches or event: its values come from a table";
        return Err(locator.problem(&table.name, "response", message));
    }
    let unit = table.unit.as_ref().map_or("1", |unit| unit.get_ref().as_str());
    let known = units();
    // Of `mm3` and `m3` the same is measured; what is kept is in SI units.
    let measures_the_same = |si: &&&str| parse_as(&format!("1 {unit}"), si).is_ok();
    let found = known.iter().find(|known| **known == unit).or_else(|| known.iter().find(measures_the_same));
    match (found, &table.unit) {
        (None, Some(found)) => {
            let unit = short(unit);
            let message = format!("\"{unit}\", expected a unit that measures the same as one of {}", known.join(", "));
            Err(locator.problem(found, "response.unit", message))
        }
        (found, _) => Ok(Question::Imported(found.copied().unwrap_or("1"))),
    }
}

/// The dataset that is asked.
fn dataset<'a>(table: &'a Table, locator: &Locator<'_>) -> Result<&'a Spanned<String>, Problem> {
    table.dataset.as_ref().ok_or_else(|| {
        let message = "expected dataset = \"/series/...\", or imported = true for values that come from a table";
        locator.problem(&table.name, "response", message)
    })
}

/// On which scale an analysis fits the values.
fn transform(table: &Table, response: &Response, locator: &Locator<'_>) -> Result<&'static str, Problem> {
    let Some(found) = &table.transform else { return Ok(TRANSFORMS[0]) };
    let word = found.get_ref().as_str();
    let transform = TRANSFORMS[1..].iter().copied().find(|transform| *transform == word).ok_or_else(|| {
        let names: Vec<String> = TRANSFORMS[1..].iter().map(|transform| format!("\"{transform}\"")).collect();
        let message = format!("\"{}\", expected one of {}", short(word), names.join(", "));
        locator.problem(found, "response.transform", message)
    })?;
    let unit = response.unit(unit_of(&response.series));
    if transform == "logit" && unit != "1" {
        let message = format!("\"logit\" is for fractions between 0 and 1, and this response is in {unit}");
        return Err(locator.problem(found, "response.transform", message));
    }
    Ok(transform)
}
