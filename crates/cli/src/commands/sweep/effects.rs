//! `plateau sweep effects`: what the factors of a study do to its responses.

use std::path::Path;

use plateau_present::figure::Format;
use plateau_present::study::analysis::{AnalysedResponse, Analysis};
use plateau_present::study::model::{lack_of_fit, name};
use plateau_present::study::words::{quality, repeats_in_words};
use plateau_study::effects::{self, Effects, Term};
use serde::Serialize;

use super::collect::collected;
use super::effects_files;
use crate::arguments::EffectsArguments;
use crate::csv_table::csv_table;
use crate::failure::Failure;
use crate::sweep;
use crate::table::{columns, print, table};
use crate::{message, number, output};

/// Analyses the results.
pub fn effects(arguments: &EffectsArguments) -> Result<(), Failure> {
    let plan = sweep::plan(&arguments.study)?;
    let study = plan.study();
    if study.responses.is_empty() {
        return Err(Failure::input(format_args!(
            "{}: no [[response]], so there is nothing to analyse; name one, such as dataset = \"/series/contact_area_mean\", \
             at = \"end\"",
            study.path.display()
        )));
    }
    let collected = collected(&plan)?;
    let left_out = collected.runs.len() - collected.count("finished");
    if left_out > 0 {
        message::warning(format_args!(
            "{} of {} have no results and are left out: {} failed, {} not made yet",
            left_out,
            number::count(collected.runs.len(), "run"),
            collected.count("failed"),
            collected.count("missing")
        ));
    }
    let analysis = Analysis::new(study, &collected, arguments.model.map(Into::into), arguments.confidence);
    let folder = arguments.output.clone().unwrap_or_else(|| study.directory.join("effects"));
    output::make_directory(&folder)?;
    let csv = folder.join("effects.csv");
    output::write(&csv, rows(&analysis).as_bytes(), true)?;
    let mut files = vec![csv.display().to_string()];
    files.extend(effects_files::write(&folder, &plan, &collected, &analysis)?);
    let reports: Vec<Report> = analysis.responses.iter().map(Report::new).collect();
    if arguments.json {
        let report = Document { study: &study.title, repeats: collected.repeats(), responses: reports, files };
        return print(&(serde_json::to_string_pretty(&report).map_err(Failure::run)? + "\n"));
    }
    let repeats = Some(collected.repeats()).filter(|repeats| *repeats > 0);
    let mut text = repeats.map_or_else(String::new, |repeats| repeats_in_words(repeats, collected.runs.len()) + "\n\n");
    text.extend(analysis.responses.iter().map(|response| text_of(response) + "\n"));
    text.push_str(&table(&study.title, &told(&folder, &files)));
    print(&text)
}

/// The files, with those that are figures as one.
fn told(folder: &Path, files: &[String]) -> Vec<(&'static str, String)> {
    let is_figure = |file: &&String| file.ends_with(".png");
    let is_drawing = |file: &&String| Format::of(Path::new(file)).is_some();
    let mut told: Vec<_> =
        files.iter().filter(|file| !is_drawing(file)).map(|file| ("written", file.clone())).collect();
    let figures = files.iter().filter(is_figure).count();
    if figures > 0 {
        let figures = number::count(figures, "figure");
        told.push(("written", format!("{figures} as PNG, SVG and PDF in {}", folder.display())));
    }
    told
}

