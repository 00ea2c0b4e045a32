//! From the settings of a scene to the surfaces before the first step.

mod base;
mod heights;
mod loader;

use plateau_core::model::state::InitialSurfaces;
use plateau_core::surface::{Body, Length, set_back_resin};

use super::error::SurfaceError;
use super::loaded::{Loaded, Patches};
use crate::scene::Scene;
use loader::Loader;

pub use base::micrograph;

/// Reads or makes the initial surfaces of a scene and prepares them.
///
/// Heights of the pin that come from an instrument (SDF, text, images) are negated after their preparation: an
/// instrument's peaks are positive, while the pin's z grows away from the disc. HDF5, NumPy and synthetic heights are
/// taken as they are.
///
/// # Errors
/// [`SurfaceError`], which names the scene's table and the file.
pub fn load(scene: &Scene) -> Result<Loaded, SurfaceError> {
    Loader::new(scene).load(scene)
}

/// As [`load`], with the patches from which the heights of disc and pin come: prepared, scaled and with the sign that the
/// heights have, at their own pitch; none for a body whose heights come from no patch.
///
/// # Errors
/// [`SurfaceError`] as for [`load`].
pub fn load_with_patches(scene: &Scene) -> Result<(Loaded, Patches), SurfaceError> {
    let mut loader = Loader { patches: Some(Patches::default()), ..Loader::new(scene) };
    let loaded = loader.load(scene)?;
    Ok((loaded, loader.patches.unwrap_or_default()))
}

impl Loader<'_> {
    fn load(&mut self, scene: &Scene) -> Result<Loaded, SurfaceError> {
        let (disc_height, disc_cut) = self.heights(&scene.disc_surface, Body::Disc)?;
        let (mut pin_height, pin_cut) = self.heights(&scene.pin_surface, Body::Pin)?;
        let pin_base = self.base(&scene.pin_base, scene.pin_base_mirror)?;
        if scene.resin_recess != 0.0 {
            self.warn_of_second(Body::Pin, "pin.surface", "resin_recess");
            set_back_resin(&mut pin_height, &pin_base, scene.resin_recess);
            self.report.push(format!("pin.surface: resin set back by {}", Length(scene.resin_recess)));
        }
        let surfaces = InitialSurfaces { disc_height, pin_height, pin_base };
        let (inputs, report) = (std::mem::take(&mut self.inputs).0, std::mem::take(&mut self.report));
        Ok(Loaded { surfaces, disc_cut, pin_cut, inputs, report })
    }
}
