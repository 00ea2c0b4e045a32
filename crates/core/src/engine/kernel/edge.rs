//! Heights and losses ahead of a span, for the cells behind it (model 4.2 and 4L), as they cross to another worker; edges of a strip.

use crate::engine::lanes::{Chunk, LANES};

/// Heights and losses of the columns ahead of a span, strip by strip.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Edge {
    pub(super) strips: Vec<Reach>,
}

/// Heights and losses of the cells ahead of eight cells in their rows, from the state at the start of a step.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reach {
    /// Height z_p of the next column after wear and before any deposit, m; out of reach where it was no plateau.
    pub height: Chunk,
    /// Share v̄ of the edge that the next column is fed from, m; of no meaning where debris is spread over one column.
    pub share: Chunk,
    /// Cells that touch in each of the next L columns, one bit each.
    pub touches: Vec<u8>,
    /// Loss v of each of these columns, m; without a transport length what the next column loses and may be compacted behind, m.
    pub lost: Vec<Chunk>,
}

/// Edges found on a strip; the next strip overwrites them.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Edges {
    /// Cells that touch in each column of the strip and in L columns ahead of it, one bit each.
    pub touches: Vec<u8>,
    /// Open cells of an edge in each column of the strip, one bit each.
    pub open: Vec<u8>,
    /// Cells that an edge feeds in each column of the strip, one bit each: open ones with a cell that touches within L columns ahead.
    pub fed: Vec<u8>,
    /// Loss v of each column of the strip and of L columns ahead of it, m; of no meaning where nothing touches.
    pub lost: Vec<Chunk>,
    /// Share v̄ of the edge behind each of the columns of the strip and behind the next, m; of no meaning where nothing touches.
    pub share: Vec<Chunk>,
    /// Cells of the columns of the strip that were plateaus at the start of the step, one bit each, and all of the next.
    pub plateau: Vec<u8>,
    /// Columns of the strip with something to do.
    pub listed: Vec<u32>,
}

impl Edge {
    /// Most words of so many strips on their way to another worker, with debris that is spread over so many columns.
    pub fn words(strips: usize, columns: usize) -> usize {
        strips * Reach::words(columns)
    }

    /// Writes the edge for another worker.
    pub fn write(&self, words: &mut Vec<u64>) {
        self.strips.iter().for_each(|reach| reach.write(words));
    }

    /// Takes over an edge of so many strips that another worker wrote.
    pub fn read(&mut self, strips: usize, columns: usize, words: &[u64]) {
        self.reaches(strips, columns).iter_mut().fold(words, |words, reach| reach.read(words));
    }

    /// Returns the reach of each of so many strips, with debris that is spread over so many columns, to be written anew.
    pub(super) fn reaches(&mut self, strips: usize, columns: usize) -> &mut [Reach] {
        self.strips.resize_with(strips, || Reach::none(columns));
        &mut self.strips
    }
}

impl Reach {
    /// Reach with nothing ahead, for debris that is spread over so many columns.
    pub fn none(columns: usize) -> Self {
        let zero = Chunk([0.0; LANES]);
        Self {
            height: Chunk([f64::INFINITY; LANES]),
            share: zero,
            touches: vec![0; columns],
            lost: vec![zero; columns],
        }
    }

    /// Most words of a reach on its way to another worker.
    fn words(columns: usize) -> usize {
        (1 + usize::from(columns > 1)) * LANES + columns * (LANES + 1)
    }

    /// Writes the reach for another worker; where nothing touches in the only column, the rest has no meaning.
    fn write(&self, words: &mut Vec<u64>) {
        let Self { height, share, touches, lost } = self;
        words.extend(touches.iter().map(|touches| u64::from(*touches)));
        if **touches == [0] {
            return;
        }
        let share = (lost.len() > 1).then_some(share);
        for chunk in lost.iter().chain([height]).chain(share) {
            words.extend_from_slice(&chunk.0.map(f64::to_bits));
        }
    }

    /// Takes over a reach that another worker wrote, and returns the words behind it.
    fn read<'a>(&mut self, words: &'a [u64]) -> &'a [u64] {
        let Self { height, share, touches, lost } = self;
        let (bytes, mut words) = words.split_at(touches.len());
        touches.iter_mut().zip(bytes).for_each(|(touches, word)| *touches = *word as u8);
        if **touches == [0] {
            return words;
        }
        let share = (lost.len() > 1).then_some(share);
        for chunk in lost.iter_mut().chain([height]).chain(share) {
            (*chunk, words) = Chunk::of_words(words);
        }
        words
    }
}
