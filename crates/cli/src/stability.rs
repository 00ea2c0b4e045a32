//! Warns where the explicit wear rule is out of its depth (model section 8).

use plateau_core::model::parameters::{Integrator, Parameters};

use crate::message;
use crate::number;

/// Π above which the explicit rule errs noticeably.
const LARGE_STIFFNESS_NUMBER: f64 = 0.1;

/// Whether a scene uses the explicit rule where it errs.
pub fn is_doubtful(parameters: &Parameters) -> bool {
    parameters.integrator == Integrator::Explicit && parameters.stiffness_number() > LARGE_STIFFNESS_NUMBER
}

/// Says so on standard error.
pub fn warn(parameters: &Parameters) {
    if is_doubtful(parameters) {
        message::warning(format_args!(
            "the stiffness number is {}: above {LARGE_STIFFNESS_NUMBER} the explicit rule errs, above 1 it overshoots, \
             above 2 it is unstable; lower numerics.time_acceleration or set numerics.integrator = \"exponential\"",
            number::short(parameters.stiffness_number())
        ));
    }
}
