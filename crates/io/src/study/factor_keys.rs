//! The factors of a study, from the keys that say them.

use std::collections::HashSet;

use toml::Spanned;

use super::document::{self, Document, unseen};
use super::factor::{Factor, Level, Values};
use crate::scene::{Locator, Origin, Problem, schema};
use crate::text::{MOST_PROBLEMS, odd_character, short, too_long};
use crate::units;

/// The factors of a study.
pub(super) fn factors(document: &Document, locator: &Locator<'_>, problems: &mut Vec<Problem>) -> Vec<Factor> {
    let mut factors: Vec<Factor> = Vec::new();
    let (mut names, mut varied) = (HashSet::new(), HashSet::new());
    for table in &document.factor {
        if problems.len() >= MOST_PROBLEMS {
            break;
        }
        let keys = table.key.as_ref().map_or(Vec::new(), |key| key.get_ref().0.clone());
        if let Some(key) = &table.key {
            for unknown in keys.iter().filter(|key| schema::find(key).is_none()) {
                let (section, name) = unknown.rsplit_once('.').unwrap_or(("", unknown));
                let without =
                    if document.base.is_none() { "; what is set on a rig needs a name and no key" } else { "" };
                let message = format!("\"{}\": {}{without}", short(unknown), schema::unknown(section, name));
                problems.push(locator.problem(key, "factor.key", message));
            }
        } else if let Some((at, message)) = without_key(table, document) {
            let locator = at.map_or_else(|| Origin::File(locator.file.clone()), |at| locator.origin(at..at));
            problems.push(Problem::new(&locator, "factor.key", message));
            continue;
        }
        let name = table.name.as_ref().map_or_else(|| keys[0].clone(), |name| name.get_ref().clone());
        let at = table.name.as_ref().map(Spanned::span).or(table.key.as_ref().map(Spanned::span)).unwrap_or_default();
        locator.check_label(&name, || locator.origin(at.clone()), "factor.name", problems);
        // What values an unknown key has nobody knows.
        let key = keys.first().map_or("", String::as_str);
        let values = if !key.is_empty() && schema::find(key).is_none() {
            Values::Levels(Vec::new())
        } else {
            let values = values(table, key, document.design.get_ref() == "csv", locator);
            values.map_err(|problem| problems.push(problem)).unwrap_or(Values::Levels(Vec::new()))
        };
        if !names.insert(name.clone()) {
            problems.push(Problem::new(
                &locator.origin(at.clone()),
                "factor.name",
                format!("\"{}\" is the name of two", short(&name)),
            ));
        }
        // A key may stand twice in one list: that sets it to the same value.
        if let (Some(twice), Some(key)) = (keys.iter().find(|key| varied.contains(*key)), &table.key) {
            problems.push(locator.problem(key, "factor.key", format!("\"{}\" is varied by two factors", short(twice))));
        }
        varied.extend(keys.iter().cloned());
        let stated_unit = match &values {
            Values::Levels(levels) => stated_unit(levels.first()),
            Values::Range { low, .. } => stated_unit(Some(low)),
        };
        factors.push(Factor { name, keys, stated_unit, values });
    }
    if factors.is_empty() {
        let message = "nothing is varied, expected at least one [[factor]]";
        problems.push(Problem::new(&Origin::File(locator.file.clone()), "factor", message));
    }
    factors
}

/// Problem with a factor that has no key, and where.
fn without_key(table: &document::Factor, document: &Document) -> Option<(Option<usize>, &'static str)> {
    let at = table.name.as_ref().map(|name| name.span().start);
    match (&document.base, at) {
        (Some(_), _) => Some((
            at,
            "missing, expected a key of the scene such as \"operation.normal_force\"; factors that are set \
            elsewhere, as on a rig, belong into a study without base",
        )),
        (None, None) => Some((None, "a factor has neither key nor name")),
        (None, Some(_)) => None,
    }
}

/// The unit of a level; empty for plain numbers and words.
pub(super) fn stated_unit(level: Option<&Level>) -> String {
    level.and_then(Level::split).map_or_else(String::new, |(_, unit)| unit.to_owned())
}

/// The levels or the range of a factor.
fn values(table: &document::Factor, key: &str, in_file: bool, locator: &Locator<'_>) -> Result<Values, Problem> {
    let start =
        table.key.as_ref().map(Spanned::span).or(table.name.as_ref().map(Spanned::span)).unwrap_or_default().start;
    let at = |message: &str| Err(Problem::new(&locator.origin(start..start), "factor", message));
    if let Some(scale) = &table.scale
        && table.range.is_none()
    {
        return Err(locator.problem(scale, "factor.scale", "it belongs to a range"));
    }
    match (&table.levels, &table.range) {
        (None, None) if in_file => Ok(Values::Levels(Vec::new())),
        (Some(given), None) => levels(given, key, locator),
        (None, Some(given)) => range(given, table.scale.as_ref(), key, locator),
        (Some(_), Some(_)) => at("levels and range are given together, keep one"),
        (None, None) => at("expected levels = [...] or range = [lower, upper]"),
    }
}

