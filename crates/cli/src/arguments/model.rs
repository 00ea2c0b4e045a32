//! What is fitted to the responses of a study, as a command line says it.

use clap::Args;
use plateau_present::study::analysis::{Asked, Processes};

/// What is fitted to the responses of a study.
#[derive(Debug, Clone, Args)]
pub struct ModelArguments {
    /// What is fitted; unless given, what `plateau sweep effects` fits
    #[arg(long, value_enum)]
    pub model: Option<Model>,
    /// Which terms of it
    #[arg(long, value_enum, default_value = "all")]
    pub terms: Terms,
    /// Confidence level of intervals
    #[arg(long, value_name = "P", allow_hyphen_values = true, default_value = "0.95", value_parser = confidence)]
    pub confidence: f64,
}

impl ModelArguments {
    /// What the analysis is asked for.
    pub fn asked(&self) -> Asked {
        Asked {
            model: self.model.map(Into::into),
            by_aicc: self.terms == Terms::Aicc,
            processes: if self.model.is_none() { Processes::ForForecasts } else { Processes::None },
            confidence: self.confidence,
        }
    }
}

/// Which terms of a model are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Terms {
    /// All of them
    All,
    /// Those that the runs support, by the corrected criterion of Akaike
    Aicc,
}

/// What is fitted to the responses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Model {
    /// Main effects alone
    Main,
    /// Main effects and interactions of two factors
    Interactions,
    /// Interactions of all orders that the runs tell apart
    Full,
    /// Main effects, interactions of two factors and squares
    Quadratic,
}

impl From<Model> for plateau_study::effects::Model {
    fn from(model: Model) -> Self {
        match model {
            Model::Main => Self::MainEffects,
            Model::Interactions => Self::Interactions,
            Model::Full => Self::Full,
            Model::Quadratic => Self::Quadratic,
        }
    }
}

/// A value of `--confidence`.
pub fn confidence(text: &str) -> Result<f64, &'static str> {
    let expected = "expected a number between 0 and 1, such as 0.95";
    text.parse().ok().filter(|level| *level > 0.0 && *level < 1.0).ok_or(expected)
}
