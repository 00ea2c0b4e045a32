//! A simulation at a limit of the model, and what must come of it.

use plateau_core::model::mesh::Mesh;
use plateau_core::model::parameters::{Integrator, Parameters, PlateauRules};
use plateau_core::model::state::InitialSurfaces;

/// What must come of a case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Expected {
    /// All numbers finite, the load balanced, debris kept, and no cell worn past its contact.
    Sound,
    /// The same but for cells worn past their contact: the explicit rule above Π = 1, of which the program warns.
    Overshoot,
    /// Two flat bodies that recede as the closed form says (model section 8).
    Recession,
    /// An error, and no result.
    Refused,
}

/// A case.
#[derive(Debug, Clone)]
pub struct Case {
    pub name: String,
    pub parameters: Parameters,
    pub surfaces: InitialSurfaces,
    pub steps: u64,
    pub expected: Expected,
}

impl Case {
    /// A case that must be sound after five revolutions.
    pub fn new(name: impl Into<String>, parameters: Parameters, surfaces: InitialSurfaces) -> Self {
        let steps = 5 * parameters.mesh.disc_columns() as u64;
        Self { name: name.into(), parameters, surfaces, steps, expected: Expected::Sound }
    }

    /// The same with other expectations.
    pub fn expecting(self, expected: Expected) -> Self {
        Self { expected, ..self }
    }

    /// The same with local debris, as a scene has it that says nothing else of it: all that wears may be compacted.
    pub fn with_local_debris(mut self) -> Self {
        self.name += ", local debris";
        self.parameters.plateaus =
            PlateauRules { formation: self.parameters.plateaus.formation, ..PlateauRules::LOCAL };
        self
    }

    /// The same with another number of steps.
    pub fn of_steps(self, steps: u64) -> Self {
        Self { steps, ..self }
    }
}

/// The paper's operation, materials and cells on a small mesh, with a nominal pressure as in the paper and one debris pool.
pub fn paper(rows: usize, disc_columns: usize, pin_columns: usize) -> Parameters {
    let mesh = Mesh::new(rows, disc_columns, pin_columns, 20e-3, 20e-3 + rows as f64 * 50e-6)
        .unwrap_or_else(|error| unreachable!("the meshes of the cases are valid: {error}"));
    let normal_force = 1.47e6 * mesh.pin_area();
    Parameters { mesh, normal_force, plateaus: PlateauRules::pool(0.06), ..Parameters::paper() }
}

/// The same with the wear rate of the pin's plateaus changed so that the stiffness number is `number`.
pub fn with_stiffness_number(mut parameters: Parameters, number: f64, integrator: Integrator) -> Parameters {
    let factor = number / parameters.stiffness_number();
    for material in [&mut parameters.materials.pin_primary, &mut parameters.materials.pin_secondary] {
        material.specific_wear_rate *= factor;
    }
    Parameters { integrator, ..parameters }
}
