//! One column of pin and disc, as the kernels see it.

use super::lanes::{LANES, Lanes, Mask};
use crate::pair::Table;
use crate::state::Base;

/// A height that nothing reaches: fills the lanes beyond the last row of the pin.
const OUT_OF_REACH: f64 = f64::MAX / 4.0;

/// The cells of one pin column.
#[derive(Debug)]
pub struct PinColumn<'a> {
    /// z_p, m.
    pub height: &'a mut [f64],
    /// b_p, m.
    pub substrate: &'a mut [f64],
    /// Resin or fibre.
    pub base: &'a [Base],
}

/// The cells of one pin column, to look at.
#[derive(Debug, Clone, Copy)]
pub struct PinView<'a> {
    /// z_p, m.
    pub height: &'a [f64],
    /// b_p, m.
    pub substrate: &'a [f64],
    /// Resin or fibre.
    pub base: &'a [Base],
}

/// The cells of one disc column.
#[derive(Debug)]
pub struct DiscColumn<'a> {
    /// z_d, m.
    pub height: &'a mut [f64],
    /// b_d, m.
    pub substrate: &'a mut [f64],
}

/// Heights and statuses of some pairs of cells at the start of a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cells {
    pub(super) pin_height: Lanes,
    pub(super) pin_substrate: Lanes,
    pub(super) disc_height: Lanes,
    pub(super) disc_substrate: Lanes,
    /// The pin's base is resin.
    pub(super) on_resin: Mask,
    /// The pin is secondary.
    pub(super) pin_secondary: Mask,
    /// The disc is secondary.
    pub(super) disc_secondary: Mask,
}

impl Cells {
    /// The pairs from `row` on.
    #[inline(always)]
    pub(super) fn load(pin: PinView, disc: (&[f64], &[f64]), row: usize) -> Self {
        let pin_height = Lanes::load(&pin.height[row..], OUT_OF_REACH);
        let pin_substrate = Lanes::load(&pin.substrate[row..], OUT_OF_REACH);
        let disc_height = Lanes::load(&disc.0[row..], 0.0);
        let disc_substrate = Lanes::load(&disc.1[row..], 0.0);
        Self {
            pin_height,
            pin_substrate,
            disc_height,
            disc_substrate,
            on_resin: Mask::resin(&pin.base[row..]),
            pin_secondary: pin_substrate.exceeds(pin_height),
            disc_secondary: disc_height.exceeds(disc_substrate),
        }
    }

    /// Resin without build-up.
    #[inline(always)]
    pub(super) fn resin(&self) -> Mask {
        self.on_resin.and_not(self.pin_secondary)
    }

    /// The coefficient of each pair in the rows from `row` on.
    ///
    /// Where build-up has the properties of what it lies on (`DISTINCT` is false), two of the six entries serve all.
    #[inline(always)]
    pub(super) fn pick<const DISTINCT: bool>(&self, table: &Table, row: usize) -> Lanes {
        let entry = |pair: usize| Lanes::load(&table[pair][row..row + LANES], 0.0);
        if !DISTINCT {
            return self.resin().select(entry(0), entry(2));
        }
        let on_coating = self.pin_secondary.select(entry(4), self.on_resin.select(entry(0), entry(2)));
        let on_debris = self.pin_secondary.select(entry(5), self.on_resin.select(entry(1), entry(3)));
        self.disc_secondary.select(on_debris, on_coating)
    }
}
