//! Passing over the worker's columns, and handing on those that cross a boundary between sectors.

use std::ops::Range;

use super::Worker;
use crate::engine::comm::Communicator;
use crate::engine::contact::Contact;
use crate::engine::debris::Debris;
use crate::engine::kernel::{Bracket, Conditions, Edge, Span};
use crate::engine::lanes::LANES;
use crate::engine::parts::Needs;
use crate::engine::sector::{Partition, Segment};
use crate::engine::strips::{PinStrips, strips};
use crate::model::error::SimulationError;

/// Words of a pin column of so many rows on its way to another worker, with what it loses where plateaus form.
pub(crate) fn halo_words(rows: usize, needs: Needs) -> usize {
    PinStrips::crossing_words(rows)
        + if needs.forms { Edge::words(strips(rows), needs.transport.unwrap_or(1)) } else { 0 }
}

/// Columns at the end of a segment that depend on the next segment: a cell takes of an edge up to L columns ahead what up to L
/// columns ahead of that are worn.
pub(crate) fn waiting_columns(transport: Option<usize>) -> usize {
    2 * transport.unwrap_or(1) - 1
}

impl<C: Communicator> Worker<C> {
    /// Wear and formation in every own column (model 4.2 and 4L), and the pairs of the next step against where its
    /// displacement is expected: the bracket that is returned.
    pub(super) fn pass_over_columns(&mut self) -> Result<Bracket, SimulationError> {
        self.reading.clear();
        self.moved.clear();
        let (expected, uncertainty) = self.forecast.expect(self.contact.mean_overlap());
        let bracket = Bracket::new(expected - uncertainty, 2.0 * uncertainty, self.overlap_quantum);
        let partition = self.partition.clone();
        let first = self.first();
        self.fetch_entering(&partition, first);
        let segments: Vec<Segment> = partition.segments_of(self.group, first).collect();
        if partition.groups() == 1 {
            self.pass_over_all(&segments, bracket);
        } else {
            self.pass_over_apart(&partition, &segments, bracket)?;
        }
        for entering in partition.entering(first) {
            let Some(sector) = &self.sectors[entering.sector] else { continue };
            let span = Span { first: entering.pin, over: entering.over, columns: 1 };
            (self.read)(self.instructions, &mut self.pin, sector, span, &bracket, &mut self.reading);
        }
        Ok(bracket)
    }

    /// Passes over segments that follow each other, all of them the worker's own.
    fn pass_over_all(&mut self, segments: &[Segment], bracket: Bracket) {
        for (number, segment) in segments.iter().enumerate() {
            // The next segment has not changed yet.
            let ahead = segments.get(number + 1).and_then(|next| self.edge_of(next, 0, bracket));
            self.pass_over_span(segment, 0..segment.pin.len(), bracket, ahead.as_ref());
        }
    }

    /// Passes over segments whose neighbours belong to others.
    ///
    /// The pin column over the first disc column of a sector lies over the sector before in the next step. It is passed over
    /// first and handed on at once, with what it lost (model 4L); the last column of a segment waits for that of the next
    /// segment.
    fn pass_over_apart(
        &mut self,
        partition: &Partition,
        segments: &[Segment],
        bracket: Bracket,
    ) -> Result<(), SimulationError> {
        let pin_columns = self.parameters.mesh.pin_columns();
        let ends_pin = |segment: &Segment| segment.pin.end == pin_columns;
        // A segment that begins with its sector is longer than what depends on the next, unless it ends the pin.
        let crosses = |segment: &Segment| usize::from(segment.over == 0);
        let waiting = waiting_columns(self.needs.transport);
        let own = |segment: &Segment| match ends_pin(segment) {
            true => segment.pin.len(),
            false => segment.pin.len().saturating_sub(waiting),
        };
        for segment in segments.iter().filter(|segment| segment.over == 0) {
            if let Some(edge) = self.edge_of(segment, 0, bracket) {
                self.edges[segment.sector] = edge;
            }
            let ahead = self.edge_of(segment, 1, bracket);
            self.pass_over_span(segment, 0..1, bracket, ahead.as_ref());
            self.hand_on(segment)?;
        }
        for segment in segments {
            let columns = crosses(segment)..own(segment);
            if !columns.is_empty() {
                let ahead = self.edge_of(segment, columns.end, bracket);
                self.pass_over_span(segment, columns, bracket, ahead.as_ref());
            }
        }
        for entering in partition.entering(self.first()) {
            if self.sectors[entering.sector].is_some() && self.sectors[entering.from].is_none() {
                self.take_over(entering.from, entering.pin)?;
            }
        }
        for segment in segments.iter().filter(|segment| !ends_pin(segment)) {
            let next = (segment.sector + 1) % partition.sectors();
            let ahead = self.edges.get_mut(next).map(std::mem::take);
            let columns = own(segment).max(crosses(segment))..segment.pin.len();
            self.pass_over_span(segment, columns, bracket, ahead.as_ref());
            if let Some(ahead) = ahead {
                self.edges[next] = ahead;
            }
        }
        Ok(())
    }

