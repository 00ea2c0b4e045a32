//! The factors and responses of a study, from the keys that say them: levels and ranges; where values come from, their unit, and how they
//! are fitted.

use std::collections::HashSet;

use plateau_core::observe::event::{EVENT_QUANTITIES, event_quantity};
use plateau_core::observe::{EXTRAS, TOTALS, quantities};
use toml::{Spanned, Value};

use crate::scene::{Locator, Origin, Problem, schema};
use crate::study::document::{self, Document, Mean, Response as Table, unseen};
use crate::study::factor::{Factor, Level, Values, is_whole};
use crate::study::record::{EVENT, unit_of};
use crate::study::response::{Question, Response, TRANSFORMS, WhichEvent, units};
use crate::text::{self, MOST_PROBLEMS, odd_character, short, too_long};
use crate::units::{self, Dimension, parse, parse_as};

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
        } else if document.base.is_some() || table.name.is_none() {
            let message = if document.base.is_some() {
                "missing, expected a key of the scene such as \"operation.normal_force\"; factors that are set \
                elsewhere, as on a rig, belong into a study without base"
            } else {
                "a factor has neither key nor name"
            };
            let file = || Origin::File(locator.file.clone());
            let origin = table.name.as_ref().map_or_else(file, |name| locator.origin(name.span()));
            problems.push(Problem::new(&origin, "factor.key", message));
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

/// The unit of a level; empty for plain numbers and words.
pub(super) fn stated_unit(level: Option<&Level>) -> String {
    level.and_then(Level::split).map_or_else(String::new, |(_, unit)| unit.to_owned())
}

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
    let unfit = unfit.find_map(|(at, level)| Some((at, Level::unfit(key, level.get_ref())?)));
    let first = |wrong: &dyn Fn(&Level) -> Option<String>| {
        list.iter().enumerate().find_map(|(at, level)| Some((at, wrong(level)?)))
    };
    let odd = |level: &Level| {
        odd_character(&level.label).map(|found| format!("{} has {found}; take it out", level.text.escape_debug()))
    };
    let unseen_word = |level: &Level| if level.number.is_none() { unseen(&level.label) } else { None };
    let wrong = unfit.or_else(|| first(&odd)).or_else(|| first(&unseen_word));
    match wrong.or_else(|| first(&|level| too_long(&level.label))) {
        Some((at, message)) => refuse(at, message),
        None => Ok(Values::Levels(list)),
    }
}

/// A range, whose ends are numbers in one unit.
fn range(
    range: &Spanned<[Spanned<toml::Value>; 2]>,
    scale: Option<&Spanned<String>>,
    key: &str,
    locator: &Locator<'_>,
) -> Result<Values, Problem> {
    let logarithmic = locator.choice(scale, "factor.scale", &[("linear", false), ("logarithmic", true)])?;
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
    if is_whole(key) {
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

pub(super) fn responses(tables: &[Table], locator: &Locator<'_>, problems: &mut Vec<Problem>) -> Vec<Response> {
    let mut responses: Vec<Response> = Vec::new();
    let mut names = HashSet::new();
    for table in tables {
        if problems.len() >= MOST_PROBLEMS {
            break;
        }
        let name = table.name.get_ref();
        locator.check_label(name, || locator.origin(table.name.span()), "response.name", problems);
        if !names.insert(name) {
            let message = format!("\"{}\" is the name of two", short(name));
            problems.push(locator.problem(&table.name, "response.name", message));
        }
        match response(table, locator, problems) {
            Ok(response) => responses.push(response),
            Err(problem) => problems.push(problem),
        }
    }
    responses
}

fn response(table: &Table, locator: &Locator<'_>, problems: &mut Vec<Problem>) -> Result<Response, Problem> {
    let (series, question) = if is_imported(table, locator)? {
        (String::new(), imported(table, locator)?)
    } else {
        let dataset = table.dataset.as_ref().ok_or_else(|| {
            let message = "expected dataset = \"/series/...\", or imported = true for values that come from a table";
            locator.problem(&table.name, "response", message)
        })?;
        let series = match &table.event {
            Some(_) => event_name(dataset, locator, problems),
            None => series_name(dataset, "response.dataset", locator, problems),
        };
        let series = series.unwrap_or_default();
        let question = match &table.measured_file {
            Some(file) => of_file(table, file, locator)?,
            None => question(table, &series, locator)?,
        };
        (series, question)
    };
    let (name, stated_unit) = (table.name.get_ref().clone(), table.unit.as_ref().map(|unit| unit.get_ref().clone()));
    let response = Response { name, series, question, transform: TRANSFORMS[0], stated_unit };
    let transform = transform(table, &response, locator)?;
    Ok(Response { transform, ..response })
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
    match (&table.event, &table.at, &table.mean, &table.reaches) {
        (Some(event), None, None, None) => which_event(event.get_ref()).map(Question::Event).ok_or_else(|| {
            locator.problem(event, "response.event", "expected the number of an event, \"last\" or \"mean\"")
        }),
        (None, Some(at), None, None) if at.get_ref() == "end" => Ok(Question::End),
        (None, Some(at), None, None) => match time(at, "response.at") {
            Ok(time) => Ok(Question::At(time)),
            Err(Problem { message, .. }) => {
                Err(locator.problem(at, "response.at", format!("{message}; \"end\" is the end of the run")))
            }
        },
        (None, None, Some(mean), None) => {
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
        (None, None, None, Some(reaches)) if (0.0..1.0).contains(reaches.get_ref()) && *reaches.get_ref() > 0.0 => {
            Ok(Question::Reaches(*reaches.get_ref()))
        }
        (None, None, None, Some(reaches)) => Err(locator.problem(
            reaches,
            "response.reaches",
            format!("{}, expected more than 0 and less than 1", reaches.get_ref()),
        )),
        _ => {
            let message = "expected one of at = \"end\", at = \"100 s\", mean = \"last tenth\", mean = [\"50 s\", \"100 s\"], \
                           reaches = 0.9; of /event/...: event = 3, event = \"last\", event = \"mean\"; for a fit to a whole \
                           series: measured_file = \"FILE.csv\"";
            Err(locator.problem(&table.name, "response", message))
        }
    }
}

/// Asks for a whole series, which is compared at the times of a table that `plateau fit` reads.
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

/// Name of a series that is given as `/series/pool` or `pool`.
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

/// Scale on which an analysis fits the values.
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
