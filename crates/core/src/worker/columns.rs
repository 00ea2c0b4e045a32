//! Sweeping the worker's columns, and handing on those that cross a boundary between sectors.

use super::Worker;
use crate::comm::Communicator;
use crate::kernel::{Bracket, Conditions, LANES, Span};
use crate::sector::{Partition, Segment};
use crate::simulation::SimulationError;
use crate::strips::PinStrips;

/// Columns that are swept before the first of a segment is handed on: that one, and the one whose status goes with it.
const FIRST_COLUMNS: usize = 2;

impl<C: Communicator> Worker<C> {
    /// Wear, destruction and formation in every own column (model 4.2 to 4.4), and the pairs of the next step against
    /// where its displacement is expected: the bracket that is returned.
    ///
    /// The pin column over the first disc column of a sector lies over the sector before in the next step. It is swept
    /// first and handed on at once; the worker that gets it needs it last.
    pub(super) fn sweep_columns(&mut self) -> Result<Bracket, SimulationError> {
        self.reading.clear();
        self.moved.clear();
        let (expected, uncertainty) = self.forecast.expect(self.contact.mean_overlap());
        let bracket = Bracket::new(expected - uncertainty, 2.0 * uncertainty, self.overlaps);
        let partition = self.partition.clone();
        let first = self.first();
        let own = self.group;
        self.fetch_entering(&partition, first);
        let is_alone = partition.groups() == 1;
        if !is_alone {
            for segment in partition.segments_of(own, first) {
                let columns = FIRST_COLUMNS.min(segment.pin.len());
                self.sweep_span(&segment, 0..columns, bracket);
                self.hand_on(&segment)?;
            }
        }
        for segment in partition.segments_of(own, first) {
            let swept = if is_alone { 0 } else { FIRST_COLUMNS.min(segment.pin.len()) };
            self.sweep_span(&segment, swept..segment.pin.len(), bracket);
        }
        for entering in partition.entering(first) {
            if self.sectors[entering.sector].is_none() {
                continue;
            }
            if self.sectors[entering.from].is_none() {
                self.take_over(entering.from, entering.pin)?;
            }
            let Some(sector) = &self.sectors[entering.sector] else { continue };
            let span = Span { first: entering.pin, over: entering.over, columns: 1 };
            (self.read)(self.instructions, &self.pin, sector, span, &bracket, &mut self.reading);
        }
        Ok(bracket)
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

    /// Sweeps some columns of a segment.
    fn sweep_span(&mut self, segment: &Segment, columns: std::ops::Range<usize>, bracket: Bracket) {
        let Some(sector) = &mut self.sectors[segment.sector] else { return };
        let conditions = Conditions {
            displacement: self.contact.displacement(),
            share: self.debris.share(),
            deposits: self.debris.deposits(),
            losses: self.debris.losses(self.quantum),
            bracket,
            first_strip: self.rows.start / LANES,
        };
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
    fn hand_on(&mut self, segment: &Segment) -> Result<(), SimulationError> {
        let to = self.partition.owner(self.partition.before(segment.sector), self.band);
        if segment.over == 0 && to != self.communicator.rank() {
            self.pin.write_crossing(segment.pin.start, &mut self.halo);
            self.communicator.send_halo(self.boundary(segment.sector), to, &self.halo)?;
        }
        Ok(())
    }

    /// Takes over a pin column that another worker has swept.
    fn take_over(&mut self, from: usize, column: usize) -> Result<(), SimulationError> {
        self.halo.resize(PinStrips::crossing_words(self.rows.len()), 0);
        let (boundary, owner) = (self.boundary(from), self.partition.owner(from, self.band));
        self.communicator.receive_halo(boundary, owner, &mut self.halo)?;
        self.pin.read_crossing(column, &self.halo);
        Ok(())
    }

    /// The lower boundary of the worker's band of a sector.
    fn boundary(&self, sector: usize) -> usize {
        sector * self.partition.bands() + self.band
    }
}
