//! The model as it is read: state (section 2) and one step (section 4), on plain arrays, cell by cell, in the order of the text.
//!
//! Nothing here is fast, and nothing is done twice for speed: [`step`] is what the engine is held
//! against, step by step. `plateau run --engine plain` drives it in place of the engine.
//!
//! | model | rule | function |
//! |---|---|---|
//! | 1, 2 | which cells face each other, and their statuses | [`step::pairs`] |
//! | 4.1 | the displacement that carries the load | [`step::balance`] |
//! | 4.2 | wear, build-up first | [`step::wear`] |
//! | 4.2a | strength of build-up | [`step::break_away`] |
//! | 4L | local debris: what wears ahead fills the gap behind it | [`step::deposit_locally`] |
//! | 4L | the same over a transport length | [`step::deposit_over`] |
//! | 4P | loss of support | [`step::destroy`] |
//! | 4P | pooled debris fills open cells | [`step::form`] |
//! | 4P | what is in a pool | [`step::pool`] |
//! | 4.6 | all of these, once | [`step::advance`] |
//! | 9 | load and speed that change | [`cycle`] |
//! | 10 | friction | [`friction::Friction::coefficient`] |
//! | 11 | heat | [`heat`] |
//! | 12 | emission | [`emission::Emission::mass`] |

pub mod accounts;
pub mod clock;
pub mod cycle;
pub mod emission;
pub mod error;
pub mod first_contact;
pub mod friction;
pub mod heat;
pub mod history;
pub mod material;
pub mod memory;
pub mod mesh;
pub mod outline;
pub mod parameters;
pub(crate) mod revolution;
pub(crate) mod running_sum;
pub mod state;
pub mod step;
pub mod totals;
mod volumes;

pub use self::volumes::Volumes;
use crate::model::friction::{ContactSums, StatusContact};
use crate::model::material::Status;
use crate::model::parameters::{DebrisRule, Parameters};
use crate::model::state::{Disc, InitialSurfaces, Pin};

/// The state of disc, pin and debris between two steps (model 2).
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// z_d and b_d.
    pub disc: Disc,
    /// z_p, b_p and base.
    pub pin: Pin,
    /// z_ref, m: the highest initial height of the disc.
    pub reference_height: f64,
    /// M, m³: one pool for the contact, one for each row, or none with local debris.
    pub pools: Vec<f64>,
    /// n: steps done.
    pub steps: u64,
    /// Columns by which the disc was turned before the first step: 0 but to see whether that changes anything.
    pub turned: u64,
}

impl State {
    /// n = 0: b = z in every cell, M = 0.
    pub fn new(parameters: &Parameters, surfaces: InitialSurfaces) -> Self {
        let InitialSurfaces { disc_height, pin_height, pin_base } = surfaces;
        let pools = match parameters.plateaus.debris {
            DebrisRule::Local => 0,
            DebrisRule::Contact => 1,
            DebrisRule::Track => parameters.mesh.rows(),
        };
        Self {
            reference_height: disc_height.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            disc: Disc { substrate: disc_height.clone(), height: disc_height },
            pin: Pin { substrate: pin_height.clone(), height: pin_height, base: pin_base },
            pools: vec![0.0; pools],
            steps: 0,
            turned: 0,
        }
    }
}

/// Displacements from this size on are out of the range of the model, m.
pub const REACH: f64 = 1e199;

/// What a step found and did.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// F_N, or F̄_n of a cycle, N.
    pub load: f64,
    /// δ, m.
    pub displacement: f64,
    /// p of every pin cell, Pa; 0 where it does not touch.
    pub pressure: Vec<f64>,
    /// Whether a pin cell touches.
    pub contact: Vec<bool>,
    /// Status of every pin cell at the start of the step.
    pub pin_status: Vec<Status>,
    /// What was moved.
    pub moved: Volumes,
}

impl Step {
    /// What friction must know of the contact (model 10).
    pub fn sums(&self, parameters: &Parameters) -> ContactSums {
        let mut statuses = [StatusContact::default(); 3];
        let cells = self.contact.iter().zip(&self.pressure).zip(&self.pin_status);
        for (((touches, pressure), status), area) in cells.zip(parameters.mesh.area().iter().cycle()) {
            if *touches {
                let of = &mut statuses[*status as usize];
                (of.area, of.load) = (of.area + area, of.load + pressure * area);
            }
        }
        let area = statuses.iter().map(|status| status.area).sum();
        ContactSums { load: self.load, area, statuses: Some(statuses) }
    }
}
