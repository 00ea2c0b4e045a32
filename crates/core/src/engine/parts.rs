//! Parts of the model that a scene needs, and those that it leaves out.

use crate::model::parameters::{DebrisRule, Integrator, Parameters};
use crate::model::state::Base;

/// Name of the part that accelerates.
pub const ACCELERATION: &str = "time acceleration";

/// A part of the model that a scene can do without.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Part {
    /// Name of the part.
    pub name: &'static str,
    /// True if this scene needs the part.
    pub needed: bool,
    /// Setting of the scene that decides.
    pub reason: &'static str,
}

/// Parts of the model that the update of the cells has to carry out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Needs {
    /// True if build-up can exist and differs from what it lies on.
    pub distinct: bool,
    /// True if build-up can break away.
    pub breaks: bool,
    /// True if the disc can wear.
    pub disc_wears: bool,
    /// True if plateaus can form.
    pub forms: bool,
    /// True if plateaus form of pooled debris (model 4P).
    pub pools: bool,
    /// Columns over which debris is gathered and spread, L or as many as the pin has, for it has no more to gather or to fill;
    /// none where it goes from one cell to the next.
    pub transport: Option<usize>,
}

/// Kinds of build-up, for each of which the kernels are compiled.
pub mod build_up {
    /// No build-up: b = z everywhere, and substrates are not kept.
    pub const NONE: u8 = 0;
    /// Build-up with the properties of what it lies on.
    pub const ALIKE: u8 = 1;
    /// Build-up with the properties of what it lies on, which breaks away where it is pressed harder than its strength.
    pub const BRITTLE: u8 = 2;
    /// Build-up with properties of its own, and perhaps a strength.
    pub const DISTINCT: u8 = 3;
}

impl Needs {
    /// Returns the needs of a scene with these parameters.
    pub fn of(parameters: &Parameters) -> Self {
        let rules = &parameters.plateaus;
        let materials = &parameters.materials;
        let forms = rules.formation && rules.captured_fraction.max(rules.captured_of_resin()) > 0.0;
        Self {
            distinct: forms
                && (materials.pin_primary != materials.pin_secondary
                    || materials.disc_primary != materials.disc_secondary
                    || materials.wears_by_counterface()
                    || parameters.friction.is_some_and(|friction| friction.primary != friction.secondary)),
            breaks: forms && materials.strength.is_some(),
            disc_wears: materials.disc_primary.specific_wear_rate > 0.0
                || (forms && materials.disc_secondary.specific_wear_rate > 0.0),
            forms,
            pools: forms && rules.debris != DebrisRule::Local,
            transport: parameters
                .transport_columns()
                .filter(|_| forms)
                .map(|columns| columns.min(parameters.mesh.pin_columns())),
        }
    }

    /// Kind of build-up for which the kernels are compiled.
    pub fn build_up(self) -> u8 {
        match self {
            Self { forms: false, .. } => build_up::NONE,
            Self { distinct: true, .. } => build_up::DISTINCT,
            Self { breaks: true, .. } => build_up::BRITTLE,
            _ => build_up::ALIKE,
        }
    }
}

/// The optional parts of the model, each with whether a scene needs it.
pub fn parts(parameters: &Parameters, pin_base: &[Base]) -> Vec<Part> {
    let materials = &parameters.materials;
    let mesh = &parameters.mesh;
    let has = |base| pin_base.iter().enumerate().any(|(cell, found)| *found == base && mesh.is_present(cell));
    let Needs { distinct, breaks, disc_wears, forms, pools, transport } = Needs::of(parameters);
    let destroys = pools && parameters.plateaus.destruction;
    let pin_wears = (has(Base::Primary) && materials.pin_primary.specific_wear_rate > 0.0)
        || (forms && materials.pin_secondary.specific_wear_rate > 0.0);
    let part = |name, needed, reason_needed, reason_left_out| Part {
        name,
        needed,
        reason: if needed { reason_needed } else { reason_left_out },
    };
    vec![
        part("wear of plateaus on the pin", pin_wears, "a wear rate above 0", "every wear rate of the pin is 0"),
        part("wear of the resin", has(Base::Resin), "the pin has resin", "the pin is fibre alone"),
        part("wear of the disc", disc_wears, "a wear rate above 0", "every wear rate of the disc is 0"),
        part(
            "formation of plateaus",
            forms,
            "formation = true and debris is captured",
            "formation = false or captured_fraction = 0",
        ),
        part(
            "destruction of plateaus",
            destroys && has(Base::Resin),
            "destruction = true on resin",
            match parameters.plateaus.debris {
                DebrisRule::Local => "debris = \"local\" has none for lack of support",
                DebrisRule::Contact | DebrisRule::Track => "destruction = false, no formation, or no resin",
            },
        ),
        part(
            "properties of their own for build-ups",
            distinct,
            "secondary materials or their friction differ from primary ones",
            "secondary materials equal primary ones, and so does their friction",
        ),
        part("strength of build-up", breaks, "materials.pin_secondary.strength", "no strength is given"),
        part(
            "transport length",
            transport.is_some(),
            "plateaus.transport_length",
            "no transport_length: debris goes from one cell to the next",
        ),
        part("debris pool", pools, "debris = \"contact\" or \"track\"", "debris = \"local\", or no formation"),
        part(
            "one debris pool per track",
            parameters.plateaus.debris == DebrisRule::Track,
            "debris = \"track\"",
            "debris = \"local\" or \"contact\"",
        ),
        part(
            "exponential wear",
            parameters.integrator == Integrator::Exponential,
            "integrator = \"exponential\"",
            "integrator = \"explicit\"",
        ),
        part(
            "load and speed that change",
            parameters.cycle.is_some(),
            "operation.cycle",
            "no operation.cycle, or one that never changes",
        ),
        part("friction", parameters.friction.is_some(), "[friction]", "no [friction]"),
        part("heat", parameters.thermal.is_some(), "[thermal]", "no [thermal]"),
        part("airborne emission", parameters.emission.is_some(), "[emission]", "no [emission]"),
        part(
            ACCELERATION,
            parameters.time_acceleration > 1.0,
            "time_acceleration above 1: an approximation, compare with 1",
            "time_acceleration = 1",
        ),
    ]
}
