//! Destruction and formation of secondary plateaus with a pool of debris (model 4P; paper 2.4, Figs. 2 to 4), eight cells at a time.

use crate::engine::lanes::Lanes;

/// A plateau of debris on resin that nothing supports in the sliding direction falls apart.
#[inline(always)]
pub(crate) fn falls<L: Lanes>(secondary_on_resin: L::Mask, supported: L::Mask) -> L::Mask {
    secondary_on_resin & !supported
}

/// Height of debris (m) that fills the clearance γ ≥ 0 (m) of an open cell, wholly or as far as the share s
/// (m) reaches.
#[inline(always)]
pub(crate) fn fill<L: Lanes>(clearance: L, share: L) -> L {
    clearance.lesser(share)
}

/// The pin's part of what is filled, the fraction `pad_share` = β against a plateau ahead, else nothing.
#[inline(always)]
pub(crate) fn on_pin<L: Lanes>(filled: L, supported: L::Mask, pad_share: L) -> L {
    (filled * pad_share).only(supported)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::lanes::{Chunk, Mask, Portable};

    fn lanes(values: [f64; 8]) -> Portable {
        Portable::load(&Chunk(values))
    }

    fn values(lanes: Portable) -> [f64; 8] {
        let mut chunk = Chunk([0.0; 8]);
        lanes.store(&mut chunk);
        chunk.0
    }

    #[test]
    fn only_unsupported_debris_on_resin_falls() {
        let of = <Portable as Lanes>::Mask::of_byte;
        assert_eq!(falls::<Portable>(of(0b0011), of(0b0101)).byte(), 0b0010);
    }

    #[test]
    fn a_clearance_is_filled_wholly_or_in_part() {
        let clearance = lanes([2.0, 2.0, 2.0, 0.0, 0.25, 0.0, 0.0, 0.0]);
        let share = lanes([8.0, 0.5, 0.5, 0.5, 0.5, 0.0, 0.0, 0.0]);
        let filled = fill(clearance, share);
        assert_eq!(values(filled), [2.0, 0.5, 0.5, 0.0, 0.25, 0.0, 0.0, 0.0]);
        let supported = <Portable as Lanes>::Mask::of_byte(0b0011);
        assert_eq!(values(on_pin(filled, supported, lanes([0.25; 8]))), [0.5, 0.125, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    }
}
