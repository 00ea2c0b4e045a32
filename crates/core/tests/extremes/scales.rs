//! Residual and volumes of single steps against the plain model, over twenty decades of stiffness, of load and of wear.
//!
//! Each step of the engine starts from a state that the plain model is given, too: so what differs is the rounding of one
//! step.

use std::sync::Arc;

use plateau_core::model::Volumes;
use plateau_core::model::cycle::{Cycle, Interpolation, Node};
use plateau_core::model::mesh::Mesh;
use plateau_core::model::parameters::{DebrisRule, Integrator, Parameters, PlateauRules};
use plateau_core::model::{State, step};
use plateau_core::observe::Sample;
use plateau_core::simulation::Simulation;

use super::case::{Case, paper, with_stiffness_number};
use super::outcome::highest;
use super::surfaces::rough;
use crate::scenes::balance_rounding;

/// Steps of a case: a revolution and more, so that build-up is there and wears.
const STEPS: u64 = 120;
/// How far the load may be off beside what the rounding of a displacement makes of it.
const LOAD: f64 = 1e-10;
/// How far a volume may be off, by that of the plain model.
const VOLUME: f64 = 1e-9;

/// Names of the numbers of a [`Scale`].
pub const HEADER: &str = "| case | load residual | real | plain model | δ | worn pin | worn disc | deposited | balance residual |\n\
                          |---|---:|---:|---:|---:|---:|---:|---:|---:|\n";

/// The largest of what the steps of some simulations came to.
#[derive(Debug)]
pub struct Scale {
    name: String,
    /// Load residual that samples report; that at their displacement; that at the displacement of the plain model; what the
    /// last place of a displacement carries, by the load; volumes worn off the pin, off the disc, and deposited, by those of
    /// the plain model, less 1; missing share of the worn volume at the end.
    numbers: [f64; 8],
    /// Names of those that are not as they must be.
    pub wrong: Vec<String>,
}

/// |Σ k A (δ − g)₊ − F|/F, summed with compensation, and Σ k A over the cells in contact.
fn residual(pairs: &[step::Pair], displacement: f64, load: f64) -> (f64, f64) {
    let (mut sum, mut rest, mut slope) = (-load, 0.0, 0.0);
    for pair in pairs.iter().filter(|pair| pair.gap < displacement) {
        let term = pair.stiffness * pair.area * (displacement - pair.gap);
        let next = sum + term;
        rest += if f64::abs(sum) >= term { (sum - next) + term } else { (term - next) + sum };
        sum = next;
        slope += pair.stiffness * pair.area;
    }
    ((sum + rest).abs() / load, slope)
}

impl Scale {
    /// Takes the steps of a case with one pool, and with local debris.
    fn of(case: &Case) -> Self {
        let mut scale = Self { name: case.name.clone(), numbers: [0.0; 8], wrong: Vec::new() };
        for case in [case.clone(), case.clone().with_local_debris()] {
            let numbers = numbers(&case, &mut scale.wrong);
            scale.numbers.iter_mut().zip(numbers).for_each(|(largest, number)| *largest = largest.max(number));
        }
        scale
    }

    /// Its line of the table.
    pub fn row(&self) -> String {
        let numbers: Vec<String> = self.numbers.iter().map(|number| format!("{number:.1e}")).collect();
        format!("| {} | {} |\n", self.name, numbers.join(" | "))
    }
}

