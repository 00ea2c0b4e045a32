//! Debris: what cells that touch lose fills the gaps behind them (model 4L).
//!
//! Between an open cell and one that touches ahead of it is an edge. What is lost within L columns ahead of it comes upon the open
//! cells within L columns behind it; without a transport length L is one column, the gaps of a strip are filled before any of its
//! cells wears, and only the columns ahead of edges are worn in passing. With one, all that touches is worn first, for most of it
//! is near an edge: from the last column to the first, so that what is lost ahead of an edge is at hand there. From the bytes that
//! tell which cells touch, columns with something to do are listed first: a branch that goes either way costs more.

use super::edge::{Edge, Edges, Reach};
use super::instructions::{InstructionSet, kernel, with_build_up};
use super::moved::{Moved, SeldomEvent, StripMoved, add};
use super::pairs::lanes_of;
use super::read::Span;
use super::rules::{Conditions, Rules, StripRules};
use super::strip::Strip;
use super::worn::wear;
use super::worn_column::{store_heights, store_worn, wear_any_and_note, wear_ordinary_column};
use crate::engine::lanes::{BYTES, Chunk, Integers, LANES, Lanes, Mask};
use crate::engine::parts::{Needs, build_up};
use crate::engine::strips::{DiscSector, PinStrips};

/// L up to which what is lost stays in registers: that of 200 µm on the paper's mesh.
const NEAR: usize = 4;

kernel! {
    /// Fills the gaps of a strip of a span, of which no column has been worn; with a transport length wears it, too.
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
        edges.wear::<L, BUILD_UP, DISC_WEARS>(rules, strip, ahead, moved);
    }
    let mut deposits = Deposits::<L>::new();
    let count = list::<L>(&mut edges.listed, &edges.fed, columns);
    let Edges { listed, fed, open, plateau: plateaus, share: shares, .. } = edges;
    let fed = &fed[..columns];
    if TRANSPORT {
        let (open, plateaus, shares) = (&open[..columns], &plateaus[1..][..columns], &shares[1..][..columns]);
        // Each cell is fed from the nearest edge ahead. An open cell ahead, which has been filled, counts as it was before: so what a
        // column becomes is stored a column later.
        let (mut nearest, height_ahead) = (L::load(&ahead.share), L::load(&ahead.height));
        let mut filled = (columns, height_ahead);
        for column in listed[..count].iter().rev() {
            let column = *column as usize;
            if column >= columns {
                break;
            }
            nearest = L::select(L::Mask::of_byte(open[column]), L::load(&shares[column]), nearest);
            let height = match strip.pin.height.get(column + 1) {
                Some(height) => L::load(height),
                None => height_ahead,
            };
            let height = L::select(L::Mask::of_byte(plateaus[column]), height, L::splat(f64::INFINITY));
            if let Some(place) = strip.pin.height.get_mut(filled.0) {
                filled.1.store(place);
            }
            let ahead = [nearest, height];
            filled = (column, deposits.fill(rules, strip, column, [fed[column], 0], ahead, &mut moved.seldom));
        }
        if let Some(place) = strip.pin.height.get_mut(filled.0) {
            filled.1.store(place);
        }
    } else {
        for column in &listed[..count] {
            let column = *column as usize;
            if column >= columns {
                break;
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
            let filled = deposits.fill(rules, strip, column, [rows, of_resin], next, &mut moved.seldom);
            filled.store(&mut strip.pin.height[column]);
        }
    }
    add::<L>(&mut moved.deposited_pin.0[index], rules.deposits(deposits.on_pins, count));
    add::<L>(&mut moved.deposited_disc.0[index], rules.deposits(deposits.on_discs, count));
}

/// Where the set bits of each byte are, in ascending order.
static SET_BITS: [[u32; 8]; 256] = {
    let mut places = [[0; 8]; 256];
    let mut byte = 0;
    while byte < 256 {
        let (mut bit, mut count) = (0, 0);
        while bit < 8 {
            if byte >> bit & 1 == 1 {
                places[byte][count] = bit as u32;
                count += 1;
            }
            bit += 1;
        }
        byte += 1;
    }
    places
};

/// Lists the columns in which a bit of the lanes' rows is set, of so many, and returns how many there are; the bytes fill up
/// what is looked at at a time.
#[inline(always)]
fn list<L: Lanes>(listed: &mut Vec<u32>, bytes: &[u8], columns: usize) -> usize {
    let bytes = &bytes.as_chunks().0[..columns.div_ceil(BYTES)];
    listed.resize((bytes.len() + 1) * BYTES, 0);
    let (mut first, mut count) = (0, 0);
    for bytes in bytes {
        for some in L::some_of(bytes).to_le_bytes() {
            let mut columns = SET_BITS[some as usize];
            for column in &mut columns {
                *column += first;
            }
            listed[count..][..8].copy_from_slice(&columns);
            first += 8;
            count += some.count_ones() as usize;
        }
    }
    while count > 0 && listed[count - 1] as usize >= columns {
        count -= 1;
    }
    count
}

