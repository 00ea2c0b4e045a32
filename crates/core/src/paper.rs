//! The paper's case (Tables 1 and 2): its parameters, and surfaces like the ones it measured, which are not public.

use std::f64::consts::TAU;

use crate::model::material::{Material, Materials};
use crate::model::mesh::Mesh;
use crate::model::parameters::{Integrator, Parameters, PlateauRules};
use crate::model::state::InitialSurfaces;
use crate::surface::{Body, FibreSynthesis, HeightSynthesis, Preparation, RawHeights, Texture, set_back_resin};

impl Parameters {
    /// The paper's baseline with local debris, m = 1: `data/scenes/cermet.toml` but for its time acceleration.
    pub fn paper() -> Self {
        let pin = Material { youngs_modulus: 1e9, poisson_ratio: 0.27, specific_wear_rate: 5e-14 };
        let disc = Material { youngs_modulus: 1e11, specific_wear_rate: 0.0, ..pin };
        Self {
            mesh: Mesh::new(80, 2764, 161, 20e-3, 24e-3)
                .unwrap_or_else(|error| unreachable!("the paper's mesh is valid: {error}")),
            normal_force: 47.0,
            by_torque: false,
            angular_velocity: 850.0 * TAU / 60.0,
            cycle: None,
            control: None,
            foundation_height: 50e-6,
            materials: Materials {
                disc_primary: disc,
                disc_secondary: disc,
                pin_primary: pin,
                pin_secondary: pin,
                pin_resin: Material { youngs_modulus: 1e5, specific_wear_rate: 0.0, ..pin },
                wear_height: 5e-6,
                pin_primary_against_secondary: None,
                pin_secondary_against_secondary: None,
                strength: None,
            },
            plateaus: PlateauRules::LOCAL,
            time_acceleration: 1.0,
            integrator: Integrator::Explicit,
            friction: None,
            thermal: None,
            emission: None,
        }
    }
}

impl InitialSurfaces {
    /// Surfaces like the paper's on a ring of its size, those of `data/scenes/cermet.toml`: a disc 3 µm rough and cut at 3 µm, a
    /// pin three tenths of which are fibres, its resin set back.
    ///
    /// # Errors
    /// When they cannot be made on a mesh of this size.
    pub fn like_the_papers(mesh: &Mesh) -> Result<Self, Box<dyn std::error::Error>> {
        let heights = |seed, rms_height, length: f64, patch| HeightSynthesis {
            seed,
            rms_height,
            texture: Texture::Correlation { along: length, across: length },
            skewness: 0.0,
            kurtosis: 3.0,
            patch,
        };
        let disc = heights(1, 3e-6, 120e-6, Some(8e-3)).field(Body::Disc, mesh)?;
        let cut = Preparation { cutoff: Some(3e-6), ..Preparation::default() };
        let fibres = FibreSynthesis { seed: 2, fibre_fraction: 0.3, fibre_length: 400e-6, fibre_width: 100e-6 };
        let pin_base = fibres.base(mesh)?;
        let mut pin_height = heights(3, 0.5e-6, 100e-6, None).field(Body::Pin, mesh)?;
        set_back_resin(&mut pin_height, &pin_base, 8e-6);
        Ok(Self {
            disc_height: cut.apply(RawHeights::OnMesh(disc), false, Body::Disc, mesh)?.heights,
            pin_height,
            pin_base,
        })
    }
}
