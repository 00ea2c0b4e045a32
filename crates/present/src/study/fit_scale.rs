//! The scale on which a model is fitted to a response: the response itself, or its transform in a unit that people read.

use plateau_io::number;
use plateau_study::effects::{EffectsError, Transform};
use plateau_study::surrogate::Scale;

use crate::quantity::Unit;

/// A scale, with the unit of what is transformed.
#[derive(Debug, Clone, PartialEq)]
pub struct FitScale {
    /// From the response, SI, to the scale and back.
    pub scale: Scale,
    /// The unit in which the response is transformed, or simply read.
    pub unit: Unit,
}

impl FitScale {
    /// For responses of this SI unit up to this size.
    pub fn new(transform: Option<Transform>, si: &str, largest: f64) -> Self {
        let unit = Unit::readable_with_differences(si, largest);
        Self { scale: Scale { unit: unit.per_si, transform }, unit }
    }

    /// What is done to the response, if anything.
    pub fn transform(&self) -> Option<Transform> {
        self.scale.transform
    }

    /// What is fitted, such as `log(contact area, mm²)`.
    pub fn title(&self, response: &str) -> String {
        match self.transform() {
            None => response.to_owned(),
            Some(transform) => format!("{}({})", transform.name(), self.unit.label(response)),
        }
    }

    /// The SI unit of what is fitted, given that of the response: transforms are plain numbers.
    pub fn unit_of_fit(&self, si: &'static str) -> &'static str {
        if self.transform().is_some() { "1" } else { si }
    }

    /// That a run's response is beyond the domain of the transform.
    pub(super) fn beyond(&self, run: usize, response: f64) -> EffectsError {
        let value = self.unit.with_symbol(&number::rounded(self.unit.value(response), 6));
        let transform = self.transform().unwrap_or(Transform::Logarithm);
        EffectsError::Domain { run, value, transform: transform.name(), domain: transform.domain() }
    }
}
