//! Wear of the eight cells of a column of a strip (model 4.2, 4.2a), and what is noted of it.

use super::moved::{SeldomEvent, StripMoved, note_broken, note_worn_through};
use super::rules::StripRules;
use super::strip::Strip;
use super::worn::{Worn, wear, wear_ordinary};
use crate::engine::lanes::{Lanes, Mask};
use crate::engine::parts::build_up;

/// Wears the eight cells of a column, with few instructions where nothing out of the ordinary happens to them, and notes what
/// they lose.
#[inline(always)]
pub fn wear_and_note<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    strip: &Strip,
    column: usize,
    moved: &mut StripMoved<L>,
    seldom: &mut Vec<SeldomEvent>,
) -> Worn<L> {
    let worn = match wear_ordinary_column::<L, BUILD_UP, DISC_WEARS>(rules, strip, column) {
        Some(worn) => worn,
        None => wear_any_and_note::<L, BUILD_UP, DISC_WEARS>(rules, strip, column, seldom),
    };
    moved.add::<BUILD_UP, DISC_WEARS>(rules, &worn);
    worn
}

/// Wears the eight cells of a column, and notes what happens to few of them.
#[inline(always)]
pub fn wear_any_and_note<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    strip: &Strip,
    column: usize,
    seldom: &mut Vec<SeldomEvent>,
) -> Worn<L> {
    let cells = strip.cells::<L, BUILD_UP, DISC_WEARS>(column);
    let worn = wear::<L, BUILD_UP, DISC_WEARS>(rules, cells);
    if BUILD_UP != build_up::DISTINCT && worn.worn_through.any() {
        let (heights, gaps) = ((worn.b_p - cells.z_p).chunk(), (cells.z_p - cells.z_d).chunk());
        note_worn_through(seldom, &heights, &gaps, worn.worn_through.byte(), rules.strip);
    }
    if (BUILD_UP == build_up::BRITTLE || BUILD_UP == build_up::DISTINCT) && worn.broken.any() {
        note_broken(seldom, &(worn.b_p - worn.z_p).chunk(), worn.broken.byte(), rules.strip);
    }
    worn
}

/// Wears the eight cells of a column, if nothing out of the ordinary happens to any.
#[inline(always)]
pub fn wear_ordinary_column<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    strip: &Strip,
    column: usize,
) -> Option<Worn<L>> {
    let bytes = [strip.pin.touches[column], strip.pin.plateau[column], strip.pin.resin[column]];
    let cells = strip.cells::<L, BUILD_UP, DISC_WEARS>(column);
    wear_ordinary::<L, BUILD_UP, DISC_WEARS>(rules, cells, bytes, strip.resin_touches)
}

/// Stores the eight worn cells of a column; returns their z_p, m, and which are secondary on the pin.
#[inline(always)]
pub fn store_worn<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    strip: &mut Strip,
    column: usize,
    worn: &Worn<L>,
) -> (L, L::Mask) {
    let (mut z_p, mut pin_secondary) = (worn.z_p, L::Mask::of_byte(0));
    if BUILD_UP != build_up::NONE {
        z_p = worn.height();
        let b_p = worn.b_p.greater(z_p);
        b_p.store(&mut strip.pin.substrate[column]);
        pin_secondary = z_p.below(b_p);
        let plateau = &mut strip.pin.plateau[column];
        *plateau = *plateau & !L::ROWS | (pin_secondary | !worn.on_resin).byte();
    }
    store_heights::<L, BUILD_UP, DISC_WEARS>(strip, column, z_p, worn);
    (z_p, pin_secondary)
}

/// Stores z_p, m, of the eight worn cells of a column, and their disc: all of it where nothing out of the ordinary happened, so that
/// build-up stays build-up.
#[inline(always)]
pub fn store_heights<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    strip: &mut Strip,
    column: usize,
    z_p: L,
    worn: &Worn<L>,
) {
    z_p.store(&mut strip.pin.height[column]);
    if DISC_WEARS {
        worn.z_d.store(&mut strip.disc_height[column]);
        if BUILD_UP != build_up::NONE {
            worn.b_d.store(&mut strip.disc_substrate[column]);
        }
    }
}
