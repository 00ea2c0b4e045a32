//! One column of pin and of disc.

use crate::state::Base;

/// The cells of one pin column, all slices of the same length.
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

/// The cells of one disc column, both slices of the same length.
#[derive(Debug)]
pub struct DiscColumn<'a> {
    /// z_d, m.
    pub height: &'a mut [f64],
    /// b_d, m.
    pub substrate: &'a mut [f64],
}

/// The cells of one disc column, to look at.
#[derive(Debug, Clone, Copy)]
pub struct DiscView<'a> {
    /// z_d, m.
    pub height: &'a [f64],
    /// b_d, m.
    pub substrate: &'a [f64],
}
