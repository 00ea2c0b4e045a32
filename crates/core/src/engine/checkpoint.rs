//! The complete state of a simulation between two steps: what a stopped run needs to go on as if nothing had happened.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::engine::contact::Contact;
use crate::engine::debris::Account;
use crate::engine::execution::Engine;
use crate::engine::forecast::Forecast;
use crate::engine::history::{Course, History};
use crate::engine::kernel::Bracket;
use crate::engine::quantum::Quantum;
use crate::model::accounts::AccountsState;
use crate::model::clock::Clock;
use crate::model::mesh::Mesh;
use crate::observe::Sample;

/// The complete state of a simulation between two steps.
///
/// A simulation of the same parameters and initial surfaces that is given it takes the coming steps bit for bit as the one
/// that it was taken of, with any number of workers and any instruction set,
/// on the same engine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// z_d, m, column by column.
    pub disc_height: Vec<f64>,
    /// b_d, m.
    pub disc_substrate: Vec<f64>,
    /// z_p, m.
    pub pin_height: Vec<f64>,
    /// b_p, m.
    pub pin_substrate: Vec<f64>,
    /// What the last step showed, where it may be reported once more: in a pause.
    pub(crate) contact: Option<LastContact>,
    /// What all workers know alike.
    pub(crate) memory: Memory,
}

/// What the last step showed, kept while the pin rests.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct LastContact {
    pub sample: Sample,
    /// p of every pin cell, Pa, column by column.
    pub pressure: Vec<f64>,
}

/// What all workers know alike.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Memory {
    pub course: Course,
    pub clock: Clock,
    pub time_acceleration: f64,
    pub account: Account,
    pub history: History,
    /// Of friction, heat and emission, where the scene asks for any.
    pub accounts: Option<AccountsState>,
    /// What the fast engine keeps beside it; the plain model needs nothing more.
    pub engine: Option<EngineMemory>,
}

/// What the fast engine keeps from step to step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct EngineMemory {
    pub contact: Contact,
    pub forecast: Forecast,
    pub bracket: Option<Bracket>,
    pub overlap_quantum: Quantum,
}

/// Why a simulation cannot go on from a checkpoint.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the checkpoint is of another mesh: {found} {body} cells, expected {expected}")]
pub struct WrongMesh {
    /// Disc or pin.
    pub body: &'static str,
    /// Cells of the checkpoint.
    pub found: usize,
    /// Cells of the simulation.
    pub expected: usize,
}

impl Memory {
    /// What of it is not as in another memory of the same run, in words; none where all of it is.
    pub(crate) fn misfit(&self, own: &Self) -> Option<&'static str> {
        let both = self.engine.as_ref().zip(own.engine.as_ref());
        let differs =
            |is_other: fn(&EngineMemory, &EngineMemory) -> bool| both.is_some_and(|(found, own)| is_other(found, own));
        [
            (self.account.pools.len() != own.account.pools.len(), "debris pools"),
            (differs(|found, own| found.contact.shape() != own.contact.shape()), "sums of the contact"),
            (differs(|found, own| found.forecast.revolution() != own.forecast.revolution()), "past displacements"),
            (self.accounts.is_some() != own.accounts.is_some(), "friction, heat and emission"),
        ]
        .into_iter()
        .find_map(|(differs, what)| differs.then_some(what))
    }
}

impl Checkpoint {
    /// Steps done.
    pub fn steps(&self) -> u64 {
        self.memory.course.steps
    }

    /// What took its steps.
    pub fn engine(&self) -> Engine {
        if self.memory.engine.is_some() { Engine::Fast } else { Engine::Plain }
    }

    /// When its steps end.
    pub fn clock(&self) -> Clock {
        self.memory.clock
    }

    /// t, s.
    pub fn time(&self) -> f64 {
        self.memory.course.time
    }

    /// Whether it is of so many cells.
    ///
    /// # Errors
    /// [`WrongMesh`].
    pub fn check(&self, mesh: &Mesh) -> Result<(), WrongMesh> {
        let fields = [
            ("disc", &self.disc_height, mesh.disc_cells()),
            ("disc", &self.disc_substrate, mesh.disc_cells()),
            ("pin", &self.pin_height, mesh.pin_cells()),
            ("pin", &self.pin_substrate, mesh.pin_cells()),
        ];
        let wrong = fields.into_iter().find(|(_, field, expected)| field.len() != *expected);
        wrong.map_or(Ok(()), |(body, field, expected)| Err(WrongMesh { body, found: field.len(), expected }))
    }
}
