//! Destruction and formation of secondary plateaus (model 4.3 and 4.4; paper 2.4, Figs. 2 to 4).

use crate::kernel::{Lanes, Mask};

/// Rule 4.3(b): plateaus of debris on resin that nothing supports in the sliding direction fall apart.
#[inline(always)]
pub fn falls(height: Lanes, substrate: Lanes, on_resin: Mask, supported: Mask) -> Mask {
    substrate.exceeds(height).and(on_resin).and_not(supported)
}

/// Heights of debris compacted in one step, m.
#[derive(Debug, Clone, Copy)]
pub struct Deposit {
    /// On the pin.
    pub pin: Lanes,
    /// On the disc.
    pub disc: Lanes,
}

/// Rule 4.4: debris fills the clearance γ (m) of open cells, wholly or as far as the share s (m) reaches.
///
/// Against a plateau ahead (`supported`) the pin takes the fraction `pad_share` = β of it; else all goes to the disc.
#[inline(always)]
pub fn form(clearance: Lanes, share: Lanes, supported: Mask, pad_share: Lanes) -> Deposit {
    let zero = Lanes::splat(0.0);
    let filled = clearance.max(zero).min(share);
    let pin = supported.select(pad_share * filled, zero);
    Deposit { pin, disc: filled - pin }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_unsupported_debris_on_resin_falls() {
        for (on_resin, supported, height, expected) in
            [(true, false, 1.0, true), (true, true, 1.0, false), (false, false, 1.0, false), (true, false, 3.0, false)]
        {
            let falls = falls(Lanes::splat(height), Lanes::splat(3.0), Mask::splat(on_resin), Mask::splat(supported));
            assert_eq!(falls.first(), expected);
        }
    }

    #[test]
    fn a_clearance_is_filled_wholly_or_in_part() {
        for (clearance, share, supported, pin, disc) in [
            (2.0, 8.0, true, 0.5, 1.5),
            (2.0, 0.5, true, 0.125, 0.375),
            (2.0, 0.5, false, 0.0, 0.5),
            (0.0, 0.5, true, 0.0, 0.0),
            (-1.0, 0.5, true, 0.0, 0.0),
        ] {
            let deposit =
                form(Lanes::splat(clearance), Lanes::splat(share), Mask::splat(supported), Lanes::splat(0.25));
            assert_eq!((deposit.pin.first(), deposit.disc.first()), (pin, disc));
        }
    }
}