/// The numbers of a case, as [`Scale`] has them; adds the names of those that are wrong.
fn numbers(case: &Case, wrong: &mut Vec<String>) -> [f64; 8] {
    let Case { name, parameters, surfaces, .. } = case;
    let mut largest = [0.0_f64; 8];
    let mut simulation = Simulation::new(parameters.clone(), surfaces.clone()).expect("a case");
    let mut before = simulation.sample().expect("a sample");
    let mut state = State::new(parameters, surfaces.clone());
    for step in 1..=STEPS {
        (state.disc, state.pin) = (simulation.disc().expect("a disc"), simulation.pin().expect("a pin"));
        state.steps = simulation.steps_done();
        if parameters.plateaus.debris == DebrisRule::Contact {
            state.pools = vec![before.pool];
        }
        let pairs = step::pairs(parameters, &state);
        let plain = step::advance(parameters, &mut state).expect("a step of the plain model");
        simulation.advance().unwrap_or_else(|error| panic!("{name}: {error}"));
        let sample = simulation.sample().expect("a sample");

        let (reached, slope) = residual(&pairs, sample.displacement, plain.load);
        let rounding = slope * sample.displacement.abs() * f64::EPSILON / plain.load;
        let Volumes { worn_pin, worn_disc, deposited_pin, deposited_disc, .. } = plain.moved;
        let deposited = |sample: &Sample| sample.deposited_pin + sample.deposited_disc;
        let off = |volume: &dyn Fn(&Sample) -> f64, plain: f64| {
            // Of totals the last places are lost.
            let (found, lost) = (volume(&sample) - volume(&before), 4.0 * f64::EPSILON * volume(&sample));
            let off = ((found - plain).abs() - lost).max(0.0);
            if off == 0.0 { 0.0 } else { off / plain }
        };
        let numbers = [
            sample.load_residual,
            reached,
            residual(&pairs, plain.displacement, plain.load).0,
            rounding,
            off(&|sample| sample.worn_pin, worn_pin),
            off(&|sample| sample.worn_disc, worn_disc),
            off(&deposited, deposited_pin + deposited_disc),
            sample.balance_residual.abs(),
        ];
        let highest = highest(case).max(sample.displacement.abs());
        let checks = [
            // Sums of some hundred terms in another order.
            ("load residual", (sample.load_residual - reached).abs() <= 1e-13 + 1e-6 * reached),
            ("displacement", reached <= LOAD.max(2.0 * rounding)),
            ("worn pin", numbers[4] <= VOLUME),
            ("worn disc", numbers[5] <= VOLUME),
            ("deposited", numbers[6] <= VOLUME),
            ("balance", numbers[7] <= 1e-12_f64.max(balance_rounding(parameters, highest, &sample))),
        ];
        let failed = checks.iter().filter(|(_, is_right)| !is_right);
        wrong.extend(failed.map(|(what, _)| format!("{name}, step {step}: {what}: {numbers:?}")));
        largest.iter_mut().zip(&numbers[..7]).for_each(|(largest, number)| *largest = largest.max(*number));
        largest[7] = numbers[7];
        before = sample;
    }
    largest
}

/// Every case.
pub fn all() -> Vec<Scale> {
    let cases = [stiffness(), resin(), loads(), first_loads(), wear(), sizes()].concat();
    cases.iter().map(Scale::of).collect()
}

/// All that wears may be compacted; both bodies wear, and build-up has wear rates of its own.
fn usual() -> Parameters {
    let mut parameters = paper(12, 96, 17);
    parameters.plateaus = PlateauRules::pool(1.0);
    parameters.integrator = Integrator::Exponential;
    parameters.materials.pin_secondary.specific_wear_rate *= 2.0;
    parameters.materials.disc_secondary.specific_wear_rate = 1e-14;
    parameters
}

fn case(name: String, parameters: Parameters) -> Case {
    let surfaces = rough(&parameters.mesh);
    Case::new(name, parameters, surfaces)
}

/// Build-up up to twenty decades softer than the fibre.
fn stiffness() -> Vec<Case> {
    let case = |decades: i32| {
        let mut parameters = usual();
        let materials = &mut parameters.materials;
        materials.pin_primary.youngs_modulus = 1e12;
        materials.pin_secondary.youngs_modulus = 1e12 * 10.0_f64.powi(-decades);
        case(format!("build-up softer than fibre by 1e{decades}"), parameters)
    };
    [0, 2, 4, 6, 8, 10, 12, 14, 16, 20].map(case).to_vec()
}

