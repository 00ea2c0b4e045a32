//! Sweeping the worker's columns, and handing on those that cross a boundary between sectors.

use std::ops::Range;

use super::Worker;
use crate::engine::comm::Communicator;
use crate::engine::contact::Contact;
use crate::engine::debris::Debris;
use crate::engine::error::SimulationError;
use crate::engine::kernel::{Bracket, Conditions, Edge, Span};
use crate::engine::lanes::LANES;
use crate::engine::pin_strips::PinStrips;
use crate::engine::sector::{Partition, Segment};
use crate::engine::strips::strips;

/// Columns that are swept before the first of a segment is handed on: that one, and the one whose status goes with it.
const FIRST_COLUMNS: usize = 2;

/// Words of a pin column of so many rows on its way to another worker, with what local debris must know of its wear.
pub(crate) fn halo_words(rows: usize, is_local: bool) -> usize {
    PinStrips::crossing_words(rows) + if is_local { Edge::words(strips(rows)) } else { 0 }
}

impl<C: Communicator> Worker<C> {
    /// Wear, destruction and formation in every own column (model 4.2, 4L and 4P), and the pairs of the next step against
    /// where its displacement is expected: the bracket that is returned.
    ///
    /// The pin column over the first disc column of a sector lies over the sector before in the next step. It is swept
    /// first and handed on at once; the worker that gets it needs it last.
    pub(super) fn sweep_columns(&mut self) -> Result<Bracket, SimulationError> {
        self.reading.clear();
        self.moved.clear();
        let (expected, uncertainty) = self.forecast.expect(self.contact.mean_overlap());
        let bracket = Bracket::new(expected - uncertainty, 2.0 * uncertainty, self.overlap_quantum);
        let partition = self.partition.clone();
        let first = self.first();
        self.fetch_entering(&partition, first);
        let segments = || partition.segments_of(self.group, first);
        let is_local = !self.edges.is_empty();
        match (partition.groups() == 1, is_local) {
            (true, false) => {
                partition.segments(first).for_each(|each| self.sweep_span(&each, 0..each.pin.len(), bracket, None));
            }
            (true, true) => self.sweep_all_locally(&segments().collect::<Vec<_>>(), bracket),
            (false, false) => self.sweep_apart(&segments().collect::<Vec<_>>(), bracket)?,
            (false, true) => self.sweep_apart_locally(&segments().collect::<Vec<_>>(), bracket)?,
        }
        for entering in partition.entering(first) {
            if self.sectors[entering.sector].is_none() {
                continue;
            }
            if !is_local && self.sectors[entering.from].is_none() {
                self.take_over(entering.from, entering.pin)?;
            }
            let Some(sector) = &self.sectors[entering.sector] else { continue };
            let span = Span { first: entering.pin, over: entering.over, columns: 1 };
            (self.read)(self.instructions, &mut self.pin, sector, span, &bracket, &mut self.reading);
        }
        Ok(bracket)
    }

    /// Sweeps segments whose neighbours belong to others: first what those wait for.
    fn sweep_apart(&mut self, segments: &[Segment], bracket: Bracket) -> Result<(), SimulationError> {
        for segment in segments {
            self.sweep_span(segment, 0..FIRST_COLUMNS.min(segment.pin.len()), bracket, None);
            self.hand_on(segment)?;
        }
        for segment in segments {
            self.sweep_span(segment, FIRST_COLUMNS.min(segment.pin.len())..segment.pin.len(), bracket, None);
        }
        Ok(())
    }

    /// Has the disc columns that enter brought near the processor while the others are swept.
    fn fetch_entering(&self, partition: &Partition, first: usize) {
        for segment in partition.segments_of(self.group, first).filter(|segment| segment.joined) {
            if let Some(sector) = &self.sectors[segment.sector] {
                sector.height.fetch_column(segment.over - 1);
            }
        }
        for entering in partition.entering(first) {
            if let Some(sector) = &self.sectors[entering.sector] {
                sector.height.fetch_column(entering.over);
            }
        }
    }

    /// Sweeps some columns of a segment; with local debris, `ahead` is the column ahead of the last of them.
    pub(super) fn sweep_span(
        &mut self,
        segment: &Segment,
        columns: Range<usize>,
        bracket: Bracket,
        ahead: Option<&Edge>,
    ) {
        let conditions = conditions(&self.contact, &self.debris, bracket, self.rows.start, ahead);
        let Some(sector) = &mut self.sectors[segment.sector] else { return };
        let span = Span {
            first: segment.pin.start + columns.start,
            over: segment.over + columns.start,
            columns: columns.len(),
        };
        (self.sweep)(
            self.instructions,
            &self.rules,
            &conditions,
            &mut self.pin,
            sector,
            span,
            columns.start > 0 || segment.joined,
            &mut self.moved,
            &mut self.reading,
        );
    }

    /// Hands the first pin column of a segment to the worker over whose sector it lies in the next step.
    pub(super) fn hand_on(&mut self, segment: &Segment) -> Result<(), SimulationError> {
        let to = self.partition.owner(self.partition.before(segment.sector), self.band);
        if segment.over == 0 && to != self.communicator.rank() {
            self.halo.clear();
            self.pin.write_crossing(segment.pin.start, &mut self.halo);
            if let Some(edge) = self.edges.get(segment.sector) {
                edge.write(&mut self.halo);
            }
            self.communicator.send_halo(self.boundary(segment.sector), to, &self.halo)?;
        }
        Ok(())
    }

    /// Takes over a pin column that another worker has swept.
    pub(super) fn take_over(&mut self, from: usize, column: usize) -> Result<(), SimulationError> {
        let crossing = PinStrips::crossing_words(self.rows.len());
        self.halo.resize(halo_words(self.rows.len(), !self.edges.is_empty()), 0);
        let (boundary, owner) = (self.boundary(from), self.partition.owner(from, self.band));
        self.communicator.receive_halo(boundary, owner, &mut self.halo)?;
        self.pin.read_crossing(column, &self.halo[..crossing]);
        if let Some(edge) = self.edges.get_mut(from) {
            edge.read(&self.halo[crossing..]);
        }
        Ok(())
    }

    /// The lower boundary of the worker's band of a sector.
    fn boundary(&self, sector: usize) -> usize {
        sector * self.partition.bands() + self.band
    }
}

/// What a sweep must know of a step; with local debris, `ahead` is the column ahead of the last that is swept.
pub(super) fn conditions<'a>(
    contact: &Contact,
    debris: &'a Debris,
    bracket: Bracket,
    first_row: usize,
    ahead: Option<&'a Edge>,
) -> Conditions<'a> {
    Conditions {
        displacement: contact.displacement(),
        share: debris.share(),
        ahead,
        deposit_quantum: debris.deposit_quantum(),
        loss_quanta: debris.loss_quanta(),
        bracket,
        first_strip: first_row / LANES,
    }
}