/// Levels: at least two, all different, each as its key has it.
fn levels(levels: &Spanned<Vec<Spanned<toml::Value>>>, key: &str, locator: &Locator<'_>) -> Result<Values, Problem> {
    let mut list: Vec<Level> = levels.get_ref().iter().map(|value| Level::new(key, value.get_ref())).collect();
    // Where nobody says what a factor is, one word among its levels makes all of them words.
    if key.is_empty() && list.iter().any(|level| level.number.is_none()) {
        list.iter_mut().for_each(|level| *level = Level::word(&level.label));
    }
    if list.len() < 2 {
        return Err(locator.problem(levels, "factor.levels", "expected at least two levels"));
    }
    let refuse = |at: usize, message: String| Err(locator.problem(&levels.get_ref()[at], "factor.levels", message));
    let mut known = HashSet::new();
    if let Some(at) = list.iter().position(|level| !known.insert(level.text.as_str())) {
        return refuse(at, format!("{} is there twice", list[at].text));
    }
    let before = |at: usize| list[..at].iter().find(|one| one.number.is_some() && one.number == list[at].number);
    if let Some((at, same)) = (0..list.len()).find_map(|at| Some((at, before(at)?))) {
        return refuse(at, format!("{} is the same as {}, expected different levels", list[at].text, same.text));
    }
    if let Some(other) = key.is_empty().then(|| Factor::in_another_unit(&list)).flatten() {
        return Err(locator.problem(levels, "factor.levels", format!("{}: expected all in the same unit", other.text)));
    }
    let mut unfit = levels.get_ref().iter().enumerate();
    if let Some((at, why)) = unfit.find_map(|(at, level)| Some((at, Level::unfit(key, level.get_ref())?))) {
        return refuse(at, why);
    }
    let odd = list.iter().enumerate().find_map(|(at, level)| Some((at, odd_character(&level.label)?)));
    if let Some((at, found)) = odd {
        return refuse(at, format!("{} has {found}; take it out", list[at].text.escape_debug()));
    }
    let words = || list.iter().enumerate().filter(|(_, level)| level.number.is_none());
    if let Some((at, unseen)) = words().find_map(|(at, level)| Some((at, unseen(&level.label)?))) {
        return refuse(at, unseen);
    }
    if let Some((at, long)) = list.iter().enumerate().find_map(|(at, level)| Some((at, too_long(&level.label)?))) {
        return refuse(at, long);
    }
    Ok(Values::Levels(list))
}

/// A range, whose ends are numbers in one unit.
fn range(
    range: &Spanned<[Spanned<toml::Value>; 2]>,
    scale: Option<&Spanned<String>>,
    key: &str,
    locator: &Locator<'_>,
) -> Result<Values, Problem> {
    let logarithmic = match scale.map(|scale| (scale, scale.get_ref().as_str())) {
        None | Some((_, "linear")) => false,
        Some((_, "logarithmic")) => true,
        Some((scale, found)) => {
            let message = format!("\"{}\", expected \"linear\" or \"logarithmic\"", short(found));
            return Err(locator.problem(scale, "factor.scale", message));
        }
    };
    let [low, high] = range.get_ref().each_ref().map(|end| Level::new(key, end.get_ref()));
    let number = |end: &Spanned<toml::Value>| {
        let refused = |why: String| locator.problem(end, "factor.range", why);
        Level::end_of_range(key, end.get_ref()).map_err(refused)
    };
    let (from, to) = (number(&range.get_ref()[0])?, number(&range.get_ref()[1])?);
    if from >= to || (logarithmic && from <= 0.0) {
        let wanted = if logarithmic { "0 < lower < upper" } else { "lower < upper" };
        let message = format!("{} to {}: expected {wanted}", low.text, high.text);
        return Err(locator.problem(range, "factor.range", message));
    }
    let whole = |end: &Spanned<toml::Value>| matches!(end.get_ref(), toml::Value::Integer(_));
    if schema::find(key).is_some_and(|key| matches!(key.kind, schema::Kind::Integer(_) | schema::Kind::CountOr(_))) {
        return Err(locator.problem(range, "factor.range", "this key holds whole numbers: give levels"));
    }
    let units_of_ends =
        [&low, &high].map(|level| level.label.trim().split_once(' ').map_or("", |(_, unit)| unit.trim()));
    if units_of_ends[0] != units_of_ends[1] && !range.get_ref().iter().all(whole) {
        let message = format!("{} to {}: expected both in the same unit", low.text, high.text);
        return Err(locator.problem(range, "factor.range", message));
    }
    if logarithmic && units::zero_of(units_of_ends[0]) != 0.0 {
        let message =
            format!("{} to {}: equal ratios need a range in K, for 0 degC is not the lowest", low.text, high.text);
        return Err(locator.problem(range, "factor.range", message));
    }
    Ok(Values::Range { low, high, logarithmic })
}
