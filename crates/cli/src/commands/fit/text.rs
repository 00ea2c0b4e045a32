//! What a fit says in the terminal.

use plateau_present::study::fit::{determined, notes, unit};
use plateau_present::study::fit_series::notes as notes_of_series;
use plateau_study::fit::FittedSeries;

use super::Told;
use super::rounds::End;
use crate::number;
use crate::table::{columns, list, table};

/// The whole text.
pub fn text(told: &Told<'_>, files: &[String]) -> String {
    let study = told.fitted.plan.study();
    let mut text = columns("Keys", &["key", "most likely", &format!("{} interval", level(told))], &keys(told));
    if !told.result.responses.is_empty() {
        text.push_str(&columns(
            "\nResponses at the most likely values",
            &["response", "measured", "runs give", "seed to seed", "apart"],
            &responses(told),
        ));
    }
    if !told.result.series.is_empty() {
        text.push_str(&columns(
            "\nSeries at the most likely values",
            &["response", "points", "count as", "components", "apart"],
            &series(told),
        ));
    }
    let mut said: Vec<String> = determined(told.result, told.keys).into_iter().collect();
    let of_series: Vec<&str> = told.series().iter().map(|(name, _)| *name).collect();
    said.extend(notes(told.result, &told.names(), &of_series, told.has_no_gain()));
    said.extend(notes_of_series(told.result, &of_series));
    if !said.is_empty() {
        text.push_str(&list("\nTo be known", &said));
    }
    let mut rows = vec![("runs", runs(told)), ("misfit", misfit(told))];
    let is_figure = |file: &&String| file.ends_with(".png");
    let is_table = |file: &&String| file.ends_with(".csv");
    rows.extend(files.iter().filter(is_table).map(|file| ("written", file.clone())));
    let figures = files.iter().filter(is_figure).count();
    rows.push(("written", format!("{} as PNG, SVG and PDF beside them", number::count(figures, "figure"))));
    text.push('\n');
    text.push_str(&table(&study.title, &rows));
    text
}

/// The level of intervals.
pub fn level(told: &Told<'_>) -> String {
    number::confidence(told.result.confidence)
}

fn keys(told: &Told<'_>) -> Vec<Vec<String>> {
    let row = |at: usize| {
        let key = &told.keys[at];
        // What can be anywhere has no value that is likelier than others.
        let likely = match told.result.profiles[at].is_undetermined() {
            true => "–".to_owned(),
            false => key.words(told.result.best[at]),
        };
        vec![key.name.clone(), likely, key.interval(&told.result.profiles[at])]
    };
    (0..told.keys.len()).map(row).collect()
}

fn responses(told: &Told<'_>) -> Vec<Vec<String>> {
    let names = told.names().into_iter().zip(told.units()).zip(&told.result.responses);
    let row = |((name, si), response): ((&str, &str), &plateau_study::fit::FittedResponse)| {
        let unit = unit(si, response);
        let with_error = |value: f64, error: f64| {
            unit.with_symbol(&number::with_error(unit.value(value), Some(unit.difference(error)).filter(|e| *e > 0.0)))
        };
        let measured = response.measurement;
        let deviation = response.surrogate_deviation.hypot(response.seeds_deviation);
        let away = (response.forecast - measured.value) / measured.uncertainty.hypot(deviation);
        let scatter = response.scatter.map(|scatter| number::significant(unit.difference(scatter), 2));
        vec![
            name.to_owned(),
            with_error(measured.value, measured.uncertainty),
            with_error(response.forecast, deviation),
            scatter.map_or_else(|| "not known".to_owned(), |scatter| unit.with_symbol(&scatter)),
            format!("{} deviations", number::with_minus(&format!("{:.1}", away + 0.0)).replace("−0.0", "0.0")),
        ]
    };
    names.map(row).collect()
}

fn series(told: &Told<'_>) -> Vec<Vec<String>> {
    let row = |((name, _), series): ((&str, &str), &FittedSeries)| {
        let points = series.measured.times().len();
        vec![
            name.to_owned(),
            points.to_string(),
            format!("{} independent", number::rounded(series.measured.independent_points(), 3)),
            series.components.to_string(),
            format!("{} uncertainties apart (root mean square)", number::rounded(series.apart, 2)),
        ]
    };
    told.series().into_iter().zip(&told.result.series).map(row).collect()
}

fn runs(told: &Told<'_>) -> String {
    let (runs, study) = (told.fitted.plan.runs(), told.fitted.plan.study());
    let why = match told.fitted.end {
        End::Settled => "further runs are expected to change little",
        End::Budget => "the limit of runs in [fit] is reached",
        End::NowhereElse => "every place that counts was run",
        End::NoGain => "more would hardly help, for runs scatter too much",
    };
    let (points, first, seeds) = (told.fitted.plan.points(), told.fitted.first_points, told.fitted.plan.replicates());
    let seeds = if seeds > 1 { format!(", {seeds} seeds each") } else { String::new() };
    format!(
        "{runs} of at most {}: {first} points of the design and {} more{seeds}; {why}",
        study.fit.runs.max(runs),
        points - first
    )
}

fn misfit(told: &Told<'_>) -> String {
    let chi = format!("χ² = {}", number::rounded(told.result.misfit, 3));
    match told.result.p {
        Some(p) => {
            format!(
                "{chi} with {} of freedom, p = {}",
                number::count(told.result.freedom, "degree"),
                number::significant(p, 2)
            )
        }
        None => format!("{chi}; there are no more measurements than keys, so the misfit cannot be tested"),
    }
}
