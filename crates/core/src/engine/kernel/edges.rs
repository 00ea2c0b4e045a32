//! The edges of a strip, and what is lost ahead of them (model 4L).
//!
//! Between an open cell and one that touches ahead of it is an edge. What is lost within L columns ahead of it comes upon the open
//! cells within L columns behind it; without a transport length L is one column. From the bytes that tell which cells touch, columns
//! with something to do are listed first: a branch that goes either way costs more.

use super::edge::{Edge, Edges, Reach};
use super::instructions::{InstructionSet, kernel, with_build_up};
use super::moved::{Moved, StripMoved};
use super::read::Span;
use super::rules::{Conditions, Rules, StripRules};
use super::strip::Strip;
use super::worn::{Worn, wear};
use super::worn_column::{store_heights, store_worn, wear_any_and_note, wear_ordinary_column};
use crate::engine::lanes::{BYTES, Chunk, Lanes, Mask};
use crate::engine::parts::{Needs, build_up};
use crate::engine::strips::{DiscSector, PinStrips};

/// L up to which what is lost stays in registers: that of 200 µm on the paper's mesh.
const NEAR: usize = 4;

kernel! {
    /// Wears what touches of a strip of a span before its gaps are filled, and keeps what may come upon the cells behind: with a
    /// transport length.
    pub fn wear_before_deposit<const BUILD_UP: u8, const DISC_WEARS: bool>(
        rules: &Rules,
        conditions: &Conditions,
        pin: &mut PinStrips,
        disc: &mut DiscSector,
        span: Span,
        index: usize,
        moved: &mut Moved,
    ) = wear_strip_before_deposit
}

#[inline(always)]
fn wear_strip_before_deposit<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
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
    moved.edges.take_touches(strip, ahead);
    moved.edges.take_plateaus(strip);
    wear_rows::<L::First, BUILD_UP, DISC_WEARS>(&StripRules::new(rules, conditions, index), strip, ahead, moved);
    if <L::First as Lanes>::ROWS != L::ROWS {
        wear_rows::<L::Second, BUILD_UP, DISC_WEARS>(&StripRules::new(rules, conditions, index), strip, ahead, moved);
    }
}

/// Wears what touches in some rows of a strip, from the last column to the first, so that what is lost ahead of an edge is at hand
/// there.
#[inline(always)]
fn wear_rows<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
    rules: &StripRules<L>,
    strip: &mut Strip,
    ahead: &Reach,
    moved: &mut Moved,
) {
    let (columns, reach) = (strip.disc_height.len(), rules.rules.reach);
    let part = L::splat(rules.rules.transport_part);
    let Edges { touches, lost, share, listed, .. } = &mut moved.edges;
    share.resize(columns + 1, ahead.share);
    (gathered::<L>(u8::MAX, &ahead.touches, &ahead.lost) * part).store(&mut share[columns]);
    if reach > NEAR {
        lost.resize(columns, ahead.height);
        lost.extend_from_slice(&ahead.lost);
    }
    let count = list::<L>(listed, touches, columns);
    let mut losses = Losses::<L> {
        moved: StripMoved::new(),
        run: Run::of(ahead),
        touches: &touches[..columns + reach],
        touches_ahead: &touches[1..][..columns],
        lost,
        part,
        share: &mut share[..columns],
    };
    let mut listed = listed[1..=count].iter().rev();
    // What is out of the ordinary is left to the outer loop: so the inner one keeps its sums in registers.
    'strip: loop {
        let column = loop {
            let Some(column) = listed.next() else {
                break 'strip;
            };
            let column = *column as usize;
            if column >= columns {
                break 'strip;
            }
            let Some(worn) = wear_ordinary_column::<L, BUILD_UP, DISC_WEARS>(rules, strip, column) else {
                break column;
            };
            store_heights::<L, BUILD_UP, DISC_WEARS>(strip, column, worn.z_p, &worn);
            losses.add::<BUILD_UP, DISC_WEARS>(rules, column, &worn);
        };
        let worn = wear_any_and_note::<L, BUILD_UP, DISC_WEARS>(rules, strip, column, &mut moved.seldom);
        store_worn::<L, BUILD_UP, DISC_WEARS>(strip, column, &worn);
        losses.add::<BUILD_UP, DISC_WEARS>(rules, column, &worn);
    }
    losses.moved.store::<BUILD_UP, DISC_WEARS>(rules, strip.index, count, moved);
}

/// Positions of the set bits of each byte, in ascending order.
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

