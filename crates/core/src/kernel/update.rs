//! Wear, destruction and formation in one column of pairs, in one pass (model 4.2 to 4.4).

use super::columns::{DiscColumn, PinColumn, PinView};
use super::instructions::{InstructionSet, kernel};
use crate::debris::Transfer;
use crate::pair::{Coefficients, PairCell, first_rows};
use crate::parts::Needs;
use crate::state::Base;
use crate::{plateau, wear};

/// What a column must know of the step and of its neighbour.
#[derive(Debug, Clone, Copy)]
pub struct Outlook<'a> {
    /// δ, m.
    pub displacement: f64,
    /// s of every row, m.
    pub share: &'a [f64],
    /// β.
    pub pad_share: f64,
    /// h_m, m.
    pub wear_height: f64,
    /// The neighbour in the sliding direction at the start of the step; for the last column, which has none, resin.
    pub ahead: PinView<'a>,
}

/// One pass over a column: new heights, and what moved is added to the transfer.
pub type Update = fn(InstructionSet, PinColumn, DiscColumn, &Outlook, &Coefficients, &mut Transfer);

/// The pass that does what a scene needs and nothing else; chosen once per run.
pub fn update(needs: Needs) -> Update {
    let Needs { distinct, disc_wears, forms, destroys } = needs;
    macro_rules! choose {
        ([$($chosen:literal),*]) => { update_column::<$($chosen),*> };
        ([$($chosen:literal),*] $flag:ident $($rest:ident)*) => {
            if $flag { choose!([$($chosen,)* true] $($rest)*) } else { choose!([$($chosen,)* false] $($rest)*) }
        };
    }
    choose!([] distinct disc_wears forms destroys)
}

kernel! {
    /// Wear, destruction and formation in one column.
    pub fn update_column<const DISTINCT, const DISC_WEARS, const FORMS, const DESTROYS>(
        pin: PinColumn,
        disc: DiscColumn,
        outlook: &Outlook,
        coefficients: &Coefficients,
        transfer: &mut Transfer,
    ) = update_slices
}

#[inline(always)]
fn update_slices<const DISTINCT: bool, const DISC_WEARS: bool, const FORMS: bool, const DESTROYS: bool>(
    pin: PinColumn,
    disc: DiscColumn,
    outlook: &Outlook,
    coefficients: &Coefficients,
    transfer: &mut Transfer,
) {
    update_rows::<DISTINCT, DISC_WEARS, FORMS, DESTROYS>(
        outlook,
        coefficients,
        pin.base,
        pin.height,
        pin.substrate,
        disc.height,
        disc.substrate,
        &mut transfer.worn_pin,
        &mut transfer.worn_resin,
        &mut transfer.worn_disc,
        &mut transfer.returned,
        &mut transfer.deposited_pin,
        &mut transfer.deposited_disc,
    );
}

/// [`update_slices`] with every slice an argument of its own, so that the compiler knows that none overlaps another.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the slices in structures would be taken for overlapping")]
fn update_rows<const DISTINCT: bool, const DISC_WEARS: bool, const FORMS: bool, const DESTROYS: bool>(
    outlook: &Outlook,
    coefficients: &Coefficients,
    base: &[Base],
    pin_height: &mut [f64],
    pin_substrate: &mut [f64],
    disc_height: &mut [f64],
    disc_substrate: &mut [f64],
    worn_pin: &mut [f64],
    worn_resin: &mut [f64],
    worn_disc: &mut [f64],
    returned: &mut [f64],
    deposited_pin: &mut [f64],
    deposited_disc: &mut [f64],
) {
    let rows = base.len();
    let (pin_height, pin_substrate) = (&mut pin_height[..rows], &mut pin_substrate[..rows]);
    let (disc_height, disc_substrate) = (&mut disc_height[..rows], &mut disc_substrate[..rows]);
    let (worn_pin, worn_resin, worn_disc) = (&mut worn_pin[..rows], &mut worn_resin[..rows], &mut worn_disc[..rows]);
    let (returned, deposited_pin) = (&mut returned[..rows], &mut deposited_pin[..rows]);
    let (deposited_disc, share) = (&mut deposited_disc[..rows], &outlook.share[..rows]);
    let (pin_factor, fibre) = (first_rows(&coefficients.pin, rows), first_rows(&coefficients.fibre, rows));
    let (disc_factor, coating) = (first_rows(&coefficients.disc, rows), first_rows(&coefficients.coating, rows));
    let ahead = outlook.ahead;
    let (ahead_height, ahead_substrate) = (&ahead.height[..rows], &ahead.substrate[..rows]);
    let ahead_base = &ahead.base[..rows];
    let Outlook { displacement, pad_share, wear_height, .. } = *outlook;

    for row in 0..rows {
        let (mut z_p, b_p) = (pin_height[row], pin_substrate[row]);
        let (mut z_d, b_d) = (disc_height[row], disc_substrate[row]);
        let pair = PairCell { on_resin: base[row].is_resin(), pin_secondary: z_p < b_p, disc_secondary: z_d > b_d };
        let overlap = displacement - (z_p - z_d);
        let touches = overlap > 0.0;
        let overlap = if touches { overlap } else { 0.0 };

        // 4.2 Resin loses its wear height at once, all else wears by its factor times the overlap.
        let resin_loss = if touches & pair.is_resin() { wear_height } else { 0.0 };
        let raw = overlap * pair.pick::<DISTINCT>(&pin_factor, row);
        let fibre = pair.pick::<DISTINCT>(&fibre, row);
        let below = if pair.on_resin { 0.0 } else { fibre };
        let worn = wear::pin::<FORMS>(z_p + resin_loss, b_p, raw, below);
        worn_pin[row] += worn.loss;
        worn_resin[row] += resin_loss;
        z_p = worn.height;
        let b_p = worn.substrate;

        if DISC_WEARS {
            let raw = overlap * pair.pick::<DISTINCT>(&disc_factor, row);
            let worn = wear::disc::<FORMS>(z_d, b_d, raw, pair.pick::<DISTINCT>(&coating, row));
            worn_disc[row] += worn.loss;
            z_d = worn.height;
            disc_substrate[row] = worn.substrate;
        }

        // 4.3(b) and 4.4
        if FORMS {
            let built_up_ahead = ahead_height[row] < ahead_substrate[row];
            let supported = !ahead_base[row].is_resin() | built_up_ahead;
            if DESTROYS {
                let falls = plateau::falls(z_p, b_p, pair.on_resin, supported);
                // A product, for a sum under a condition would be stored under a condition, which is slow to read again.
                returned[row] += (b_p - z_p) * if falls { 1.0 } else { 0.0 };
                z_p = if falls { b_p } else { z_p };
            }
            let clearance = z_p - z_d - displacement;
            let clearance = if touches { 0.0 } else { clearance };
            let deposit = plateau::form(clearance, share[row], supported, pad_share);
            z_p -= deposit.pin;
            z_d += deposit.disc;
            deposited_pin[row] += deposit.pin;
            deposited_disc[row] += deposit.disc;
        }

        pin_height[row] = z_p;
        pin_substrate[row] = b_p;
        if DISC_WEARS || FORMS {
            disc_height[row] = z_d;
        }
    }
}
