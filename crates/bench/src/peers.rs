//! The same step in Python, as Numba loops and as NumPy arrays.

use std::path::Path;

use plateau_core::observe::{Map, MapValues};

use crate::document::{Agreement, Benchmark};
use crate::error::BenchError;
use crate::peer::{Peer, Trace, export, python};
use crate::race::{Entry, race};
use crate::session::Options;
use crate::stepper::{Setup, Stepper};

/// How a peer is called by step.py, and by people.
const PEERS: [(&str, &str); 2] = [("numba", "Numba loops"), ("numpy", "NumPy arrays")];
/// Largest accepted difference over the largest value. The load tolerance leaves the displacement undetermined by about
/// as much of the overlap, rounding by far less.
const TOLERANCE: f64 = 1e-9;

/// Checks that the peers compute the same, measures and reports.
pub fn peers(options: Options) -> Result<(), BenchError> {
    let mut session = options.begin(Benchmark::Peers)?;
    let case = session.source.case()?;
    let folder = tempfile::tempdir().map_err(BenchError::file(Path::new("a temporary directory")))?;
    export(&case, folder.path())?;
    let python = python()?;

    // More than a revolution, so that the pin meets columns that it has been on before.
    let steps = session.mesh.disc_columns + session.mesh.pin_columns;
    let setup = Setup::of(1);
    let mut plateau = Stepper::new(&case, setup)?;
    let (ours, heights) = reference(&mut plateau, steps)?;

    let mesh = session.mesh;
    let instructions = setup.instructions.name().to_owned();
    let mut entries = vec![Entry { name: "Plateau".into(), mesh, workers: 1, instructions, runner: Box::new(plateau) }];
    for (kind, name) in PEERS {
        let mut peer = match Peer::start(&python, kind, folder.path()) {
            Err(error) if kind == "numba" => {
                session.document.notes.push(format!("Numba cannot be had here: {error}."));
                continue;
            }
            started => started?,
        };
        eprintln!("comparing {steps} steps: {name}");
        let theirs = peer.trace(steps)?;
        session.document.agreements.push(Agreement {
            peer: name.into(),
            versions: peer.versions.clone(),
            steps,
            displacement: compare(name, "displacement", &ours.displacement, &theirs.displacement)?,
            contact_area: compare(name, "contact area", &ours.contact_area, &theirs.contact_area)?,
            pool: compare(name, "debris pool", &ours.pool, &theirs.pool)?,
            heights: compare(name, "height", &heights, &peer.heights(folder.path())?.concat())?,
        });
        let instructions = String::from("its own");
        entries.push(Entry { name: name.into(), mesh, workers: 1, instructions, runner: Box::new(peer) });
    }
    session.document.measurements = race(entries, session.pace)?;
    session.finish()
}

/// What our simulation does in the next steps, and the heights of disc and pin after them.
fn reference(simulation: &mut Stepper, steps: usize) -> Result<(Trace, Vec<f64>), BenchError> {
    let mut trace = Trace::default();
    for _ in 0..steps {
        simulation.run(1)?;
        let sample = simulation.sample()?;
        trace.displacement.push(sample.displacement);
        trace.contact_area.push(sample.contact_area);
        trace.pool.push(sample.pool);
    }
    let maps = simulation.snapshot(&[Map::DiscHeight, Map::PinHeight])?.maps;
    let heights = maps.into_iter().filter_map(|(_, values)| match values {
        MapValues::Float(heights) => Some(heights),
        MapValues::Status(_) => None,
    });
    Ok((trace, heights.flatten().collect()))
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
