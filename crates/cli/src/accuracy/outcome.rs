//! What is kept of a run: little, however long it was.

use plateau_core::observe::Sample;

use super::history::History;

/// A run that came to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Steps.
    pub steps: u64,
    /// Wall time of all steps, s: without making the surfaces, and without a run file. None where a run file does not tell.
    pub wall_time: Option<f64>,
    /// Its course, at the ends of the windows.
    pub history: History,
    /// Its end.
    pub end: End,
    /// Heights at the end, if they are known.
    pub heights: Heights,
}

/// Heights of disc and pin, m, column by column.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Heights {
    /// z_d.
    pub disc: Option<Vec<f64>>,
    /// z_p.
    pub pin: Option<Vec<f64>>,
}

/// Quantities at the end of a run; NaN where one is not known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// Filled fraction.
    pub filled: f64,
    /// Worn volume of both bodies, m³.
    pub worn: f64,
    /// Debris that left the contact, m³.
    pub emitted: f64,
    /// Area fraction of the ring that is secondary plateau.
    pub disc_secondary: f64,
    /// Area fraction of the pin that is secondary plateau.
    pub pin_secondary: f64,
    /// Largest load residual of any step.
    pub load_residual: f64,
    /// Balance residual.
    pub balance_residual: f64,
}

impl End {
    /// Of the last sample of a run, the largest load residual of which was this.
    pub fn of(sample: &Sample, load_residual: f64) -> Self {
        Self {
            filled: sample.filled_fraction,
            worn: sample.worn_pin + sample.worn_resin + sample.worn_disc,
            emitted: sample.emitted,
            disc_secondary: sample.disc_secondary,
            pin_secondary: sample.pin_secondary,
            load_residual,
            balance_residual: sample.balance_residual,
        }
    }
}
