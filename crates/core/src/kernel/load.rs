//! Gap and stiffness of the pairs of a column, and the load that they carry (model 4.1).

use super::cells::{Cells, DiscView, PinView};
use super::lanes::{LANES, Lanes};
use crate::field::Rows;
use crate::pair::Table;

/// Load and its slope at one displacement.
#[derive(Debug, Clone, Copy, Default)]
pub struct Load {
    /// Σ k A u, N.
    pub load: f64,
    /// Σ k A over cells in contact, N/m.
    pub slope: f64,
}

/// Writes gap g = z_p − z_d and stiffness k A of every pair of a column.
///
/// `DISTINCT` tells whether build-up has properties of its own.
pub fn face_column<const DISTINCT: bool>(
    pin: PinView,
    disc: DiscView,
    table: &Table,
    gap: &mut [[f64; LANES]],
    stiffness: &mut [[f64; LANES]],
) {
    for (group, (gap, stiffness)) in gap.iter_mut().zip(stiffness).enumerate() {
        let cells = Cells::load(pin, disc, group);
        *gap = (cells.pin_height - cells.disc_height).0;
        *stiffness = cells.pick::<DISTINCT>(table, group).0;
    }
}

/// Load and slope of one column at a displacement.
#[inline]
pub fn load_of_column(displacement: f64, gap: &[[f64; LANES]], stiffness: &[[f64; LANES]]) -> Load {
    let displacement = Lanes::splat(displacement);
    let zero = Lanes::splat(0.0);
    let (mut load, mut slope) = (zero, zero);
    for (gap, stiffness) in gap.iter().zip(stiffness) {
        let overlap = displacement - Lanes(*gap);
        let carried = overlap.exceeds(zero).select(Lanes(*stiffness), zero);
        load += carried * overlap;
        slope += carried;
    }
    Load { load: load.sum(), slope: slope.sum() }
}

/// Adds 1 to the count of every row whose pair touches.
#[inline]
pub fn count_touching(displacement: f64, gap: &[[f64; LANES]], touching: &mut Rows) {
    let displacement = Lanes::splat(displacement);
    for (gap, count) in gap.iter().zip(touching) {
        let touches = displacement.exceeds(Lanes(*gap));
        touches.select(Lanes::splat(1.0), Lanes::splat(0.0)).add_to(count);
    }
}
