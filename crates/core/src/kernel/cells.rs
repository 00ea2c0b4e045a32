//! One column of pin and disc, as the kernels see it: in groups of lanes.

use super::lanes::{LANES, Lanes, Mask};
use crate::pair::Table;
use crate::state::Base;

/// The cells of one pin column, all slices of the same length.
#[derive(Debug)]
pub struct PinColumn<'a> {
    /// z_p, m.
    pub height: &'a mut [[f64; LANES]],
    /// b_p, m.
    pub substrate: &'a mut [[f64; LANES]],
    /// Resin or fibre.
    pub base: &'a [[Base; LANES]],
}

/// The cells of one pin column, to look at.
#[derive(Debug, Clone, Copy)]
pub struct PinView<'a> {
    /// z_p, m.
    pub height: &'a [[f64; LANES]],
    /// b_p, m.
    pub substrate: &'a [[f64; LANES]],
    /// Resin or fibre.
    pub base: &'a [[Base; LANES]],
}

impl PinView<'_> {
    /// Which cells of a group are plateaus.
    #[inline(always)]
    pub(super) fn plateaus(self, group: usize) -> Mask {
        let build_up = Lanes(self.substrate[group]).exceeds(Lanes(self.height[group]));
        Mask::resin(&self.base[group]).not().or(build_up)
    }
}

/// The cells of one disc column, both slices of the same length.
#[derive(Debug)]
pub struct DiscColumn<'a> {
    /// z_d, m.
    pub height: &'a mut [[f64; LANES]],
    /// b_d, m.
    pub substrate: &'a mut [[f64; LANES]],
}

/// The cells of one disc column, to look at.
#[derive(Debug, Clone, Copy)]
pub struct DiscView<'a> {
    /// z_d, m.
    pub height: &'a [[f64; LANES]],
    /// b_d, m.
    pub substrate: &'a [[f64; LANES]],
}

/// Heights and statuses of a group of pairs at the start of a step.
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
    /// The pairs of a group.
    #[inline(always)]
    pub(super) fn load(pin: PinView, disc: DiscView, group: usize) -> Self {
        let (pin_height, pin_substrate) = (Lanes(pin.height[group]), Lanes(pin.substrate[group]));
        let (disc_height, disc_substrate) = (Lanes(disc.height[group]), Lanes(disc.substrate[group]));
        Self {
            pin_height,
            pin_substrate,
            disc_height,
            disc_substrate,
            on_resin: Mask::resin(&pin.base[group]),
            pin_secondary: pin_substrate.exceeds(pin_height),
            disc_secondary: disc_height.exceeds(disc_substrate),
        }
    }

    /// Resin without build-up.
    #[inline(always)]
    pub(super) fn resin(&self) -> Mask {
        self.on_resin.and_not(self.pin_secondary)
    }

    /// The coefficient of each pair of a group.
    ///
    /// Where build-up has the properties of what it lies on (`DISTINCT` is false), two of the six entries serve all.
    #[inline(always)]
    pub(super) fn pick<const DISTINCT: bool>(&self, table: &Table, group: usize) -> Lanes {
        let entry = |pair: usize| Lanes(table[pair][group]);
        if !DISTINCT {
            return self.resin().select(entry(0), entry(2));
        }
        let on_coating = self.pin_secondary.select(entry(4), self.on_resin.select(entry(0), entry(2)));
        let on_debris = self.pin_secondary.select(entry(5), self.on_resin.select(entry(1), entry(3)));
        self.disc_secondary.select(on_debris, on_coating)
    }
}
