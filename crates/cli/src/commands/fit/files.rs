//! Tables and figures of a fit.

use plateau_io::study::results_table::table as table_of_runs;
use plateau_present::figure::Format;
use plateau_present::figure::fit::figures;

use super::Told;
use crate::arguments::FitArguments;
use crate::csv_table::csv_table;
use crate::failure::Failure;
use crate::output;

/// Writes all; their paths.
///
/// # Errors
/// [`Failure::Run`] when a figure cannot be drawn, and those of [`output::write()`].
pub fn write(told: &Told<'_>, arguments: &FitArguments) -> Result<Vec<String>, Failure> {
    let study = told.fitted.plan.study();
    let folder = arguments.output.clone().unwrap_or_else(|| study.directory.join("fit"));
    output::make_directory(&folder)?;
    let mut files = Vec::new();
    let mut add = |name: &str, content: &[u8]| {
        let path = folder.join(name);
        files.push(path.display().to_string());
        output::write(&path, content, true)
    };
    add("keys.csv", csv_table(keys(told)).as_bytes())?;
    add("responses.csv", csv_table(responses(told)).as_bytes())?;
    add("profiles.csv", csv_table(profiles(told)).as_bytes())?;
    add("runs.csv", csv_table(table_of_runs(&told.fitted.plan, &told.fitted.collected)).as_bytes())?;
    let values = |run: &plateau_io::study::collected::CollectedRun| {
        run.run.levels.iter().map(|level| level.number.unwrap_or(f64::NAN)).collect::<Vec<f64>>()
    };
    let runs: Vec<Vec<f64>> = told.fitted.collected.runs.iter().map(values).collect();
    for figure in figures(told.result, told.keys, &runs) {
        for format in Format::ALL {
            let content = match format {
                Format::Svg => figure.svg().map_err(Failure::run)?.into_bytes(),
                format => figure.draw(format).map_err(Failure::run)?,
            };
            add(&format!("{}.{}", figure.name, format.ending()), &content)?;
        }
    }
    Ok(files)
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
        for piece in &profile.pieces {
            let [low, high] = piece.ends.map(exactly);
            let [below, above] = piece.open.map(|open| open.to_string());
            lines.push(vec![factor.name.clone(), factor.unit().to_owned(), exactly(*best), low, high, below, above]);
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
