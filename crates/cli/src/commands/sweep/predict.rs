//! `plateau sweep predict`: what responses are expected to be where no run was made.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use plateau_io::study::value_table::{Row, ValueTable};
use plateau_io::text::short;
use plateau_io::{brief, number};
use plateau_present::study::analysis::AnalysedResponse;
use plateau_present::study::cautions::between_two_values;
use plateau_present::study::forecasts::heads;
use plateau_present::study::place::{Place, Space};
use plateau_study::design::Setting;
use plateau_study::surrogate::{Forecast, Surrogate};
use rayon::prelude::*;
use serde::Serialize;

use super::analysed::Analysed;
use super::prediction_table;
use crate::arguments::PredictArguments;
use crate::failure::Failure;
use crate::sweep;
use crate::sweep::confirmation::{Confirmed, confirm};
use crate::table::{columns, print};
use crate::{message, output};

/// More places than these are announced: with a Gaussian process they take some ten seconds or more.
const MANY_PLACES: usize = 50_000;
/// Most places of a grid: 200 MB of table.
const MOST_PLACES: usize = 1_000_000;

/// Predicts the responses of a study.
pub fn predict(arguments: &PredictArguments) -> Result<(), Failure> {
    let plan = sweep::plan(&arguments.study)?;
    let inputs: Vec<PathBuf> = plan.study().inputs().into_iter().chain(arguments.points.clone()).collect();
    let check = |inputs: &[PathBuf]| {
        arguments.output.as_ref().map_or(Ok(()), |path| output::check(path, arguments.force, inputs))
    };
    check(&inputs)?;
    let analysed = Analysed::of(plan, arguments.fit.asked())?;
    check(&analysed.inputs)?;
    analysed.warn_of_factors();
    let confidence = arguments.fit.confidence;
    let places = places(&analysed, arguments)?;
    refuse_beyond(&places, arguments.extrapolate)?;
    let settings: Vec<&[Setting]> = places.iter().map(|place| &place.settings[..]).collect();
    analysed.warn_of_no_curve(&between_two_values(&analysed.analysis, &settings));
    let surrogates: Vec<_> = analysed.analysis.responses.iter().map(AnalysedResponse::surrogate).collect();
    if places.len() > MANY_PLACES {
        message::note(format_args!(
            "{} places are predicted, which takes a while",
            crate::number::grouped(places.len() as u64)
        ));
    }
    let forecasts = places.par_iter().map(|place| forecasts_at(&analysed, &surrogates, place, confidence));
    let forecasts = forecasts.collect::<Result<Vec<_>, Failure>>()?;
    let expected: Vec<_> = places.iter().zip(&forecasts).map(|(place, own)| (&place.levels[..], &own[..])).collect();
    let confirmed = if arguments.confirm {
        confirm(&analysed.plan, &analysed.identities, &expected, &arguments.cores)?
    } else {
        Vec::new()
    };
    if let Some(path) = &arguments.output {
        let table = prediction_table::table(&analysed, &places, &forecasts, &confirmed);
        output::write(path, table.as_bytes(), arguments.force)?;
    }
    let study = analysed.plan.study();
    if arguments.json {
        let report = |(at, (place, forecasts)): (usize, (&Place, &Vec<Option<Forecast>>))| {
            PlaceReport::new(&analysed, place, forecasts, confirmed.get(at).cloned())
        };
        let reports = places.iter().zip(&forecasts).enumerate().map(report);
        let models = surrogates.iter().map(|surrogate| surrogate.as_ref().map(|surrogate| surrogate.name())).collect();
        let document = Document { study: &study.title, confidence, models, places: reports.collect() };
        return print(&(serde_json::to_string_pretty(&document).map_err(Failure::run)? + "\n"));
    }
    let mut text = match &arguments.output {
        Some(path) if places.len() > 1 => {
            let places = number::count(places.len(), "place");
            format!("{}\n  predicted at {places}, written {}\n", study.title, path.display())
        }
        _ => {
            let each = places.iter().zip(&forecasts);
            each.map(|(place, forecasts)| text_of(&analysed, place, forecasts, confidence)).collect()
        }
    };
    match &confirmed[..] {
        [] => {}
        [confirmed] => text.push_str(&confirmed_text(&analysed, confirmed)),
        all => text.push_str(&confirmed_places_text(&analysed, &forecasts, all)),
    }
    print(&text)
}

