//! Debris: what cells that touch lose fills the gaps behind them (model 4L).
//!
//! Without a transport length the gaps of a strip are filled before any of its cells wears, and only the columns ahead of edges are
//! worn in passing. With one, all that touches has worn ([`super::edges`]), for most of it is near an edge.

use super::edge::{Edges, Reach};
use super::edges::{list, worn_ahead};
use super::instructions::kernel;
use super::moved::{Moved, SeldomEvent, add};
use super::pairs::lanes_of;
use super::read::Span;
use super::rules::{Conditions, Rules, StripRules};
use super::strip::Strip;
use crate::engine::lanes::{Integers, LANES, Lanes, Mask};
use crate::engine::strips::{DiscSector, PinStrips};

/// Columns with something to do ahead of which b_p is fetched.
const LATER: usize = 8;

kernel! {
    /// Fills the gaps of a strip of a span, of which no column has been worn, or, with a transport length, all that touches.
    pub fn deposit<const BUILD_UP: u8, const DISC_WEARS: bool, const TRANSPORT: bool>(
        rules: &Rules,
        conditions: &Conditions,
        pin: &mut PinStrips,
        disc: &mut DiscSector,
        span: Span,
        index: usize,
        moved: &mut Moved,
    ) = deposit_on_strip
}

#[inline(always)]
fn deposit_on_strip<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool, const TRANSPORT: bool>(
    rules: &Rules,
    conditions: &Conditions,
    pin: &mut PinStrips,
    disc: &mut DiscSector,
    span: Span,
    index: usize,
    moved: &mut Moved,
) {
    let ahead = conditions.ahead_of(index, rules);
    let strip = &mut Strip::new::<L, BUILD_UP>(index, pin, disc, span, false);
    if !TRANSPORT {
        moved.edges.take_fed(strip, ahead);
    }
    // Most columns with something to do have it in one half, and half of the registers are enough.
    deposit_on_rows::<L::First, BUILD_UP, DISC_WEARS, TRANSPORT>(rules, conditions, strip, ahead, moved);
    if <L::First as Lanes>::ROWS != L::ROWS {
        deposit_on_rows::<L::Second, BUILD_UP, DISC_WEARS, TRANSPORT>(rules, conditions, strip, ahead, moved);
    }
}

/// Fills the gaps in some rows of a strip.
#[inline(always)]
fn deposit_on_rows<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool, const TRANSPORT: bool>(
    rules: &Rules,
    conditions: &Conditions,
    strip: &mut Strip,
    ahead: &Reach,
    moved: &mut Moved,
) {
    let (index, columns) = (strip.index, strip.disc_height.len());
    let rules = &StripRules::<L>::new(rules, conditions, index);
    let mut deposits = Deposits::<L>::new();
    let Edges { listed, fed, open, plateau: plateaus, share: shares, .. } = &mut moved.edges;
    let count = list::<L>(listed, fed, columns);
    let fed = &fed[..columns];
    if TRANSPORT {
        let (open, plateaus, shares) = (&open[..columns], &plateaus[1..][..columns], &shares[1..][..columns]);
        // Each cell is fed from the nearest edge ahead. An open cell ahead, which is filled before it, counts as it was: so that is
        // read before anything is stored.
        let mut nearest = L::load(&ahead.share);
        let last = listed[..=count][count].wrapping_add(1) as usize;
        let mut height_ahead = L::load(strip.pin.height.get(last).unwrap_or(&ahead.height));
        for (column, behind) in listed[1..=count].iter().zip(&listed[..count]).rev() {
            let (column, behind) = (*column as usize, behind.wrapping_add(1) as usize);
            if column >= columns || behind >= columns {
                break;
            }
            nearest = L::select(L::Mask::of_byte(open[column]), L::load(&shares[column]), nearest);
            let height = L::select(L::Mask::of_byte(plateaus[column]), height_ahead, L::splat(f64::INFINITY));
            height_ahead = L::load(&strip.pin.height[behind]);
            deposits.fill(rules, strip, column, [fed[column], 0], [nearest, height], &mut moved.seldom);
        }
    } else {
        let lacks_substrate = strip.lacks_substrate::<BUILD_UP>();
        for (column, later) in listed[1..=count].iter().zip(&listed[1 + LATER..]) {
            let column = *column as usize;
            if column >= columns {
                break;
            }
            if lacks_substrate && let Some(later) = strip.pin.substrate.get(*later as usize) {
                later.fetch(0);
            }
            let rows = fed[column] & L::ROWS;
            let (of_resin, next);
            if column + 1 < columns {
                of_resin = rows & !strip.pin.plateau[column + 1];
                next = worn_ahead::<L, BUILD_UP, DISC_WEARS>(rules, strip, column + 1);
            } else {
                let height = L::load(&ahead.height);
                of_resin = rows & height.at_least(L::splat(f64::INFINITY)).byte();
                next = [L::load(&ahead.lost[0]), height];
            };
            deposits.fill(rules, strip, column, [rows, of_resin], next, &mut moved.seldom);
        }
    }
    add::<L>(&mut moved.deposited_pin.0[index], rules.deposits(deposits.on_pins, count));
    add::<L>(&mut moved.deposited_disc.0[index], rules.deposits(deposits.on_discs, count));
}

