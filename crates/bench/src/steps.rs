//! Benchmarks of a step: by instruction set and workers, by size of the mesh, and with optional parts on and off.

use std::time::{Duration, Instant};

use plateau_core::engine::kernel::InstructionSet;
use plateau_core::observe::Map;
use plateau_core::simulation::{Decomposition, Exchange, Execution, Simulation};

use crate::case::{Case, MeshSize, Outcome, Source};
use crate::race::{Entry, Measurement, Runner, Session, race};

/// Times of a benchmark, and sentences on agreement with a peer.
pub type Found = (Vec<Measurement>, Vec<String>);

/// A hundredth of the wear rate of the pin.
const DISC_WEAR: &str = "materials.disc_primary.specific_wear_rate=\"5e-16 1/Pa\"";
/// Half the modulus of the fibres.
const SOFTER_DEBRIS: &str = "materials.pin_secondary.youngs_modulus=\"5e8 Pa\"";
/// Twice the wear rate of the fibres.
const FASTER_DEBRIS: &str = "materials.pin_secondary.specific_wear_rate=\"1e-13 1/Pa\"";

/// Times a step for every instruction set and number of workers.
pub fn kernel(session: &Session) -> Outcome<Found> {
    let case = session.source.case()?;
    let mut entries = Vec::new();
    for workers in &session.workers {
        for instructions in InstructionSet::available() {
            let execution = Execution { workers: *workers, instructions, ..Execution::default() };
            // Several workers with one that has the same instructions, and these with the first.
            let alone = entries.iter().position(|entry: &Entry| entry.name == instructions.name());
            let simulation = simulation(&case, execution)?;
            entries.push(entry(instructions.name(), alone.unwrap_or(0), session.mesh, *workers, simulation));
        }
    }
    Ok((race(entries, session.pace)?, Vec::new()))
}

/// Times a step for every number of workers, with either decomposition, on meshes of several sizes.
///
/// Strong scaling: every number of workers on every mesh, compared with one worker; one worker on larger meshes, compared with the
/// first. Weak scaling: W workers on a mesh whose pin and ring have W times the columns, so that every worker has as many cells as
/// one has on the first mesh.
pub fn scaling(session: &Session) -> Outcome<Found> {
    let grown = [1, 2, 4].map(|factor| session.mesh.times(factor));
    let meshes = if session.quick { grown[..2].to_vec() } else { [&grown[..], &[MeshSize::FULL_PAD]].concat() };
    let mut entries = Vec::new();
    for mesh in meshes {
        let (case, alone) = (session.source.on(mesh)?.case()?, entries.len());
        for (name, execution) in session.workers.iter().flat_map(|workers| ways("strong", *workers)) {
            let against = if execution.workers == session.workers[0] { 0 } else { alone };
            entries.push(entry(&name, against, mesh, execution.workers, simulation(&case, execution)?));
        }
    }
    for workers in session.workers.iter().filter(|workers| **workers > 1) {
        let mesh = session.mesh.longer(*workers);
        let case = session.source.on(mesh)?.case()?;
        for (name, execution) in ways("weak", *workers) {
            entries.push(entry(&name, 0, mesh, *workers, simulation(&case, execution)?));
        }
    }
    Ok((race(entries, session.pace)?, Vec::new()))
}

/// The decompositions for so many workers, with a name for each.
fn ways(scaling: &str, workers: usize) -> Vec<(String, Execution)> {
    if workers == 1 {
        return vec![(scaling.to_owned(), execution(1))];
    }
    [(Decomposition::Sectors, "sectors"), (Decomposition::Bands, "bands")]
        .map(|(decomposition, way)| (format!("{scaling}, {way}"), Execution { decomposition, ..execution(workers) }))
        .to_vec()
}

fn entry(name: &str, against: usize, mesh: MeshSize, workers: usize, simulation: Simulation) -> Entry {
    Entry { name: name.to_owned(), against, mesh, workers, runner: Box::new(simulation) }
}

/// Makes an execution by so many workers with the widest instruction set.
fn execution(workers: usize) -> Execution {
    Execution { workers, instructions: InstructionSet::best(), ..Execution::default() }
}

/// A case at its start.
fn simulation(case: &Case, execution: Execution) -> Outcome<Simulation> {
    let mut simulation = Simulation::with_execution(case.parameters.clone(), case.surfaces.clone(), execution)?;
    if let Some(start) = &case.start {
        simulation.restore(start)?;
    }
    Ok(simulation)
}

/// Makes the simulation of a case at its start, with one worker.
pub fn alone(case: &Case) -> Outcome<Simulation> {
    simulation(case, execution(1))
}

impl Runner for Simulation {
    fn advance(&mut self, steps: u64) -> Outcome<Duration> {
        let end = self.steps_done() + steps;
        let start = Instant::now();
        self.pass_to(end)?;
        Ok(start.elapsed())
    }

    fn load_evaluations_per_step(&self) -> Option<f64> {
        let course = self.course();
        (course.steps > 0).then(|| 1.0 + course.extra_readings as f64 / course.steps as f64)
    }

    fn exchanges(&self) -> Vec<Exchange> {
        self.exchanges()
    }
}

/// Name of the scene without changes, with which the others are compared.
const THE_SCENE: &str = "the scene";