/// Refuses places beyond the runs, unless they were asked for.
fn refuse_beyond(places: &[Place], extrapolate: bool) -> Result<(), Failure> {
    let beyond = places.iter().enumerate().find(|(_, place)| !place.beyond.is_empty());
    let Some((at, place)) = beyond.filter(|_| !extrapolate) else { return Ok(()) };
    let which = if places.len() > 1 { format!("place {}: ", at + 1) } else { String::new() };
    Err(Failure::input(format!(
        "{which}{}; the model knows nothing there, give --extrapolate to see what it says nevertheless",
        brief::list(&place.beyond, ", ")
    )))
}

/// What is expected of each response at a place; none of one without a model.
fn forecasts_at(
    analysed: &Analysed,
    surrogates: &[Option<Box<dyn Surrogate + '_>>],
    place: &Place,
    confidence: f64,
) -> Result<Vec<Option<Forecast>>, Failure> {
    let path = &analysed.plan.study().path;
    let of = |surrogate: &Option<Box<dyn Surrogate + '_>>| {
        let forecast = surrogate.as_ref().map(|surrogate| surrogate.forecast(&place.settings, confidence));
        forecast.transpose().map_err(|error| Failure::input(format!("{}: {error}", path.display())))
    };
    surrogates.iter().map(of).collect()
}

/// The places that the command line asks for.
fn places(analysed: &Analysed, arguments: &PredictArguments) -> Result<Vec<Place>, Failure> {
    let study = analysed.plan.study();
    let space = Space::new(study, &analysed.analysis);
    let at = |error: String| Failure::input(format!("--at: {error}"));
    let given = space.named(&arguments.at).map_err(at)?;
    if let Some(path) = &arguments.points {
        return points(analysed, &space, &given, path);
    }
    match arguments.grid {
        Some(count) => grid(analysed, &space, &given, count as usize),
        None => Ok(vec![given]),
    }
}

/// The places of a table; factors that it has no column of are where `given` says.
fn points(analysed: &Analysed, space: &Space<'_>, given: &Place, path: &Path) -> Result<Vec<Place>, Failure> {
    let factors = &analysed.plan.study().factors;
    let table = ValueTable::read(path).map_err(Failure::input)?;
    let columns = table.factor_columns(factors).map_err(Failure::input)?;
    let known: HashSet<usize> = columns.iter().copied().flatten().collect();
    if let Some((_, unknown)) = table.heads().iter().enumerate().find(|(at, _)| !known.contains(at)) {
        let (path, unknown) = (path.display(), short(unknown));
        return Err(Failure::input(format!("{path}: column \"{unknown}\" is not a factor of the study")));
    }
    let place = |row: &Row| {
        let each = factors.iter().zip(&columns).zip(&given.levels);
        let levels = each.map(|((factor, column), held)| match column {
            Some(column) => table.level(row, *column, factor).map(Some),
            None => Ok((!given.assumed.contains(&factor.name)).then(|| held.clone())),
        });
        let levels = levels.collect::<Result<Vec<_>, String>>()?;
        space.at(levels).map_err(|error| format!("{}: {error}", table.place(row)))
    };
    table.rows().iter().map(place).collect::<Result<_, String>>().map_err(Failure::input)
}

