//! Debris: what cells that touch lose fills the gaps behind them (model 4L).
//!
//! Between an open cell and one that touches ahead of it is an edge. What is lost within L columns ahead of it comes upon the open
//! cells within L columns behind it; without a transport length L is one column. Heights change before any cell of a strip wears:
//! the columns ahead of edges are worn in passing. From the bytes that tell which cells touch, columns with something to do are
//! listed first: a branch that goes either way costs more.

use super::edge::{Edge, Edges, Reach};
use super::instructions::{InstructionSet, kernel, with_build_up};
use super::moved::{Moved, SeldomEvent, add};
use super::pairs::lanes_of;
use super::read::Span;
use super::rules::{Conditions, Rules, StripRules};
use super::strip::Strip;
use super::worn::wear;
use super::worn_column::wear_ordinary_column;
use crate::engine::lanes::{Chunk, Integers, LANES, Lanes, Mask};
use crate::engine::parts::{Needs, build_up};
use crate::engine::strips::{DiscSector, PinStrips};

/// Columns that are looked up at a time: a word of bytes.
const COLUMNS: usize = 8;

/// Columns ahead of an edge that are looked at whether their cells touch or not.
const NEAR: usize = 4;

kernel! {
    /// Fills the gaps of a strip of a span, of which no column has been worn.
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
    let ahead = conditions.ahead.map_or(&rules.nothing_ahead, |edge| &edge.strips[index]);
    let mut strip = Strip::new::<L, BUILD_UP>(index, pin, disc, span, false);
    strip.shorten(span.columns);
    let mut edges = std::mem::take(&mut moved.edges);
    edges.take_touches(&strip, ahead);
    let (strip, edges_of) = (&mut strip, &mut edges);
    if <L::First as Lanes>::ROWS == L::ROWS {
        deposit_on_rows::<L, BUILD_UP, DISC_WEARS, TRANSPORT>(rules, conditions, strip, ahead, edges_of, moved);
    } else {
        // Most columns with something to do have it in one half, and half of the registers are enough.
        deposit_on_rows::<L::First, BUILD_UP, DISC_WEARS, TRANSPORT>(rules, conditions, strip, ahead, edges_of, moved);
        deposit_on_rows::<L::Second, BUILD_UP, DISC_WEARS, TRANSPORT>(rules, conditions, strip, ahead, edges_of, moved);
    }
    moved.edges = edges;
}

/// Fills the gaps in some rows of a strip.
#[inline(always)]
fn deposit_on_rows<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool, const TRANSPORT: bool>(
    rules: &Rules,
    conditions: &Conditions,
    strip: &mut Strip,
    ahead: &Reach,
    edges: &mut Edges,
    moved: &mut Moved,
) {
    let (index, columns) = (strip.index, strip.disc_height.len());
    let rules = &StripRules::<L>::new(rules, conditions, index);
    if TRANSPORT {
        edges.wear::<L, BUILD_UP, DISC_WEARS>(rules, strip, ahead);
        edges.gather(rules, columns, ahead);
    }
    let mut deposits = Deposits::<L>::new();
    let count = list::<L>(&mut edges.listed, &edges.fed, columns, if TRANSPORT { COLUMNS } else { 4 });
    let fed = &edges.fed[..columns];
    let (shares, heights) =
        if TRANSPORT { (&edges.share[..columns], &edges.height[..=columns]) } else { Default::default() };
    for column in &edges.listed[..count] {
        let column = *column as usize;
        if column >= columns {
            break;
        }
        let rows = fed[column] & strip.present(column) & L::ROWS;
        let mut of_resin = 0;
        let next = if TRANSPORT {
            // An open cell ahead has not been filled.
            let next = (column + 1).min(columns - 1);
            let (z_p, plateaus) = (L::load(&strip.pin.height[next]), L::Mask::of_byte(strip.pin.plateau[next]));
            let open = L::select(plateaus, z_p, L::splat(f64::INFINITY));
            let worn = if column < next { edges.touches[next] } else { u8::MAX };
            [L::load(&shares[column]), L::select(L::Mask::of_byte(worn), L::load(&heights[column + 1]), open)]
        } else if column + 1 < columns {
            of_resin = rows & !strip.pin.plateau[column + 1];
            worn_ahead::<L, BUILD_UP, DISC_WEARS, TRANSPORT>(rules, strip, column + 1)
        } else {
            let height = L::load(&ahead.height);
            of_resin = rows & height.at_least(L::splat(f64::INFINITY)).byte();
            [L::load(&ahead.lost[0]), height]
        };
        deposits.fill(rules, strip, column, [rows, of_resin], next, &mut moved.seldom);
    }
    add::<L>(&mut moved.deposited_pin.0[index], rules.deposits(deposits.on_pins, deposits.terms));
    add::<L>(&mut moved.deposited_disc.0[index], rules.deposits(deposits.on_discs, deposits.terms));
}

