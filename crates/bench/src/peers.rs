//! The same step in Python, as loops that Numba compiles, in a process that is told what to do line by line: timed beside ours after it has
//! been found to compute the same.

use std::error::Error;
use std::fmt::Display;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Duration;

use plateau_core::engine::parts::Needs;
use plateau_core::model::material::Material;
use plateau_core::model::parameters::{DebrisRule, Integrator, Parameters};
use plateau_core::observe::{Map, MapValues};
use plateau_core::simulation::Simulation;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::case::{Case, repository};
use crate::race::{Entry, Runner, race};
use crate::steps::{Found, alone};
use crate::{Outcome, Session, of_file};

/// Name of the peer.
const PEER: &str = "Numba loops";
/// Largest accepted difference over the largest value.
const TOLERANCE: f64 = 1e-10;

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
    let fast = Reference::new(session.source.with([FAST.to_owned()]).case()?, EXACT)?;
    let case = session.source.case()?;
    let exact = Reference::new(case.clone(), EXACT)?;
    let scene = Reference::new(case, TIMED)?;
    let python = python()?;
    let start = |reference: &Reference| Peer::start(&python, reference.folder.path());

    let mut agreements = Vec::new();
    for reference in [&fast, &exact] {
        agreements.push(reference.agreement(&mut start(reference)?)?);
    }
    // What is timed has made as many steps as ours.
    let mut peer = start(&scene)?;
    peer.trace(scene.steps)?;
    let ours = Entry { name: "Plateau".into(), against: 0, mesh, workers: 1, runner: Box::new(scene.simulation) };
    let theirs = Entry { name: PEER.into(), against: 0, mesh, workers: 1, runner: Box::new(peer) };
    Ok((race(vec![ours, theirs], session.pace)?, agreements))
}

/// Our simulation from the start on, with which the peer is compared.
struct Reference {
    /// Folder where the peer finds the surfaces, and puts its own.
    folder: TempDir,
    case: Case,
    steps: usize,
    trace: Trace,
    /// Of disc and pin after the last step.
    heights: Vec<f64>,
    /// It, after the last step.
    simulation: Simulation,
}

impl Reference {
    fn new(case: Case, load_tolerance: f64) -> Outcome<Self> {
        let folder = tempfile::tempdir()?;
        export(&case, load_tolerance, folder.path())?;
        let mut simulation = alone(&case)?;
        // More than a revolution, so that the pin meets columns that it has been on before.
        let steps = case.parameters.mesh.disc_columns() + case.parameters.mesh.pin_columns();
        let mut trace = Trace::default();
        for step in 1..=steps as u64 {
            simulation.advance_to(step)?;
            let sample = simulation.sample()?;
            trace.displacement.push(sample.displacement);
            trace.contact_area.push(sample.contact_area);
            trace.deposited.push(sample.deposited_pin + sample.deposited_disc);
        }
        let maps = simulation.snapshot(&[Map::DiscHeight, Map::PinHeight])?.maps;
        let heights = maps.into_iter().filter_map(|(_, values)| match values {
            MapValues::Float(heights) => Some(heights),
            MapValues::Status(_) => None,
        });
        let heights = heights.flatten().collect();
        Ok(Self { folder, case, steps, trace, heights, simulation })
    }

    /// Compares the peer's first steps with ours, in a sentence.
    fn agreement(&self, peer: &mut Peer) -> Outcome<String> {
        let (steps, acceleration) = (self.steps, self.case.parameters.time_acceleration);
        eprintln!("comparing {steps} steps with time acceleration {acceleration}: {PEER}");
        let (ours, theirs) = (&self.trace, peer.trace(steps)?);
        let heights = peer.heights(self.folder.path())?.concat();
        let pairs = [
            ("displacement", &ours.displacement, &theirs.displacement),
            ("contact area", &ours.contact_area, &theirs.contact_area),
            ("deposited volume", &ours.deposited, &theirs.deposited),
            ("heights", &self.heights, &heights),
        ];
        let mut differences = Vec::new();
        for (quantity, ours, theirs) in pairs {
            let difference = compare(quantity, ours, theirs)?;
            if ours.iter().any(|value| *value != 0.0) {
                differences.push(format!("{quantity} {difference:.0e}"));
            }
        }
        let differences = differences.join(", ");
        Ok(format!(
            "{PEER} ({}) over {steps} steps at time acceleration {acceleration}: largest difference from ours over the largest value: \
             {differences}.",
            peer.versions
        ))
    }
}

/// Largest difference over the largest value.
fn compare(quantity: &str, ours: &[f64], theirs: &[f64]) -> Outcome<f64> {
    if ours.len() != theirs.len() {
        return Err(format!("{PEER}: found {} values of {quantity}, expected {}", theirs.len(), ours.len()).into());
    }
    let largest = ours.iter().fold(f64::MIN_POSITIVE, |largest, value| largest.max(value.abs()));
    let mut difference = 0.0_f64;
    for (index, (ours, theirs)) in ours.iter().zip(theirs).enumerate() {
        let relative = (ours - theirs).abs() / largest;
        // Not a number is no agreement either.
        if relative.is_nan() || relative > TOLERANCE {
            let differ = format!(
                "{PEER}: {quantity} {index} is {theirs:e} and ours {ours:e}, which differ by more than {TOLERANCE:e} of the largest \
                 value; their times cannot be compared"
            );
            return Err(differ.into());
        }
        difference = difference.max(relative);
    }
    Ok(difference)
}

