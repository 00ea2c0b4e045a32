//! What the last column of a span must know of the one ahead of it, where debris is local (model 4L).

use super::instructions::{InstructionSet, kernel};
use super::lanes::{Chunk, LANES, Lanes, Mask};
use super::read::Span;
use super::rules::{Conditions, Rules, StripRules};
use super::worn::{Cells, Worn, wear};
use crate::parts::Needs;
use crate::strips::{DiscSector, PinStrips};

/// A column of the pin after wear and before its own deposit, strip by strip.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Edge {
    strips: Vec<EdgeStrip>,
}

/// Eight cells of an [`Edge`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeStrip {
    /// z_p after wear, m.
    height: Chunk,
    /// What of the losses of its pairs may be compacted behind them, m.
    caught: Chunk,
    /// Which were plateaus at the start of the step, one bit each.
    plateau: u8,
    /// Which are resin that lost its wear height.
    resin: u8,
}

/// The same in registers.
#[derive(Clone, Copy)]
pub(super) struct Ahead<L: Lanes> {
    pub height: L,
    pub caught: L,
    pub plateau: L::Mask,
    pub resin: L::Mask,
}

impl<L: Lanes> Ahead<L> {
    /// Eight cells after wear; `plateau` are those that were plateaus at the start of the step.
    #[inline(always)]
    pub fn new<const DISTINCT: bool, const DISC_WEARS: bool>(
        rules: &StripRules<L>,
        cells: &Cells<L>,
        worn: &Worn<L>,
        plateau: u8,
    ) -> Self {
        // What they really lost.
        let mut lost = worn.raw_pin;
        if DISTINCT {
            lost = lost - worn.spared_pin;
        } else {
            lost = L::select(worn.worn_through, worn.b_p - cells.z_p, lost);
        }
        if DISC_WEARS {
            lost = lost + worn.raw_disc;
            if DISTINCT {
                lost = lost - worn.spared_disc;
            }
        }
        let of_resin = rules.wear_height().only(worn.resin);
        Self {
            height: L::select(worn.worn_through, worn.b_p, worn.z_p),
            caught: rules.caught(lost, of_resin),
            plateau: L::Mask::of_byte(plateau),
            resin: worn.resin,
        }
    }

    /// Nothing that wears.
    #[inline(always)]
    fn none(rules: &StripRules<L>) -> Self {
        let nothing = L::Mask::of_byte(0);
        Self { height: rules.zero, caught: rules.zero, plateau: nothing, resin: nothing }
    }

    /// From memory; nothing where no column is ahead.
    #[inline(always)]
    pub fn of_edge(edge: Option<&Edge>, rules: &StripRules<L>, strip: usize) -> Self {
        match edge.map(|edge| &edge.strips[strip]) {
            None => Self::none(rules),
            Some(EdgeStrip { height, caught, plateau, resin }) => Self {
                height: L::load(height),
                caught: L::load(caught),
                plateau: L::Mask::of_byte(*plateau),
                resin: L::Mask::of_byte(*resin),
            },
        }
    }
}

impl Edge {
    /// Words of a column of so many strips on its way to another worker.
    pub fn words(strips: usize) -> usize {
        (2 * LANES + 1) * strips
    }

    /// Writes it for another worker.
    pub fn write(&self, words: &mut Vec<u64>) {
        for EdgeStrip { height, caught, plateau, resin } in &self.strips {
            words.extend(height.0.iter().chain(&caught.0).map(|value| value.to_bits()));
            words.push(u64::from(*plateau) | u64::from(*resin) << 8);
        }
    }

    /// Takes over one that another worker wrote.
    pub fn read(&mut self, words: &[u64]) {
        let (words, _) = words.as_chunks::<{ 2 * LANES + 1 }>();
        self.strips.clear();
        self.strips.extend(words.iter().map(|words| {
            let heights = |first: usize| Chunk(std::array::from_fn(|lane| f64::from_bits(words[first + lane])));
            let [plateau, resin, ..] = words[2 * LANES].to_le_bytes();
            EdgeStrip { height: heights(0), caught: heights(LANES), plateau, resin }
        }));
    }
}

/// Wears a column of pairs, the first of a span, without changing it.
pub type WearColumn = fn(InstructionSet, &Rules, &Conditions, &PinStrips, &DiscSector, Span, &mut Edge);

/// The wear that does what a scene needs and nothing else; chosen once per run.
pub fn wear_column(needs: Needs) -> WearColumn {
    match (needs.distinct, needs.disc_wears) {
        (false, false) => wear_first::<false, false>,
        (false, true) => wear_first::<false, true>,
        (true, false) => wear_first::<true, false>,
        (true, true) => wear_first::<true, true>,
    }
}

kernel! {
    /// Wears a column.
    pub fn wear_first<const DISTINCT, const DISC_WEARS>(
        rules: &Rules,
        conditions: &Conditions,
        pin: &PinStrips,
        disc: &DiscSector,
        span: Span,
        edge: &mut Edge,
    ) = wear_strips
}

#[inline(always)]
fn wear_strips<L: Lanes, const DISTINCT: bool, const DISC_WEARS: bool>(
    rules: &Rules,
    conditions: &Conditions,
    pin: &PinStrips,
    disc: &DiscSector,
    span: Span,
    edge: &mut Edge,
) {
    edge.strips.clear();
    for strip in 0..pin.height.strips() {
        let rules = StripRules::<L>::new(rules, conditions, strip);
        let fields = [&pin.height, pin.substrate(), &disc.height, disc.substrate()].map(|field| field.strip(strip));
        let (resin, plateau) = (pin.resin(strip)[span.first], pin.plateau(strip)[span.first]);
        let cells = Cells::load::<DISTINCT, DISC_WEARS, true>(fields, resin, [span.first, span.over]);
        let worn = wear::<L, DISTINCT, DISC_WEARS, true>(&rules, cells);
        let ahead = Ahead::new::<DISTINCT, DISC_WEARS>(&rules, &cells, &worn, plateau);
        let mut stored =
            EdgeStrip { height: Chunk([0.0; LANES]), caught: Chunk([0.0; LANES]), plateau, resin: ahead.resin.byte() };
        ahead.height.store(&mut stored.height);
        ahead.caught.store(&mut stored.caught);
        edge.strips.push(stored);
    }
}