/// The bytes of eight columns from `first` on.
#[inline(always)]
fn word(bytes: &[u8], first: usize) -> u64 {
    bytes.get(first..).and_then(|bytes| bytes.first_chunk()).map_or(0, |bytes| u64::from_le_bytes(*bytes))
}

/// Lists the columns in which a bit of the lanes' rows is set, of so many, and returns how many there are; `few` of eight, without
/// a branch for each, are most.
#[inline(always)]
fn list<L: Lanes>(listed: &mut Vec<u32>, bytes: &[u8], columns: usize, few: usize) -> usize {
    listed.resize(bytes.len() + COLUMNS, 0);
    let mut count = 0;
    for first in (0..columns).step_by(COLUMNS) {
        let mut some = some_of(word(bytes, first) & u64::from_le_bytes([L::ROWS; COLUMNS]));
        let (places, all) = (&mut listed[count..][..COLUMNS], some.count_ones() as usize);
        for place in &mut places[..few] {
            *place = first as u32 + some.trailing_zeros() / u8::BITS;
            some &= some.wrapping_sub(1);
        }
        if all > few {
            for place in &mut places[few..] {
                *place = first as u32 + some.trailing_zeros() / u8::BITS;
                some &= some.wrapping_sub(1);
            }
        }
        count += all;
    }
    while count > 0 && listed[count - 1] as usize >= columns {
        count -= 1;
    }
    count
}

/// The highest bit of each byte in which one is set.
#[inline(always)]
fn some_of(word: u64) -> u64 {
    const LOW: u64 = u64::from_le_bytes([0x7f; COLUMNS]);
    (((word & LOW) + LOW) | word) & !LOW
}

/// Wears a column in passing: what its cells lose, as far as it may be compacted, m, and z_p of those that touch after it, m, out of
/// reach where there is no plateau.
#[inline(always)]
fn worn_ahead<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool, const TRANSPORT: bool>(
    rules: &StripRules<L>,
    strip: &Strip,
    column: usize,
) -> [L; 2] {
    if let Some(worn) = wear_ordinary_column::<L, BUILD_UP, DISC_WEARS>(rules, strip, column) {
        // No resin that touches is among these.
        let lost = worn.lost::<DISC_WEARS>(false);
        return [if TRANSPORT { lost } else { rules.captured(lost) }, worn.z_p];
    }
    let worn = wear::<L, BUILD_UP, DISC_WEARS>(rules, strip.cells::<L, BUILD_UP, DISC_WEARS>(column));
    let lost = worn.lost::<DISC_WEARS>(TRANSPORT);
    let lost = if TRANSPORT { lost } else { rules.captured(lost) + rules.captured_of_resin().only(worn.resin) };
    [lost, L::select(worn.resin, L::splat(f64::INFINITY), worn.height())]
}

impl Edges {
    /// Finds which cells an edge feeds: the open ones behind it.
    #[inline(always)]
    pub fn take_touches(&mut self, strip: &Strip, ahead: &Reach) {
        let columns = strip.disc_height.len();
        self.touches.clear();
        self.touches.extend_from_slice(&strip.pin.touches[..columns]);
        self.touches.extend_from_slice(&ahead.touches);
        let reach = ahead.touches.len();
        // Whole words are looked at, and those up to L columns ahead.
        let words = columns.div_ceil(COLUMNS) * COLUMNS;
        self.touches.resize(words + reach + COLUMNS, 0);
        self.open.resize(words, 0);
        self.fed.resize(words, 0);
        for first in (0..words).step_by(COLUMNS) {
            let (open, touching) = (!word(&self.touches, first), word(&self.touches, first + 1));
            let within_reach = (2..=reach).fold(touching, |within, ahead| within | word(&self.touches, first + ahead));
            self.open[first..][..COLUMNS].copy_from_slice(&(open & touching).to_le_bytes());
            self.fed[first..][..COLUMNS].copy_from_slice(&(open & within_reach).to_le_bytes());
        }
    }