/// Resin up to twenty decades softer than the fibre that stands back behind it, and that touching hardly wears.
fn resin() -> Vec<Case> {
    let case = |decades: i32, formation: bool| {
        let mut parameters = usual();
        let materials = &mut parameters.materials;
        materials.pin_primary.youngs_modulus = 1e12;
        materials.pin_secondary = materials.pin_primary;
        materials.disc_secondary = materials.disc_primary;
        materials.pin_resin.youngs_modulus = 1e12 * 10.0_f64.powi(-decades);
        materials.wear_height = 1e-12;
        parameters.plateaus.formation = formation;
        let without = if formation { "" } else { ", no formation" };
        case(format!("resin softer than fibre by 1e{decades}{without}"), parameters)
    };
    (0..=20).step_by(5).flat_map(|decades| [case(decades, true), case(decades, false)]).collect()
}

/// Rings of which a step moves more than any of a laboratory.
fn sizes() -> Vec<Case> {
    let case = |outer: f64, wear_height: f64| {
        let mut parameters = usual();
        parameters.mesh = Mesh::new(12, 4, 3, 0.5 * outer, outer).expect("a mesh");
        parameters.normal_force = 1.47e6 * parameters.mesh.pin_area();
        parameters.materials.wear_height = wear_height;
        case(format!("a ring of {} to {outer} m, a wear height of {wear_height:e} m", 0.5 * outer), parameters)
    };
    [(2.0, 2e-4), (2e3, 2e-4), (2e9, 1e-6)].map(|(outer, wear_height)| case(outer, wear_height)).to_vec()
}

/// Loads over twenty decades, of the cells and materials of the paper.
fn loads() -> Vec<Case> {
    let case = |decades: i32| {
        let normal_force = 10.0_f64.powi(decades);
        case(format!("load of 1e{decades} N"), Parameters { normal_force, ..usual() })
    };
    (-9..=11).step_by(4).map(case).collect()
}

/// A cycle whose first load is a small part of its largest.
fn first_loads() -> Vec<Case> {
    let case = |decades: i32| {
        let mut parameters = usual();
        let (speed, step) = (parameters.angular_velocity, parameters.step_time());
        let load = |part: f64| parameters.normal_force * part;
        let first = load(10.0_f64.powi(-decades));
        let node = |steps: f64, force| Node::new(steps * step, force, speed);
        let nodes =
            [node(0.0, first), node(30.0, load(1.0)), node(60.0, first), node(90.0, load(1.0)), node(200.0, load(1.0))];
        parameters.cycle = Some(Arc::new(Cycle::new(&nodes, Interpolation::Hold, 1).expect("a cycle")));
        case(format!("a cycle whose first load is 1e-{decades} of its largest"), parameters)
    };
    [3, 6, 9].map(case).to_vec()
}

/// Stiffness numbers over twenty decades; and build-up of the disc that wears off at once, whatever the pin does.
fn wear() -> Vec<Case> {
    let number = |decades: i32| {
        let parameters = with_stiffness_number(usual(), 10.0_f64.powi(decades), Integrator::Exponential);
        case(format!("Π = 1e{decades}"), parameters)
    };
    let disc = |decades: i32| {
        let mut parameters = usual();
        parameters.materials.disc_secondary.specific_wear_rate = 10.0_f64.powi(decades);
        case(format!("build-up of the disc wears by 1e{decades}/Pa"), parameters)
    };
    let tiny = |decades: i32| {
        let mut parameters = usual();
        parameters.materials.pin_primary.specific_wear_rate = 10.0_f64.powi(decades);
        parameters.materials.pin_secondary = parameters.materials.pin_primary;
        parameters.materials.disc_secondary = parameters.materials.disc_primary;
        case(format!("the pin wears by 1e{decades}/Pa"), parameters)
    };
    let tiny = [-60, -35, -24].map(tiny);
    [tiny.to_vec(), (-12..=8).step_by(4).map(number).collect::<Vec<_>>(), (-24..=-4).step_by(4).map(disc).collect()]
        .concat()
}
