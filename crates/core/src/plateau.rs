//! Destruction and formation of secondary plateaus (model 4.3 and 4.4; paper 2.4, Figs. 2 to 4).

/// Rule 4.3(b): a plateau of debris on resin that nothing supports in the sliding direction falls apart.
#[inline(always)]
pub fn falls(height: f64, substrate: f64, on_resin: bool, supported: bool) -> bool {
    (height < substrate) & on_resin & !supported
}

/// Heights of debris compacted at a cell in one step, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deposit {
    /// On the pin.
    pub pin: f64,
    /// On the disc.
    pub disc: f64,
}

/// Rule 4.4: debris fills the clearance γ (m) of an open cell, wholly or as far as the share s (m) reaches.
///
/// Against a plateau ahead (`supported`) the pin takes the fraction `pad_share` = β of it; else all goes to the disc.
#[inline(always)]
pub fn form(clearance: f64, share: f64, supported: bool, pad_share: f64) -> Deposit {
    let clearance = if clearance > 0.0 { clearance } else { 0.0 };
    let filled = if clearance < share { clearance } else { share };
    let pin = if supported { pad_share * filled } else { 0.0 };
    Deposit { pin, disc: filled - pin }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_unsupported_debris_on_resin_falls() {
        assert!(falls(1.0, 3.0, true, false));
        assert!(!falls(1.0, 3.0, true, true));
        assert!(!falls(1.0, 3.0, false, false));
        assert!(!falls(3.0, 3.0, true, false));
    }

    #[test]
    fn a_clearance_is_filled_wholly_or_in_part() {
        assert_eq!(form(2.0, 8.0, true, 0.25), Deposit { pin: 0.5, disc: 1.5 });
        assert_eq!(form(2.0, 0.5, true, 0.25), Deposit { pin: 0.125, disc: 0.375 });
        assert_eq!(form(2.0, 0.5, false, 0.25), Deposit { pin: 0.0, disc: 0.5 });
        assert_eq!(form(-1.0, 0.5, true, 0.25), Deposit { pin: 0.0, disc: 0.0 });
    }
}
