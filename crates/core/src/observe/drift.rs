//! Whether a run is still running in: what its mean contact area changed by in its second half, and how long that takes to rise and
//! fall once.

use serde::Serialize;

use super::window_mean::{Cumulative, LEAST_PARTS, ROUNDING, WindowMean, error_of_mean};
use crate::model::parameters::Parameters;
use crate::model::state::Base;
use crate::surface::fibre_fraction;

/// The fraction of the value at the end with which a run counts as run in.
pub const RUN_IN: f64 = 0.9;
/// Standard errors from which on a change is not taken for chance: 2.5 times in a hundred in either direction.
const BEYOND_CHANCE: f64 = 2.0;
/// Parts of what is missing at a fraction of the last value, and with no fraction a tenth: a change of less than the first counts as none,
/// and a run that may hide a larger one than the second tells nothing.
const NEGLIGIBLE: f64 = 0.1;
const OF_INTEREST: f64 = 0.5;
/// What is missing where nothing else is asked: at the fraction of the running-in time of a summary. So 1 % is negligible and 5 % is of
/// interest.
const MISSING: f64 = 1.0 - RUN_IN;
/// Pulses in a quarter of a run from which on two quarters can be compared: with one or less the change is that of a pulse, and no
/// standard error tells that.
pub const LEAST_PULSES: f64 = 3.0;

/// The last quarter of a run beside the one before it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Drift {
    /// Mean over the third quarter.
    pub third_quarter: WindowMean,
    /// Mean over the last quarter.
    pub last_quarter: WindowMean,
    /// Change from one to the other, as a part of the mean of the third.
    pub change: f64,
    /// Its standard error, in the same measure: of what varies about a straight line through both quarters, for a steady rise is no
    /// chance; as if both quarters were independent.
    pub standard_error: f64,
    /// Pulses of the contact area in a quarter, at most; none where nothing pulses or that is not known.
    pub pulses: Option<f64>,
}

/// What the change of a mean says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trend {
    /// It rises by more than chance explains.
    Rises,
    /// It falls by more than chance explains.
    Falls,
    /// It changes by less than is of interest, and by no more than chance or next to nothing.
    Steady,
    /// Chance may hide a change that is of interest.
    Unknown,
    /// There are too few pulses in a quarter.
    TooShort,
}

impl Drift {
    /// What the samples of a run tell whose contact area pulses in this time, s, or longer; none where a quarter has too few samples or
    /// simulated revolutions for a standard error, or nothing to compare with.
    pub fn of(samples: &Cumulative<'_>, pulse_time: Option<f64>) -> Option<Self> {
        let end = *samples.time.last()?;
        let quarter = |from: f64, to: f64| samples.mean(from * end, to * end);
        let (third, last) = (quarter(0.5, 0.75)?, quarter(0.75, 1.0)?);
        let parts = [&third, &last].map(|quarter| samples.parts(quarter.from, quarter.to));
        let parts = parts[0].min(parts[1]);
        if parts < LEAST_PARTS || third.mean <= 0.0 {
            return None;
        }
        let rest = beside_a_line(&samples.means_of_parts(third.from, last.to, 2 * parts));
        Some(Self {
            third_quarter: third,
            last_quarter: last,
            change: (last.mean - third.mean) / third.mean,
            standard_error: 2.0_f64.sqrt() * error_of_mean(&rest, parts) / third.mean,
            pulses: pulse_time.map(|time| 0.25 * end / time),
        })
    }

    /// What the change says.
    pub fn trend(&self) -> Trend {
        self.trend_beside(MISSING)
    }

    /// What the change says where this part of the last value is missing, or more than in [`trend`](Self::trend): less is finer.
    pub(super) fn trend_beside(&self, missing: f64) -> Trend {
        let missing = missing.min(MISSING);
        let chance = BEYOND_CHANCE * self.standard_error;
        let is_negligible = self.change.abs() <= NEGLIGIBLE * missing * (1.0 + ROUNDING);
        match self.change {
            _ if self.pulses.is_some_and(|pulses| pulses < LEAST_PULSES) => Trend::TooShort,
            change if change > chance && !is_negligible => Trend::Rises,
            change if change < -chance && !is_negligible => Trend::Falls,
            change if change.abs() + chance <= OF_INTEREST * missing * (1.0 + ROUNDING) => Trend::Steady,
            _ => Trend::Unknown,
        }
    }
}

/// What is left of values when their least-squares line is taken out.
pub(super) fn beside_a_line(values: &[f64]) -> Vec<f64> {
    let middle = 0.5 * (values.len() as f64 - 1.0);
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let places = || (0..values.len()).map(|place| place as f64 - middle);
    let slope = places().zip(values).map(|(place, value)| place * value).sum::<f64>()
        / places().map(|place| place * place).sum::<f64>();
    places().zip(values).map(|(place, value)| value - mean - slope * place).collect()
}

/// Time of one pulse of the contact area at constant load and speed, s, at least: T = h_m φ A/(κ F_N v). Resin that touches loses its
/// wear height h_m at once (model 4.2), and touches again when the fibres, of area φ A and specific wear rate κ, have worn as far.
/// Build-up beside the fibres has to wear as well, and makes it longer. `base` is that of the pin's cells.
///
/// None where load or speed change with time, where there is no resin, or nothing wears.
pub fn pulse_time(parameters: &Parameters, base: &[Base]) -> Option<f64> {
    if parameters.cycle.is_some() || !base.contains(&Base::Resin) {
        return None;
    }
    let (materials, mesh) = (&parameters.materials, &parameters.mesh);
    let fibre_area = fibre_fraction(base, mesh) * mesh.pin_area();
    let sliding_speed = parameters.angular_velocity * mesh.mean_radius();
    let worn_per_second = materials.pin_primary.specific_wear_rate * parameters.usual_load() * sliding_speed;
    let time = materials.wear_height * fibre_area / worn_per_second;
    (time > 0.0 && time.is_finite()).then_some(time)
}