/// Wears a column in passing: what its cells lose and may be compacted, m, and z_p of those that touch after it, m, out of reach
/// where there is no plateau.
#[inline(always)]
fn worn_ahead<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    strip: &Strip,
    column: usize,
) -> [L; 2] {
    if let Some(worn) = wear_ordinary_column::<L, BUILD_UP, DISC_WEARS>(rules, strip, column) {
        // No resin that touches is among these.
        return [rules.captured(worn.lost::<DISC_WEARS>(false)), worn.z_p];
    }
    let worn = wear::<L, BUILD_UP, DISC_WEARS>(rules, strip.cells::<L, BUILD_UP, DISC_WEARS>(column));
    let lost = rules.captured(worn.lost::<DISC_WEARS>(false)) + rules.captured_of_resin().only(worn.resin);
    [lost, worn.height_of_plateaus()]
}

impl Edges {
    /// Finds which cells an edge feeds: the open ones behind it.
    #[inline(always)]
    pub fn take_touches(&mut self, strip: &Strip, ahead: &Reach) {
        let columns = strip.disc_height.len();
        self.touches.clear();
        self.touches.extend_from_slice(&strip.pin.touches[..columns]);
        self.touches.extend_from_slice(&ahead.touches);
        let bytes = columns.div_ceil(BYTES) * BYTES;
        self.touches.resize(bytes + ahead.touches.len(), 0);
        self.open.resize(bytes, 0);
        self.fed.resize(bytes, 0);
        let Self { touches, open, fed, .. } = self;
        // A compiler makes wide loops of these.
        for (fed, touches) in fed.iter_mut().zip(&touches[1..]) {
            *fed = *touches;
        }
        for ahead in 2..=ahead.touches.len() {
            for (fed, touches) in fed.iter_mut().zip(&touches[ahead..]) {
                *fed |= touches;
            }
        }
        for (((open, fed), own), next) in open.iter_mut().zip(fed.iter_mut()).zip(&touches[..]).zip(&touches[1..]) {
            *open = !own & next;
            *fed &= !own;
        }
        // No cell that is not there is filled.
        for (fed, present) in fed.iter_mut().zip(strip.pin.present) {
            *fed &= present;
        }
    }

