//! What deserves attention in what a scene asks for, in words.

use plateau_core::acceleration::scout::Idle;
use plateau_core::model::parameters::{Integrator, Parameters};
use plateau_io::number;

/// Π above which the explicit rule errs noticeably.
const LARGE_STIFFNESS_NUMBER: f64 = 0.1;

/// Says where a scene uses the explicit wear rule out of its depth (model section 8).
pub fn stiffness_warning(parameters: &Parameters) -> Option<String> {
    let stiffness_number = parameters.stiffness_number();
    let is_doubtful = parameters.integrator == Integrator::Explicit && stiffness_number > LARGE_STIFFNESS_NUMBER;
    is_doubtful.then(|| {
        format!(
            "the stiffness number is {}: above {LARGE_STIFFNESS_NUMBER} the explicit rule errs, above 1 it overshoots, \
             above 2 it is unstable; lower numerics.time_acceleration or set numerics.integrator = \"exponential\"",
            number::short(stiffness_number)
        )
    })
}

/// Says why a run is not accelerated although it might choose.
pub fn idle_warning(idle: Idle) -> String {
    format!("numerics.time_acceleration: {idle}; see docs/accuracy.md")
}
