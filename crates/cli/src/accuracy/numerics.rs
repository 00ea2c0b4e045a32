//! The numerics of one run of a scene: what a ladder changes.

use plateau_core::acceleration::Adaptive;
use plateau_core::model::parameters::{Integrator, Parameters};
use plateau_io::scene::recipe::Scene;
use plateau_io::scene::schema::choices;

use super::coarsening::Coarsening;

/// The numerics of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Numerics {
    /// m: how many revolutions a simulated one stands for; where the run chooses it, at the start.
    pub time_acceleration: f64,
    /// How the run chooses its acceleration, if it does.
    pub adaptive: Option<Adaptive>,
    /// Cells of the scene's mesh along a cell; 1 is the scene's mesh.
    pub coarsening: usize,
    /// How wear follows from contact.
    pub integrator: Integrator,
    /// Initial heights of the disc are changed by this part of themselves; 0 leaves them as they are.
    pub perturbation: f64,
}

impl Numerics {
    /// Those of the scene itself.
    pub fn of(scene: &Scene) -> Self {
        let parameters = &scene.parameters;
        Self {
            time_acceleration: parameters.time_acceleration,
            adaptive: scene.adaptive,
            coarsening: 1,
            integrator: parameters.integrator,
            perturbation: 0.0,
        }
    }

    /// The same with another time acceleration, which never changes.
    pub fn accelerated(self, time_acceleration: f64) -> Self {
        Self { time_acceleration, adaptive: None, ..self }
    }

    /// The time acceleration as a scene gives it.
    pub fn acceleration(&self) -> String {
        match self.adaptive {
            None => format!("time_acceleration = {}", self.time_acceleration),
            Some(Adaptive { tolerance, largest }) => {
                format!("time_acceleration = {{ tolerance = {tolerance}, max = {largest} }}")
            }
        }
    }

    /// Whether a reference with this time acceleration is finer than the run, or the model itself. A run that chooses its
    /// acceleration begins with 1, so that nothing but the model is finer.
    pub fn is_judged_by(&self, reference: f64) -> bool {
        reference == 1.0 || (self.adaptive.is_none() && reference < self.time_acceleration)
    }

    /// What a simulation with these numerics is told; `coarsening` is that of the mesh, if there is one.
    pub fn parameters(&self, scene: &Scene, coarsening: Option<&Coarsening>) -> Parameters {
        let mut parameters = Parameters {
            time_acceleration: self.time_acceleration,
            integrator: self.integrator,
            ..scene.parameters.clone()
        };
        if let Some(coarsening) = coarsening {
            parameters.mesh = coarsening.mesh.clone();
        }
        parameters
    }
}

/// Name of an integrator in a scene.
pub fn integrator_name(integrator: Integrator) -> &'static str {
    choices::word(&choices::INTEGRATOR, &integrator)
}
