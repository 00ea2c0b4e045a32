//! Warnings of values that a scene asks for, in words.

use plateau_core::acceleration::scout::Idle;
use plateau_core::model::parameters::{Integrator, Parameters};
use plateau_io::number;

/// Π above which the explicit rule errs noticeably.
const LARGE_STIFFNESS_NUMBER: f64 = 0.1;

/// Tells whether the wear rule of a scene is out of its depth with a stiffness number (model section 8).
pub fn is_stiff(parameters: &Parameters, stiffness_number: f64) -> bool {
    parameters.integrator == Integrator::Explicit && stiffness_number > LARGE_STIFFNESS_NUMBER
}

/// Says where that is so at the temperature with which a run begins.
pub fn stiffness_warning(parameters: &Parameters) -> Option<String> {
    let stiffness_number = parameters.first_stiffness_number();
    is_stiff(parameters, stiffness_number).then(|| in_words("the stiffness number is", stiffness_number))
}

/// Says that it has become so.
pub fn grown_stiffness_warning(stiffness_number: f64, time: f64) -> String {
    let time = number::rounded(time, 4);
    in_words(
        &format!("with the wear rates of the temperature after {time} s the stiffness number is"),
        stiffness_number,
    )
}

fn in_words(what: &str, stiffness_number: f64) -> String {
    let found = number::short(stiffness_number);
    format!(
        "{what} {found}: above {LARGE_STIFFNESS_NUMBER} the explicit rule errs, above 1 it overshoots, \
         above 2 it is unstable; lower numerics.time_acceleration or set numerics.integrator = \"exponential\""
    )
}

/// Says why a run is not accelerated although it might choose.
pub fn idle_warning(idle: Idle) -> String {
    format!("numerics.time_acceleration: {idle}; see docs/evidence/accuracy.md")
}
