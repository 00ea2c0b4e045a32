//! A study and what others found for it, as the files in this folder have it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use plateau_study::design::Setting;
use plateau_study::effects::{Effects, Factor, FactorKind, Model, Observation, Options, analyse};
use serde::Deserialize;

#[derive(Deserialize)]
pub(super) struct Study {
    pub(super) factors: Vec<StudyFactor>,
    pub(super) model: String,
    pub(super) blocks: bool,
    pub(super) settings: Vec<Vec<f64>>,
    pub(super) replicates: Vec<usize>,
    /// What is to be added to the responses.
    pub(super) shift: f64,
    pub(super) responses: Vec<Option<f64>>,
    pub(super) expected: Expected,
}

#[derive(Deserialize)]
pub(super) struct StudyFactor {
    pub(super) name: String,
    pub(super) categories: Option<Vec<String>>,
    pub(super) values: Option<Vec<f64>>,
    pub(super) range: Option<[f64; 2]>,
}

#[derive(Deserialize)]
pub(super) struct Expected {
    pub(super) constant: f64,
    pub(super) total: (usize, f64),
    pub(super) fitted: Vec<f64>,
    pub(super) residuals: Vec<f64>,
    pub(super) terms: BTreeMap<String, ExpectedTerm>,
    pub(super) residual: Option<(usize, f64)>,
    pub(super) r_squared: Option<[f64; 3]>,
    pub(super) deviation: Option<f64>,
    pub(super) pure_error: Option<(usize, f64)>,
    pub(super) lack_of_fit: Option<(usize, f64)>,
    pub(super) lack_of_fit_test: Option<[f64; 2]>,
    #[serde(default)]
    pub(super) predictions: Vec<ExpectedPrediction>,
    #[serde(default)]
    pub(super) level_means: Vec<Vec<ExpectedCell>>,
    #[serde(default)]
    pub(super) cell_means: Vec<ExpectedCell>,
    pub(super) surface: Option<ExpectedSurface>,
    /// F and p of the larger model against this one, and its share of the sum of squares.
    pub(super) misfit: Option<[f64; 3]>,
}

#[derive(Deserialize)]
pub(super) struct ExpectedTerm {
    pub(super) squares: (usize, f64),
    pub(super) test: Option<[f64; 2]>,
    pub(super) coefficient: Option<f64>,
    /// Standard error, t, p, and interval of the coefficient.
    pub(super) uncertainty: Option<[f64; 5]>,
}

#[derive(Deserialize)]
pub(super) struct ExpectedPrediction {
    pub(super) settings: Vec<f64>,
    /// Value, standard error, interval.
    pub(super) numbers: [f64; 4],
}

#[derive(Deserialize)]
pub(super) struct ExpectedCell {
    pub(super) settings: Vec<f64>,
    pub(super) count: usize,
    /// Mean and interval.
    pub(super) numbers: [f64; 3],
}

#[derive(Deserialize)]
pub(super) struct ExpectedSurface {
    pub(super) settings: Vec<f64>,
    pub(super) constant: f64,
    pub(super) linear: Vec<f64>,
    pub(super) quadratic: Vec<Vec<f64>>,
    pub(super) eigenvalues: Vec<f64>,
    pub(super) stationary: Vec<f64>,
    pub(super) natural: Vec<f64>,
    pub(super) response: f64,
}

impl Study {
    pub(super) fn read(name: &str) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/effects").join(name).with_extension("json");
        serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
    }

    fn factors(&self) -> Vec<Factor> {
        let kind = |factor: &StudyFactor| match (&factor.categories, &factor.values, factor.range) {
            (Some(labels), ..) => FactorKind::Categorical(labels.clone()),
            (_, Some(values), _) => FactorKind::Levels(values.clone()),
            (_, _, Some([low, high])) => FactorKind::Range { low, high },
            _ => panic!("{} is no factor", factor.name),
        };
        self.factors.iter().map(|factor| Factor { name: factor.name.clone(), kind: kind(factor) }).collect()
    }

    pub(super) fn settings(&self, numbers: &[f64]) -> Vec<Setting> {
        let setting = |(factor, number): (&StudyFactor, &f64)| match factor.range {
            Some(_) => Setting::Coded(*number),
            None => Setting::Level(*number as usize),
        };
        self.factors.iter().zip(numbers).map(setting).collect()
    }

    fn observations(&self) -> Vec<Observation> {
        let each = self.settings.iter().zip(&self.replicates).zip(&self.responses);
        each.enumerate()
            .map(|(run, ((numbers, replicate), response))| Observation {
                settings: self.settings(numbers),
                replicate: *replicate,
                run,
                response: response.map_or(f64::NAN, |response| response + self.shift),
            })
            .collect()
    }

    pub(super) fn effects(&self) -> Effects {
        let model = match self.model.as_str() {
            "interactions" => Model::Interactions,
            "full" => Model::Full,
            "quadratic" => Model::Quadratic,
            other => panic!("{other} is no model"),
        };
        analyse(&self.factors(), &self.observations(), &Options { model, blocks: self.blocks, confidence: 0.95 })
            .unwrap()
    }
}
