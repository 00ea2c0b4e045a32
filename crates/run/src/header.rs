//! What a run file says of its run before the first step.

use std::path::PathBuf;

use plateau_io::run_file::{Header, InputFile};
use plateau_io::scene::Scene;

use crate::assembly::Assembly;
use crate::machine;
use crate::options::Program;

/// The part of the run file that is known before the first step. `surface_files` are those that were read, with their digests;
/// `surfaces` says what was done for the surfaces.
pub fn header(
    scene: &Scene,
    assembly: &Assembly,
    program: &Program,
    surface_files: &[(PathBuf, String)],
    surfaces: Vec<String>,
) -> Header {
    let execution = assembly.simulation.execution();
    Header {
        title: scene.title.clone(),
        mesh: scene.parameters.mesh.clone(),
        pin_base: assembly.simulation.pin_base().to_vec(),
        maps: scene.output.maps.clone(),
        extras: scene.extras(assembly.chooses_acceleration()),
        expected_samples: assembly.schedule.samples(),
        scene: scene.resolved.clone(),
        program: program.name.clone(),
        source_revision: program.revision.clone(),
        host: machine::host(),
        workers: execution.workers,
        instruction_set: execution.means().into(),
        seeds: scene.seeds.clone(),
        inputs: input_files(scene, surface_files),
        surfaces,
    }
}

/// Every file that a scene read, with the digest of what was read; those of surfaces are `surface_files`.
pub fn input_files(scene: &Scene, surface_files: &[(PathBuf, String)]) -> Vec<InputFile> {
    let read = scene.files.iter().chain(surface_files);
    read.map(|(path, sha256)| InputFile { path: path.to_string_lossy().into_owned(), sha256: sha256.clone() }).collect()
}
