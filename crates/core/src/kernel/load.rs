//! Gap and stiffness of the pairs of a column, and the load that they carry (model 4.1).

use super::cells::{Cells, PinView};
use super::lanes::{LANES, Lanes};
use crate::pair::Table;

/// Load and its slope at one displacement.
#[derive(Debug, Clone, Copy, Default)]
pub struct Load {
    /// Σ k A u, N.
    pub load: f64,
    /// Σ k A over cells in contact, N/m.
    pub slope: f64,
}

/// Writes gap g = z_p − z_d and stiffness k A of every pair of a column; `disc` is (z_d, b_d).
///
/// `DISTINCT` tells whether build-up has properties of its own.
pub fn face_column<const DISTINCT: bool>(
    pin: PinView,
    disc: (&[f64], &[f64]),
    table: &Table,
    gap: &mut [f64],
    stiffness: &mut [f64],
) {
    for row in (0..gap.len()).step_by(LANES) {
        let cells = Cells::load(pin, disc, row);
        (cells.pin_height - cells.disc_height).store(&mut gap[row..]);
        cells.pick::<DISTINCT>(table, row).store(&mut stiffness[row..]);
    }
}

/// Load and slope of one column at a displacement.
#[inline]
pub fn load_of_column(displacement: f64, gap: &[f64], stiffness: &[f64]) -> Load {
    let displacement = Lanes::splat(displacement);
    let zero = Lanes::splat(0.0);
    let (mut load, mut slope) = (zero, zero);
    for row in (0..gap.len()).step_by(LANES) {
        let overlap = displacement - Lanes::load(&gap[row..], f64::MAX);
        let carried = overlap.exceeds(zero).select(Lanes::load(&stiffness[row..], 0.0), zero);
        load += carried * overlap;
        slope += carried;
    }
    Load { load: load.sum(), slope: slope.sum() }
}

/// Adds 1 to the count of every row whose pair touches; `touching` is padded.
#[inline]
pub fn count_touching(displacement: f64, gap: &[f64], touching: &mut [f64]) {
    let displacement = Lanes::splat(displacement);
    for row in (0..gap.len()).step_by(LANES) {
        let touches = displacement.exceeds(Lanes::load(&gap[row..], f64::MAX));
        touches.select(Lanes::splat(1.0), Lanes::splat(0.0)).add_to(&mut touching[row..]);
    }
}
