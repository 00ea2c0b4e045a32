//! The column ahead of a span: what its cells lose, for the cells behind them (model 4.2 and 4L), and how that crosses to another
//! worker.

use crate::engine::lanes::{Chunk, LANES};

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
    /// In place of these where debris has a transport length.
    pub(super) reaches: Vec<Reach>,
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

    /// Words of a column of so many strips on its way to another worker, with a transport length of so many columns or none.
    pub fn words(strips: usize, transport: Option<usize>) -> usize {
        strips * transport.map_or(WORDS, Reach::words)
    }

    /// Writes it for another worker.
    pub fn write(&self, words: &mut Vec<u64>) {
        for EdgeStrip { touches, cells } in &self.strips {
            words.extend(cells.iter().map(|cell| cell.height.to_bits()));
            words.extend(cells.iter().map(|cell| cell.captured.to_bits()));
            let plateaus = (0..LANES).fold(0, |bits, lane| bits | u64::from(cells[lane].plateau) << lane);
            words.push(u64::from(*touches) | plateaus << LANES);
        }
        self.reaches.iter().for_each(|reach| reach.write(words));
    }

    /// Takes over one that another worker wrote.
    pub fn read(&mut self, transport: Option<usize>, words: &[u64]) {
        if let Some(columns) = transport {
            let strips = words.chunks_exact(Reach::words(columns));
            self.reaches = strips.map(|words| Reach::read(columns, words)).collect();
            return;
        }
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

/// What eight cells must know of the cells ahead of them in their rows, at the start of a step.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reach {
    /// z_p of the next column after wear and before any deposit, m; out of reach where it was no plateau.
    pub height: Chunk,
    /// v̄ of the edge that the next column is fed from, m.
    pub share: Chunk,
    /// How many more cells it feeds.
    pub remaining: Chunk,
    /// Which cells touch in each of the next L columns, one bit each.
    pub touches: Vec<u8>,
    /// v of each of these columns, m.
    pub lost: Vec<Chunk>,
}

impl Reach {
    /// Nothing ahead, with a transport length of so many columns.
    pub fn none(columns: usize) -> Self {
        let zero = Chunk([0.0; LANES]);
        Self {
            height: Chunk([f64::INFINITY; LANES]),
            share: zero,
            remaining: zero,
            touches: vec![0; columns],
            lost: vec![zero; columns],
        }
    }

    /// Words of one on its way to another worker.
    pub fn words(columns: usize) -> usize {
        3 * LANES + columns * (LANES + 1)
    }

    /// Writes it for another worker.
    pub fn write(&self, words: &mut Vec<u64>) {
        let Self { height, share, remaining, touches, lost } = self;
        for chunk in [height, share, remaining].into_iter().chain(lost) {
            words.extend(chunk.0.map(f64::to_bits));
        }
        words.extend(touches.iter().map(|touches| u64::from(*touches)));
    }

    /// Takes over one that another worker wrote.
    pub fn read(columns: usize, words: &[u64]) -> Self {
        let (chunks, bytes) = words.split_at((3 + columns) * LANES);
        let chunk = |words: &[u64]| Chunk(std::array::from_fn(|lane| f64::from_bits(words[lane])));
        let mut chunks = chunks.chunks_exact(LANES).map(chunk);
        let mut next = || chunks.next().unwrap_or(Chunk([0.0; LANES]));
        let [height, share, remaining] = [next(), next(), next()];
        Self {
            height,
            share,
            remaining,
            touches: bytes.iter().map(|word| *word as u8).collect(),
            lost: (0..columns).map(|_| next()).collect(),
        }
    }
}
