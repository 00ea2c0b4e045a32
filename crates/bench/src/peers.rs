//! The same step in Python, as loops that Numba compiles, in a process that is told what to do line by line: timed beside ours after it has
//! found that it computes the same.

use std::error::Error;
use std::fmt::Display;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Duration;

use plateau_core::engine::parts::Needs;
use plateau_core::model::material::Material;
use plateau_core::model::parameters::{DebrisRule, Integrator, Parameters};
use plateau_core::model::state::Base;
use plateau_core::observe::Map;
use plateau_core::simulation::Simulation;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use crate::case::{Case, Outcome, of_file, repository};
use crate::race::{Entry, Runner, Session, race};
use crate::steps::{Found, alone};

/// Name of the peer.
const PEER: &str = "Numba loops";

/// Time acceleration of a second comparison: build-ups are worn through in a step, which hardly happens at 1.
const FAST: &str = "numerics.time_acceleration=1000";

/// Load tolerance of the peer's solver where its time is taken, and of the comparisons: ours is solved exactly, and an error of
/// its own decides which clearances are filled.
const TIMED: f64 = 1e-9;
const EXACT: f64 = 1e-14;

/// Checks that the peer computes the same, and times both.
pub fn peers(session: &Session) -> Outcome<Found> {
    let mesh = session.mesh;
    if session.source.worn_in > 0.0 {
        return Err(
            "the step in Python starts from the surfaces of the scene; --worn-in asks for surfaces that have worn in"
                .into(),
        );
    }
    // A scene that the peer does not compute is refused before anything is installed for it.
    let fast = Reference::new(session.source.with([FAST.to_owned()]).case()?)?;
    let scene = Reference::new(session.source.case()?)?;
    let python = python()?;

    let agreements = vec![fast.agreement(&python)?, scene.agreement(&python)?];
    let (mut peer, _) = Peer::start(&python, &json!({"scene": exported(&scene.case, TIMED), "ours": []}))?;
    // What is timed has made as many steps as ours.
    peer.advance(scene.steps)?;
    let ours = Entry { name: "Plateau".into(), against: 0, mesh, workers: 1, runner: Box::new(scene.simulation) };
    let theirs = Entry { name: PEER.into(), against: 0, mesh, workers: 1, runner: Box::new(peer) };
    Ok((race(vec![ours, theirs], session.pace)?, agreements))
}

/// Our simulation from the start on, with which the peer is compared.
struct Reference {
    case: Case,
    steps: u64,
    /// Displacement (m), contact area (m²) and deposited volume (m³) after every step, and heights (m) after the last, each with its name.
    found: Value,
    /// Simulation after the last step.
    simulation: Simulation,
}

impl Reference {
    fn new(case: Case) -> Outcome<Self> {
        refuse_unsupported(&case.parameters)?;
        let mut simulation = alone(&case)?;
        // More than a revolution, so that the pin meets columns that it has been on before.
        let steps = (case.parameters.mesh.disc_columns() + case.parameters.mesh.pin_columns()) as u64;
        let (mut displacement, mut contact_area, mut deposited) = (Vec::new(), Vec::new(), Vec::new());
        for step in 1..=steps {
            simulation.advance_to(step)?;
            let sample = simulation.sample()?;
            displacement.push(sample.displacement);
            contact_area.push(sample.contact_area);
            deposited.push(sample.deposited_pin + sample.deposited_disc);
        }
        let maps = simulation.snapshot(&[Map::DiscHeight, Map::PinHeight])?.maps;
        let heights: Vec<f64> = maps.into_iter().flat_map(|(_, values)| values.into_numbers()).collect();
        let found = json!([
            ["displacement", displacement],
            ["contact area", contact_area],
            ["deposited volume", deposited],
            ["heights", heights],
        ]);
        Ok(Self { case, steps, found, simulation })
    }

    /// Has the peer compare its first steps with ours, in a sentence.
    fn agreement(&self, python: &Path) -> Outcome<String> {
        let (steps, acceleration) = (self.steps, self.case.parameters.time_acceleration);
        eprintln!("comparing {steps} steps with time acceleration {acceleration}: {PEER}");
        let document = json!({"scene": exported(&self.case, EXACT), "ours": self.found});
        let (_, Agreement { versions, differences }) = Peer::start(python, &document)?;
        let differences = differences.iter().map(|(quantity, difference)| format!("{quantity} {difference:.0e}"));
        Ok(format!(
            "{PEER} ({versions}) over {steps} steps at time acceleration {acceleration}: largest difference from ours over the largest \
             value: {}.",
            differences.collect::<Vec<_>>().join(", ")
        ))
    }
}

/// Process of the peer.
struct Peer {
    child: Child,
    requests: Option<ChildStdin>,
    answers: BufReader<ChildStdout>,
    load_evaluations_per_step: Option<f64>,
}

/// Differences of the peer's steps from ours.
#[derive(Deserialize)]
struct Agreement {
    /// Versions of Python and its packages.
    versions: String,
    /// Largest difference over the largest value of each quantity.
    differences: Vec<(String, f64)>,
}

