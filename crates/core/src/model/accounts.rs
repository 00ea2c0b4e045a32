//! Friction, heat and emission that follow from each step beside wear (model 10 to 12), where a scene asks for them.
//!
//! All of it comes from sums that the load balance and the debris have anyway, so the engine and the plain model share
//! it, and every worker of the engine keeps the same account.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::model::clock::StepOperation;
use crate::model::cycle::{Cycle, Kind, Pause};
use crate::model::emission::{Emission, EmissionAccount, EmissionReport};
use crate::model::friction::{ContactSums, Friction, FrictionAccount, FrictionReport};
use crate::model::heat::account::{HeatAccount, HeatModel, HeatReport};
use crate::model::parameters::Parameters;
use crate::model::totals::Volumes;

/// The accounts of a simulation.
#[derive(Debug, Clone)]
pub struct Accounts {
    friction: Option<Friction>,
    heat: Option<HeatModel>,
    emission: Option<Emission>,
    cycle: Option<Arc<Cycle>>,
    /// r̄, m.
    mean_radius: f64,
    /// Steps per revolution.
    columns: u64,
    state: AccountsState,
}

/// State of the accounts after the steps so far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AccountsState {
    friction: Option<FrictionAccount>,
    heat: Option<HeatAccount>,
    emission: Option<EmissionAccount>,
    /// True if pauses after the last step are still to be taken by the chain.
    pause_due: bool,
}

/// Friction, heat and emission as they are reported.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct AccountsReport {
    /// Friction, where the scene asks for it.
    pub friction: Option<FrictionReport>,
    /// Heat, where the scene asks for it; it needs friction.
    pub heat: Option<HeatReport>,
    /// Emission, where the scene asks for it.
    pub emission: Option<EmissionReport>,
}

/// A step as the accounts see it.
#[derive(Debug, Clone, Copy)]
pub struct StepFacts<'a> {
    /// Number of the step, from 1.
    pub number: u64,
    /// m Δθ, rad.
    pub angle: f64,
    /// Load and times of the step.
    pub operation: &'a StepOperation,
    /// Sums over its cells in contact.
    pub contact: &'a ContactSums,
    /// Volumes that it moved, m³.
    pub moved: &'a Volumes,
}

impl Accounts {
    /// Accounts of a scene at t = 0; none where it asks for neither friction nor emission.
    pub fn of(parameters: &Parameters) -> Option<Self> {
        let Parameters { mesh, friction, emission, cycle, .. } = parameters;
        if friction.is_none() && emission.is_none() {
            return None;
        }
        let heat = HeatModel::of(parameters).filter(|_| friction.is_some());
        let begins_with_pause =
            cycle.as_ref().is_some_and(|cycle| !cycle.pauses_after(0, parameters.step_angle()).is_empty());
        Some(Self {
            state: AccountsState {
                friction: friction.map(|_| FrictionAccount::new(mesh.disc_columns())),
                heat: heat.as_ref().map(HeatAccount::new),
                emission: emission.as_ref().map(|_| EmissionAccount::default()),
                pause_due: heat.is_some() && begins_with_pause,
            },
            friction: *friction,
            heat,
            emission: emission.clone(),
            cycle: cycle.clone(),
            mean_radius: mesh.mean_radius(),
            columns: mesh.disc_columns() as u64,
        })
    }

    /// Returns the state after the steps so far.
    pub fn state(&self) -> &AccountsState {
        &self.state
    }

    /// Goes on from a state that was kept.
    pub fn restore(&mut self, state: AccountsState) {
        self.state = state;
    }

    /// μ of the last step; none before the first, or without friction.
    pub fn friction_coefficient(&self) -> Option<f64> {
        self.state.friction.as_ref().and_then(FrictionAccount::coefficient)
    }

    /// f_κ, by which the wear rates of the pin's plateaus are multiplied in the coming step.
    pub fn wear_rate_factor(&self) -> f64 {
        self.state.heat.as_ref().map_or(1.0, |heat| heat.factors().wear_rate)
    }

    /// Takes the pauses between the step before and this one, given by its number, from 1, and angle (rad).
    pub fn begin(&mut self, number: u64, angle: f64) {
        let (Some(cycle), Some(model), Some(heat)) = (&self.cycle, &self.heat, &mut self.state.heat) else { return };
        if !std::mem::take(&mut self.state.pause_due) {
            return;
        }
        for pause in cycle.pauses_after(number - 1, angle) {
            heat.pause(model, &pause, f64::INFINITY);
        }
        heat.read_factors(model);
        heat.begin_event(model);
    }