/// A line for each response and term.
fn rows(analysis: &Analysis) -> String {
    let header = [
        "response",
        "term",
        "degrees_of_freedom",
        "sum_of_squares",
        "mean_square",
        "f",
        "p",
        "share",
        "effect",
        "coefficient",
        "standard_error",
        "t",
        "low",
        "high",
        "margin_of_error",
        "simultaneous_margin_of_error",
        "aliased_with",
    ];
    let mut lines = vec![header.map(str::to_owned).to_vec()];
    let shown = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:?}"));
    for response in &analysis.responses {
        let Ok(effects) = &response.effects else { continue };
        for term in effects.rows() {
            let uncertainty = term.estimate.and_then(|estimate| estimate.uncertainty);
            lines.push(vec![
                response.name.clone(),
                term.label.clone(),
                term.freedom.to_string(),
                shown(Some(term.sum_of_squares)),
                shown(term.mean_square()),
                shown(term.test.map(|test| test.f)),
                shown(term.test.map(|test| test.p)),
                shown(Some(term.share)),
                shown(term.estimate.map(|estimate| estimate.effect)),
                shown(term.estimate.map(|estimate| estimate.coefficient)),
                shown(uncertainty.map(|uncertainty| uncertainty.standard_error)),
                shown(uncertainty.map(|uncertainty| uncertainty.t)),
                shown(uncertainty.map(|uncertainty| uncertainty.interval[0])),
                shown(uncertainty.map(|uncertainty| uncertainty.interval[1])),
                shown(term.estimate.and(effects.lenth).map(|lenth| lenth.margin)),
                shown(term.estimate.and(effects.lenth).map(|lenth| lenth.simultaneous_margin)),
                term.aliased_with.join("; "),
            ]);
        }
        for (name, squares) in [("residual", effects.residual.squares), ("total", effects.total)] {
            let mut cells = vec![
                response.name.clone(),
                name.to_owned(),
                squares.freedom.to_string(),
                shown(Some(squares.sum)),
                shown(squares.mean()),
            ];
            cells.resize(header.len(), String::new());
            lines.push(cells);
        }
    }
    csv_table(lines)
}

/// What is said of a response.
fn text_of(response: &AnalysedResponse) -> String {
    let unit = if response.unit == "1" { String::new() } else { format!(" ({})", response.unit) };
    let heading = format!("{}{unit}", response.name);
    let effects = match &response.effects {
        Ok(effects) => effects,
        Err(error) => return format!("{heading}\n  {error}\n"),
    };
    let misfit = response.misfit.as_ref().map(|misfit| lack_of_fit(misfit, effects.r_squared));
    let notes = [Some(response.choice.words()), misfit].into_iter().flatten();
    let heading = notes.fold(heading, |heading, note| format!("{heading}\n  {note}"));
    let names = ["term", "effect", "interval", "share", "F", "p"];
    let mut rows: Vec<&Term> = effects.rows().collect();
    rows.sort_by(|a, b| b.share.total_cmp(&a.share));
    let rows: Vec<Vec<String>> = rows.into_iter().map(cells).collect();
    let mut text = columns(&heading, &names, &rows);
    text.push_str(&format!("  {}\n", quality(effects, number::short)));
    for term in effects.rows().filter(|term| !term.aliased_with.is_empty()) {
        text.push_str(&format!("  {} cannot be told from {}\n", term.label, term.aliased_with.join(", ")));
    }
    text
}

fn cells(term: &Term) -> Vec<String> {
    let uncertainty = term.estimate.and_then(|estimate| estimate.uncertainty);
    let effect = term.estimate.map_or_else(String::new, |estimate| number::short(estimate.effect));
    let interval = uncertainty.map_or_else(String::new, |uncertainty| {
        let [low, high] = uncertainty.interval.map(number::short);
        format!("{low} … {high}")
    });
    let test = |value: fn(&effects::Test) -> f64| {
        term.test.as_ref().map_or_else(String::new, |test| number::short(value(test)))
    };
    vec![
        term.label.clone(),
        effect,
        interval,
        format!("{:.1} %", 100.0 * term.share),
        test(|test| test.f),
        test(|test| test.p),
    ]
}

/// What `plateau sweep effects --json` prints.
#[derive(Debug, Serialize)]
struct Document<'a> {
    study: &'a str,
    /// Runs that repeat another one and count once with it.
    repeats: usize,
    responses: Vec<Report>,
    files: Vec<String>,
}

