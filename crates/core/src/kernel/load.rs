//! Gap and stiffness of the pairs of a column, and the load that they carry (model 4.1).

use super::columns::{DiscView, PinView};
use super::instructions::kernel;
use crate::pair::{PairCell, Table, first_rows};

kernel! {
    /// Writes gap g = z_p − z_d and stiffness k A of every pair of a column.
    ///
    /// `DISTINCT` tells whether build-up has properties of its own.
    pub fn face_column<const DISTINCT>(
        pin: PinView,
        disc: DiscView,
        table: &Table,
        gap: &mut [f64],
        stiffness: &mut [f64],
    ) = face_rows
}

#[inline(always)]
fn face_rows<const DISTINCT: bool>(
    pin: PinView,
    disc: DiscView,
    table: &Table,
    gap: &mut [f64],
    stiffness: &mut [f64],
) {
    let rows = gap.len();
    let stiffness = &mut stiffness[..rows];
    let (pin_height, pin_substrate, base) = (&pin.height[..rows], &pin.substrate[..rows], &pin.base[..rows]);
    let (disc_height, disc_substrate) = (&disc.height[..rows], &disc.substrate[..rows]);
    let table = first_rows(table, rows);
    for row in 0..rows {
        let pair = PairCell {
            on_resin: base[row].is_resin(),
            pin_secondary: pin_height[row] < pin_substrate[row],
            disc_secondary: disc_height[row] > disc_substrate[row],
        };
        gap[row] = pin_height[row] - disc_height[row];
        stiffness[row] = pair.pick::<DISTINCT>(&table, row);
    }
}

kernel! {
    /// Adds what every cell of a column carries at a displacement to the sums of its row: load Σ k A u, slope Σ k A and
    /// number of cells in contact.
    pub fn add_load(
        displacement: f64,
        gap: &[f64],
        stiffness: &[f64],
        load: &mut [f64],
        slope: &mut [f64],
        touching: &mut [f64],
    ) = add_rows
}

// Every slice is an argument of its own, so that the compiler knows that none overlaps another.
#[inline(always)]
fn add_rows(
    displacement: f64,
    gap: &[f64],
    stiffness: &[f64],
    load: &mut [f64],
    slope: &mut [f64],
    touching: &mut [f64],
) {
    let rows = gap.len();
    let (stiffness, load, slope) = (&stiffness[..rows], &mut load[..rows], &mut slope[..rows]);
    let touching = &mut touching[..rows];
    for row in 0..rows {
        let overlap = displacement - gap[row];
        let touches = if overlap > 0.0 { 1.0 } else { 0.0 };
        let carried = stiffness[row] * touches;
        load[row] += carried * overlap;
        slope[row] += carried;
        touching[row] += touches;
    }
}
