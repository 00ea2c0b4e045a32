//! Surfaces that several runs of a study have in common, made once.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, PoisonError};

use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::{Base, InitialSurfaces};
use plateau_io::scene::{BaseSource, HeightSettings, Scene};
use plateau_io::study::record::Identity;
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
    /// Digests of the files, by what they are for.
    files: BTreeMap<String, String>,
}

impl Recipe {
    fn of(scene: &Scene, identity: &Identity) -> Self {
        Self {
            mesh: scene.parameters.mesh.clone(),
            disc: scene.disc_surface.clone(),
            pin: scene.pin_surface.clone(),
            resin_recess: scene.resin_recess,
            base: scene.pin_base.clone(),
            is_mirrored: scene.pin_base_mirror,
            files: identity.files.clone(),
        }
    }
}

impl SharedSurfaces {
    /// The surfaces of a run of this identity, if another run had the same.
    pub fn find(&self, scene: &Scene, identity: &Identity) -> Option<Arc<Loaded>> {
        let recipe = Recipe::of(scene, identity);
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.iter().find(|(of, _)| *of == recipe).map(|(_, loaded)| Arc::clone(loaded))
    }

    /// Keeps the surfaces of a run of this identity for other runs, and lets go of the oldest.
    pub fn keep(&self, scene: &Scene, identity: &Identity, loaded: &Arc<Loaded>) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.push_back((Recipe::of(scene, identity), Arc::clone(loaded)));
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
