//! Which model is fitted to a response, why, and what it misses.

use plateau_io::study::{DesignSource, Study};
use plateau_study::design::Kind;
use plateau_study::effects::{Factor, FactorKind, Misfit, Model, NoSquares, Observation, no_squares};

use plateau_io::number;

/// Decimals of R² with which two of them are told apart, at least and at most.
const DECIMALS: std::ops::RangeInclusive<usize> = 4..=9;
/// Probabilities below this are said to be less.
const LEAST_PROBABILITY: f64 = 1e-4;

/// A model, and why it is that one.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The model.
    pub model: Model,
    /// Why it has no squares, or that it was asked for; empty where there is nothing to say.
    pub reason: String,
}

impl Choice {
    /// What is fitted unless the user says so: squares where the runs allow them, no more than main effects where the design
    /// is made for no more.
    pub fn new(
        asked: Option<Model>,
        study: &Study,
        factors: &[Factor],
        observations: &[Observation],
        blocks: bool,
    ) -> Self {
        let without_squares =
            |reason: String| Self { model: Model::Interactions, reason: format!("no squares: {reason}") };
        if let Some(model) = asked {
            return Self { model, reason: "as asked for".to_owned() };
        }
        match &study.source {
            DesignSource::Kind(Kind::CentralComposite { .. } | Kind::BoxBehnken { .. }) => {
                Self { model: Model::Quadratic, reason: String::new() }
            }
            DesignSource::Kind(Kind::PlackettBurman) => Self {
                model: Model::MainEffects,
                reason: "a Plackett-Burman design mixes interactions with main effects".to_owned(),
            },
            DesignSource::Kind(Kind::FullFactorial | Kind::FractionalFactorial(_)) => {
                let has_levels =
                    |factor: &Factor| matches!(&factor.kind, FactorKind::Levels(levels) if levels.len() > 2);
                without_squares(match factors.iter().any(has_levels) {
                    true => "levels are compared one by one, which shows curves, too".to_owned(),
                    false => NoSquares::TwoValues.to_string(),
                })
            }
            DesignSource::Kind(Kind::LatinHypercube { .. } | Kind::Sobol { .. } | Kind::Morris { .. })
            | DesignSource::File(_) => match no_squares(factors, observations, blocks) {
                None => Self { model: Model::Quadratic, reason: String::new() },
                Some(reason) => without_squares(reason.to_string()),
            },
        }
    }

    /// The terms of the model, in words.
    pub fn terms(&self) -> &'static str {
        match self.model {
            Model::MainEffects => "main effects",
            Model::Interactions => "main effects and interactions of two factors",
            Model::Full => "main effects and interactions of all orders",
            Model::Quadratic => "main effects, interactions of two factors and squares",
        }
    }

    /// What is fitted, in words.
    pub fn words(&self) -> String {
        let terms = self.terms();
        let reason = if self.reason.is_empty() { String::new() } else { format!("; {}", self.reason) };
        format!("model: {terms}{reason}")
    }
}

/// What `--model` calls a model.
pub fn name(model: Model) -> &'static str {
    match model {
        Model::MainEffects => "main",
        Model::Interactions => "interactions",
        Model::Full => "full",
        Model::Quadratic => "quadratic",
    }
}

/// That a model of this R² misses something, and which one to try.
pub fn lack_of_fit(misfit: &Misfit, r_squared: f64) -> String {
    let Misfit { test, by_replicates, better } = *misfit;
    let p = match test.p {
        p if p < LEAST_PROBABILITY => format!("p < {LEAST_PROBABILITY}"),
        p => format!("p = {}", number::significant(p, 2)),
    };
    let better = better.map(|better| {
        let [other, own] = told_apart(better.r_squared, r_squared);
        (format!("--model {}", name(better.model)), format!("R² {other} instead of {own}"))
    });
    match (by_replicates, better) {
        (true, Some((model, r_squared))) => format!(
            "lack of fit: points differ from the model by more than replicates from each other ({p}); try {model}, which \
             explains more, {r_squared}"
        ),
        (true, None) => format!(
            "lack of fit: points differ from the model by more than replicates from each other ({p}), and no other --model \
             explains more; narrow the ranges, or try scale = \"logarithmic\" for a factor"
        ),
        (false, better) => {
            let (model, r_squared) = better.unwrap_or_default();
            format!("lack of fit: try {model}, which explains significantly more ({p}), {r_squared}")
        }
    }
}

/// Two shares with as many decimals as show that they differ.
fn told_apart(one: f64, other: f64) -> [String; 2] {
    let texts = |decimals: usize| [one, other].map(|share| format!("{share:.decimals$}"));
    let told = DECIMALS.map(texts).find(|[one, other]| one != other);
    told.unwrap_or_else(|| texts(*DECIMALS.start()))
}

#[cfg(test)]
mod tests {
    use super::told_apart;

    #[test]
    fn shares_have_the_decimals_that_tell_them_apart() {
        assert_eq!(told_apart(0.98662, 0.64843), ["0.9866", "0.6484"]);
        assert_eq!(told_apart(0.999_998, 0.999_991), ["1.00000", "0.99999"]);
        assert_eq!(told_apart(1.0, 1.0), ["1.0000", "1.0000"]);
    }
}