/// Sums of the deposits on a strip, anchored.
struct Deposits<L: Lanes> {
    on_pins: L::Integers,
    on_discs: L::Integers,
}

impl<L: Lanes> Deposits<L> {
    /// Returns empty sums.
    #[inline(always)]
    fn new() -> Self {
        Self { on_pins: L::Integers::splat(0), on_discs: L::Integers::splat(0) }
    }

    /// Fills the gaps at some of the eight cells of a column, with v̄, m, up to z_p of the cells ahead after wear and before any
    /// deposit, m; some of these are resin, whose debris is noted by itself.
    #[inline(always)]
    fn fill(
        &mut self,
        rules: &StripRules<L>,
        strip: &mut Strip,
        column: usize,
        [rows, of_resin]: [u8; 2],
        [share, height_ahead]: [L; 2],
        seldom: &mut Vec<SeldomEvent>,
    ) {
        let (z_p, z_d) = (L::load(&strip.pin.height[column]), L::load(&strip.disc_height[column]));
        let bounds = [rules.conditions.displacement, rules.rules.reference_height];
        let Filled { height, disc_height, on_pin, on_disc } = filled(rows, [z_p, z_d], [share, height_ahead], bounds);
        let substrate = L::load(&strip.pin.substrate[column]).greater(z_p);
        height.store(&mut strip.pin.height[column]);
        disc_height.store(&mut strip.disc_height[column]);
        substrate.store(&mut strip.pin.substrate[column]);
        strip.pin.plateau[column] |= height.below(substrate).byte();
        let [on_pin, on_disc] = if of_resin != 0 {
            note_of_resin(of_resin, rules.strip * LANES, [on_pin, on_disc], seldom);
            let others = L::Mask::of_byte(!of_resin);
            [on_pin.only(others), on_disc.only(others)]
        } else {
            [on_pin, on_disc]
        };
        self.on_pins = rules.plus_deposit(self.on_pins, on_pin);
        self.on_discs = rules.plus_deposit(self.on_discs, on_disc);
    }
}

/// Eight cells after a deposit.
struct Filled<L: Lanes> {
    /// Heights z_p and z_d, m.
    height: L,
    disc_height: L,
    /// Deposits on pin and disc, m.
    on_pin: L,
    on_disc: L,
}