/// Changes of the scene that switch one part on or off, with their names.
///
/// The first, none, takes part twice, so that the difference of a scene from itself shows what can be told apart.
const VARIANTS: [(&str, &[&str]); 13] = [
    (THE_SCENE, &[]),
    ("the scene once more", &[]),
    ("no formation", &["plateaus.formation=false"]),
    ("no resin", &["pin.base.uniform=primary"]),
    ("wear of fibres alone", &["plateaus.formation=false", "pin.base.uniform=primary"]),
    ("exponential wear", &["numerics.integrator=exponential"]),
    ("transport length of 200 um", &["plateaus.transport_length=\"200 um\""]),
    ("strength of build-up", &["materials.pin_secondary.strength=\"5 MPa\""]),
    ("wear by counterface", &["materials.pin_primary.wear_rate_against_secondary=\"2e-14 1/Pa\""]),
    ("wear of the disc", &[DISC_WEAR]),
    ("materials of their own for build-ups", &[SOFTER_DEBRIS, FASTER_DEBRIS]),
    ("wear of the disc and such materials", &[DISC_WEAR, SOFTER_DEBRIS, FASTER_DEBRIS]),
    ("time acceleration 100", &["numerics.time_acceleration=100"]),
];

/// The friction law of `cermet-hot.toml`.
const FRICTION: &str = "friction={ pressure_coefficient = 0.33, shear_strength = \"0.75 MPa\", maximum = 0.6 }";
/// Bodies of `cermet-hot.toml`, without the coating.
const HEAT: &str = "thermal={ ambient = \"23 degC\", \
    disc = { conductivity = \"50 W/(m K)\", density = \"7200 kg/m^3\", specific_heat = \"500 J/(kg K)\", area = \"31 cm^2\", \
    thickness = \"6 mm\", cooling = \"0.4 W/K\", cooling_per_speed = \"1 mJ/(K rad)\" }, \
    pin = { conductivity = \"1.5 W/(m K)\", density = \"2600 kg/m^3\", specific_heat = \"900 J/(kg K)\", area = \"78.5 mm^2\", \
    length = \"12 mm\", cooling = \"0.02 W/K\" } }";

/// Friction, and what needs it: its name, that of what it is compared with, and changes of the scene.
fn with_friction(source: &Source) -> Outcome<[(&'static str, &'static str, Vec<String>); 4]> {
    let parameters = source.parameters()?;
    let (force, speed) = (parameters.normal_force, parameters.angular_velocity);
    let row = |time: f64, load: &str| format!("[\"{time} s\", \"{load}\", \"{speed} rad/s\"]");
    // About the load of the scene, at a coefficient of friction of 0.5. As a cycle, for a changed mesh sets the force.
    let torque = format!("{} N m", 0.5 * force * parameters.mesh.mean_radius());
    let torque = format!("operation.cycle={{ points = [{}, {}] }}", row(0.0, &torque), row(1e5, &torque));
    // Several pauses in every block of steps.
    let (force, active) = (format!("{force} N"), 10.0 * parameters.step_time());
    let rows = [row(0.0, &force), row(active, &force), row(active, "0 N"), row(active + 0.1, "0 N")].join(", ");
    let pauses = format!("operation.cycle={{ points = [{rows}], repeat = 100000 }}");
    let [friction, heat] = [FRICTION, HEAT].map(str::to_owned);
    Ok([
        ("friction", THE_SCENE, vec![friction.clone()]),
        ("braking torque", "friction", vec![friction.clone(), torque]),
        ("heat", "friction", vec![friction.clone(), heat.clone()]),
        ("lifted for 0.1 s after every 10 steps", "heat", vec![friction, heat, pauses]),
    ])
}

/// Times a step with optional parts of the model and of the output on and off.
pub fn parts(session: &Session) -> Outcome<Found> {
    let of_scene = VARIANTS.map(|(name, sets)| (name, THE_SCENE, sets.iter().map(|set| (*set).to_owned()).collect()));
    let mut entries: Vec<Entry> = Vec::new();
    for (name, other, sets) in of_scene.into_iter().chain(with_friction(&session.source)?) {
        let against = entries.iter().position(|entry| entry.name == other).unwrap_or(0);
        entries.push(entry(name, against, session.mesh, 1, alone(&session.source.with(sets).case()?)?));
    }
    let revolution = session.mesh.disc_columns as u64;
    let case = session.source.case()?;
    for (name, every, maps) in [
        ("a sample every revolution", revolution, false),
        ("a sample every step", 1, false),
        ("all maps every revolution", revolution, true),
    ] {
        let runner = Box::new(Observed { simulation: alone(&case)?, every, maps });
        entries.push(Entry { name: name.to_owned(), against: 0, mesh: session.mesh, workers: 1, runner });
    }
    Ok((race(entries, session.pace)?, Vec::new()))
}

/// A simulation that is looked at now and then.
struct Observed {
    simulation: Simulation,
    every: u64,
    maps: bool,
}

impl Runner for Observed {
    fn advance(&mut self, steps: u64) -> Outcome<Duration> {
        let (start, end) = (Instant::now(), self.simulation.steps_done() + steps);
        while self.simulation.steps_done() < end {
            let next = (self.simulation.steps_done() / self.every + 1) * self.every;
            // A step after which something may be reported.
            self.simulation.advance_to(next.min(end))?;
            if next <= end {
                std::hint::black_box(self.simulation.sample()?);
                if self.maps {
                    std::hint::black_box(self.simulation.snapshot(&Map::ALL)?);
                }
            }
        }
        Ok(start.elapsed())
    }

    fn load_evaluations_per_step(&self) -> Option<f64> {
        Runner::load_evaluations_per_step(&self.simulation)
    }
}