/// So many values of each range with all levels; factors that are given stay.
fn grid(analysed: &Analysed, space: &Space<'_>, given: &Place, count: usize) -> Result<Vec<Place>, Failure> {
    let mut all: Vec<Vec<Setting>> = vec![Vec::new()];
    let last = (count.max(2) - 1) as f64;
    for (factor, held) in given.settings.iter().enumerate() {
        let is_given = !given.assumed.contains(&analysed.plan.study().factors[factor].name);
        let settings: Vec<Setting> = match () {
            () if is_given => vec![*held],
            () if space.is_continuous(factor) => {
                (0..count).map(|at| Setting::Coded(-1.0 + 2.0 * at as f64 / last)).collect()
            }
            () => space.levels(factor),
        };
        if all.len().saturating_mul(settings.len()) > MOST_PLACES {
            return Err(Failure::input(format!(
                "--grid {count}: more than {MOST_PLACES} places; hold factors with --at"
            )));
        }
        let with = |before: &Vec<Setting>| {
            settings.iter().map(|own| [before.as_slice(), &[*own]].concat()).collect::<Vec<_>>()
        };
        all = all.iter().flat_map(with).collect();
    }
    all.into_iter().map(|settings| space.of(settings)).collect::<Result<_, String>>().map_err(Failure::input)
}

/// What is said of a place.
fn text_of(analysed: &Analysed, place: &Place, forecasts: &[Option<Forecast>], confidence: f64) -> String {
    let study = analysed.plan.study();
    let words = Space::new(study, &analysed.analysis).words(place);
    let mut heading = format!("{}\n  at {words}", study.title);
    if !place.assumed.is_empty() {
        heading.push_str("\n  not given: in the middle of the range, or at the first level");
    }
    let beyond = place.beyond.join(", ");
    let heads = heads(confidence);
    let names: Vec<&str> = heads.iter().map(String::as_str).chain([""]).collect();
    let line = |(response, forecast): (&AnalysedResponse, &Option<Forecast>)| {
        let mut cells = match (forecast, &response.effects) {
            (Some(forecast), _) => response.cells(forecast),
            (None, Err(error)) => vec![response.head(), format!("– ({error})")],
            (None, Ok(_)) => vec![response.head(), "–".to_owned()],
        };
        cells.resize(heads.len(), String::new());
        cells.push(beyond.clone());
        cells
    };
    let rows: Vec<Vec<String>> = analysed.analysis.responses.iter().zip(forecasts).map(line).collect();
    columns(&heading, &names, &rows)
        + &reasons(analysed)
        + &notes_of_place(analysed, place)
        + &notes_of_intervals(analysed, forecasts)
}

/// Of which responses the runs do not tell what is at a place, a line for each.
pub(super) fn notes_of_place(analysed: &Analysed, place: &Place) -> String {
    let notes = analysed.analysis.responses.iter().filter_map(|response| response.note_of_place(&place.settings));
    notes.map(|note| format!("  {note}\n")).collect()
}

/// Which intervals are cut where a response cannot be, and which few seeds make as wide as another one, a line for each.
pub(super) fn notes_of_intervals(analysed: &Analysed, forecasts: &[Option<Forecast>]) -> String {
    let each = analysed.analysis.responses.iter().zip(forecasts);
    let each = each.filter_map(|(response, forecast)| Some((response, forecast.as_ref()?)));
    let notes = each.flat_map(|(response, forecast)| {
        [response.note_of_bounds(forecast), response.note_of_few_seeds(forecast)].into_iter().flatten()
    });
    notes.map(|note| format!("  {note}\n")).collect()
}

/// Why a response is forecast by what it is, a line for each of which there was a choice; and of which the model misses something.
pub(super) fn reasons(analysed: &Analysed) -> String {
    let reason =
        |response: &AnalysedResponse| Some(format!("  {}: {}\n", response.name, response.reason_of_surrogate()?));
    let misfit = |response: &AnalysedResponse| Some(format!("  {}\n", response.note_of_misfit()?));
    let responses = &analysed.analysis.responses;
    responses.iter().filter_map(reason).chain(responses.iter().filter_map(misfit)).collect()
}

/// What the extra runs gave.
pub(super) fn confirmed_text(analysed: &Analysed, confirmed: &[Option<Confirmed>]) -> String {
    let rows = confirmed.iter().enumerate();
    let rows: Vec<Vec<String>> = rows
        .filter_map(|(response, confirmed)| Some(confirmed.as_ref()?.cells(&analysed.analysis, response)))
        .collect();
    let has_errors = confirmed.iter().flatten().any(|confirmed| confirmed.standard_error.is_some());
    let heading = match has_errors {
        true => "Confirmed by extra runs, mean ± standard error",
        false => "Compared with one extra run, which tells no error",
    };
    columns(heading, &["response", "mean", "runs", ""], &rows)
}

