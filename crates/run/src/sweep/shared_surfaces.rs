//! Surfaces that several runs of a study have in common, made once. Those of files are read for each run: a file that is replaced
//! meanwhile must show.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::{Base, InitialSurfaces};
use plateau_io::scene::{BaseSource, HeightSettings, Scene};
use plateau_io::surface::Loaded;

/// Most bytes of surfaces that are kept: those of some thirty runs on the paper's mesh.
const MOST_BYTES: usize = 64 << 20;

/// Surfaces that were made last.
#[derive(Default)]
pub struct SharedSurfaces(Mutex<VecDeque<(Recipe, Arc<Loaded>)>>);

/// Everything that surfaces come from.
#[derive(PartialEq)]
struct Recipe {
    mesh: Mesh,
    disc: HeightSettings,
    pin: HeightSettings,
    resin_recess: f64,
    base: BaseSource,
    is_mirrored: bool,
}

impl Recipe {
    fn of(scene: &Scene) -> Self {
        Self {
            mesh: scene.parameters.mesh.clone(),
            disc: scene.disc_surface.clone(),
            pin: scene.pin_surface.clone(),
            resin_recess: scene.resin_recess,
            base: scene.pin_base.clone(),
            is_mirrored: scene.pin_base_mirror,
        }
    }
}

impl SharedSurfaces {
    /// The surfaces of a scene, if another run had the same.
    pub fn find(&self, scene: &Scene) -> Option<Arc<Loaded>> {
        let recipe = Recipe::of(scene);
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.iter().find(|(of, _)| *of == recipe).map(|(_, loaded)| Arc::clone(loaded))
    }

    /// Keeps the surfaces of a scene for other runs, unless a file was read for them, and lets go of the oldest.
    pub fn keep(&self, scene: &Scene, loaded: &Arc<Loaded>) {
        if !loaded.inputs.is_empty() {
            return;
        }
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.push_back((Recipe::of(scene), Arc::clone(loaded)));
        let mut bytes: usize = kept.iter().map(|(_, loaded)| size(&loaded.surfaces)).sum();
        while bytes > MOST_BYTES {
            let Some((_, oldest)) = kept.pop_front() else { break };
            bytes -= size(&oldest.surfaces);
        }
    }
}

/// Bytes of surfaces.
fn size(surfaces: &InitialSurfaces) -> usize {
    let InitialSurfaces { disc_height, pin_height, pin_base } = surfaces;
    (disc_height.len() + pin_height.len()) * size_of::<f64>() + pin_base.len() * size_of::<Base>()
}

#[cfg(test)]
#[path = "../../tests/unit/sweep/shared_surfaces.rs"]
mod tests;