    /// Wears the columns in which something touches.
    #[inline(always)]
    pub fn wear<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
        &mut self,
        rules: &StripRules<L>,
        strip: &Strip,
        ahead: &Reach,
    ) {
        let columns = strip.disc_height.len();
        self.lost.resize(columns, ahead.height);
        self.lost.extend_from_slice(&ahead.lost);
        self.height.resize(columns, ahead.height);
        self.height.push(ahead.height);
        let count = list::<L>(&mut self.listed, &self.touches, columns, COLUMNS);
        let (lost, height) = (&mut self.lost[..columns], &mut self.height[..columns]);
        for column in &self.listed[..count] {
            let column = *column as usize;
            if column >= columns {
                break;
            }
            let worn = worn_ahead::<L, BUILD_UP, DISC_WEARS, true>(rules, strip, column);
            worn[0].store(&mut lost[column]);
            worn[1].store(&mut height[column]);
        }
    }

    /// Gathers what is lost ahead of edges, and shares it among the cells that they feed.
    #[inline(always)]
    fn gather<L: Lanes>(&mut self, rules: &StripRules<L>, columns: usize, ahead: &Reach) {
        let reach = rules.rules.reach;
        self.share.resize(columns, ahead.share);
        // Nearer edges, which come later, take the place of this.
        self.share[columns.saturating_sub(reach)..].fill(ahead.share);
        let count = list::<L>(&mut self.listed, &self.open, columns, 4);
        for place in (0..count).rev() {
            let column = self.listed[place] as usize;
            let share = self.gathered(rules, self.open[column], column + 1);
            let edges = L::Mask::of_byte(self.open[column]);
            for chunk in &mut self.share[(column + 1).saturating_sub(reach)..=column] {
                L::select(edges, share, L::load(chunk)).store(chunk);
            }
        }
    }

    /// v̄ of edges, m, of which some cells of this column are the next that touch.
    #[inline(always)]
    fn gathered<L: Lanes>(&self, rules: &StripRules<L>, mut run: u8, column: usize) -> L {
        let reach = rules.rules.reach;
        let (touches, lost) = (&self.touches[column..][..reach], &self.lost[column..][..reach]);
        let mut sum = L::load(&lost[0]);
        for next in 1..reach {
            run &= touches[next];
            if next >= NEAR && run == 0 {
                break;
            }
            sum = sum + L::load(&lost[next]).only(L::Mask::of_byte(run));
        }
        sum * L::splat(rules.rules.transport_part)
    }

    /// Finds what the first column means to the one behind it.
    #[inline(always)]
    pub fn find_reach<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
        &mut self,
        rules: &StripRules<L>,
        strip: &Strip,
        reach: &mut Reach,
    ) {
        let columns = rules.rules.reach;
        let cells = strip.cells::<L, BUILD_UP, DISC_WEARS>(0);
        let worn = wear::<L, BUILD_UP, DISC_WEARS>(rules, cells);
        L::select(worn.resin, L::splat(f64::INFINITY), worn.height()).store(&mut reach.height);
        reach.touches.copy_from_slice(&self.touches[..columns]);
        if rules.rules.transport.is_none() {
            let [lost, _] = worn_ahead::<L, BUILD_UP, DISC_WEARS, false>(rules, strip, 0);
            lost.store(&mut reach.lost[0]);
            return;
        }
        L::splat(0.0).store(&mut reach.share);
        let mut open = u8::MAX;
        for next in 1..columns.min(strip.disc_height.len()) {
            open &= !self.touches[next - 1];
            let edges = open & self.touches[next];
            let share = self.gathered::<L>(rules, edges, next);
            L::select(L::Mask::of_byte(edges), share, L::load(&reach.share)).store(&mut reach.share);
        }
        reach.lost.copy_from_slice(&self.lost[..columns]);
    }
}

/// What is compacted on a strip, anchored.
struct Deposits<L: Lanes> {
    on_pins: L::Integers,
    on_discs: L::Integers,
    /// How many terms these sums have.
    terms: usize,
}

