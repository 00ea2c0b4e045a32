//! Wear, destruction and formation in one column of pairs, in one pass (model 4.2 to 4.4).

use super::cells::{Cells, DiscColumn, DiscView, PinColumn, PinView};
use super::lanes::{Lanes, Mask};
use crate::debris::Transfer;
use crate::field::Rows;
use crate::pair::Coefficients;
use crate::{plateau, wear};

/// What a column must know of the step and of its neighbour.
#[derive(Debug, Clone, Copy)]
pub struct Outlook<'a> {
    /// δ, m.
    pub displacement: f64,
    /// s of every row, m.
    pub share: &'a Rows,
    /// β.
    pub pad_share: f64,
    /// h_m, m.
    pub wear_height: f64,
    /// The neighbour in the sliding direction at the start of the step; the last column has none.
    pub ahead: Option<PinView<'a>>,
}

/// One pass over a column: new heights, and what moved is added to the transfer.
pub type Update = fn(PinColumn, DiscColumn, &Outlook, &Coefficients, &mut Transfer);

/// The pass that does what a scene needs and nothing else; chosen once per run.
///
/// `distinct`: build-up has properties of its own. `disc_wears`, `forms`, `destroys`: the disc wears, plateaus form,
/// unsupported plateaus fall.
pub fn update(distinct: bool, disc_wears: bool, forms: bool, destroys: bool) -> Update {
    macro_rules! choose {
        ([$($chosen:literal),*]) => { update_column::<$($chosen),*> };
        ([$($chosen:literal),*] $flag:ident $($rest:ident)*) => {
            if $flag { choose!([$($chosen,)* true] $($rest)*) } else { choose!([$($chosen,)* false] $($rest)*) }
        };
    }
    choose!([] distinct disc_wears forms destroys)
}

fn update_column<const DISTINCT: bool, const DISC_WEARS: bool, const FORMS: bool, const DESTROYS: bool>(
    pin: PinColumn,
    disc: DiscColumn,
    outlook: &Outlook,
    coefficients: &Coefficients,
    transfer: &mut Transfer,
) {
    let zero = Lanes::splat(0.0);
    let displacement = Lanes::splat(outlook.displacement);
    for group in 0..pin.height.len() {
        let cells = Cells::load(
            PinView { height: pin.height, substrate: pin.substrate, base: pin.base },
            DiscView { height: disc.height, substrate: disc.substrate },
            group,
        );
        let overlap = displacement - (cells.pin_height - cells.disc_height);
        let touches = overlap.exceeds(zero);
        let overlap = overlap.max(zero);

        // 4.2 Resin loses its wear height at once, all else wears by its factor times the overlap.
        let resin_loss = touches.and(cells.resin()).select(Lanes::splat(outlook.wear_height), zero);
        let raw = overlap * cells.pick::<DISTINCT>(&coefficients.pin, group);
        let below = cells.on_resin.select(zero, cells.pick::<DISTINCT>(&coefficients.fibre, group));
        let worn = wear::pin::<FORMS>(cells.pin_height + resin_loss, cells.pin_substrate, raw, below);
        worn.loss.add_to(&mut transfer.worn_pin[group]);
        resin_loss.add_to(&mut transfer.worn_resin[group]);
        let (mut pin_height, pin_substrate) = (worn.height, worn.substrate);

        let mut disc_height = cells.disc_height;
        if DISC_WEARS {
            let raw = overlap * cells.pick::<DISTINCT>(&coefficients.disc, group);
            let below = cells.pick::<DISTINCT>(&coefficients.coating, group);
            let worn = wear::disc::<FORMS>(disc_height, cells.disc_substrate, raw, below);
            worn.loss.add_to(&mut transfer.worn_disc[group]);
            disc_height = worn.height;
            disc.substrate[group] = worn.substrate.0;
        }

        // 4.3(b) and 4.4
        if FORMS {
            let supported = outlook.ahead.map_or(Mask::splat(false), |ahead| ahead.plateaus(group));
            if DESTROYS {
                let falls = plateau::falls(pin_height, pin_substrate, cells.on_resin, supported);
                falls.select(pin_substrate - pin_height, zero).add_to(&mut transfer.returned[group]);
                pin_height = falls.select(pin_substrate, pin_height);
            }
            let clearance = touches.select(zero, pin_height - disc_height - displacement);
            let share = Lanes(outlook.share[group]);
            let deposit = plateau::form(clearance, share, supported, Lanes::splat(outlook.pad_share));
            pin_height = pin_height - deposit.pin;
            disc_height += deposit.disc;
            deposit.pin.add_to(&mut transfer.deposited_pin[group]);
            deposit.disc.add_to(&mut transfer.deposited_disc[group]);
        }

        pin.height[group] = pin_height.0;
        pin.substrate[group] = pin_substrate.0;
        if DISC_WEARS || FORMS {
            disc.height[group] = disc_height.0;
        }
    }
}
