//! A pass over the pin where debris has a transport length: what plateaus lose within that length ahead of an edge fills the open
//! cells within that length behind it (model 4L; 4.2, and 4.1 of the next step, as in [`super::pass`]).
//!
//! It goes along each strip against the sliding direction: what lies ahead of a column has lost what it loses when the column is
//! reached, so eight cells are loaded once to wear, to be filled and to be read. A [`Scan`] has what they must know of those ahead.
//! Edges are looked for and gaps filled in all cells: a branch that goes either way costs more.

use super::deposit::taken_back;
use super::edge::{Edge, Reach};
use super::instructions::{InstructionSet, kernel, with_build_up};
use super::moved::{Moved, StripMoved, add};
use super::pairs::{Pairs, lanes_of};
use super::read::Span;
use super::reading::{Reading, StripReading};
use super::rules::{Conditions, Rules, StripRules};
use super::strip::Strip;
use super::worn::{Worn, wear};
use super::worn_column::wear_and_note;
use crate::engine::lanes::{Chunk, Integers, LANES, Lanes, Mask};
use crate::engine::parts::{Needs, build_up};
use crate::engine::strips::{DiscSector, PinStrips};

/// Finds what the first column of a span means to the one behind it, from the state at the start of the step.
pub type ReachOf =
    fn(InstructionSet, &Rules, &Conditions, &mut PinStrips, &mut DiscSector, Span, &mut Moved, &mut Edge);

/// The one that does what a scene needs and nothing else; chosen once per run.
pub fn reach_of(needs: Needs) -> ReachOf {
    with_build_up!(needs, reach_of_span)
}

kernel! {
    /// Finds the reach of the first column of a span.
    pub fn reach_of_span<const BUILD_UP: u8, const DISC_WEARS: bool>(
        rules: &Rules,
        conditions: &Conditions,
        pin: &mut PinStrips,
        disc: &mut DiscSector,
        span: Span,
        moved: &mut Moved,
        edge: &mut Edge,
    ) = reach_of_strips
}

kernel! {
    /// Passes over a span against the sliding direction.
    pub fn pass_against_sliding<const BUILD_UP: u8, const DISC_WEARS: bool>(
        rules: &Rules,
        conditions: &Conditions,
        pin: &mut PinStrips,
        disc: &mut DiscSector,
        span: Span,
        joined: bool,
        moved: &mut Moved,
        reading: &mut Reading,
    ) = pass_over_strips
}

#[inline(always)]
fn reach_of_strips<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &Rules,
    conditions: &Conditions,
    pin: &mut PinStrips,
    disc: &mut DiscSector,
    span: Span,
    moved: &mut Moved,
    edge: &mut Edge,
) {
    let none = Reach::none(rules.transport.unwrap_or(1));
    for index in 0..pin.height.strips() {
        let strip = Strip::new::<L, BUILD_UP>(index, pin, disc, span, false);
        let strip_rules = StripRules::<L>::new(rules, conditions, index);
        let mut scan = Scan::<L>::new(&strip, &none, moved);
        for column in strip.extent.clone().rev() {
            let worn = wear::<L, BUILD_UP, DISC_WEARS>(&strip_rules, strip.cells::<L, BUILD_UP, DISC_WEARS>(column));
            scan.enter(&strip_rules, column);
            scan.leave::<DISC_WEARS>(column, &worn);
        }
        edge.reaches.push(if strip.extent.start == 0 { scan.reach(&strip_rules) } else { none.clone() });
        scan.give_back(moved);
    }
}

#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the kernel's own")]
fn pass_over_strips<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &Rules,
    conditions: &Conditions,
    pin: &mut PinStrips,
    disc: &mut DiscSector,
    span: Span,
    joined: bool,
    moved: &mut Moved,
    reading: &mut Reading,
) {
    let none = Reach::none(rules.transport.unwrap_or(1));
    for index in 0..pin.height.strips() {
        let mut strip = Strip::new::<L, BUILD_UP>(index, pin, disc, span, joined);
        if strip.extent.is_empty() {
            continue;
        }
        let strip_rules = StripRules::<L>::new(rules, conditions, index);
        // Where the strip ends before the span, what is ahead belongs to cells that are not there.
        let ahead = match conditions.ahead {
            Some(edge) if strip.extent.end == span.columns => &edge.reaches[index],
            _ => &none,
        };
        pass_over::<L, BUILD_UP, DISC_WEARS>(&strip_rules, &mut strip, ahead, moved, reading);
    }
}

