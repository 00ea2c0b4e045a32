//! Local debris: what a cell that touches loses fills the gap behind it (model 4L).
//!
//! Few cells get any: the open ones behind one that touches. So they are looked up in the bytes that tell which cells touch,
//! and done one by one. Their heights change before any cell wears, and what is ahead of them is worn in passing.

use super::edge::{Ahead, EdgeStrip};
use super::moved::{Moved, SeldomEvent};
use super::rules::{Conditions, Rules};
use super::strip::Strip;
use super::worn_pair::Cells;
use crate::engine::lanes::{Chunk, LANES};
use crate::engine::parts::build_up;

/// Columns that are looked up at a time: a word of bytes.
pub(super) const COLUMNS: usize = 8;

/// Compacts debris in the columns of a strip from `first` on, [`COLUMNS`] of them or as many as there are. The next have not
/// been worn.
#[inline(always)]
pub(super) fn deposit<const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &Rules,
    conditions: &Conditions,
    edge: &EdgeStrip,
    strip: &mut Strip,
    first: usize,
    moved: &mut Moved,
) {
    let mut receivers = !word(strip.pin.touches, first) & word(strip.pin.touches, first + 1);
    if receivers == 0 {
        return;
    }
    if !strip.pin.present.is_empty() {
        receivers &= word(strip.pin.present, first);
    }
    let columns = strip.disc_height.len();
    let mut cells = StripCells {
        rules,
        conditions,
        strip: strip.index,
        edge,
        pin_height: &mut strip.pin.height[..columns],
        pin_substrate: &mut strip.pin.substrate[..columns],
        resin: &strip.pin.resin[..columns],
        plateau: &mut strip.pin.plateau[..columns],
        disc_height: &mut strip.disc_height[..columns],
        disc_substrate: if BUILD_UP == build_up::DISTINCT { &strip.disc_substrate[..columns] } else { &[] },
    };
    while receivers != 0 {
        let place = receivers.trailing_zeros() as usize;
        receivers &= receivers - 1;
        cells.fill::<BUILD_UP, DISC_WEARS>(first + place / LANES, place % LANES, moved);
    }
}

/// The bytes of eight columns from `first` on; where there are none, nothing touches and no cell is there.
#[inline(always)]
fn word(touches: &[u8], first: usize) -> u64 {
    let touches = touches.get(first..).unwrap_or_default();
    match touches.first_chunk::<COLUMNS>() {
        Some(bytes) => u64::from_le_bytes(*bytes),
        None => touches.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte)),
    }
}

/// A strip while debris comes upon it.
struct StripCells<'a> {
    rules: &'a Rules,
    conditions: &'a Conditions<'a>,
    strip: usize,
    edge: &'a EdgeStrip,
    pin_height: &'a mut [Chunk],
    pin_substrate: &'a mut [Chunk],
    resin: &'a [u8],
    plateau: &'a mut [u8],
    disc_height: &'a mut [Chunk],
    disc_substrate: &'a [Chunk],
}

impl StripCells<'_> {
    /// Fills the gap at an open cell with what the touching one ahead of it loses.
    #[inline(always)]
    fn fill<const BUILD_UP: u8, const DISC_WEARS: bool>(&mut self, column: usize, lane: usize, moved: &mut Moved) {
        let (rules, displacement) = (self.rules, self.conditions.displacement);
        let row = (self.conditions.first_strip + self.strip) * LANES + lane;
        let ahead = if column + 1 < self.disc_height.len() {
            let cells = Cells {
                z_p: self.pin_height[column + 1].0[lane],
                b_p: self.pin_substrate[column + 1].0[lane],
                z_d: self.disc_height[column + 1].0[lane],
                b_d: if BUILD_UP == build_up::DISTINCT { self.disc_substrate[column + 1].0[lane] } else { 0.0 },
                on_resin: self.resin[column + 1] >> lane & 1 == 1,
            };
            Ahead::new::<BUILD_UP, DISC_WEARS>(rules, row, displacement, cells)
        } else {
            self.edge.cells[lane]
        };

        let (z_p, z_d) = (self.pin_height[column].0[lane], self.disc_height[column].0[lane]);
        let flush = lesser(z_p, ahead.height);
        let (to_plateau, to_reference) = (z_p - flush, rules.reference_height - z_d);
        let clearance = z_p - z_d - displacement;
        let deposit = lesser(lesser(clearance, to_plateau + to_reference), ahead.captured);
        let on_pin = lesser(deposit, to_plateau);
        let on_disc = deposit - on_pin;
        // Neither beyond the plateau ahead nor above the reference, in rounded numbers too.
        let mut height = greater(z_p - on_pin, flush);
        let mut disc_height = lesser(z_d + on_disc, rules.reference_height);
        // Nor does a cell touch in the step in which it is filled up.
        if height - disc_height - displacement < 0.0 {
            [height, disc_height] = taken_back([z_p, z_d], [height, disc_height], displacement);
        }
        let substrate = greater(self.pin_substrate[column].0[lane], z_p);
        self.disc_height[column].0[lane] = disc_height;
        self.pin_height[column].0[lane] = height;
        self.pin_substrate[column].0[lane] = substrate;
        self.plateau[column] |= u8::from(height < substrate) << lane;

        if ahead.plateau {
            let quantum = self.conditions.deposit_quantum;
            let add = |sum: &mut i64, height: f64| *sum = sum.wrapping_add(quantum.count(height));
            add(&mut moved.deposited_pin.0[self.strip][lane], on_pin);
            add(&mut moved.deposited_disc.0[self.strip][lane], on_disc);
        } else if deposit > 0.0 {
            moved.seldom.push(SeldomEvent::deposited(row, [on_pin, on_disc]));
        }
    }
}

/// Heights of pin and disc, m, that rounding leaves touching: what is too much goes back, up to where the cell was open.
#[cold]
#[inline(never)]
pub(super) fn taken_back([z_p, z_d]: [f64; 2], [mut height, mut disc_height]: [f64; 2], displacement: f64) -> [f64; 2] {
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