/// Lists the columns in which a bit of the lanes' rows is set, of so many, behind a number that follows upon 0 when it wraps, and
/// returns how many there are; the bytes fill up what is looked at at a time.
#[inline(always)]
pub(super) fn list<L: Lanes>(listed: &mut Vec<u32>, bytes: &[u8], columns: usize) -> usize {
    let bytes = &bytes.as_chunks().0[..columns.div_ceil(BYTES)];
    listed.resize((bytes.len() + 1) * BYTES, 0);
    let (behind, listed) = listed.split_at_mut(1);
    behind[0] = u32::MAX;
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

impl Edges {
    /// Finds which cells an edge feeds without a transport length: the open ones right behind it.
    #[inline(always)]
    pub fn take_fed(&mut self, strip: &Strip, ahead: &Reach) {
        let touches = &*strip.pin.touches;
        let last = touches.len() - 1;
        self.fed.resize(touches.len().next_multiple_of(BYTES), 0);
        let (fed, beyond) = self.fed.split_at_mut(touches.len());
        // A compiler makes a wide loop of this.
        for ((fed, own), next) in fed[..last].iter_mut().zip(touches).zip(&touches[1..]) {
            *fed = !own & next;
        }
        fed[last] = !touches[last] & ahead.touches[0];
        beyond.fill(0);
        keep_present(fed, strip);
    }

    /// Finds which cells an edge feeds: the open ones behind it.
    #[inline(always)]
    pub fn take_touches(&mut self, strip: &Strip, ahead: &Reach) {
        let columns = strip.disc_height.len();
        self.touches.clear();
        self.touches.extend_from_slice(strip.pin.touches);
        self.touches.extend_from_slice(&ahead.touches);
        let bytes = columns.next_multiple_of(BYTES);
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
        keep_present(fed, strip);
    }

    /// Keeps which cells are plateaus before any wears.
    #[inline(always)]
    fn take_plateaus(&mut self, strip: &Strip) {
        self.plateau.clear();
        self.plateau.extend_from_slice(strip.pin.plateau);
        // What lies ahead has told its plateaus by its height.
        self.plateau.push(u8::MAX);
    }

    /// Finds what the first columns mean to those behind them with a transport length, from the state at the start of the step.
    #[inline(always)]
    fn find_reach<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
        &mut self,
        rules: &StripRules<L>,
        strip: &Strip,
        reach: &mut Reach,
    ) {
        let (columns, own) = (rules.rules.reach, strip.disc_height.len());
        let worn = wear::<L, BUILD_UP, DISC_WEARS>(rules, strip.cells::<L, BUILD_UP, DISC_WEARS>(0));
        worn.height_of_plateaus().store(&mut reach.height);
        self.take_touches(strip, &rules.rules.nothing_ahead);
        reach.touches.copy_from_slice(&self.touches[..columns]);
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

/// Leaves out cells that are not there, which no debris fills.
#[inline(always)]
fn keep_present(fed: &mut [u8], strip: &Strip) {
    for (fed, present) in fed.iter_mut().zip(strip.pin.present) {
        *fed &= present;
    }
}

/// Sum of v of the first of L columns and the others as far as cells touch, m, of some cells; of the columns is given what touches
/// and what it loses.
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

/// Losses of a strip while it wears from its last column to its first, and the part of them that may come upon the cells behind.
struct Losses<'a, L: Lanes> {
    moved: StripMoved<L>,
    run: Run<L>,
    touches: &'a [u8],
    /// Cells that touch from the second column on, one bit each.
    touches_ahead: &'a [u8],
    /// Loss v of each column, m, where L is more than [`NEAR`].
    lost: &'a mut [Chunk],
    /// Factor η/L, 1.
    part: L,
    share: &'a mut [Chunk],
}

impl<L: Lanes> Losses<'_, L> {
    /// Adds what a column loses, and finds v̄ of an edge behind it.
    #[inline(always)]
    fn add<const BUILD_UP: u8, const DISC_WEARS: bool>(
        &mut self,
        rules: &StripRules<L>,
        column: usize,
        worn: &Worn<L>,
    ) {
        self.moved.add::<BUILD_UP, DISC_WEARS>(rules, worn);
        let (lost, reach) = (worn.lost::<DISC_WEARS>(true), rules.rules.reach);
        self.run.step_back(L::Mask::of_byte(self.touches_ahead[column]), lost);
        let mut sum = self.run.sum(NEAR);
        if reach < NEAR {
            sum = self.run.sum(reach);
        } else if reach > NEAR {
            lost.store(&mut self.lost[column]);
            sum = gathered::<L>(u8::MAX, &self.touches[column..][..reach], &self.lost[column..][..reach]);
        }
        (sum * self.part).store(&mut self.share[column]);
    }
}

/// Losses of the columns from one on, m, each as far as it and all before it touch; else 0.
struct Run<L: Lanes>([L; NEAR]);

impl<L: Lanes> Run<L> {
    /// Returns the losses ahead of a span.
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

    /// Steps back from a column of which some cells touch to one that loses so much, m: 0 where it does not touch.
    #[inline(always)]
    fn step_back(&mut self, touches: L::Mask, lost: L) {
        let mut next = NEAR - 1;
        while next > 0 {
            self.0[next] = self.0[next - 1].only(touches);
            next -= 1;
        }
        self.0[0] = lost;
    }

    /// Sum of the losses of so many of the columns, m, the nearest first.
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

/// Computes what the cells of a column will lose and may be compacted, m, and z_p of those that touch after that, m, out of reach where there
/// is no plateau; changes nothing.
#[inline(always)]
pub(super) fn worn_ahead<L: Lanes, const BUILD_UP: u8, const DISC_WEARS: bool>(
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

/// Finds what the first column of a span means to the one behind it, from the state at the start of the step.
pub type EdgeOf = fn(InstructionSet, &Rules, &Conditions, &mut PinStrips, &mut DiscSector, Span, &mut Moved, &mut Edge);

/// Returns the instance that does what a scene needs and nothing else; chosen once per run.
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
        // Nothing else of it has a meaning then, nor is it told.
        if rules.transport.is_none() && strip.pin.touches[0] == 0 {
            reach.touches[0] = 0;
            continue;
        }
        let strip_rules = StripRules::<L>::new(rules, conditions, index);
        if rules.transport.is_some() {
            moved.edges.find_reach::<L, BUILD_UP, DISC_WEARS>(&strip_rules, &strip, reach);
        } else {
            let [lost, height] = worn_ahead::<L, BUILD_UP, DISC_WEARS>(&strip_rules, &strip, 0);
            lost.store(&mut reach.lost[0]);
            height.store(&mut reach.height);
            reach.touches[0] = strip.pin.touches[0];
        }
    }
}