/// Passes over a strip.
#[inline(always)]
fn pass_over<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    strip: &mut Strip,
    ahead: &Reach,
    moved: &mut Moved,
    reading: &mut Reading,
) {
    let mut scan = Scan::<L>::new(strip, ahead, moved);
    let (mut strip_moved, mut next) = (StripMoved::<L>::new(), StripReading::<L, BUILD_UP>::new());
    let (mut on_pins, mut on_discs) = (L::Integers::splat(0), L::Integers::splat(0));
    let nothing = L::Mask::of_byte(0);
    let extent = strip.extent.clone();
    strip.shorten(extent.end);
    // The pin of the column ahead after the step: it lies over this column of the disc in the next.
    let (mut height_ahead, mut resin_ahead, mut secondary_ahead) = (rules.zero, nothing, nothing);
    for column in extent.clone().rev() {
        let worn = wear_and_note::<L, BUILD_UP, DISC_WEARS>(rules, strip, column, &mut strip_moved, &mut moved.seldom);
        let z_p = worn.height();
        let receivers = scan.enter(rules, column) & L::Mask::of_byte(strip.present(column));
        let filled = fill(rules, &worn, receivers, scan.height, scan.share);
        on_pins = rules.plus_deposit(on_pins, filled.on_pin);
        on_discs = rules.plus_deposit(on_discs, filled.on_disc);
        scan.leave::<DISC_WEARS>(column, &worn);

        let b_p = worn.b_p.greater(z_p);
        let secondary = filled.z_p.below(b_p);
        filled.z_p.store(&mut strip.pin.height[column]);
        b_p.store(&mut strip.pin.substrate[column]);
        strip.pin.plateau[column] = (secondary | !worn.on_resin).byte();
        filled.z_d.store(&mut strip.disc_height[column]);
        if DISC_WEARS {
            worn.b_d.store(&mut strip.disc_substrate[column]);
        }

        // 4.1 of the next step.
        if column + 1 < extent.end {
            let disc_secondary = if BUILD_UP == build_up::DISTINCT { worn.b_d.below(filled.z_d) } else { nothing };
            let pairs = Pairs { on_resin: resin_ahead, pin_secondary: secondary_ahead, disc_secondary };
            let place = [strip.index, strip.first + column + 1];
            strip.pin.touches[column + 1] =
                next.add(height_ahead - filled.z_d, pairs, &rules.bracket, place, reading).byte();
        }
        (height_ahead, resin_ahead, secondary_ahead) = (filled.z_p, worn.on_resin, secondary);
    }
    let behind = strip.behind::<L, BUILD_UP>(extent.start);
    let pairs = Pairs { on_resin: resin_ahead, pin_secondary: secondary_ahead, disc_secondary: behind.secondary };
    let place = [strip.index, strip.first + extent.start];
    strip.pin.touches[extent.start] =
        next.add(height_ahead - behind.height, pairs, &rules.bracket, place, reading).byte();

    scan.give_back(moved);
    add::<L>(&mut moved.deposited_pin.0[strip.index], rules.deposits(on_pins, extent.len()));
    add::<L>(&mut moved.deposited_disc.0[strip.index], rules.deposits(on_discs, extent.len()));
    strip_moved.store::<BUILD_UP, DISC_WEARS>(rules, strip.index, extent.len(), moved);
    next.store(strip.index, reading);
}

/// What the eight cells of a column must know of those ahead of them in their rows, at the start of a step.
struct Scan<L: Lanes> {
    /// L.
    columns: usize,
    /// Which cells touch in each column of the strip and in L columns ahead of it, one bit each.
    touches: Vec<u8>,
    /// v of each of these columns, m.
    lost: Vec<Chunk>,
    /// v of the next columns, m, as long as their cells touch: most of what is gathered, without a branch.
    near: [L; NEAR],
    /// z_p of the next column after wear and before any deposit, m; out of reach where it is no plateau.
    height: L,
    /// v̄ of the edge that the column is fed from, m.
    share: L,
    /// How many cells that edge feeds from the column on.
    remaining: L,
}

/// Columns of which v is in registers: as many as 200 µm are on the paper's mesh.
const NEAR: usize = 4;

impl<L: Lanes> Scan<L> {
    /// At the end of a strip, ahead of which lies this.
    #[inline(always)]
    fn new(strip: &Strip, ahead: &Reach, moved: &mut Moved) -> Self {
        let end = strip.extent.end;
        let mut lost = std::mem::take(&mut moved.lost);
        // What is there of another strip is overwritten before it is read.
        lost.resize(end, Chunk([0.0; LANES]));
        lost.extend_from_slice(&ahead.lost);
        let mut touches = std::mem::take(&mut moved.touches);
        touches.clear();
        touches.extend_from_slice(&strip.pin.touches[..end]);
        touches.extend_from_slice(&ahead.touches);
        Self {
            columns: ahead.lost.len(),
            touches,
            near: near_of(ahead),
            lost,
            height: L::load(&ahead.height),
            share: L::load(&ahead.share),
            remaining: L::load(&ahead.remaining),
        }
    }

    /// Comes to a column: finds its edges. Returns which of its cells an edge feeds.
    #[inline(always)]
    fn enter(&mut self, rules: &StripRules<L>, column: usize) -> L::Mask {
        let (open, ahead) = (!self.touches[column], self.touches[column + 1]);
        let edges = L::Mask::of_byte(open & ahead);
        let share = self.gathered(open & ahead, column + 1) * L::splat(rules.rules.transport_part);
        self.share = L::select(edges, share, self.share);
        self.remaining = L::select(edges, L::splat(self.columns as f64), self.remaining);
        L::Mask::of_byte(open) & rules.zero.below(self.remaining)
    }

