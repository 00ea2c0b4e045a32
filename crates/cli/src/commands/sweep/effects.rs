//! `plateau sweep effects`: what the factors of a study do to its responses.

use std::path::Path;

use plateau_present::Unit;
use plateau_present::figure::Format;
use plateau_present::study::analysed_factor::AnalysedFactor;
use plateau_present::study::analysis::{AnalysedResponse, Analysis, Asked, Processes};
use plateau_present::study::equation::paragraphs;
use plateau_present::study::model::lack_of_fit;
use plateau_present::study::words::{box_cox, curvature, fit, quality, repeats_in_words, selected};
use plateau_study::effects::{self, Effects, Squares, Term};

use super::analysed::Analysed;
use super::effects_document::Document;
use super::effects_files;
use crate::arguments::{EffectsArguments, Terms};
use crate::csv_table::csv_table;
use crate::failure::Failure;
use crate::output_folder::OutputFolder;
use crate::table::{columns, print, table};
use crate::{number, sweep};

/// Inflation of variances above which terms are said to be correlated.
const MOST_INFLATION: f64 = 10.0;
/// How much the sum of all shares differs from R² for it to be said.
const SHARES_DIFFER: f64 = 0.02;

/// Analyses the results.
pub fn effects(arguments: &EffectsArguments) -> Result<(), Failure> {
    let asked = Asked {
        model: arguments.model.map(Into::into),
        by_aicc: arguments.terms == Terms::Aicc,
        processes: Processes::None,
        confidence: arguments.confidence,
    };
    let plan = sweep::plan(&arguments.study)?;
    let folder = arguments.output.clone().unwrap_or_else(|| plan.study().directory.join("effects"));
    let mut folder = OutputFolder::new(folder, arguments.force)?;
    let analysed = Analysed::of(plan, asked)?;
    let Analysed { plan, collected, analysis, .. } = &analysed;
    let study = plan.study();
    effects_files::write(&mut folder, &analysed, &rows(analysis), &residuals(&analysed))?;
    let files = folder.files().to_vec();
    if arguments.json {
        let report = Document::new(&study.title, collected.repeats(), analysis, files);
        return print(&(serde_json::to_string_pretty(&report).map_err(Failure::run)? + "\n"));
    }
    let repeats = Some(collected.repeats()).filter(|repeats| *repeats > 0);
    let mut text = repeats.map_or_else(String::new, |repeats| repeats_in_words(repeats, collected.runs.len()) + "\n\n");
    text.extend(analysis.responses.iter().map(|response| text_of(response, &analysis.factors) + "\n"));
    text.push_str(&table(&study.title, &told(folder.path(), &files)));
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
        "variance_inflation",
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
                shown(term.inflation),
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
        let mut others = vec![("residual", effects.residual.squares, None)];
        if let Some(parts) = effects.residual.parts {
            others.extend([("lack of fit", parts.lack_of_fit, parts.test), ("pure error", parts.pure_error, None)]);
        }
        others.push(("total", effects.total, None));
        for (name, squares, test) in others {
            let mut cells = vec![
                response.name.clone(),
                name.to_owned(),
                squares.freedom.to_string(),
                shown(Some(squares.sum)),
                shown(squares.mean()),
                shown(test.map(|test| test.f)),
                shown(test.map(|test| test.p)),
            ];
            cells.resize(header.len(), String::new());
            lines.push(cells);
        }
    }
    csv_table(lines)
}

/// A line for each response and run: what the model makes of it, and how much depends on it. In the SI unit of what is fitted.
fn residuals(analysed: &Analysed) -> String {
    let Analysed { collected, analysis, .. } = analysed;
    let heads =
        ["response", "run", "made_as", "replicate", "fitted", "residual", "standardised", "leverage", "cooks_distance"];
    let mut lines = vec![heads.map(str::to_owned).to_vec()];
    let shown = |value: f64| if value.is_finite() { format!("{value:?}") } else { String::new() };
    for response in &analysis.responses {
        let Ok(effects) = &response.effects else { continue };
        let standardised = effects.standardised_residuals();
        for (at, (fitted, [leverage, distance])) in effects.fitted.iter().zip(effects.influences()).enumerate() {
            let run = &collected.runs[fitted.observation].run;
            let standardised = standardised.as_ref().map_or(f64::NAN, |all| all[at]);
            let numbers = [fitted.fitted, fitted.residual, standardised, leverage, distance];
            let which = [run.number, analysis.order[fitted.observation], run.replicate + 1].map(|one| one.to_string());
            lines.push([vec![response.name.clone()], which.to_vec(), numbers.map(shown).to_vec()].concat());
        }
    }
    csv_table(lines)
}