/// What the extra runs gave at many places: how many are within the interval, and how far off the forecast is.
fn confirmed_places_text(
    analysed: &Analysed,
    forecasts: &[Vec<Option<Forecast>>],
    confirmed: &[Vec<Option<Confirmed>>],
) -> String {
    let line = |(at, response): (usize, &AnalysedResponse)| {
        let each = forecasts.iter().zip(confirmed);
        let pairs: Vec<(Forecast, Confirmed)> = each.filter_map(|(own, made)| Some((own[at]?, made[at]?))).collect();
        let squares: f64 = pairs.iter().map(|(forecast, made)| (made.mean - forecast.value).powi(2)).sum();
        let off = (squares / pairs.len() as f64).sqrt();
        let within = pairs.iter().filter(|(_, made)| made.within_run_interval == Some(true)).count();
        (!pairs.is_empty()).then(|| {
            let off = number::short(response.scale.unit.difference(off));
            vec![response.head(), off, format!("{within} of {}", pairs.len())]
        })
    };
    let rows: Vec<Vec<String>> = analysed.analysis.responses.iter().enumerate().filter_map(line).collect();
    let heading = "Confirmed by extra runs: root mean square of (mean of a place's runs − predicted)";
    columns(heading, &["response", "apart", "places within the interval of runs"], &rows)
}

/// What `plateau sweep predict --json` prints. All numbers are in SI units.
#[derive(Debug, Serialize)]
struct Document<'a> {
    study: &'a str,
    confidence: f64,
    models: Vec<Option<String>>,
    places: Vec<PlaceReport>,
}

/// A place in it.
#[derive(Debug, Serialize)]
struct PlaceReport {
    settings: Vec<SettingReport>,
    beyond: Vec<String>,
    responses: Vec<ForecastReport>,
    /// What extra runs gave, for each response.
    confirmed: Option<Vec<Option<Confirmed>>>,
}

/// A factor's value.
#[derive(Debug, Serialize)]
pub(super) struct SettingReport {
    pub factor: String,
    pub value: String,
    /// SI; absent of words.
    pub number: Option<f64>,
    pub given: bool,
}

/// What is expected of a response.
#[derive(Debug, Serialize)]
pub(super) struct ForecastReport {
    pub name: String,
    pub unit: &'static str,
    pub value: Option<f64>,
    pub mean_interval: Option<[f64; 2]>,
    pub run_interval: Option<[f64; 2]>,
    pub error: Option<String>,
}

/// The settings of a place.
pub(super) fn settings_of(analysed: &Analysed, place: &Place) -> Vec<SettingReport> {
    let each = analysed.plan.study().factors.iter().zip(&place.levels);
    each.map(|(factor, level)| SettingReport {
        factor: factor.name.clone(),
        value: level.label.clone(),
        number: level.number,
        given: !place.assumed.contains(&factor.name),
    })
    .collect()
}

/// What is expected of each response.
pub(super) fn forecasts_of(analysed: &Analysed, forecasts: &[Option<Forecast>]) -> Vec<ForecastReport> {
    let each = analysed.analysis.responses.iter().zip(forecasts);
    each.map(|(response, forecast)| ForecastReport {
        name: response.name.clone(),
        unit: response.unit,
        value: forecast.map(|forecast| forecast.value),
        mean_interval: forecast.and_then(|forecast| forecast.mean_interval),
        run_interval: forecast.and_then(|forecast| forecast.run_interval),
        error: response.effects.as_ref().err().map(ToString::to_string),
    })
    .collect()
}

impl PlaceReport {
    fn new(
        analysed: &Analysed,
        place: &Place,
        forecasts: &[Option<Forecast>],
        confirmed: Option<Vec<Option<Confirmed>>>,
    ) -> Self {
        Self {
            settings: settings_of(analysed, place),
            beyond: place.beyond.clone(),
            responses: forecasts_of(analysed, forecasts),
            confirmed,
        }
    }
}
