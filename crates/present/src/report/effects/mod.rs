//! One self-contained HTML page about a study: `plateau sweep effects`.
//!
//! | what | where |
//! |---|---|
//! | design, runs, factors, what cannot be told apart | [`study`] |
//! | a response: table of variances, quality of the fit, figures | [`response`] |
//! | all runs as lines over axes side by side | [`parallel`] |

mod parallel;
mod response;
mod study;

use plateau_io::study::collected::Collected;
use plateau_io::study::plan::Plan;

use super::html;
use super::layout::{Layout, Section};
use super::picture::Pictures;
use crate::figure::effects::axes;
use crate::study::analysis::Analysis;
use crate::study::words::repeats_in_words;
use parallel::Parallel;
use plateau_io::number;

const STYLE: &str = include_str!("../assets/parallel.css");
const SCRIPT: &str = include_str!("../assets/parallel.js");

/// What a page is made of.
#[derive(Debug, Clone, Copy)]
pub struct StudyPage<'a> {
    /// The study and its design.
    pub plan: &'a Plan,
    /// What became of its runs.
    pub collected: &'a Collected,
    /// What they tell.
    pub analysis: &'a Analysis,
    /// Figures of each response.
    pub pictures: &'a [Pictures],
    /// Name and version of the program that makes it.
    pub program: &'a str,
}

/// The page about a study.
pub fn page(of: &StudyPage) -> String {
    let study = of.plan.study();
    let axes = axes(of.analysis);
    let parallel = Parallel::new(of.analysis, &axes);
    let mut sections = vec![Section::new("study", "Study", study::html(of))];
    for (at, (response, pictures)) in of.analysis.responses.iter().zip(of.pictures).enumerate() {
        let heading = format!("Response: {}", response.name);
        sections.push(Section::new(format!("response-{}", at + 1), heading, response::html(response, &axes, pictures)));
    }
    sections.push(Section::new("runs", "All runs", parallel.html()));
    sections.push(Section::new("contents", "What this page holds", html::list(&contents(of))));
    let (factors, responses) =
        (number::count(study.factors.len(), "factor"), number::count(of.analysis.responses.len(), "response"));
    let style = [STYLE, &parallel::colours()].concat();
    Layout {
        title: &study.title,
        subtitle: &format!("Effects of {factors} on {responses}. Made by {}.", of.program),
        notices: &notices(of),
        without_scripts: "Without JavaScript the lines of all runs cannot be filtered; everything else is there.",
        sections: &sections,
        style: &style,
        data: &parallel.to_json(),
        script: SCRIPT,
    }
    .html()
}

fn notices(of: &StudyPage) -> Vec<String> {
    let [failed, missing] = ["failed", "missing"].map(|state| of.collected.count(state));
    let (runs, repeats) = (of.collected.runs.len(), of.collected.repeats());
    let left_out = (failed + missing > 0).then(|| {
        format!(
            "{} of {} have no results and are left out: {failed} failed, {missing} not made yet.",
            failed + missing,
            number::count(runs, "run")
        )
    });
    left_out.into_iter().chain((repeats > 0).then(|| repeats_in_words(repeats, runs))).collect()
}

fn contents(of: &StudyPage) -> Vec<String> {
    let mut notes = vec![
        "Numbers in tables are rounded; effects.csv, beside this page, has all their digits, in SI units.".to_owned(),
        "Figures are also there as files, PNG and SVG.".to_owned(),
        "The lines of all runs show every run of the study; values on this page have six digits.".to_owned(),
    ];
    for (response, pictures) in of.analysis.responses.iter().zip(of.pictures) {
        notes.extend(pictures.left_out.iter().map(|reason| format!("{}: {reason}", response.name)));
    }
    notes
}
