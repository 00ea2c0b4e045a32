//! The same step in Python, as loops that Numba compiles: timed beside ours after it has been found to compute the same.

use plateau_core::observe::{Map, MapValues};
use plateau_core::simulation::Simulation;
use tempfile::TempDir;

use crate::case::Case;
use crate::python::{Peer, Trace, export, python};
use crate::race::{Entry, race};
use crate::steps::{Found, alone};
use crate::{Outcome, Session};

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
