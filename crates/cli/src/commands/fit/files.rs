//! Tables and figures of a fit.

use plateau_io::study::Study;
use plateau_io::study::results_table::table as table_of_runs;
use plateau_present::figure::fit::figures;
use plateau_present::figure::fit_series::figures as figures_of_series;
use plateau_present::study::fit::parts;

use super::Told;
use crate::arguments::FitArguments;
use crate::csv_table::csv_table;
use crate::failure::Failure;
use crate::output_folder::{OutputFolder, names_of};

/// The tables, of which the third is there where a series was measured.
const TABLES: [&str; 5] = ["keys.csv", "responses.csv", "series.csv", "profiles.csv", "runs.csv"];

/// The folder of a fit that is to be made. What an earlier fit of the same study wrote there is replaced, for a fit goes on where it
/// was.
///
/// # Errors
/// [`Failure::Input`] when it has files of somebody else.
pub fn folder(study: &Study, arguments: &FitArguments) -> Result<OutputFolder, Failure> {
    let path = arguments.output.clone().unwrap_or_else(|| study.directory.join("fit"));
    let folder = OutputFolder::of("fit", &study.path, path, arguments.force)?;
    folder.check(TABLES, &study.inputs())?;
    Ok(folder)
}

/// Writes all; their paths.
///
/// # Errors
/// [`Failure::Run`] when a figure cannot be drawn, and those of [`OutputFolder`].
pub fn write(told: &Told<'_>, mut folder: OutputFolder) -> Result<Vec<String>, Failure> {
    let runs = table_of_runs(&told.fitted.plan, &told.fitted.collected);
    let [of_keys, of_responses, of_series, of_profiles, of_runs] = TABLES;
    let mut tables = vec![(of_keys, keys(told)), (of_responses, responses(told))];
    tables.extend((!told.result.series.is_empty()).then(|| (of_series, series(told))));
    tables.extend([(of_profiles, profiles(told)), (of_runs, runs)]);
    let values = |run: &plateau_io::study::collected::CollectedRun| {
        run.run.levels.iter().map(|level| level.number.unwrap_or(f64::NAN)).collect::<Vec<f64>>()
    };
    let runs: Vec<Vec<f64>> = told.fitted.collected.runs.iter().map(values).collect();
    let figures =
        [figures(told.result, told.keys, &runs), figures_of_series(told.result, &told.series(), &told.times())]
            .concat();
    let names: Vec<String> =
        tables.iter().map(|(name, _)| (*name).to_owned()).chain(names_of(figures.iter())).collect();
    folder.begin(&names, &told.fitted.inputs)?;
    for (name, lines) in tables {
        folder.write(name, csv_table(lines).as_bytes())?;
    }
    folder.write_figures(&figures)?;
    Ok(folder.files().to_vec())
}

/// A number with all its digits.
fn exactly(number: f64) -> String {
    format!("{number:?}")
}

fn heads<const N: usize>(names: [&str; N]) -> Vec<String> {
    names.map(str::to_owned).to_vec()
}

/// A line for each piece of the interval of each key.
fn keys(told: &Told<'_>) -> Vec<Vec<String>> {
    let mut lines = vec![heads(["key", "unit", "most_likely", "low", "high", "open_below", "open_above"])];
    let study = told.fitted.plan.study();
    for ((factor, best), profile) in study.factors.iter().zip(&told.result.best).zip(&told.result.profiles) {
        for piece in parts(profile) {
            let [low, high] = piece.ends.map(exactly);
            let [below, above] = piece.open.map(|open| open.to_string());
            // What may be anywhere has no value that is likelier than others.
            let likely = if profile.is_undetermined() { String::new() } else { exactly(*best) };
            lines.push(vec![factor.name.clone(), factor.unit().to_owned(), likely, low, high, below, above]);
        }
    }
    lines
}

fn responses(told: &Told<'_>) -> Vec<Vec<String>> {
    let mut lines = vec![heads([
        "response",
        "unit",
        "measured",
        "uncertainty",
        "forecast",
        "surrogate_deviation",
        "seeds_deviation",
        "seed_to_seed",
        "leave_one_out_error",
    ])];
    let responses = told.names().into_iter().zip(told.units()).zip(&told.result.responses);
    lines.extend(responses.map(|((name, unit), response)| {
        vec![
            name.to_owned(),
            unit.to_owned(),
            exactly(response.measurement.value),
            exactly(response.measurement.uncertainty),
            exactly(response.forecast),
            exactly(response.surrogate_deviation),
            exactly(response.seeds_deviation),
            response.scatter.map_or_else(String::new, exactly),
            exactly(response.leave_one_out_error),
        ]
    }));
    lines
}

/// A line for each point of each series.
fn series(told: &Told<'_>) -> Vec<Vec<String>> {
    let mut lines =
        vec![heads(["response", "unit", "time", "measured", "uncertainty", "forecast", "forecast_deviation"])];
    for ((name, unit), series) in told.series().into_iter().zip(&told.result.series) {
        let measured = &series.measured;
        let points = measured.times().iter().zip(measured.values()).zip(measured.uncertainties());
        for (((time, value), uncertainty), (forecast, deviation)) in
            points.zip(series.forecast.iter().zip(&series.deviations))
        {
            let numbers = [time, value, uncertainty, forecast, deviation].map(|number| exactly(*number));
            lines.push([name.to_owned(), unit.to_owned()].into_iter().chain(numbers).collect());
        }
    }
    lines
}

/// A line for each place of each profile.
fn profiles(told: &Told<'_>) -> Vec<Vec<String>> {
    let mut lines = vec![heads(["key", "value", "rise", "threshold"])];
    for (factor, profile) in told.fitted.plan.study().factors.iter().zip(&told.result.profiles) {
        for (value, rise) in profile.values.iter().zip(&profile.rises) {
            lines.push(vec![factor.name.clone(), exactly(*value), exactly(*rise), exactly(profile.threshold)]);
        }
    }
    lines
}
