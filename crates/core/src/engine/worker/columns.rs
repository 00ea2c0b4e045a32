//! Pass over the worker's columns (model 4.2 and 4L), and exchange of those that cross a boundary between sectors.

use super::Worker;
use crate::engine::contact::Contact;
use crate::engine::debris::Debris;
use crate::engine::kernel::{Bracket, Conditions, Edge, Span};
use crate::engine::lanes::LANES;
use crate::engine::parts::Needs;
use crate::engine::sector::{Partition, Segment};
use crate::engine::strips::{PinStrips, strips};
use crate::model::error::SimulationError;

/// Words of the longest message about a boundary, on a mesh of so many rows.
pub(crate) fn halo_words(rows: usize, needs: Needs) -> usize {
    let edge = if needs.forms { Edge::words(strips(rows), needs.transport.unwrap_or(1)) } else { 0 };
    PinStrips::crossing_words(rows).max(edge)
}

/// Columns at the end of a segment that depend on the next segment: a cell takes of an edge up to L columns ahead what up to L
/// columns ahead of that are worn.
pub(crate) fn waiting_columns(transport: Option<usize>) -> usize {
    2 * transport.unwrap_or(1) - 1
}

impl Worker {
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
        self.pass_over_segments(&partition, &segments, bracket)?;
        for entering in partition.entering(first) {
            if self.sectors[entering.sector].is_some() && self.sectors[entering.from].is_none() {
                self.take_over(entering.from, entering.pin)?;
            }
            let Some(sector) = &self.sectors[entering.sector] else { continue };
            let span = Span { first: entering.pin, over: entering.over, columns: 1 };
            (self.read)(self.instructions, &mut self.pin, sector, span, &bracket, &mut self.reading);
        }
        Ok(bracket)
    }

    /// Passes over the worker's segments, whose neighbours may belong to others.
    ///
    /// Heights and losses of the first columns of a segment (model 4L) are found and told first, from the state at the
    /// start of the step. So each segment is passed over in one go. The pin column over the first disc column of a sector lies over
    /// the sector before in the next step, and is handed on after that.
    fn pass_over_segments(
        &mut self,
        partition: &Partition,
        segments: &[Segment],
        bracket: Bracket,
    ) -> Result<(), SimulationError> {
        let pin_columns = self.parameters.mesh.pin_columns();
        for segment in segments.iter().filter(|segment| segment.pin.start > 0) {
            if let Some(edge) = self.edge_of(segment, bracket) {
                self.tell_edge(segment.sector, edge)?;
            }
        }
        // The first waits longest for what lies ahead of it; what the last hands on is waited for.
        for segment in segments.iter().rev() {
            let next = (segment.sector + 1) % partition.sectors();
            let ahead = if segment.pin.end < pin_columns { self.edge_ahead(next)? } else { None };
            self.pass_over_segment(segment, bracket, ahead.as_ref());
            if let Some(ahead) = ahead {
                self.edges[next] = ahead;
            }
            self.hand_on(segment)?;
        }
        Ok(())
    }

    /// Finds the heights and losses of the first columns of a segment that the cells behind them need, from the state at the start of
    /// the step; none where nothing forms.
    fn edge_of(&mut self, segment: &Segment, bracket: Bracket) -> Option<Edge> {
        let sector = self.sectors[segment.sector].as_mut().filter(|_| self.needs.forms)?;
        let mut edge = std::mem::take(&mut self.edges[segment.sector]);
        let columns = segment.pin.len().min(2 * self.needs.transport.unwrap_or(1));
        let span = Span { first: segment.pin.start, over: segment.over, columns };
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

    /// Passes over a segment; `ahead` is what lies ahead of it.
    fn pass_over_segment(&mut self, segment: &Segment, bracket: Bracket, ahead: Option<&Edge>) {
        let conditions = conditions(&self.contact, &self.debris, bracket, self.rows.start, ahead);
        let Some(sector) = &mut self.sectors[segment.sector] else { return };
        let span = Span { first: segment.pin.start, over: segment.over, columns: segment.pin.len() };
        (self.pass)(
            self.instructions,
            &self.rules,
            &conditions,
            &mut self.pin,
            sector,
            span,
            segment.joined,
            &mut self.moved,
            &mut self.reading,
        );
    }

    /// Tells the worker of the sector before what lies ahead of its segment.
    fn tell_edge(&mut self, sector: usize, edge: Edge) -> Result<(), SimulationError> {
        let to = self.partition.owner(self.partition.before(sector), self.band);
        if to != self.communicator.rank() {
            self.halo.clear();
            edge.write(&mut self.halo);
            self.communicator.send_halo(self.boundary(sector).edge, to, &self.halo)?;
        }
        self.edges[sector] = edge;
        Ok(())
    }

    /// Returns the edge of the sector ahead of a segment, found by this worker or told by its owner; none where nothing forms.
    fn edge_ahead(&mut self, sector: usize) -> Result<Option<Edge>, SimulationError> {
        if !self.needs.forms {
            return Ok(None);
        }
        let mut edge = std::mem::take(&mut self.edges[sector]);
        let owner = self.partition.owner(sector, self.band);
        if owner != self.communicator.rank() {
            let columns = self.needs.transport.unwrap_or(1);
            let strips = strips(self.rows.len());
            self.halo.resize(Edge::words(strips, columns), 0);
            self.communicator.receive_halo(self.boundary(sector).edge, owner, &mut self.halo)?;
            edge.read(strips, columns, &self.halo);
        }
        Ok(Some(edge))
    }

    /// Hands the first pin column of a segment to the worker over whose sector it lies in the next step.
    fn hand_on(&mut self, segment: &Segment) -> Result<(), SimulationError> {
        let to = self.partition.owner(self.partition.before(segment.sector), self.band);
        if segment.over == 0 && to != self.communicator.rank() {
            self.halo.clear();
            self.pin.write_crossing(segment.pin.start, &mut self.halo);
            self.communicator.send_halo(self.boundary(segment.sector).column, to, &self.halo)?;
        }
        Ok(())
    }

    /// Takes over a pin column that another worker has passed over.
    fn take_over(&mut self, from: usize, column: usize) -> Result<(), SimulationError> {
        self.halo.resize(PinStrips::crossing_words(self.rows.len()), 0);
        let owner = self.partition.owner(from, self.band);
        self.communicator.receive_halo(self.boundary(from).column, owner, &mut self.halo)?;
        self.pin.read_crossing(column, &self.halo);
        Ok(())
    }

    /// The lower boundary of the worker's band of a sector.
    fn boundary(&self, sector: usize) -> Boundary {
        let boundary = sector * self.partition.bands() + self.band;
        Boundary { edge: 2 * boundary, column: 2 * boundary + 1 }
    }
}

/// A boundary between workers, by the messages that cross it.
struct Boundary {
    /// Number of the boundary for messages about what lies ahead of it.
    edge: usize,
    /// Number of the boundary for the column that turns across it.
    column: usize,
}

/// Returns the conditions of a step for a pass; `ahead` is the column ahead of the last.
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