/// A response in it.
#[derive(Debug, Serialize)]
struct Report {
    name: String,
    unit: &'static str,
    /// Why there are no effects.
    error: Option<String>,
    /// As `--model` calls it.
    model: &'static str,
    /// Why it is that one.
    model_reason: String,
    /// Runs that have a response, each counted once.
    runs: usize,
    missing: usize,
    /// Mean of the responses.
    mean: f64,
    /// What the model says where all ranges are in the middle, averaged over levels.
    middle: f64,
    r_squared: f64,
    adjusted_r_squared: Option<f64>,
    predicted_r_squared: Option<f64>,
    residual_standard_deviation: Option<f64>,
    error_from: String,
    lack_of_fit: Option<MisfitReport>,
    lenth: Option<LenthReport>,
    terms: Vec<TermReport>,
}

/// A lack of fit that is significant.
#[derive(Debug, Serialize)]
struct MisfitReport {
    /// Absent where the other model leaves nothing.
    f: Option<f64>,
    p: f64,
    /// Whether replicates tell it; else the model to try does.
    by_replicates: bool,
    model_to_try: Option<&'static str>,
    /// Of the model to try.
    r_squared: Option<f64>,
}

/// What judges effects where there is no error.
#[derive(Debug, Serialize)]
struct LenthReport {
    pseudo_standard_error: f64,
    margin_of_error: f64,
    simultaneous_margin_of_error: f64,
}

#[derive(Debug, Serialize)]
struct TermReport {
    label: String,
    degrees_of_freedom: usize,
    sum_of_squares: f64,
    share: f64,
    f: Option<f64>,
    p: Option<f64>,
    effect: Option<f64>,
    standard_error: Option<f64>,
    interval: Option<[f64; 2]>,
    aliased_with: Vec<String>,
}

impl Report {
    fn new(response: &AnalysedResponse) -> Self {
        let effects = response.effects.as_ref().ok();
        let number = |value: fn(&Effects) -> f64| effects.map_or(f64::NAN, value);
        let optional = |value: fn(&Effects) -> Option<f64>| effects.and_then(value);
        let term = |term: &Term| {
            let uncertainty = term.estimate.and_then(|estimate| estimate.uncertainty);
            TermReport {
                label: term.label.clone(),
                degrees_of_freedom: term.freedom,
                sum_of_squares: term.sum_of_squares,
                share: term.share,
                f: term.test.map(|test| test.f),
                p: term.test.map(|test| test.p),
                effect: term.estimate.map(|estimate| estimate.effect),
                standard_error: uncertainty.map(|uncertainty| uncertainty.standard_error),
                interval: uncertainty.map(|uncertainty| uncertainty.interval),
                aliased_with: term.aliased_with.clone(),
            }
        };
        Self {
            name: response.name.clone(),
            unit: response.unit,
            error: response.effects.as_ref().err().map(ToString::to_string),
            model: name(response.choice.model),
            model_reason: response.choice.reason.clone(),
            runs: effects.map_or(0, |effects| effects.observations),
            missing: effects.map_or(0, |effects| effects.missing),
            mean: number(|effects| effects.mean),
            middle: number(|effects| effects.constant.value),
            r_squared: number(|effects| effects.r_squared),
            adjusted_r_squared: optional(|effects| effects.adjusted_r_squared),
            predicted_r_squared: optional(|effects| effects.predicted_r_squared),
            residual_standard_deviation: optional(|effects| effects.residual_standard_deviation),
            error_from: effects.map_or_else(String::new, |effects| effects.error.to_string()),
            lack_of_fit: response.misfit.map(|misfit| MisfitReport {
                f: Some(misfit.test.f).filter(|f| f.is_finite()),
                p: misfit.test.p,
                by_replicates: misfit.by_replicates,
                model_to_try: misfit.better.map(|better| name(better.model)),
                r_squared: misfit.better.map(|better| better.r_squared),
            }),
            lenth: effects.and_then(|effects| effects.lenth).map(|lenth| LenthReport {
                pseudo_standard_error: lenth.pseudo_standard_error,
                margin_of_error: lenth.margin,
                simultaneous_margin_of_error: lenth.simultaneous_margin,
            }),
            terms: effects.map_or_else(Vec::new, |effects| effects.rows().map(term).collect()),
        }
    }
}
