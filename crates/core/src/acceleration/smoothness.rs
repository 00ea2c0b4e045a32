//! Discs too smooth for time acceleration where debris is pooled (model 4.2, 4P and 4.6).
//!
//! With local debris (4L) the gap behind a cell of resin takes what that cell loses, wherever it touches: nothing is raised
//! above the highest initial level, and no disc is too smooth.
//!
//! Resin loses its wear height at once where it touches, and its debris is compacted where the pin just is. On a rough disc
//! the topography decides where that is, at any m. On a smooth one the debris does: with m = 1 resin touches on the
//! highest part of the ring first, which its debris raises further, so that waves longer than the pin grow round the ring;
//! with a larger m a revolution lowers the pin by more than these waves are high, resin touches all round, and there
//! are none. That is an error that two accelerated runs share, so that comparing them does not show it.

use std::f64::consts::TAU;

use crate::engine::parts::Needs;
use crate::model::parameters::Parameters;
use crate::model::state::{Base, InitialSurfaces};
use crate::observe::roughness::root_mean_square_along_tracks;

/// How much rougher a disc must be than the pin wears down in a revolution with m = 1.
///
/// Of the paper's discs the roughest is 75 times as rough, and 62 times after 3000 s: waves grow, and are lost among its
/// asperities. The others begin with 7.5 and 0.75 times, and end as waves (docs/evidence/accuracy.md).
const ROUGH_ENOUGH: f64 = 20.0;

/// The roughness below which a disc is too smooth to accelerate its run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Smoothness {
    /// By how much the pin's fibres recede in a revolution with m = 1, if they carry the load alone, m.
    recession: f64,
}

impl Smoothness {
    /// That of a pin; none where no resin wears, its debris is not compacted, or debris is local.
    pub fn of(parameters: &Parameters, pin_base: &[Base]) -> Option<Self> {
        let Parameters { mesh, materials, .. } = parameters;
        let base = || pin_base.iter().zip(mesh.pin_areas()).filter(|(_, area)| *area > 0.0);
        let wears = materials.wear_height > 0.0 && base().any(|(base, _)| base.is_resin());
        let pooled = Needs::of(parameters).pools && parameters.plateaus.captured_of_resin() > 0.0;
        if !(wears && pooled) {
            return None;
        }
        let fibre: f64 = base().filter(|(base, _)| !base.is_resin()).map(|(_, area)| area).sum();
        let radius = mesh.radius().iter().sum::<f64>() / mesh.rows() as f64;
        let pressure = parameters.usual_load() / fibre;
        Some(Self { recession: materials.pin_primary.specific_wear_rate * pressure * TAU * radius })
    }

    /// Whether a run that begins with these surfaces is not accelerated for it.
    pub fn forbids_from_the_start(parameters: &Parameters, surfaces: &InitialSurfaces) -> bool {
        Self::of(parameters, &surfaces.pin_base)
            .is_some_and(|smoothness| smoothness.forbids(parameters, &surfaces.disc_height))
    }

    /// Whether a disc of these heights (m, column by column) is too smooth.
    pub(crate) fn forbids(&self, parameters: &Parameters, disc_height: &[f64]) -> bool {
        root_mean_square_along_tracks(&parameters.mesh, disc_height) < ROUGH_ENOUGH * self.recession
    }
}
