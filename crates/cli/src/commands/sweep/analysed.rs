//! A study whose results were collected and analysed: what `effects`, `predict` and `optimize` begin with.

use std::path::PathBuf;

use plateau_io::number;
use plateau_io::study::Study;
use plateau_io::study::collected::Collected;
use plateau_io::study::plan::Plan;
use plateau_present::study::analysis::{Analysis, Asked};
use plateau_present::study::cautions::{no_curve, together};
use plateau_study::effects::EffectsError;

use super::collect::{Found, collected};
use crate::failure::Failure;
use crate::{called, message};

/// The results of a study that asks for responses. Runs without results are said.
///
/// # Errors
/// [`Failure::Input`] when the study has no response; [`Failure::Run`] when the results cannot be read, or there are none.
pub fn analysable(plan: &Plan) -> Result<Found, Failure> {
    let study = plan.study();
    if study.responses.is_empty() {
        return Err(Failure::input(format!(
            "{}: no [[response]], so there is nothing to analyse; name one, such as dataset = \"/series/contact_area_mean\", \
             at = \"end\"",
            study.path.display()
        )));
    }
    let found = collected(plan)?;
    let collected = &found.collected;
    if collected.runs.iter().all(|run| run.responses.iter().all(|response| !response.is_finite())) {
        return Err(Failure::run(nothing_yet(study, collected)));
    }
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
    Ok(found)
}

/// What is said of a study without a single value.
fn nothing_yet(study: &Study, collected: &Collected) -> String {
    let path = study.path.display();
    let program = called::program();
    let study_argument = called::argument(&study.path.to_string_lossy());
    let to_do = match collected.count("finished") {
        _ if study.is_imported() => {
            format!("{program} sweep import {study_argument} TABLE.csv brings them")
        }
        0 => format!("{program} sweep run {study_argument} makes the runs"),
        finished => format!("the {} that finished have none: look at the responses", number::count(finished, "run")),
    };
    format!("{path}: there is no result to analyse yet; {to_do}")
}

/// A study, its results and what they tell.
#[derive(Debug)]
pub struct Analysed {
    pub plan: Plan,
    pub collected: Collected,
    pub analysis: Analysis,
    /// What the results were made of.
    pub inputs: Vec<PathBuf>,
    /// By what the results of each run are known, in the order of the design.
    pub identities: Vec<String>,
}

impl Analysed {
    /// Says which factors cannot be told apart, for those who do not show the effects.
    pub fn warn_of_factors(&self) {
        together(&self.analysis).into_iter().for_each(|said| message::warning(format_args!("{said}")));
    }

    /// Says of which factors the runs show no curve.
    pub fn warn_of_no_curve(&self, factors: &[usize]) {
        no_curve(&self.analysis, factors).into_iter().for_each(message::warning);
    }

    /// Of a study. Runs without results are said.
    ///
    /// # Errors
    /// [`Failure::Input`] when the study has no response, or one that its transform is not for; [`Failure::Run`] when
    /// the results cannot be read.
    pub fn of(plan: Plan, asked: Asked) -> Result<Self, Failure> {
        let study = plan.study();
        let Found { collected, inputs, identities, .. } = analysable(&plan)?;
        let analysis = Analysis::of(study, &collected, asked).in_order_of(&plan);
        for response in &analysis.responses {
            if let Err(error @ EffectsError::Domain { .. }) = &response.effects {
                let path = study.path.display();
                return Err(Failure::input(format!("{path}: response \"{}\": {error}", response.name)));
            }
        }
        Ok(Self { plan, collected, analysis, inputs, identities })
    }
}
