//! What it takes to be a series that not every run has.

use super::map::Map;
use super::quantity::Quantity;
use super::sample::Sample;
use crate::model::parameters::Parameters;

/// A series that not every run has.
#[derive(Debug, Clone, Copy)]
pub struct Extra {
    /// Name; of one on request that of its switch, `output.NAME` in a scene.
    pub name: &'static str,
    /// What is written with every sample.
    pub quantities: &'static [Quantity],
    /// How it is asked for and measured; none where a run has it for another reason.
    pub request: Option<Request>,
    /// What of a scene it needs, in words, besides a switch; empty where it needs nothing.
    pub needs: &'static str,
}

/// A series on request.
#[derive(Debug, Clone, Copy)]
pub struct Request {
    /// What it is, as in "roughness with every sample".
    pub what: &'static str,
    /// What its switch means.
    pub meaning: &'static str,
    /// The fields that it is measured of, which are gathered for it: what it costs.
    pub maps: &'static [Map],
    /// Measures it of these fields, column by column: one value for each quantity.
    pub measure: fn(&Parameters, &[Vec<f64>]) -> Vec<f64>,
}

impl Extra {
    /// Adds the values of its quantities to a sample.
    pub fn record(&self, sample: &mut Sample, values: impl IntoIterator<Item = f64>) {
        sample.extras.extend(self.quantities.iter().map(|quantity| quantity.name).zip(values));
    }
}

impl PartialEq for Extra {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}
