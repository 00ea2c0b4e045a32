//! What lies ahead of a span, for the cells behind it (model 4.2 and 4L), and how that crosses to another worker.

use super::instructions::{InstructionSet, kernel, with_build_up};
use super::moved::Moved;
use super::read::Span;
use super::rules::{Conditions, Rules, StripRules};
use super::strip::Strip;
use crate::engine::lanes::{Chunk, LANES, Lanes};
use crate::engine::parts::{Needs, build_up};
use crate::engine::strips::{DiscSector, PinStrips};

/// What the columns ahead of a span mean to it, strip by strip.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Edge {
    pub(super) strips: Vec<Reach>,
}

/// What eight cells must know of the cells ahead of them in their rows, at the start of a step.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reach {
    /// z_p of the next column after wear and before any deposit, m; out of reach where it was no plateau.
    pub height: Chunk,
    /// v̄ of the edge that the next column is fed from, m.
    pub share: Chunk,
    /// Which cells touch in each of the next L columns, one bit each.
    pub touches: Vec<u8>,
    /// v of each of these columns, m.
    pub lost: Vec<Chunk>,
}

impl Edge {
    /// Words of so many strips on their way to another worker, with debris that is spread over so many columns.
    pub fn words(strips: usize, columns: usize) -> usize {
        strips * Reach::words(columns)
    }

    /// Writes it for another worker.
    pub fn write(&self, words: &mut Vec<u64>) {
        self.strips.iter().for_each(|reach| reach.write(words));
    }

    /// Takes over one that another worker wrote.
    pub fn read(&mut self, columns: usize, words: &[u64]) {
        let strips = words.chunks_exact(Reach::words(columns));
        self.strips = strips.map(|words| Reach::read(columns, words)).collect();
    }
}

impl Reach {
    /// Nothing ahead, with debris that is spread over so many columns.
    pub fn none(columns: usize) -> Self {
        let zero = Chunk([0.0; LANES]);
        Self {
            height: Chunk([f64::INFINITY; LANES]),
            share: zero,
            touches: vec![0; columns],
            lost: vec![zero; columns],
        }
    }

    /// Words of one on its way to another worker.
    fn words(columns: usize) -> usize {
        2 * LANES + columns * (LANES + 1)
    }

    /// Writes it for another worker.
    fn write(&self, words: &mut Vec<u64>) {
        let Self { height, share, touches, lost } = self;
        for chunk in [height, share].into_iter().chain(lost) {
            words.extend(chunk.0.map(f64::to_bits));
        }
        words.extend(touches.iter().map(|touches| u64::from(*touches)));
    }

    /// Takes over one that another worker wrote.
    fn read(columns: usize, words: &[u64]) -> Self {
        let (chunks, bytes) = words.split_at((2 + columns) * LANES);
        let chunk = |words: &[u64]| Chunk(std::array::from_fn(|lane| f64::from_bits(words[lane])));
        let mut chunks = chunks.chunks_exact(LANES).map(chunk);
        let mut next = || chunks.next().unwrap_or(Chunk([0.0; LANES]));
        let [height, share] = [next(), next()];
        Self {
            height,
            share,
            touches: bytes.iter().map(|word| *word as u8).collect(),
            lost: (0..columns).map(|_| next()).collect(),
        }
    }
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
    edge.strips.clear();
    for index in 0..pin.height.strips() {
        let strip = Strip::new::<L, BUILD_UP>(index, pin, disc, span, false);
        let strip_rules = StripRules::<L>::new(rules, conditions, index);
        let edges = &mut moved.edges;
        edges.take_touches(&strip, &rules.nothing_ahead);
        if rules.transport.is_some() {
            edges.wear::<L, BUILD_UP, DISC_WEARS>(&strip_rules, &strip, &rules.nothing_ahead);
        }
        edge.strips.push(edges.reach::<L, BUILD_UP, DISC_WEARS>(&strip_rules, &strip));
    }
}
