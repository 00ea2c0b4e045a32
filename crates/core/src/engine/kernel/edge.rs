//! What lies ahead of a span, for the cells behind it (model 4.2 and 4L), and how that crosses to another worker; and what is found on the way.

use crate::engine::lanes::{Chunk, LANES};

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
    /// v̄ of the edge that the next column is fed from, m; of no meaning where debris is spread over one column.
    pub share: Chunk,
    /// Which cells touch in each of the next L columns, one bit each.
    pub touches: Vec<u8>,
    /// v of each of these columns, m.
    pub lost: Vec<Chunk>,
}

/// What is found of the edges of a strip; the next strip overwrites it.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Edges {
    /// Which cells touch in each column of the strip and in L columns ahead of it, one bit each.
    pub touches: Vec<u8>,
    /// Which cells of these columns are the open ones of an edge.
    pub open: Vec<u8>,
    /// Which an edge feeds: those with a cell that touches within L columns ahead.
    pub fed: Vec<u8>,
    /// v of each of these columns, m; of no meaning where nothing touches.
    pub lost: Vec<Chunk>,
    /// v̄ of the edge behind each of the columns of the strip and behind the next, m; of no meaning where nothing touches.
    pub share: Vec<Chunk>,
    /// Which cells of the columns of the strip were plateaus at the start of the step, one bit each, and all of the next.
    pub plateau: Vec<u8>,
    /// Columns of the strip with something to do.
    pub listed: Vec<u32>,
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
        self.reaches(strips.len(), columns).iter_mut().zip(strips).for_each(|(reach, words)| reach.read(words));
    }

    /// What so many strips must know, with debris that is spread over so many columns, to be written anew.
    pub(super) fn reaches(&mut self, strips: usize, columns: usize) -> &mut [Reach] {
        self.strips.resize_with(strips, || Reach::none(columns));
        &mut self.strips
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
        (1 + usize::from(columns > 1)) * LANES + columns * (LANES + 1)
    }

    /// Writes it for another worker.
    fn write(&self, words: &mut Vec<u64>) {
        let Self { height, share, touches, lost } = self;
        let share = (lost.len() > 1).then_some(share);
        for chunk in lost.iter().chain([height]).chain(share) {
            words.extend(chunk.0.map(f64::to_bits));
        }
        words.extend(touches.iter().map(|touches| u64::from(*touches)));
    }

    /// Takes over one that another worker wrote.
    fn read(&mut self, words: &[u64]) {
        let Self { height, share, touches, lost } = self;
        let (chunks, bytes) = words.split_at(words.len() - touches.len());
        for (chunk, words) in lost.iter_mut().chain([height, share]).zip(chunks.chunks_exact(LANES)) {
            *chunk = Chunk(std::array::from_fn(|lane| f64::from_bits(words[lane])));
        }
        touches.iter_mut().zip(bytes).for_each(|(touches, word)| *touches = *word as u8);
    }
}