/// Fills the gaps at some of eight cells of these z_p and z_d, m, with v̄, m, up to z_p ahead, m; δ and z_ref, m, bound them.
#[inline(always)]
fn filled<L: Lanes>(
    rows: u8,
    [z_p, z_d]: [L; 2],
    [share, height_ahead]: [L; 2],
    [displacement, reference]: [f64; 2],
) -> Filled<L> {
    let (receivers, reference) = (L::Mask::of_byte(rows), L::splat(reference));
    let clearance = z_p - z_d - L::splat(displacement);
    let flush = z_p.lesser(height_ahead);
    let deposit = (z_p - flush + (reference - z_d)).lesser(share).only(receivers);
    // Rounding moves a height by no more than twice what comes upon it: a quarter of the clearance makes no cell touch.
    let near = clearance.below(share * L::splat(4.0)).byte() & rows;
    if near == 0 {
        return parted(deposit, [z_p, z_d], [flush, reference]);
    }
    let mut filled = parted(clearance.lesser(deposit).only(receivers), [z_p, z_d], [flush, reference]);
    // Nor does a cell touch in the step in which it is filled up.
    let touching = receivers & (filled.height - filled.disc_height).below(L::splat(displacement));
    if touching.any() {
        [filled.height, filled.disc_height] =
            taken_back_of(touching.byte(), [z_p, z_d], [filled.height, filled.disc_height], displacement);
    }
    filled
}

/// Parts a deposit on eight cells, m: the pin has it up to a height, m, and the disc the rest.
#[inline(always)]
fn parted<L: Lanes>(deposit: L, [z_p, z_d]: [L; 2], [flush, reference]: [L; 2]) -> Filled<L> {
    let on_pin = deposit.lesser(z_p - flush);
    let on_disc = deposit - on_pin;
    // Neither beyond the plateau ahead nor above the reference, in rounded numbers too.
    let (height, disc_height) = ((z_p - on_pin).greater(flush), (z_d + on_disc).lesser(reference));
    Filled { height, disc_height, on_pin, on_disc }
}

/// Notes what is compacted on some of eight cells of what resin ahead loses, in the rows from this on.
#[cold]
#[inline(never)]
fn note_of_resin<L: Lanes>(cells: u8, first_row: usize, [on_pin, on_disc]: [L; 2], seldom: &mut Vec<SeldomEvent>) {
    let (pin, disc) = (on_pin.chunk(), on_disc.chunk());
    let event = |lane: usize| SeldomEvent::deposited(first_row + lane, [pin.0[lane], disc.0[lane]]);
    seldom.extend(lanes_of(cells).map(event).filter(|event| event.deposited != [0.0; 2]));
}

/// Heights of pin and disc, m, of which rounding leaves some touching: what is too much goes back.
#[cold]
#[inline(never)]
fn taken_back_of<L: Lanes>(touching: u8, before: [L; 2], after: [L; 2], displacement: f64) -> [L; 2] {
    let ([z_p, z_d], [mut height, mut disc_height]) = (before.map(L::chunk), after.map(L::chunk));
    for lane in lanes_of(touching) {
        [height.0[lane], disc_height.0[lane]] =
            taken_back([z_p.0[lane], z_d.0[lane]], [height.0[lane], disc_height.0[lane]], displacement);
    }
    [L::load(&height), L::load(&disc_height)]
}

/// Heights of pin and disc, m, that rounding leaves touching: what is too much goes back, up to where the cell was open.
#[cold]
#[inline(never)]
fn taken_back([z_p, z_d]: [f64; 2], [mut height, mut disc_height]: [f64; 2], displacement: f64) -> [f64; 2] {
    loop {
        let clearance = height - disc_height - displacement;
        if clearance >= 0.0 || (disc_height <= z_d && height >= z_p) {
            return [height, disc_height];
        }
        if disc_height > z_d {
            disc_height = greater(lesser(disc_height + clearance, disc_height.next_down()), z_d);
        } else {
            height = lesser(greater(height - clearance, height.next_up()), z_p);
        }
    }
}

#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[cfg(test)]
#[path = "../../../tests/unit/engine/deposit.rs"]
mod tests;
