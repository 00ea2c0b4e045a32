//! Scenes of the command line.

use plateau_io::plausibility;
use plateau_io::scene::{self, Scene};

use crate::arguments::SceneArguments;
use crate::failure::Failure;
use crate::message;

/// Reads the scene with the changes of the command line; what it can hardly mean goes to standard error.
pub fn load_scene(arguments: &SceneArguments) -> Result<Scene, Failure> {
    let mut scene = scene::load(&arguments.scene, &sets(arguments)).map_err(Failure::of_scene)?;
    scene.warnings.extend(plausibility::of_scene(&scene));
    scene.warnings.iter().for_each(message::warning);
    Ok(scene)
}

/// All changes of a scene on the command line, as after `--set`.
pub fn sets(arguments: &SceneArguments) -> Vec<String> {
    let workers = arguments.workers.iter().map(|workers| format!("numerics.workers={workers}"));
    arguments.sets.iter().cloned().chain(workers).collect()
}
