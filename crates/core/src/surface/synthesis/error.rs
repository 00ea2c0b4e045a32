//! Why a synthetic surface cannot be made.

use thiserror::Error;

use crate::surface::Length;

/// Why a synthetic surface cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum SynthesisError {
    #[error("rms_height is {found} m, expected 0 or more and finite")]
    RmsHeight { found: f64 },
    #[error("{key} is {found} m, expected more than 0 and finite")]
    CorrelationLength { key: &'static str, found: f64 },
    #[error(
        "{key} is {}, expected at most {} here (the ring's circumference, or 2^20 cells): \
         a surface that varies so slowly is flat on this mesh, use flat = true",
        Length(*found), Length(*longest)
    )]
    CorrelationTooLong { key: &'static str, found: f64, longest: f64 },
    #[error("hurst is {found}, expected 0 to 1")]
    Hurst { found: f64 },
    #[error(
        "roll_off is {}, expected a wavelength from {} (two cells) to {} (the ring's circumference, or 2^20 cells)",
        Length(*found), Length(*shortest), Length(*longest)
    )]
    RollOff { found: f64, shortest: f64, longest: f64 },
    #[error(
        "short_cutoff is {}, expected a wavelength from {} (two cells) to the roll_off of {}",
        Length(*found), Length(*shortest), Length(*roll_off)
    )]
    ShortCutoff { found: f64, shortest: f64, roll_off: f64 },
    #[error(
        "skewness {skewness} with kurtosis {found}: with this skewness the kurtosis is expected to be at least {least:.4} \
         and at most {most} (3 is normal; below skewness² + 1 there is no distribution, and near it all heights are two)"
    )]
    Kurtosis { skewness: f64, found: f64, least: f64, most: f64 },
    #[error(
        "a field of {columns} by {rows} cells would be needed so that its ends do not feel each other: use a shorter \
         correlation length or roll_off"
    )]
    TooLarge { columns: usize, rows: usize },
    #[error("patch is {}, expected at least two columns of {} and a finite length", Length(*found), Length(*column_width))]
    Patch { found: f64, column_width: f64 },
    #[error("patch repeats the heights round the ring, which a pin does not close: leave it out")]
    PatchOnPin,
    #[error(
        "nothing but the mean is left of a field of {columns} columns and {rows} rows with {key} {}: \
         use a shorter {key}, a longer patch or flat = true",
        Length(*length)
    )]
    OnlyMean { columns: usize, rows: usize, key: &'static str, length: f64 },
}