/// The process.
#[derive(Debug)]
pub struct Peer {
    /// Versions of Python and its packages.
    pub versions: String,
    child: Child,
    requests: Option<ChildStdin>,
    answers: BufReader<ChildStdout>,
    load_evaluations_per_step: Option<f64>,
    steps: u64,
}

#[derive(Deserialize)]
struct Greeting {
    versions: String,
}

#[derive(Deserialize)]
struct Advanced {
    seconds: f64,
    evaluations: u64,
}

/// What a simulation did, step by step.
#[derive(Debug, Default, Deserialize)]
pub struct Trace {
    /// δ after every step, m.
    pub displacement: Vec<f64>,
    /// Contact area of every step, m².
    pub contact_area: Vec<f64>,
    /// Debris compacted until after every step, m³.
    pub deposited: Vec<f64>,
}

#[derive(Deserialize)]
struct Nothing {}

impl Peer {
    /// Starts `python step.py DIRECTORY`.
    pub fn start(python: &Path, directory: &Path) -> Outcome<Self> {
        let program = repository().join("crates/bench/peers/step.py");
        let mut command = Command::new(python);
        command.arg("-B").arg(program).arg(directory).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().map_err(of_file(python))?;
        let (requests, answers) = (child.stdin.take(), child.stdout.take());
        let answers = answers.ok_or_else(|| problem("it has no standard output"))?;
        let (versions, answers) = (String::new(), BufReader::new(answers));
        let mut peer = Self { versions, child, requests, answers, load_evaluations_per_step: None, steps: 0 };
        peer.versions = peer.answer::<Greeting>()?.versions;
        Ok(peer)
    }

    /// What happens in the next steps.
    pub fn trace(&mut self, steps: usize) -> Outcome<Trace> {
        self.steps += steps as u64;
        self.ask(&json!({"do": "trace", "steps": steps}))
    }

    /// Heights of disc and pin as they are now.
    pub fn heights(&mut self, directory: &Path) -> Outcome<[Vec<f64>; 2]> {
        self.ask::<Nothing>(&json!({"do": "write"}))?;
        let read = |name| -> Outcome<Vec<f64>> {
            let path = directory.join(name);
            let bytes = fs::read(&path).map_err(of_file(&path))?;
            Ok(bytes.as_chunks::<8>().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect())
        };
        Ok([read("disc_height_after.f64")?, read("pin_height_after.f64")?])
    }

    fn ask<A: DeserializeOwned>(&mut self, request: &Value) -> Outcome<A> {
        let requests = self.requests.as_mut().ok_or_else(|| problem("it has no standard input"))?;
        writeln!(requests, "{request}").map_err(problem)?;
        self.answer()
    }

    fn answer<A: DeserializeOwned>(&mut self) -> Outcome<A> {
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
        let advanced: Advanced = self.ask(&json!({"do": "advance", "steps": steps}))?;
        self.steps += steps;
        self.load_evaluations_per_step = Some(advanced.evaluations as f64 / self.steps as f64);
        Ok(Duration::from_secs_f64(advanced.seconds))
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
pub fn python() -> Outcome<PathBuf> {
    let script = repository().join("scripts/peers.sh");
    let output = Command::new("sh").arg(&script).stderr(Stdio::inherit()).output().map_err(of_file(&script))?;
    if !output.status.success() {
        return Err(problem("no environment with Numba can be had, see above"));
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim_end().into())
}

/// Writes a case as step.py reads it, with the load tolerance of its solver.
pub fn export(case: &Case, load_tolerance: f64, directory: &Path) -> Outcome<()> {
    let Case { parameters, surfaces, .. } = case;
    supported(parameters)?;
    let Parameters { mesh, materials, plateaus, .. } = parameters;
    let body = |material: &Material| json!({"youngs_modulus": material.youngs_modulus, "poisson_ratio": material.poisson_ratio});
    let half_width = 0.5 * mesh.row_height() * mesh.rows() as f64;
    let scene = json!({
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
    });
    let write = |name: &str, bytes: &[u8]| {
        let path = directory.join(name);
        fs::write(&path, bytes).map_err(of_file(&path))
    };
    let raw = |heights: &[f64]| heights.iter().flat_map(|height| height.to_le_bytes()).collect::<Vec<u8>>();
    write("scene.json", scene.to_string().as_bytes())?;
    write("disc_height.f64", &raw(&surfaces.disc_height))?;
    write("pin_height.f64", &raw(&surfaces.pin_height))?;
    Ok(write("pin_base.u8", &surfaces.pin_base.iter().map(|base| *base as u8).collect::<Vec<_>>())?)
}

/// The peer does what the paper's scene needs, and nothing else.
fn supported(parameters: &Parameters) -> Outcome<()> {
    let Needs { distinct, breaks, disc_wears, forms, transport, .. } = Needs::of(parameters);
    let rules = &parameters.plateaus;
    let unsupported = [
        (distinct, "materials of their own for build-ups"),
        (breaks, "a strength of build-up"),
        (disc_wears, "wear of the disc"),
        (!forms, "no formation"),
        (rules.debris != DebrisRule::Local, "pooled debris"),
        (transport.is_some(), "a transport length"),
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
