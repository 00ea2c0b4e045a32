//! The same step in Python, as Numba loops and as NumPy arrays.

use std::path::Path;

use plateau_core::observe::{Map, MapValues};
use plateau_core::parameters::DebrisRule;
use tempfile::TempDir;

use crate::case::Case;
use crate::document::{Agreement, Benchmark};
use crate::error::BenchError;
use crate::peer::{Peer, Trace, export, python};
use crate::race::{Entry, race};
use crate::session::Options;
use crate::stepper::{Setup, Stepper};

/// How a peer is called by step.py, and by people.
const PEERS: [(&str, &str); 2] = [("numba", "Numba loops"), ("numpy", "NumPy arrays")];
/// Largest accepted difference over the largest value.
const TOLERANCE: f64 = 1e-10;

/// Time acceleration of a second comparison: build-ups are worn through in a step, which hardly happens at 1.
const FAST: &str = "numerics.time_acceleration=1000";

/// Load tolerance of the comparisons: ours is solved exactly, and an error of theirs decides which clearances are filled.
const EXACT: &str = "contact.load_tolerance=1e-14";

/// Checks that the peers compute the same, measures and reports.
pub fn peers(options: Options) -> Result<(), BenchError> {
    let mut session = options.begin(Benchmark::Peers)?;
    let mesh = session.mesh;
    // A scene that the peers do not compute is refused before anything is installed for it.
    let fast = Reference::new(&session.source.with([FAST, EXACT].map(str::to_owned)).case()?)?;
    let exact = Reference::new(&session.source.with([EXACT.to_owned()]).case()?)?;
    let scene = Reference::new(&session.source.case()?)?;
    let python = python()?;

    let mut peers = Vec::new();
    for (kind, name) in PEERS {
        match fast.start(&python, kind) {
            Err(error) if kind == "numba" => {
                eprintln!("{error}");
                session.document.notes.push("Numba could not be started on this machine.".into());
                continue;
            }
            started => session.document.agreements.push(fast.agreement(&mut started?, name)?),
        }
        session.document.agreements.push(exact.agreement(&mut exact.start(&python, kind)?, name)?);
        // What is timed has made as many steps as ours.
        let mut peer = scene.start(&python, kind)?;
        peer.trace(scene.steps)?;
        peers.push((name, peer));
    }

    let setup = Setup::of(1);
    let entry = |name: &str, instructions: &str, runner| {
        let (name, instructions) = (name.to_owned(), instructions.to_owned());
        Entry { name, mesh, workers: 1, instructions, runner }
    };
    let mut entries = vec![entry("Plateau", setup.instructions.name(), Box::new(scene.simulation))];
    entries.extend(peers.into_iter().map(|(name, peer)| entry(name, "its own", Box::new(peer))));
    session.document.measurements = race(entries, session.pace)?;
    session.finish()
}

/// What our simulation does from the start on, with which the peers are compared.
struct Reference {
    /// Where the peers find the surfaces, and put theirs.
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
    fn new(case: &Case) -> Result<Self, BenchError> {
        let folder = tempfile::tempdir().map_err(BenchError::file(Path::new("a temporary directory")))?;
        export(case, folder.path())?;
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

    fn start(&self, python: &Path, kind: &str) -> Result<Peer, BenchError> {
        Peer::start(python, kind, self.folder.path())
    }

    /// Compares a peer's first steps with ours.
    fn agreement(&self, peer: &mut Peer, name: &str) -> Result<Agreement, BenchError> {
        let Self { steps, time_acceleration, .. } = *self;
        eprintln!("comparing {steps} steps with time acceleration {time_acceleration}: {name}");
        let theirs = peer.trace(steps)?;
        // Without a pool both must stay at 0, which is no figure to report.
        let pool = compare(name, "debris pool", &self.trace.pool, &theirs.pool)?;
        Ok(Agreement {
            peer: name.into(),
            versions: peer.versions.clone(),
            time_acceleration,
            steps,
            displacement: compare(name, "displacement", &self.trace.displacement, &theirs.displacement)?,
            contact_area: compare(name, "contact area", &self.trace.contact_area, &theirs.contact_area)?,
            pool: self.has_pool.then_some(pool),
            deposited: Some(compare(name, "deposited volume", &self.trace.deposited, &theirs.deposited)?),
            heights: compare(name, "height", &self.heights, &peer.heights(self.folder.path())?.concat())?,
        })
    }
}

/// Largest difference over the largest value.
fn compare(peer: &str, quantity: &'static str, ours: &[f64], theirs: &[f64]) -> Result<f64, BenchError> {
    if ours.len() != theirs.len() {
        let problem = format!("found {} values of {quantity}, expected {}", theirs.len(), ours.len());
        return Err(BenchError::Peer { peer: peer.into(), problem });
    }
    let largest = ours.iter().fold(f64::MIN_POSITIVE, |largest, value| largest.max(value.abs()));
    let mut difference = 0.0_f64;
    for (index, (ours, theirs)) in ours.iter().zip(theirs).enumerate() {
        let relative = (ours - theirs).abs() / largest;
        // Not a number is no agreement either.
        if relative.is_nan() || relative > TOLERANCE {
            let (peer, ours, theirs, tolerance) = (peer.to_owned(), *ours, *theirs, TOLERANCE);
            return Err(BenchError::Disagreement { peer, quantity, index, theirs, ours, tolerance });
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
        assert_eq!(compare("peer", "pool", &[1.0, -4.0], &[1.0, -4.0]).unwrap(), 0.0);
        assert_eq!(compare("peer", "pool", &[0.0, 4.0], &[4e-10, 4.0]).unwrap(), 1e-10);
        for theirs in [&[1.0, 4.0 + 1e-8][..], &[1.0, f64::NAN], &[1.0]] {
            assert!(compare("peer", "pool", &[1.0, 4.0], theirs).is_err(), "{theirs:?}");
        }
    }
}