    /// What a column of a segment loses in this step, from its state at the start of it; none where nothing forms, or the pin
    /// has no such column.
    fn edge_of(&mut self, segment: &Segment, column: usize, bracket: Bracket) -> Option<Edge> {
        let columns = segment.pin.len().checked_sub(column).filter(|columns| *columns > 0)?;
        let sector = self.sectors[segment.sector].as_mut().filter(|_| self.needs.forms)?;
        let mut edge = Edge::default();
        let columns = columns.min(2 * self.needs.transport.unwrap_or(1));
        let span = Span { first: segment.pin.start + column, over: segment.over + column, columns };
        let conditions = conditions(&self.contact, &self.debris, bracket, self.rows.start, None);
        let Self { instructions, rules, pin, moved, .. } = self;
        (self.edge_of)(*instructions, rules, &conditions, pin, sector, span, moved, &mut edge);
        Some(edge)
    }

    /// Has the disc columns that enter brought near the processor while the others are passed over.
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

    /// Passes over some columns of a segment; `ahead` is the column ahead of the last of them.
    fn pass_over_span(&mut self, segment: &Segment, columns: Range<usize>, bracket: Bracket, ahead: Option<&Edge>) {
        let conditions = conditions(&self.contact, &self.debris, bracket, self.rows.start, ahead);
        let Some(sector) = &mut self.sectors[segment.sector] else { return };
        let span = Span {
            first: segment.pin.start + columns.start,
            over: segment.over + columns.start,
            columns: columns.len(),
        };
        (self.pass)(
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
            self.halo.clear();
            self.pin.write_crossing(segment.pin.start, &mut self.halo);
            if let Some(edge) = self.edges.get(segment.sector) {
                edge.write(&mut self.halo);
            }
            self.communicator.send_halo(self.boundary(segment.sector), to, &self.halo)?;
        }
        Ok(())
    }

    /// Takes over a pin column that another worker has passed over.
    fn take_over(&mut self, from: usize, column: usize) -> Result<(), SimulationError> {
        let crossing = PinStrips::crossing_words(self.rows.len());
        self.halo.resize(halo_words(self.rows.len(), self.needs), 0);
        let (boundary, owner) = (self.boundary(from), self.partition.owner(from, self.band));
        self.communicator.receive_halo(boundary, owner, &mut self.halo)?;
        self.pin.read_crossing(column, &self.halo[..crossing]);
        if let Some(edge) = self.edges.get_mut(from) {
            edge.read(self.needs.transport.unwrap_or(1), &self.halo[crossing..]);
        }
        Ok(())
    }

    /// The lower boundary of the worker's band of a sector.
    fn boundary(&self, sector: usize) -> usize {
        sector * self.partition.bands() + self.band
    }
}

/// What a pass must know of a step; `ahead` is the column ahead of the last.
fn conditions<'a>(
    contact: &Contact,
    debris: &Debris,
    bracket: Bracket,
    first_row: usize,
    ahead: Option<&'a Edge>,
) -> Conditions<'a> {
    Conditions {
        displacement: contact.displacement(),
        ahead,
        deposit_quantum: debris.deposit_quantum(),
        loss_quanta: debris.loss_quanta(),
        bracket,
        first_strip: first_row / LANES,
    }
}
