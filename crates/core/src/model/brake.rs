//! A brake of whose pads the simulated pin is a piece: what one of them has follows from what the other has.
//!
//! The pin rubs as the pads do, with the same friction force per area at the same sliding speed. So its force, its power and all that it
//! wears and emits are those of the brake in the ratio of the areas, and its torque is that of the brake in the ratio of the areas and of
//! the radii.

use super::mesh::Mesh;

/// A disc brake of a vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brake {
    /// Area of friction material of one pad, m².
    pub pad_area: f64,
    /// Number of pads.
    pub pads: u64,
    /// Thickness of the friction material that may wear, m.
    pub pad_thickness: f64,
    /// r_e: radius at which the friction force acts, m.
    pub effective_radius: f64,
    /// r_w: rolling radius of the wheel, m.
    pub wheel_radius: f64,
    /// Area of the pistons that press one pad, m², where a pressure is to press it.
    pub piston_area: Option<f64>,
    /// Fraction of the force of the pistons that comes to the pad.
    pub efficiency: f64,
}

impl Brake {
    /// Area of friction material of all pads, m².
    pub fn pads_area(&self) -> f64 {
        self.pads as f64 * self.pad_area
    }

    /// Part of the pads that the pin of a mesh is, by area.
    pub fn share(&self, mesh: &Mesh) -> f64 {
        mesh.pin_area() / self.pads_area()
    }

    /// Torque of friction on the pin of a mesh, N m, while the brake has this one (N m).
    pub fn torque_of_pin(&self, torque: f64, mesh: &Mesh) -> f64 {
        torque * self.share(mesh) * mesh.mean_radius() / self.effective_radius
    }

    /// Torque of the brake, N m, while this friction force (N) acts on the pin of a mesh.
    pub fn torque(&self, friction_force: f64, mesh: &Mesh) -> f64 {
        friction_force / self.share(mesh) * self.effective_radius
    }

    /// Sliding speed of pads and pin, m/s, on a road at this speed (m/s).
    pub fn sliding_speed(&self, road_speed: f64) -> f64 {
        road_speed * self.effective_radius / self.wheel_radius
    }

    /// Pressure on the pads over their area, Pa, at this pressure in the brake line (Pa); none where the pistons are not known.
    pub fn nominal_pressure(&self, line_pressure: f64) -> Option<f64> {
        self.piston_area.map(|area| line_pressure * area * self.efficiency / self.pad_area)
    }
}
