//! What a surface is like: the parameters of ISO 25178-2 and ISO 21920-2 for heights on a grid.
//!
//! Form is taken out before ([`level`](super::level)); no wavelength is filtered out. Missing points (NaN) take no part.
//! `docs/surface.md` has every definition with its formula and standard.

mod autocorrelation;
mod heights;
mod material_curve;
mod parameter;

pub use autocorrelation::Autocorrelation;
pub use heights::{Direction, Gradient, Grid, HeightParameters, ProfileParameters};
pub use material_curve::{CoreHeight, MaterialCurve, Volumes};
pub use parameter::{Group, PARAMETERS, Parameter, Unit, sampling_errors};

/// Classes of the Abbott-Firestone curve that a [`Description`] keeps: 0, 0.1, …, 100 %.
const CURVE_CLASSES: usize = 1000;

/// The parameters of a surface. A number that the heights do not determine is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct Description {
    /// Points that have a height.
    pub measured: usize,
    /// Moments and extremes of the heights.
    pub heights: HeightParameters,
    /// The core of the Abbott-Firestone curve and what stands out of it.
    pub core: CoreHeight,
    /// Volumes of material and void.
    pub volumes: Volumes,
    /// Sxp, m: height between the material ratios 2.5 % and 50 %.
    pub extreme_peak_height: f64,
    /// Heights above the mean at the material ratios 0, 0.1, …, 100 %, m: the Abbott-Firestone curve.
    pub material_curve: Vec<f64>,
    /// Slopes and developed area; none without a pitch.
    pub gradient: Option<Gradient>,
    /// Autocorrelation length and aspect ratio; none without a pitch.
    pub autocorrelation: Option<Autocorrelation>,
    /// Profiles along x, the sliding direction.
    pub along: ProfileParameters,
    /// Profiles along y, across it.
    pub across: ProfileParameters,
}

impl Description {
    /// Bytes that [`of`](Self::of) takes besides the heights of a grid of that size, at most.
    pub fn memory_needed(columns: usize, rows: usize) -> u64 {
        // The sorted heights are gone before the autocorrelation is made.
        let sorted = (columns as u64).saturating_mul(rows as u64).saturating_mul(size_of::<f64>() as u64);
        sorted.max(Autocorrelation::memory_needed(columns, rows))
    }

    /// Describes heights from which form was taken out. None if no point has a height.
    ///
    /// Takes one and a half times the memory of the heights besides them, and a quarter more where points are missing. The
    /// numbers do not depend on how many threads share the work.
    pub fn of(grid: &Grid) -> Option<Self> {
        let heights = HeightParameters::of(grid.heights)?;
        let curve = MaterialCurve::of(grid.heights, heights.mean);
        let ratio = |class| class as f64 / CURVE_CLASSES as f64;
        Some(Self {
            measured: curve.points(),
            core: CoreHeight::of(&curve),
            volumes: Volumes::of(&curve),
            extreme_peak_height: curve.height(0.025) - curve.height(0.5),
            material_curve: (0..=CURVE_CLASSES).map(|class| curve.height(ratio(class))).collect(),
            gradient: {
                // The sorted heights are as large as the heights: gone before the next large array is made.
                drop(curve);
                Gradient::of(grid)
            },
            autocorrelation: Autocorrelation::of(grid, heights.mean),
            along: ProfileParameters::of(grid, Direction::Along),
            across: ProfileParameters::of(grid, Direction::Across),
            heights,
        })
    }
}