    /// Σ v over the cells from a column on, as long as they touch, of at most L columns; of no meaning in other rows than these.
    #[inline(always)]
    fn gathered(&self, rows: u8, first: usize) -> L {
        let (mut sum, mut run, mut column) = (L::splat(0.0), rows, 0);
        if self.columns >= NEAR {
            let [a, b, c, d] = self.near;
            sum = a + b + c + d;
            if self.columns == NEAR {
                return sum;
            }
            while column < NEAR {
                run &= self.touches[first + column];
                column += 1;
            }
        }
        while column < self.columns {
            run &= self.touches[first + column];
            if run == 0 {
                break;
            }
            sum = sum + L::load(&self.lost[first + column]).only(L::Mask::of_byte(run));
            column += 1;
        }
        sum
    }

    /// Goes on to the column behind one that is worn.
    #[inline(always)]
    fn leave<const DISC_WEARS: bool>(&mut self, column: usize, worn: &Worn<L>) {
        let (lost, [a, b, c, _]) = (worn.lost::<DISC_WEARS>(), self.near);
        lost.store(&mut self.lost[column]);
        let touching = self.touches[column];
        let touches = L::Mask::of_byte(touching);
        self.near = [lost, a.only(touches), b.only(touches), c.only(touches)];
        self.height = L::select(worn.resin, L::splat(f64::INFINITY), worn.height());
        self.remaining = self.remaining - L::splat(1.0);
    }

    /// What the first column, the last that was left, means to the one behind it.
    #[inline(always)]
    fn reach(&self, rules: &StripRules<L>) -> Reach {
        let mut reach = Reach::none(self.columns);
        self.height.store(&mut reach.height);
        self.share.store(&mut reach.share);
        self.remaining.greater(rules.zero).store(&mut reach.remaining);
        reach.touches.copy_from_slice(&self.touches[..self.columns]);
        reach.lost.copy_from_slice(&self.lost[..self.columns]);
        reach
    }

    /// Gives back what is kept for the next strip.
    #[inline(always)]
    fn give_back(self, moved: &mut Moved) {
        (moved.lost, moved.touches) = (self.lost, self.touches);
    }
}

/// v of the first columns of a reach, as long as their cells touch.
#[inline(always)]
fn near_of<L: Lanes>(ahead: &Reach) -> [L; NEAR] {
    let (mut near, mut run, mut column) = ([L::splat(0.0); NEAR], u8::MAX, 0);
    while column < NEAR.min(ahead.lost.len()) {
        run &= ahead.touches[column];
        near[column] = L::load(&ahead.lost[column]).only(L::Mask::of_byte(run));
        column += 1;
    }
    near
}

/// Eight cells after wear and deposits, m.
struct Filled<L> {
    z_p: L,
    z_d: L,
    on_pin: L,
    on_disc: L,
}

/// Fills the gaps at those of eight cells that an edge feeds, from the pin's height ahead and v̄; the others stay as wear left them.
#[inline(always)]
fn fill<L: Lanes>(rules: &StripRules<L>, worn: &Worn<L>, receivers: L::Mask, height_ahead: L, share: L) -> Filled<L> {
    let reference = L::splat(rules.rules.reference_height);
    let (z_p, z_d) = (worn.height(), worn.z_d);
    let flush = z_p.lesser(height_ahead);
    let to_plateau = z_p - flush;
    let deposit = worn.clearance.lesser(to_plateau + (reference - z_d)).lesser(share).only(receivers);
    let on_pin = deposit.lesser(to_plateau);
    let on_disc = deposit - on_pin;
    // Neither beyond the plateau ahead nor above the reference, in rounded numbers too.
    let (mut height, mut disc_height) = ((z_p - on_pin).greater(flush), (z_d + on_disc).lesser(reference));
    // Nor does a cell touch in the step in which it is filled up.
    let touching = receivers & (height - disc_height).below(rules.displacement);
    if touching.any() {
        [height, disc_height] =
            taken_back_of(touching.byte(), [z_p, z_d], [height, disc_height], rules.conditions.displacement);
    }
    Filled { z_p: height, z_d: disc_height, on_pin, on_disc }
}

/// Heights of pin and disc, m, of which rounding leaves some touching: what is too much goes back.
#[cold]
#[inline(never)]
fn taken_back_of<L: Lanes>(touching: u8, before: [L; 2], after: [L; 2], displacement: f64) -> [L; 2] {
    let chunk = |lanes: L| {
        let mut chunk = Chunk([0.0; LANES]);
        lanes.store(&mut chunk);
        chunk
    };
    let ([z_p, z_d], [mut height, mut disc_height]) = (before.map(chunk), after.map(chunk));
    for lane in lanes_of(touching) {
        [height.0[lane], disc_height.0[lane]] =
            taken_back([z_p.0[lane], z_d.0[lane]], [height.0[lane], disc_height.0[lane]], displacement);
    }
    [L::load(&height), L::load(&disc_height)]
}