/// Terms whose estimates are many times less certain than they would be alone, for they are correlated with others; a line.
fn inflated(effects: &Effects) -> Option<String> {
    let large = effects.terms.iter().filter(|term| term.inflation.is_some_and(|inflation| inflation > MOST_INFLATION));
    let large: Vec<String> = large
        .map(|term| format!("{} {}", term.label, number::rounded(term.inflation.unwrap_or_default(), 2)))
        .collect();
    (!large.is_empty()).then(|| {
        format!(
            "correlated with other terms, so that their effects are hardly told apart (variance inflation above {MOST_INFLATION}): {}",
            large.join(", ")
        )
    })
}

/// That shares do not add up to R²; none where they nearly do.
fn shares(effects: &Effects) -> Option<String> {
    let sum: f64 = effects.rows().map(|term| term.share).sum();
    ((sum - effects.r_squared).abs() > SHARES_DIFFER).then(|| {
        format!(
            "shares add up to {:.0} %, not to R²: terms are correlated, and a share is what is lost without the term and all others \
             kept (type III)",
            100.0 * sum
        )
    })
}

/// What is said of a response.
fn text_of(response: &AnalysedResponse, factors: &[AnalysedFactor]) -> String {
    let effects = match &response.effects {
        Ok(effects) => effects,
        Err(error) => return format!("{}\n  {error}\n", response.name),
    };
    let unit = response.unit_shown(effects);
    let misfit = response.misfit.as_ref().map(|misfit| lack_of_fit(misfit, effects.r_squared));
    let transformed = response.scale.transform().map(|_| format!("all results are those of {}", response.title()));
    let notes = [
        Some(response.model_words()),
        misfit,
        curvature(response, effects.confidence, |value| unit.with_symbol(&number::short(unit.difference(value)))),
        Some(fit(effects)),
        Some(quality(effects, |value| unit.with_symbol(&number::short(unit.difference(value))))),
        transformed,
        selected(response),
        box_cox(response),
        inflated(effects),
        shares(effects),
    ];
    let heading =
        notes.into_iter().flatten().fold(response.name.clone(), |heading, note| format!("{heading}\n  {note}"));
    let names = [
        "term",
        &unit.label("effect"),
        &format!("{} interval", number::confidence(effects.confidence)),
        "share",
        "df",
        "F",
        "p",
    ];
    let mut rows: Vec<&Term> = effects.rows().collect();
    rows.sort_by(|a, b| b.share.total_cmp(&a.share));
    let rows: Vec<Vec<String>> = rows.into_iter().map(|term| cells(term, &unit)).collect();
    let mut text = columns(&heading, &names, &[rows, left(effects)].concat());
    for term in effects.rows().filter(|term| !term.aliased_with.is_empty()) {
        text.push_str(&format!("  {} cannot be told from {}\n", term.label, term.aliased_with.join(", ")));
    }
    for (what, lines) in paragraphs(response, effects, factors) {
        text.push_str(&format!("  {what}:\n"));
        text.extend(lines.iter().map(|line| format!("    {line}\n")));
    }
    text
}

fn cells(term: &Term, unit: &Unit) -> Vec<String> {
    let uncertainty = term.estimate.and_then(|estimate| estimate.uncertainty);
    let effect = term.estimate.map_or_else(String::new, |estimate| number::short(unit.difference(estimate.effect)));
    let interval = uncertainty.map_or_else(String::new, |uncertainty| {
        let [low, high] = uncertainty.interval.map(|end| number::short(unit.difference(end)));
        format!("{low} … {high}")
    });
    let test = |value: fn(&effects::Test) -> f64| {
        term.test.as_ref().map_or_else(String::new, |test| number::short(value(test)))
    };
    vec![
        term.label.clone(),
        effect,
        interval,
        percent(term.share),
        term.freedom.to_string(),
        test(|test| test.f),
        test(|test| test.p),
    ]
}

/// Lines of what the model leaves, and of its parts where points are repeated.
fn left(effects: &Effects) -> Vec<Vec<String>> {
    let residual = effects.residual;
    let line = |name: &str, squares: Squares, test: Option<effects::Test>| {
        let of = |value: fn(effects::Test) -> f64| test.map_or_else(String::new, |test| number::short(value(test)));
        vec![
            name.to_owned(),
            String::new(),
            String::new(),
            percent(squares.sum / effects.total.sum),
            squares.freedom.to_string(),
            of(|test| test.f),
            of(|test| test.p),
        ]
    };
    let mut lines = vec![line("residual", residual.squares, None)];
    if let Some(parts) = residual.parts.filter(|parts| parts.lack_of_fit.freedom > 0) {
        lines.push(line("  lack of fit", parts.lack_of_fit, parts.test));
        lines.push(line("  pure error", parts.pure_error, None));
    }
    lines
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}
