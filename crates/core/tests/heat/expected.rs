//! What the accounts of friction, heat and emission must be, by the order of model 11 written out anew; and steps of no
//! surface.

use std::sync::Arc;

use crate::scenes::wear_only;
use plateau_core::model::Volumes;
use plateau_core::model::accounts::{Accounts, AccountsReport, StepFacts};
use plateau_core::model::cycle::{Cycle, Kind};
use plateau_core::model::emission::Emission;
use plateau_core::model::friction::{ContactSums, Friction, FrictionLaw};
use plateau_core::model::heat::account::HeatReport;
use plateau_core::model::heat::chain::{Chain, ChainReport, ChainState, Link, sub_steps};
use plateau_core::model::heat::passing::Passing;
use plateau_core::model::parameters::Parameters;
use plateau_core::model::thermal::{Factor, Thermal};

/// μ of every step, but for its factor.
pub const MU: f64 = 0.4;

/// 10 columns around the disc, and constant friction.
pub fn parameters(thermal: Thermal, cycle: Option<Cycle>) -> Parameters {
    Parameters {
        time_acceleration: 20.0,
        friction: Some(Friction::of(FrictionLaw { pressure_coefficient: MU, shear_strength: 0.0 }, f64::INFINITY)),
        thermal: Some(Arc::new(thermal)),
        emission: Some(Emission {
            pm10_fraction: 0.4,
            pm25_fraction: 0.15,
            number_per_mass: 1e15,
            pin_density: 2600.0,
            disc_density: 7200.0,
            number_factor: Factor::new(vec![(300.0, 1.0), (500.0, 3.0)]).unwrap(),
        }),
        cycle: cycle.map(Arc::new),
        ..wear_only(2, 10, 4)
    }
}

/// What wears off the pin in each step, m³; all of it is emitted.
pub const WORN: f64 = 1e-13;

/// Takes a step of constant friction.
pub fn take(accounts: &mut Accounts, parameters: &Parameters, number: u64) {
    let angle = parameters.step_angle();
    accounts.begin(number, angle);
    let operation = parameters.operation_of(number, &parameters.clock());
    let contact = ContactSums { load: operation.load, area: 1e-6, statuses: None };
    let moved = Volumes { worn_pin: WORN, emitted: WORN, ..Volumes::default() };
    accounts.record(&StepFacts { number, angle, operation: &operation, contact: &contact, moved: &moved });
}

/// The chain as it must be.
#[derive(Clone)]
pub struct Expected {
    chain: Chain,
    pub state: ChainState,
    parameters: Parameters,
}

impl Expected {
    /// All at ambient temperature.
    pub fn new(parameters: &Parameters) -> Self {
        let chain = Chain::new(parameters.thermal.as_deref().unwrap());
        Self { chain, state: ChainState::at_rest(), parameters: parameters.clone() }
    }

    /// R, K/W.
    fn resistance(&self, speed: f64) -> f64 {
        let mesh = &self.parameters.mesh;
        let passing = Passing::of(&self.parameters.thermal.as_ref().unwrap().disc);
        let at_rest = 0.479 / (50.0 * mesh.pin_area().sqrt());
        if speed == 0.0 {
            return at_rest;
        }
        let time = mesh.column_angle() / speed;
        let mean = (1..=4).map(|column| passing.response(f64::from(column) * time)).sum::<f64>() / 4.0;
        (1.0 / ((mesh.pin_area() / mean).powi(2) + at_rest.powi(-2))).sqrt()
    }

    /// An interval of some time under a load, at a speed.
    pub fn interval(&mut self, time: f64, load: f64, speed: f64, factor: f64) {
        let count = sub_steps(time);
        let power = factor * MU * load * self.parameters.mesh.mean_radius() * speed;
        let link = Link::Closed(self.resistance(speed));
        self.chain.advance(&mut self.state, count, time / count as f64, power, speed, link);
    }

    /// So many sub-steps of a pause of a length, s.
    pub fn pause(&mut self, length: f64, ended: u64, kind: Kind) {
        let link = if kind == Kind::Lifted { Link::Open } else { Link::Closed(self.resistance(0.0)) };
        self.chain.advance(&mut self.state, ended, length / sub_steps(length) as f64, 0.0, 0.0, link);
    }

    /// Whether this is reported.
    pub fn agrees(&self, found: &AccountsReport) -> bool {
        let HeatReport { contact, disc, pin, lost, .. } = found.heat.unwrap();
        let expected = self.chain.report(&self.state);
        let ChainReport { disc: expected_disc, pin: expected_pin, lost: expected_lost, .. } = expected;
        let close = |found: f64, expected: f64| (found - 296.15 - expected).abs() < 1e-11 * (1.0 + expected);
        let same_contact = self.state.contact.map_or(contact.is_nan(), |expected| close(contact, expected));
        same_contact
            && close(disc, expected_disc)
            && close(pin, expected_pin)
            && (lost - expected_lost).abs() <= 1e-11 * expected_lost
    }
}