impl<L: Lanes> Deposits<L> {
    /// Nothing yet.
    #[inline(always)]
    fn new() -> Self {
        Self { on_pins: L::Integers::splat(0), on_discs: L::Integers::splat(0), terms: 0 }
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
        let reference = L::splat(rules.rules.reference_height);
        let receivers = L::Mask::of_byte(rows);
        let (z_p, z_d) = (L::load(&strip.pin.height[column]), L::load(&strip.disc_height[column]));
        let clearance = z_p - z_d - rules.displacement;
        let flush = z_p.lesser(height_ahead);
        let to_plateau = z_p - flush;
        let deposit = clearance.lesser(to_plateau + (reference - z_d)).lesser(share).only(receivers);
        let on_pin = deposit.lesser(to_plateau);
        let on_disc = deposit - on_pin;
        // Neither beyond the plateau ahead nor above the reference, in rounded numbers too.
        let (height, disc_height) = ((z_p - on_pin).greater(flush), (z_d + on_disc).lesser(reference));
        // Nor does a cell touch in the step in which it is filled up.
        let touching = receivers & (height - disc_height).below(rules.displacement);
        let [height, disc_height] = if touching.any() {
            taken_back_of(touching.byte(), [z_p, z_d], [height, disc_height], rules.conditions.displacement)
        } else {
            [height, disc_height]
        };
        let substrate = L::load(&strip.pin.substrate[column]).greater(z_p);
        height.store(&mut strip.pin.height[column]);
        disc_height.store(&mut strip.disc_height[column]);
        substrate.store(&mut strip.pin.substrate[column]);
        strip.pin.plateau[column] |= height.below(substrate).byte();
        self.terms += 1;
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

/// Notes what is compacted on some of eight cells of what resin ahead loses, in the rows from this on.
#[cold]
#[inline(never)]
fn note_of_resin<L: Lanes>(cells: u8, first_row: usize, [on_pin, on_disc]: [L; 2], seldom: &mut Vec<SeldomEvent>) {
    let (mut pin, mut disc) = (Chunk([0.0; LANES]), Chunk([0.0; LANES]));
    on_pin.store(&mut pin);
    on_disc.store(&mut disc);
    let event = |lane: usize| SeldomEvent::deposited(first_row + lane, [pin.0[lane], disc.0[lane]]);
    seldom.extend(lanes_of(cells).map(event).filter(|event| event.deposited != [0.0; 2]));
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

/// Finds what the first column of a span means to the one behind it, from the state at the start of the step.
pub type EdgeOf = fn(InstructionSet, &Rules, &Conditions, &mut PinStrips, &mut DiscSector, Span, &mut Moved, &mut Edge);

/// The one that does what a scene needs and nothing else; chosen once per run.
pub fn edge_of(needs: Needs) -> EdgeOf {
    with_build_up!(needs, edge_of_span)
}

kernel! {
    /// Finds what the first column of a span means to the one behind it.
    pub fn edge_of_span<const BUILD_UP: u8, const DISC_WEARS: bool>(
        rules: &Rules,
        conditions: &Conditions,
        pin: &mut PinStrips,
        disc: &mut DiscSector,
        span: Span,
        moved: &mut Moved,
        edge: &mut Edge,
    ) = edge_of_strips
}

#[inline(always)]
fn edge_of_strips<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &Rules,
    conditions: &Conditions,
    pin: &mut PinStrips,
    disc: &mut DiscSector,
    span: Span,
    moved: &mut Moved,
    edge: &mut Edge,
) {
    for (index, reach) in edge.reaches(pin.height.strips(), rules.reach).iter_mut().enumerate() {
        let strip = Strip::new::<L, BUILD_UP>(index, pin, disc, span, false);
        let strip_rules = StripRules::<L>::new(rules, conditions, index);
        let edges = &mut moved.edges;
        edges.take_touches(&strip, &rules.nothing_ahead);
        if rules.transport.is_some() {
            edges.wear::<L, BUILD_UP, DISC_WEARS>(&strip_rules, &strip, &rules.nothing_ahead);
        }
        edges.find_reach::<L, BUILD_UP, DISC_WEARS>(&strip_rules, &strip, reach);
    }
}
