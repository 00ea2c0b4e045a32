//! Why a synthetic surface cannot be made.

use thiserror::Error;

use crate::surface::Length;

/// Why a synthetic surface cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SynthesisError {
    /// The rms height is no height.
    #[error("rms_height is {found} m, expected 0 or more and finite")]
    RmsHeight {
        /// What was asked for.
        found: f64,
    },
    /// The correlation length is no length.
    #[error("{key} is {found} m, expected more than 0 and finite")]
    CorrelationLength {
        /// Key of the setting.
        key: &'static str,
        /// What was asked for.
        found: f64,
    },
    /// The field would hardly vary, and the filter would need endless lines.
    #[error(
        "{key} is {}, expected at most {} here (the ring's circumference, or 2^20 cells): \
         a surface that varies so slowly is flat on this mesh, use flat = true",
        Length(*found), Length(*longest)
    )]
    CorrelationTooLong {
        /// Key of the setting.
        key: &'static str,
        /// What was asked for, m.
        found: f64,
        /// The longest accepted, m.
        longest: f64,
    },
    /// The Hurst exponent is none.
    #[error("hurst is {found}, expected 0 to 1")]
    Hurst {
        /// What was asked for.
        found: f64,
    },
    /// The roll-off is no wavelength of the mesh.
    #[error(
        "roll_off is {}, expected a wavelength from {} (two cells) to {} (the ring's circumference, or 2^20 cells)",
        Length(*found), Length(*shortest), Length(*longest)
    )]
    RollOff {
        /// What was asked for, m.
        found: f64,
        /// The shortest accepted, m.
        shortest: f64,
        /// The longest accepted, m.
        longest: f64,
    },
    /// The spectrum ends before it begins.
    #[error(
        "short_cutoff is {}, expected a wavelength from {} (two cells) to the roll_off of {}",
        Length(*found), Length(*shortest), Length(*roll_off)
    )]
    ShortCutoff {
        /// What was asked for, m.
        found: f64,
        /// The shortest accepted, m.
        shortest: f64,
        /// The roll-off, m.
        roll_off: f64,
    },
    /// No distribution that can be made has these moments.
    #[error(
        "skewness {skewness} with kurtosis {found}: with this skewness the kurtosis is expected to be at least {least:.4} \
         and at most {most} (3 is normal; below skewness² + 1 there is no distribution, and near it all heights are two)"
    )]
    Kurtosis {
        /// Skewness asked for.
        skewness: f64,
        /// Kurtosis asked for.
        found: f64,
        /// Least that can be made with this skewness.
        least: f64,
        /// Most that can be made.
        most: f64,
    },
    /// The field would be far larger than the body.
    #[error(
        "a field of {columns} by {rows} cells would be needed so that its ends do not feel each other: use a shorter \
         correlation length or roll_off"
    )]
    TooLarge {
        /// Columns of the field.
        columns: usize,
        /// Rows of the field.
        rows: usize,
    },
    /// The field cannot repeat in that length.
    #[error("patch is {}, expected at least two columns of {} and a finite length", Length(*found), Length(*column_width))]
    Patch {
        /// What was asked for, m.
        found: f64,
        /// Arc length of a column, m.
        column_width: f64,
    },
    /// A pin is no ring.
    #[error("patch repeats the heights round the ring, which a pin does not close: leave it out")]
    PatchOnPin,
    /// Only the mean was left, which is removed.
    #[error(
        "nothing but the mean is left of a field of {columns} columns and {rows} rows with {key} {}: \
         use a shorter {key}, a longer patch or flat = true",
        Length(*length)
    )]
    OnlyMean {
        /// Columns of the field.
        columns: usize,
        /// Rows of the field.
        rows: usize,
        /// Key of the length.
        key: &'static str,
        /// That length, m.
        length: f64,
    },
}
