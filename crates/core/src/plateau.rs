//! Destruction and formation of secondary plateaus at one cell (model 4.3 and 4.4; paper 2.4, Figs. 2 to 4).

use crate::state::Base;

/// Rule 4.3(b): a plateau of debris on resin that nothing supports in the sliding direction falls apart.
///
/// Returns the height (m) of the build-up that goes back to the pool, 0 where the plateau stands.
#[inline]
pub fn destroy_unsupported(height: &mut f64, substrate: f64, base: Base, supported: bool) -> f64 {
    if base == Base::None && !supported && *height < substrate {
        let build_up = substrate - *height;
        *height = substrate;
        return build_up;
    }
    0.0
}

/// Heights of debris compacted at one cell in one step, m.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Deposit {
    /// On the pin.
    pub pin: f64,
    /// On the disc.
    pub disc: f64,
}

/// Rule 4.4: debris fills the clearance of a cell that does not touch, wholly or as far as its share reaches.
///
/// `displacement` is δ and `share` s = M/S, m. Against a plateau ahead (`supported`) the pin takes the fraction
/// `pad_share` = β of it; else all goes to the disc.
#[inline]
pub fn form(
    pin_height: &mut f64,
    disc_height: &mut f64,
    displacement: f64,
    share: f64,
    supported: bool,
    pad_share: f64,
) -> Deposit {
    let clearance = *pin_height - *disc_height - displacement;
    if clearance <= 0.0 {
        return Deposit::default();
    }
    let filled = clearance.min(share);
    let pin = if supported { pad_share * filled } else { 0.0 };
    let deposit = Deposit { pin, disc: filled - pin };
    *pin_height -= deposit.pin;
    *disc_height += deposit.disc;
    deposit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_unsupported_debris_on_resin_falls() {
        for (base, supported, height, returned) in [
            (Base::None, false, 1.0, 2.0),
            (Base::None, true, 1.0, 0.0),
            (Base::Primary, false, 1.0, 0.0),
            (Base::None, false, 3.0, 0.0),
        ] {
            let mut after = height;
            assert_eq!(destroy_unsupported(&mut after, 3.0, base, supported), returned);
            assert_eq!(after, height + returned);
        }
    }

    #[test]
    fn a_clearance_is_filled_wholly_or_in_part() {
        let mut heights = (4.0, 1.0);
        let deposit = form(&mut heights.0, &mut heights.1, 1.0, 8.0, true, 0.25);
        assert_eq!(deposit, Deposit { pin: 0.5, disc: 1.5 });
        assert_eq!(heights, (3.5, 2.5));
        assert_eq!(form(&mut heights.0, &mut heights.1, 1.0, 8.0, true, 0.25), Deposit::default());

        let mut heights = (4.0, 1.0);
        assert_eq!(form(&mut heights.0, &mut heights.1, 1.0, 0.5, false, 0.25), Deposit { pin: 0.0, disc: 0.5 });
        assert_eq!(heights, (4.0, 1.5));
    }
}
