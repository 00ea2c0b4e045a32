//! Sweeping the worker's columns where debris is local (model 4L): the last column of a segment must know what the first of
//! the next segment lost.

use super::Worker;
use super::columns::conditions;
use crate::engine::comm::Communicator;
use crate::engine::error::SimulationError;
use crate::engine::kernel::{Bracket, Edge, Span};
use crate::engine::sector::Segment;

impl<C: Communicator> Worker<C> {
    /// Sweeps segments that follow each other, all of them the worker's own.
    pub(super) fn sweep_all_locally(&mut self, segments: &[Segment], bracket: Bracket) {
        for (number, segment) in segments.iter().enumerate() {
            // The next segment is not swept yet.
            let ahead = segments.get(number + 1).map(|next| self.wear_column_of(next, 0, bracket));
            self.sweep_span(segment, 0..segment.pin.len(), bracket, ahead.as_ref());
        }
    }

    /// Sweeps segments whose neighbours belong to others: the first column of each is handed on at once, with what it lost,
    /// and the last waits for that of the next segment.
    pub(super) fn sweep_apart_locally(
        &mut self,
        segments: &[Segment],
        bracket: Bracket,
    ) -> Result<(), SimulationError> {
        let ends_pin = |segment: &Segment, pin_columns: usize| segment.pin.end == pin_columns;
        let (partition, pin_columns) = (self.partition.clone(), self.parameters.mesh.pin_columns());
        for segment in segments.iter().filter(|segment| segment.over == 0) {
            self.edges[segment.sector] = self.wear_column_of(segment, 0, bracket);
        }
        for segment in segments {
            if segment.pin.len() > 1 {
                let ahead = self.wear_column_of(segment, 1, bracket);
                self.sweep_span(segment, 0..1, bracket, Some(&ahead));
            } else if ends_pin(segment, pin_columns) {
                self.sweep_span(segment, 0..1, bracket, None);
            }
            // A segment of one column that does not end the pin is the end of its sector, so nobody waits for it.
            self.hand_on(segment)?;
        }
        for segment in segments.iter().filter(|segment| segment.pin.len() > 2) {
            let last = segment.pin.len() - 1;
            let ahead = self.wear_column_of(segment, last, bracket);
            self.sweep_span(segment, 1..last, bracket, Some(&ahead));
        }
        for entering in partition.entering(self.first()) {
            if self.sectors[entering.sector].is_some() && self.sectors[entering.from].is_none() {
                self.take_over(entering.from, entering.pin)?;
            }
        }
        for segment in segments {
            let (columns, next) = (segment.pin.len(), (segment.sector + 1) % partition.sectors());
            if !ends_pin(segment, pin_columns) {
                let ahead = std::mem::take(&mut self.edges[next]);
                self.sweep_span(segment, columns - 1..columns, bracket, Some(&ahead));
                self.edges[next] = ahead;
            } else if columns > 1 {
                self.sweep_span(segment, columns - 1..columns, bracket, None);
            }
        }
        Ok(())
    }

    /// What a column of a segment loses in this step, from its state at the start of it.
    fn wear_column_of(&self, segment: &Segment, column: usize, bracket: Bracket) -> Edge {
        let mut edge = Edge::default();
        if let Some(sector) = &self.sectors[segment.sector] {
            let span = Span { first: segment.pin.start + column, over: segment.over + column, columns: 1 };
            let conditions = conditions(&self.contact, &self.debris, bracket, self.rows.start, None);
            (self.wear_column)(&self.rules, &conditions, &self.pin, sector, span, &mut edge);
        }
        edge
    }
}
