//! The same step in Python, as loops that Numba compiles.

mod process;

use std::path::Path;

use plateau_core::model::parameters::DebrisRule;
use plateau_core::observe::{Map, MapValues};
use tempfile::TempDir;

use crate::case::Case;
use crate::document::{Agreement, Benchmark};
use crate::error::BenchError;
use crate::race::{Entry, race};
use crate::session::{Options, Session};
use crate::stepper::{Setup, Stepper};
use process::{Peer, Trace, export, python};

/// What the peer is called.
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
pub fn peers(options: Options) -> Result<Session, BenchError> {
    let mut session = options.begin(Benchmark::Peers)?;
    let mesh = session.mesh;
    if session.source.worn_in > 0.0 {
        return Err(BenchError::NotForPeers("surfaces that have worn in"));
    }
    // A scene that the peer does not compute is refused before anything is installed for it.
    let fast = Reference::new(&session.source.with([FAST.to_owned()]).case()?, EXACT)?;
    let case = session.source.case()?;
    let exact = Reference::new(&case, EXACT)?;
    let scene = Reference::new(&case, TIMED)?;
    let python = python()?;

    for reference in [&fast, &exact] {
        session.document.agreements.push(reference.agreement(&mut reference.start(&python)?)?);
    }
    // What is timed has made as many steps as ours.
    let mut peer = scene.start(&python)?;
    peer.trace(scene.steps)?;

    let setup = Setup::of(1);
    let entry = |name: &str, instructions: &str, runner| {
        let (name, instructions) = (name.to_owned(), instructions.to_owned());
        Entry { name, mesh, workers: 1, instructions, runner }
    };
    let ours = entry("Plateau", setup.instructions.name(), Box::new(scene.simulation));
    let entries = vec![ours, entry(PEER, "its own", Box::new(peer))];
    session.document.measurements = race(entries, session.pace)?;
    Ok(session)
}

/// What our simulation does from the start on, with which the peer is compared.
struct Reference {
    /// Where the peer finds the surfaces, and puts its own.
    folder: TempDir,
    time_acceleration: f64,
    has_pool: bool,
    steps: usize,
    trace: Trace,
    /// Of disc and pin after the last step.
    heights: Vec<f64>,
    /// It, after the last step.
    simulation: Stepper,
}

impl Reference {
    fn new(case: &Case, load_tolerance: f64) -> Result<Self, BenchError> {
        let folder = tempfile::tempdir().map_err(BenchError::file(Path::new("a temporary directory")))?;
        export(case, load_tolerance, folder.path())?;
        let mut simulation = Stepper::new(case, Setup::of(1))?;
        // More than a revolution, so that the pin meets columns that it has been on before.
        let steps = case.parameters.mesh.disc_columns() + case.parameters.mesh.pin_columns();
        let mut trace = Trace::default();
        for _ in 0..steps {
            simulation.run(1)?;
            let sample = simulation.sample()?;
            trace.displacement.push(sample.displacement);
            trace.contact_area.push(sample.contact_area);
            trace.pool.push(sample.pool);
            trace.deposited.push(sample.deposited_pin + sample.deposited_disc);
        }
        let maps = simulation.snapshot(&[Map::DiscHeight, Map::PinHeight])?.maps;
        let heights = maps.into_iter().filter_map(|(_, values)| match values {
            MapValues::Float(heights) => Some(heights),
            MapValues::Status(_) => None,
        });
        let heights = heights.flatten().collect();
        let time_acceleration = case.parameters.time_acceleration;
        let has_pool = case.parameters.plateaus.debris != DebrisRule::Local;
        Ok(Self { folder, time_acceleration, has_pool, steps, trace, heights, simulation })
    }

    fn start(&self, python: &Path) -> Result<Peer, BenchError> {
        Peer::start(python, self.folder.path())
    }

    /// Compares the peer's first steps with ours.
    fn agreement(&self, peer: &mut Peer) -> Result<Agreement, BenchError> {
        let Self { steps, time_acceleration, .. } = *self;
        eprintln!("comparing {steps} steps with time acceleration {time_acceleration}: {PEER}");
        let theirs = peer.trace(steps)?;
        // Without a pool both must stay at 0, which is no figure to report.
        let pool = compare("debris pool", &self.trace.pool, &theirs.pool)?;
        Ok(Agreement {
            peer: PEER.into(),
            versions: peer.versions.clone(),
            time_acceleration,
            steps,
            displacement: compare("displacement", &self.trace.displacement, &theirs.displacement)?,
            contact_area: compare("contact area", &self.trace.contact_area, &theirs.contact_area)?,
            pool: self.has_pool.then_some(pool),
            deposited: Some(compare("deposited volume", &self.trace.deposited, &theirs.deposited)?),
            heights: compare("height", &self.heights, &peer.heights(self.folder.path())?.concat())?,
        })
    }
}

/// Largest difference over the largest value.
fn compare(quantity: &'static str, ours: &[f64], theirs: &[f64]) -> Result<f64, BenchError> {
    if ours.len() != theirs.len() {
        let problem = format!("found {} values of {quantity}, expected {}", theirs.len(), ours.len());
        return Err(BenchError::Peer { problem });
    }
    let largest = ours.iter().fold(f64::MIN_POSITIVE, |largest, value| largest.max(value.abs()));
    let mut difference = 0.0_f64;
    for (index, (ours, theirs)) in ours.iter().zip(theirs).enumerate() {
        let relative = (ours - theirs).abs() / largest;
        // Not a number is no agreement either.
        if relative.is_nan() || relative > TOLERANCE {
            let (ours, theirs, tolerance) = (*ours, *theirs, TOLERANCE);
            return Err(BenchError::Disagreement { quantity, index, theirs, ours, tolerance });
        }
        difference = difference.max(relative);
    }
    Ok(difference)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_is_told_from_something_else() {
        assert_eq!(compare("pool", &[1.0, -4.0], &[1.0, -4.0]).unwrap(), 0.0);
        assert_eq!(compare("pool", &[0.0, 4.0], &[4e-10, 4.0]).unwrap(), 1e-10);
        for theirs in [&[1.0, 4.0 + 1e-8][..], &[1.0, f64::NAN], &[1.0]] {
            assert!(compare("pool", &[1.0, 4.0], theirs).is_err(), "{theirs:?}");
        }
    }
}
