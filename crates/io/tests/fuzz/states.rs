//! Checkpoints: none that was changed is believed. One that was changed and sealed again is refused, or gone on with to a number or
//! an error.

use std::fs;
use std::path::Path;

use plateau_io::run_file::checkpoint::{self, RunState};
use plateau_io::scene::Scene;
use proptest::prelude::*;
use sha2::{Digest, Sha256};

use super::bytes::changes;
use super::harness::Fuzz;
use crate::checkpoints::{scene, simulation, state_after};

/// Bytes before the content, and of the digest behind it.
const AROUND: [usize; 2] = [16 + 8, 32];

/// A checkpoint after ten steps.
fn good(scene: &Scene, path: &Path) -> Vec<u8> {
    checkpoint::keep(path, &state_after(scene, 10)).unwrap();
    fs::read(path).unwrap()
}

#[test]
fn changed_checkpoints_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5.checkpoint");
    let good = good(&scene(), &path);
    let original = good.clone();
    let strategy = changes().prop_map(move |changes| {
        let mut content = good.clone();
        changes.iter().for_each(|change| change.apply(&mut content));
        content
    });
    Fuzz { corpus: "checkpoints", cases: 600, least_accepted: u32::MAX }.run(strategy, |content| {
        fs::write(&path, content).unwrap();
        match checkpoint::read::<RunState>(&path, None) {
            Err(error) => prop_assert!(!error.to_string().is_empty()),
            Ok(state) => prop_assert!(state.is_some() && content == original, "a changed checkpoint is believed"),
        }
        Ok(true)
    });
}

#[test]
fn changed_states_end_in_a_number_or_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5.checkpoint");
    let scene = scene();
    let good = good(&scene, &path);
    let content = good[AROUND[0]..good.len() - AROUND[1]].to_vec();
    let strategy = changes().prop_map(move |changes| {
        let mut content = content.clone();
        changes.iter().for_each(|change| change.apply(&mut content));
        let length = (content.len() as u64).to_le_bytes();
        [&b"plateau state 8\n"[..], &length, &content, &Sha256::digest(&content)].concat()
    });
    Fuzz { corpus: "states", cases: 400, least_accepted: 25 }.run(strategy, |content| {
        fs::write(&path, content).unwrap();
        let state = match checkpoint::read::<RunState>(&path, None) {
            Err(error) => {
                prop_assert!(!error.to_string().is_empty());
                return Ok(false);
            }
            Ok(state) => state,
        };
        let Some(state) = state else { return Ok(false) };
        let mut simulation = simulation(&scene);
        let answer = simulation.restore(&state.simulation.run).and_then(|()| {
            let next = simulation.steps_done().saturating_add(1);
            simulation.advance_to(next)?;
            simulation.sample()?;
            simulation.check_heights()
        });
        if let Err(error) = answer {
            prop_assert!(!error.to_string().is_empty());
        }
        Ok(true)
    });
}
