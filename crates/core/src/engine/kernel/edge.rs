//! The column ahead of a span, where debris is local: what its cells lost, for the cells behind them (model 4L).

use crate::engine::lanes::LANES;

/// A cell of the pin that touches, after wear and before its own deposit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Ahead {
    /// z_p of a plateau after wear, m; out of reach where it is none, which nothing is built up against.
    pub height: f64,
    /// What of the losses of the pair may be compacted behind it, m.
    pub captured: f64,
    /// Whether it was a plateau at the start of the step; else it is resin that lost its wear height.
    pub plateau: bool,
}

/// The column ahead of a span: the first of the next.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Edge {
    pub(super) strips: Vec<EdgeStrip>,
}

/// Eight cells of an [`Edge`]; those that do not touch lose nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct EdgeStrip {
    /// Which touch, one bit each.
    pub touches: u8,
    pub cells: [Ahead; LANES],
}

/// Words of a strip on its way to another worker.
const WORDS: usize = 2 * LANES + 1;

impl Edge {
    /// A strip; nothing that touches where no column is ahead.
    #[inline(always)]
    pub(super) fn strip(edge: Option<&Self>, strip: usize) -> EdgeStrip {
        edge.map_or_else(EdgeStrip::default, |edge| edge.strips[strip])
    }

    /// Words of a column of so many strips on its way to another worker.
    pub fn words(strips: usize) -> usize {
        WORDS * strips
    }

    /// Writes it for another worker.
    pub fn write(&self, words: &mut Vec<u64>) {
        for EdgeStrip { touches, cells } in &self.strips {
            words.extend(cells.iter().map(|cell| cell.height.to_bits()));
            words.extend(cells.iter().map(|cell| cell.captured.to_bits()));
            let plateaus = (0..LANES).fold(0, |bits, lane| bits | u64::from(cells[lane].plateau) << lane);
            words.push(u64::from(*touches) | plateaus << LANES);
        }
    }

    /// Takes over one that another worker wrote.
    pub fn read(&mut self, words: &[u64]) {
        let (words, _) = words.as_chunks::<WORDS>();
        self.strips.clear();
        self.strips.extend(words.iter().map(|words| {
            let [touches, plateaus, ..] = words[2 * LANES].to_le_bytes();
            let cell = |lane: usize| Ahead {
                height: f64::from_bits(words[lane]),
                captured: f64::from_bits(words[LANES + lane]),
                plateau: plateaus >> lane & 1 == 1,
            };
            EdgeStrip { touches, cells: std::array::from_fn(cell) }
        }));
    }
}