    /// Adds a step.
    pub fn record(&mut self, step: &StepFacts) {
        let mut work = 0.0;
        if let (Some(law), Some(friction)) = (&self.friction, &mut self.state.friction) {
            let factor = self.state.heat.as_ref().map_or(1.0, |heat| heat.factors().friction);
            let distance = self.mean_radius * step.angle;
            work = friction.record(factor * law.coefficient(step.contact), step.operation.load, distance);
        }
        if let (Some(emission), Some(account)) = (&self.emission, &mut self.state.emission) {
            account.record(emission.mass(step.moved));
            if self.heat.is_none() {
                account.count(emission, None);
            }
        }
        let Some(heat) = &mut self.state.heat else { return };
        heat.collect(work, step.operation.active, step.angle);
        let pauses = self.cycle.as_ref().map(|cycle| cycle.has_pause_after(step.number, step.angle));
        self.state.pause_due = pauses.unwrap_or(false);
        if self.state.pause_due || heat.steps() == self.columns {
            self.end_interval();
            if let (false, Some(model), Some(heat)) = (self.state.pause_due, &self.heat, &mut self.state.heat) {
                heat.read_factors(model);
            }
        }
    }

    /// The chain takes the steps since the last interval ended, and their particles are counted.
    fn end_interval(&mut self) {
        let (Some(model), Some(heat)) = (&self.heat, &mut self.state.heat) else { return };
        let temperature = heat.end_interval(model);
        if let (Some(emission), Some(account)) = (&self.emission, &mut self.state.emission) {
            account.count(emission, Some(temperature));
        }
    }

    /// Reports the accounts at a time (s), after so many steps of this angle (rad): their end, or a time in a pause before
    /// or after it.
    pub fn report(&self, steps: u64, angle: f64, time: f64, pause: Option<Kind>) -> AccountsReport {
        if self.heat.is_none() || (!self.state.pause_due && pause.is_none()) {
            return self.as_it_is(pause);
        }
        Resting::new(self.clone(), steps, angle, pause).report(time, pause)
    }

    fn as_it_is(&self, pause: Option<Kind>) -> AccountsReport {
        let AccountsState { friction, heat, emission, .. } = &self.state;
        let mut friction = friction.as_ref().map(FrictionAccount::report);
        if let (Some(friction), Some(Kind::Lifted)) = (&mut friction, pause) {
            friction.coefficient = f64::NAN;
        }
        AccountsReport {
            friction,
            heat: heat.as_ref().zip(self.heat.as_ref()).map(|(heat, model)| heat.report(model)),
            emission: emission.as_ref().zip(self.emission.as_ref()).map(|(account, emission)| account.report(emission)),
        }
    }
}

/// The accounts at one moment after the other in which the pin may rest: what follows the same step.
///
/// A pause may have very many rows, each with samples, so the chain takes each row once.
#[derive(Debug, Clone)]
pub struct Resting {
    /// Accounts after the first `over` pauses.
    accounts: Accounts,
    /// All pauses that may come.
    pauses: Vec<Pause>,
    over: usize,
}

impl Resting {
    /// Begins after so many steps of this angle (rad), in a `pause` or at the end of the last step.
    pub fn new(mut accounts: Accounts, steps: u64, angle: f64, pause: Option<Kind>) -> Self {
        let mut pauses = Vec::new();
        if let (Some(cycle), true) = (accounts.cycle.clone(), accounts.heat.is_some()) {
            if accounts.state.pause_due {
                pauses = cycle.pauses_after(steps, angle);
            }
            if pause.is_some() {
                if !accounts.state.pause_due && accounts.state.heat.as_ref().is_some_and(|heat| heat.steps() > 0) {
                    accounts.end_interval();
                }
                // In the last pause of a run the step around it is not taken any more.
                pauses.extend(cycle.pauses_after(steps + 1, angle));
            }
        }
        Self { accounts, pauses, over: 0 }
    }

    /// Reports the accounts at a time (s), not before that of the last report.
    pub fn report(&mut self, time: f64, pause: Option<Kind>) -> AccountsReport {
        let Self { accounts, pauses, over } = self;
        while let (Some(next), Some(model)) = (pauses.get(*over), &accounts.heat) {
            let before = accounts.state.heat.clone();
            if !accounts.state.heat.as_mut().is_some_and(|heat| heat.pause(model, next, time)) {
                let report = accounts.as_it_is(pause);
                accounts.state.heat = before;
                return report;
            }
            *over += 1;
        }
        accounts.as_it_is(pause)
    }
}
