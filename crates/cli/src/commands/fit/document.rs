//! What `plateau fit --json` prints.

use plateau_present::study::fit::{determined, notes, parts};
use plateau_present::study::fit_series::notes as notes_of_series;
use serde::Serialize;

use super::Told;
use super::rounds::End;
use crate::failure::Failure;

/// The document; numbers in SI units.
#[derive(Debug, Serialize)]
struct Document<'a> {
    study: &'a str,
    keys: Vec<KeyReport<'a>>,
    responses: Vec<ResponseReport<'a>>,
    /// Responses of which a whole series was measured; what runs give is in series.csv.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    series: Vec<SeriesReport<'a>>,
    /// Level of intervals.
    confidence: f64,
    misfit: f64,
    degrees_of_freedom: usize,
    p: Option<f64>,
    /// What is determined where single keys are not.
    determined: Option<String>,
    notes: Vec<String>,
    runs: usize,
    runs_at_most: usize,
    rounds: usize,
    /// Why no more runs were made: settled, budget, nowhere else or no gain.
    ended: &'static str,
    /// The largest variance of a forecast over that of its measurement, where the measurements are likely.
    surrogate_share: f64,
    files: &'a [String],
}

#[derive(Debug, Serialize)]
struct KeyReport<'a> {
    name: &'a str,
    keys: &'a [String],
    unit: &'a str,
    /// None where it may be anywhere.
    most_likely: Option<f64>,
    /// Pieces of the interval.
    interval: Vec<PieceReport>,
    /// Whether the interval is the whole range.
    undetermined: bool,
}

#[derive(Debug, Serialize)]
struct PieceReport {
    low: f64,
    high: f64,
    /// Whether it goes on below and above, as far as the data tell.
    open_below: bool,
    open_above: bool,
}

#[derive(Debug, Serialize)]
struct ResponseReport<'a> {
    name: &'a str,
    unit: &'a str,
    measured: f64,
    uncertainty: f64,
    forecast: f64,
    surrogate_deviation: f64,
    seeds_deviation: f64,
    seed_to_seed: Option<f64>,
    leave_one_out_error: f64,
}

#[derive(Debug, Serialize)]
struct SeriesReport<'a> {
    name: &'a str,
    unit: &'static str,
    points: usize,
    correlation_time: f64,
    /// How many independent points would tell a constant as well.
    independent_points: f64,
    components: usize,
    /// Root mean square of the deviations, over the uncertainties.
    apart: f64,
    /// Correlation of successive deviations.
    successive: f64,
}

/// The document as text.
///
/// # Errors
/// [`Failure::Run`] when it cannot be written as JSON.
pub fn text(told: &Told<'_>, files: &[String]) -> Result<String, Failure> {
    let study = told.fitted.plan.study();
    let keys = study.factors.iter().zip(&told.result.best).zip(&told.result.profiles);
    let keys = keys.map(|((factor, best), profile)| KeyReport {
        name: &factor.name,
        keys: &factor.keys,
        unit: factor.unit(),
        most_likely: (!profile.is_undetermined()).then_some(*best),
        interval: parts(profile)
            .iter()
            .map(|piece| PieceReport {
                low: piece.ends[0],
                high: piece.ends[1],
                open_below: piece.open[0],
                open_above: piece.open[1],
            })
            .collect(),
        undetermined: profile.is_undetermined(),
    });
    let responses = told.names().into_iter().zip(told.units()).zip(&told.result.responses);
    let responses = responses.map(|((name, unit), response)| ResponseReport {
        name,
        unit,
        measured: response.measurement.value,
        uncertainty: response.measurement.uncertainty,
        forecast: response.forecast,
        surrogate_deviation: response.surrogate_deviation,
        seeds_deviation: response.seeds_deviation,
        seed_to_seed: response.scatter,
        leave_one_out_error: response.leave_one_out_error,
    });
    let series = told.series().into_iter().zip(&told.result.series);
    let series = series.map(|((name, unit), series)| SeriesReport {
        name,
        unit,
        points: series.measured.times().len(),
        correlation_time: series.measured.correlation_time(),
        independent_points: series.measured.independent_points(),
        components: series.components,
        apart: series.apart,
        successive: series.successive,
    });
    let names: Vec<&str> = told.series().iter().map(|(name, _)| *name).collect();
    let document = Document {
        study: &study.title,
        keys: keys.collect(),
        responses: responses.collect(),
        series: series.collect(),
        confidence: told.result.confidence,
        misfit: told.result.misfit,
        degrees_of_freedom: told.result.freedom,
        p: told.result.p,
        determined: determined(told.result, told.keys),
        notes: [notes(told.result, &told.names(), &names, told.has_no_gain()), notes_of_series(told.result, &names)]
            .concat(),
        runs: told.fitted.plan.runs(),
        runs_at_most: study.fit.runs,
        rounds: told.fitted.rounds,
        ended: match told.fitted.end {
            End::Settled => "settled",
            End::Budget => "budget",
            End::NowhereElse => "nowhere else",
            End::NoGain => "no gain",
        },
        surrogate_share: told.result.surrogate_share,
        files,
    };
    Ok(serde_json::to_string_pretty(&document).map_err(Failure::run)? + "\n")
}