#[derive(Deserialize)]
struct Advanced {
    seconds: f64,
    evaluations: f64,
}

impl Peer {
    /// Starts `python step.py` with a case, of which it makes as many steps as it is given results of ours.
    fn start(python: &Path, case: &Value) -> Outcome<(Self, Agreement)> {
        let program = repository().join("crates/bench/peers/step.py");
        let mut command = Command::new(python);
        command.arg("-B").arg(program).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().map_err(of_file(python))?;
        let (requests, answers) = (child.stdin.take(), child.stdout.take());
        let answers = BufReader::new(answers.ok_or_else(|| problem("it has no standard output"))?);
        let mut peer = Self { child, requests, answers, load_evaluations_per_step: None };
        let agreement = peer.ask(case)?;
        Ok((peer, agreement))
    }

    fn ask<A: DeserializeOwned>(&mut self, request: impl Display) -> Outcome<A> {
        let requests = self.requests.as_mut().ok_or_else(|| problem("it has no standard input"))?;
        writeln!(requests, "{request}").map_err(problem)?;
        let mut line = String::new();
        match self.answers.read_line(&mut line) {
            Ok(0) => Err(problem("it ended, see above")),
            Ok(_) => serde_json::from_str(&line).map_err(|error| problem(format!("{error} in {line:?}"))),
            Err(error) => Err(problem(error)),
        }
    }
}

impl Runner for Peer {
    fn advance(&mut self, steps: u64) -> Outcome<Duration> {
        let Advanced { seconds, evaluations } = self.ask(steps)?;
        self.load_evaluations_per_step = Some(evaluations);
        Ok(Duration::from_secs_f64(seconds))
    }

    fn load_evaluations_per_step(&self) -> Option<f64> {
        self.load_evaluations_per_step
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        // The end of its input is the end of its work. Whether it ended well no longer matters.
        self.requests = None;
        let _ = self.child.wait();
    }
}

fn problem(problem: impl Display) -> Box<dyn Error> {
    format!("the step in Python: {problem}").into()
}

/// A Python with Numba; installs it if need be.
fn python() -> Outcome<PathBuf> {
    let script = repository().join("scripts/peers.sh");
    let output = Command::new("sh").arg(&script).stderr(Stdio::inherit()).output().map_err(of_file(&script))?;
    if !output.status.success() {
        return Err(problem("no environment with Numba can be had, see above"));
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim_end().into())
}

/// A case as step.py reads it, with the load tolerance of its solver.
fn exported(Case { parameters, surfaces, .. }: &Case, load_tolerance: f64) -> Value {
    let Parameters { mesh, materials, plateaus, .. } = parameters;
    let body = |material: &Material| json!({"youngs_modulus": material.youngs_modulus, "poisson_ratio": material.poisson_ratio});
    let half_width = 0.5 * mesh.row_height() * mesh.rows() as f64;
    json!({
        "rows": mesh.rows(),
        "pin_columns": mesh.pin_columns(),
        "disc_columns": mesh.disc_columns(),
        "inner_radius": mesh.mean_radius() - half_width,
        "outer_radius": mesh.mean_radius() + half_width,
        "foundation_height": parameters.foundation_height,
        "disc": body(&materials.disc_primary),
        "fibre": body(&materials.pin_primary),
        "resin": body(&materials.pin_resin),
        "wear_rate": materials.pin_primary.specific_wear_rate,
        "wear_height": materials.wear_height,
        "normal_force": parameters.normal_force,
        "load_tolerance": load_tolerance,
        "time_acceleration": parameters.time_acceleration,
        "captured_fraction": plateaus.captured_fraction,
        "disc_height": surfaces.disc_height,
        "pin_height": surfaces.pin_height,
        "pin_is_fibre": surfaces.pin_base.iter().map(|base| *base == Base::Primary).collect::<Vec<_>>(),
    })
}

/// The peer does what the paper's scene needs, and nothing else.
fn refuse_unsupported(parameters: &Parameters) -> Outcome<()> {
    let Needs { distinct, breaks, disc_wears, forms, transport, .. } = Needs::of(parameters);
    let rules = &parameters.plateaus;
    let unsupported = [
        (distinct, "materials of their own for build-ups"),
        (breaks, "a strength of build-up"),
        (disc_wears, "wear of the disc"),
        (!forms, "no formation"),
        (rules.debris != DebrisRule::Local, "pooled debris"),
        (transport.is_some(), "a transport length"),
        (!parameters.mesh.is_rectangle(), "a round pin"),
        (rules.captured_of_resin() != rules.captured_fraction, "a captured fraction of its own for resin"),
        (parameters.integrator != Integrator::Explicit, "exponential wear"),
    ];
    match unsupported.into_iter().find(|(asked, _)| *asked) {
        Some((_, what)) => Err(format!(
            "the step in Python has explicit wear of the pin on a disc that does not wear, build-ups as what they lie on, and local \
             debris; the scene asks for {what}"
        )
        .into()),
        None => Ok(()),
    }
}
