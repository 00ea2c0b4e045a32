//! The complete state of a simulation between two steps: what a stopped run needs to go on as if nothing had happened.

use serde::{Deserialize, Serialize};

use crate::engine::execution::Engine;
use crate::engine::worker::EngineMemory;
use crate::model::clock::{Clock, Operation};
use crate::model::error::WrongMesh;
use crate::model::memory::{Heights, Memory};
use crate::model::mesh::Mesh;
use crate::observe::Sample;

/// The complete state of a simulation between two steps.
///
/// A simulation of the same parameters and initial surfaces that is given it takes the coming steps bit for bit as the one
/// that it was taken of, with any number of workers and any instruction set,
/// on the same engine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Heights of both surfaces.
    pub heights: Heights,
    /// Parts that only some simulations have.
    pub(crate) kept: Kept,
    /// State that is kept beside the heights.
    pub(crate) memory: Memory,
    /// State that the engine keeps beside it; the plain model needs nothing more.
    pub(crate) engine: Option<EngineMemory>,
}

/// Parts of a state that only some simulations have: a contact that is kept, load and speed that were set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) enum Kept {
    /// Nothing: load and speed are those of the scene, and no contact is kept.
    Nothing,
    /// Contact of the last step, where it may be reported once more, as in a pause.
    Contact(LastContact),
    /// Load and speed of the coming steps, speed of the last one (rad/s) if it had another, and the contact of the last step if kept.
    Control(Operation, Option<f64>, Option<LastContact>),
}

impl Kept {
    /// Picks the parts that a simulation has.
    pub fn new(operation: Operation, last_speed: Option<f64>, contact: Option<LastContact>) -> Self {
        match (operation.control, contact) {
            (Some(_), contact) => Self::Control(operation, last_speed, contact),
            (None, Some(contact)) => Self::Contact(contact),
            (None, None) => Self::Nothing,
        }
    }

    /// Load and speed, and speed of the last step (rad/s) if it had another.
    pub fn control(&self) -> Option<(Operation, Option<f64>)> {
        if let Self::Control(operation, last_speed, _) = self { Some((*operation, *last_speed)) } else { None }
    }

    /// Returns the contact of the last step, if it is kept.
    pub fn contact(&self) -> Option<&LastContact> {
        match self {
            Self::Nothing => None,
            Self::Contact(contact) => Some(contact),
            Self::Control(_, _, contact) => contact.as_ref(),
        }
    }
}

/// Sample and pressures of the last step, kept to be reported once more, as in a pause.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct LastContact {
    pub sample: Sample,
    /// Pressure p of every pin cell, Pa, column by column.
    pub pressure: Vec<f64>,
}

impl Checkpoint {
    /// Number of steps done.
    pub fn steps(&self) -> u64 {
        self.memory.course.steps
    }

    /// Returns the engine that took the steps.
    pub fn engine(&self) -> Engine {
        if self.engine.is_some() { Engine::Fast } else { Engine::Plain }
    }

    /// Returns the clock, which tells when steps end.
    pub fn clock(&self) -> Clock {
        self.memory.clock
    }

    /// Time t, s.
    pub fn time(&self) -> f64 {
        self.memory.course.time
    }

    /// Checks that the state is of as many cells as a mesh has.
    pub fn check(&self, mesh: &Mesh) -> Result<(), WrongMesh> {
        let Heights { disc_height, disc_substrate, pin_height, pin_substrate } = &self.heights;
        let fields = [
            ("disc", disc_height, mesh.disc_cells()),
            ("disc", disc_substrate, mesh.disc_cells()),
            ("pin", pin_height, mesh.pin_cells()),
            ("pin", pin_substrate, mesh.pin_cells()),
        ];
        let wrong = fields.into_iter().find(|(_, field, expected)| field.len() != *expected);
        wrong.map_or(Ok(()), |(body, field, expected)| Err(WrongMesh { body, found: field.len(), expected }))
    }

    /// Names the first part that is not as a simulation of the same run has it, in words; none where all of it is.
    pub(crate) fn misfit(&self, own: &Memory, own_engine: Option<&EngineMemory>) -> Option<&'static str> {
        let both = self.engine.as_ref().zip(own_engine);
        let differs =
            |is_other: fn(&EngineMemory, &EngineMemory) -> bool| both.is_some_and(|(found, own)| is_other(found, own));
        let memory = &self.memory;
        [
            (
                self.kept.control().is_some_and(|(operation, _)| !operation.is_possible(memory.course.steps)),
                "load and speed",
            ),
            (memory.account.pools.len() != own.account.pools.len(), "debris pools"),
            (differs(|found, own| found.contact.has_statuses() != own.contact.has_statuses()), "sums of the contact"),
            (differs(|found, own| found.forecast.revolution() != own.forecast.revolution()), "past displacements"),
            (memory.accounts.is_some() != own.accounts.is_some(), "friction, heat and emission"),
        ]
        .into_iter()
        .find_map(|(differs, what)| differs.then_some(what))
    }
}
