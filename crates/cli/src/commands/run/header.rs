//! What a run file says of its run before the first step.

use std::path::PathBuf;

use plateau_core::simulation::Simulation;
use plateau_io::run_file::{Header, InputFile};
use plateau_io::scene::recipe::Scene;

use crate::failure::Failure;
use crate::{machine, version};

/// The part of the run file that is known before the first step.
pub(super) fn header(
    scene: &Scene,
    simulation: &Simulation,
    accelerates: bool,
    surface_files: &[(PathBuf, String)],
    surfaces: &[String],
    expected_samples: u64,
) -> Result<Header, Failure> {
    let mut inputs = InputFile::read_all(&scene.files)
        .map_err(|(path, error)| Failure::input(format_args!("{}: {error}", path.display())))?;
    inputs.extend(
        surface_files
            .iter()
            .map(|(path, sha256)| InputFile { path: path.to_string_lossy().into_owned(), sha256: sha256.clone() }),
    );
    Ok(Header {
        title: scene.title.clone(),
        mesh: scene.parameters.mesh.clone(),
        pin_base: simulation.pin_base().to_vec(),
        maps: scene.output.maps.clone(),
        extras: scene.extras(accelerates),
        expected_samples,
        scene: scene.resolved.clone(),
        program: version::program(),
        source_revision: version::REVISION.into(),
        host: machine::host(),
        workers: simulation.execution().workers,
        instruction_set: simulation.execution().means().into(),
        seeds: scene.seeds.clone(),
        inputs,
        surfaces: surfaces.to_vec(),
    })
}