    /// Wears what touches, and keeps what it loses.
    #[inline(always)]
    pub fn wear<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
        &mut self,
        rules: &StripRules<L>,
        strip: &mut Strip,
        ahead: &Reach,
        moved: &mut Moved,
    ) {
        let columns = strip.disc_height.len();
        let reach = rules.rules.reach;
        self.plateau.clear();
        self.plateau.extend_from_slice(&strip.pin.plateau[..columns]);
        // What lies ahead has told its plateaus by its height.
        self.plateau.push(u8::MAX);
        let part = L::splat(rules.rules.transport_part);
        self.share.resize(columns + 1, ahead.height);
        (gathered::<L>(u8::MAX, &ahead.touches, &ahead.lost) * part).store(&mut self.share[columns]);
        if reach > NEAR {
            self.lost.resize(columns, ahead.height);
            self.lost.extend_from_slice(&ahead.lost);
        }
        let mut run = Run::<L>::of(ahead);
        let count = list::<L>(&mut self.listed, &self.touches, columns);
        let mut strip_moved = StripMoved::<L>::new();
        let (shares, mut last) = (&mut self.share[..columns], columns);
        for column in self.listed[..count].iter().rev() {
            let column = *column as usize;
            if column >= columns {
                break;
            }
            let worn = match wear_ordinary_column::<L, BUILD_UP, DISC_WEARS>(rules, strip, column) {
                Some(worn) => {
                    store_heights::<L, BUILD_UP, DISC_WEARS>(strip, column, worn.z_p, &worn);
                    worn
                }
                None => {
                    let worn = wear_any_and_note::<L, BUILD_UP, DISC_WEARS>(rules, strip, column, &mut moved.seldom);
                    store_worn::<L, BUILD_UP, DISC_WEARS>(strip, column, &worn);
                    worn
                }
            };
            if BUILD_UP == build_up::DISTINCT {
                strip_moved.add::<DISC_WEARS>(rules, &worn);
            }
            let lost = worn.lost::<DISC_WEARS>(true);
            // Without a branch, which goes either way.
            let joined = L::Mask::of_byte(u8::from(column + 1 == last).wrapping_neg());
            run.step_back(worn.touches & joined, lost);
            last = column;
            let mut sum = run.sum(NEAR);
            if reach < NEAR {
                sum = run.sum(reach);
            } else if reach > NEAR {
                lost.store(&mut self.lost[column]);
                sum = gathered::<L>(u8::MAX, &self.touches[column..][..reach], &self.lost[column..][..reach]);
            }
            (sum * part).store(&mut shares[column]);
        }
        strip_moved.store::<BUILD_UP, DISC_WEARS>(rules, strip.index, count, moved);
    }

    /// Finds what the first column means to the one behind it, from the state at the start of the step.
    #[inline(always)]
    pub fn find_reach<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
        &mut self,
        rules: &StripRules<L>,
        strip: &Strip,
        reach: &mut Reach,
    ) {
        let columns = rules.rules.reach;
        let worn = wear::<L, BUILD_UP, DISC_WEARS>(rules, strip.cells::<L, BUILD_UP, DISC_WEARS>(0));
        worn.height_of_plateaus().store(&mut reach.height);
        reach.touches.copy_from_slice(&self.touches[..columns]);
        if rules.rules.transport.is_none() {
            let [lost, _] = worn_ahead::<L, BUILD_UP, DISC_WEARS>(rules, strip, 0);
            lost.store(&mut reach.lost[0]);
            return;
        }
        let own = strip.disc_height.len();
        self.lost.resize(own, reach.height);
        self.lost.extend_from_slice(&rules.rules.nothing_ahead.lost);
        for column in 0..own {
            let worn = wear::<L, BUILD_UP, DISC_WEARS>(rules, strip.cells::<L, BUILD_UP, DISC_WEARS>(column));
            worn.lost::<DISC_WEARS>(true).store(&mut self.lost[column]);
        }
        L::splat(0.0).store(&mut reach.share);
        let mut open = u8::MAX;
        for next in 1..columns.min(own) {
            open &= !self.touches[next - 1];
            let edges = open & self.touches[next];
            let share = gathered::<L>(edges, &self.touches[next..][..columns], &self.lost[next..][..columns])
                * L::splat(rules.rules.transport_part);
            L::select(L::Mask::of_byte(edges), share, L::load(&reach.share)).store(&mut reach.share);
        }
        reach.lost.copy_from_slice(&self.lost[..columns]);
    }
}

/// Σ v of the first of L columns and the others as far as cells touch, m, of some cells; of the columns is given what touches and
/// what it loses.
#[inline(always)]
fn gathered<L: Lanes>(mut run: u8, touches: &[u8], lost: &[Chunk]) -> L {
    let lost = &lost[..touches.len()];
    let mut sum = L::load(&lost[0]);
    run &= touches[0] & L::ROWS;
    for next in 1..touches.len() {
        run &= touches[next];
        if run == 0 {
            break;
        }
        sum = sum + L::load(&lost[next]).only(L::Mask::of_byte(run));
    }
    sum
}

/// What the columns from one on lose, m, each as far as it and all before it touch; else 0.
struct Run<L: Lanes>([L; NEAR]);

impl<L: Lanes> Run<L> {
    /// What lies ahead of a span.
    #[inline(always)]
    fn of(ahead: &Reach) -> Self {
        let mut lost = [L::splat(0.0); NEAR];
        let (mut run, mut next) = (u8::MAX, 0);
        while next < ahead.touches.len() && next < NEAR {
            run &= ahead.touches[next];
            lost[next] = L::load(&ahead.lost[next]).only(L::Mask::of_byte(run));
            next += 1;
        }
        Self(lost)
    }

    /// Steps back by a column, in which some cells touch that go on a run, and which loses so much.
    #[inline(always)]
    fn step_back(&mut self, touches: L::Mask, lost: L) {
        let mut next = NEAR - 1;
        while next > 0 {
            self.0[next] = self.0[next - 1].only(touches);
            next -= 1;
        }
        self.0[0] = lost;
    }

    /// What so many of them lose in all, the nearest first.
    #[inline(always)]
    fn sum(&self, columns: usize) -> L {
        let mut sum = self.0[0];
        let mut next = 1;
        while next < columns {
            sum = sum + self.0[next];
            next += 1;
        }
        sum
    }
}

/// What is compacted on a strip, anchored.
struct Deposits<L: Lanes> {
    on_pins: L::Integers,
    on_discs: L::Integers,
}

impl<L: Lanes> Deposits<L> {
    /// Nothing yet.
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
    ) -> L {
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
        height
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
        edges.find_reach::<L, BUILD_UP, DISC_WEARS>(&strip_rules, &strip, reach);
    }
}
