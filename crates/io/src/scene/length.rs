//! How much of a scene is simulated: its steps and its physical time.

use plateau_core::model::parameters::Parameters;

use super::contents::OperationCycle;
use super::error::Problem;
use super::schema::ACCELERATION;
use super::settings::Settings;
use crate::number;

/// More steps than this cannot be counted one by one in a double (2^53), and the time of a step would be wrong.
const MOST_STEPS: u64 = 1 << f64::MANTISSA_DIGITS;

/// How much is simulated.
pub(super) struct Length {
    pub steps: u64,
    /// Physical time, s.
    pub duration: f64,
}

/// The steps and the time that the keys say.
pub(super) fn length(
    settings: &Settings,
    parameters: &Parameters,
    operation: Option<&OperationCycle>,
) -> Result<Length, Problem> {
    let duration = settings.optional_number("operation.duration")?;
    let given = settings.get("operation.steps").map(|_| settings.integer("operation.steps")).transpose()?;
    let key = match (duration, given) {
        (Some(_), _) => "operation.duration",
        (None, Some(_)) => "operation.steps",
        (None, None) => ACCELERATION,
    };
    let problem = |message: String| Problem::new(&settings.origin(key), key, message);
    let length = match (operation, duration, given) {
        (Some(OperationCycle { cycle, .. }), _, _) => {
            let angle = parameters.step_angle();
            let duration = match (duration, given) {
                (Some(duration), _) => duration,
                (None, Some(steps)) if steps <= cycle.steps_done(cycle.duration(), angle) => cycle.end_of(steps, angle),
                (None, Some(_)) => f64::INFINITY,
                (None, None) => cycle.duration(),
            };
            if duration > cycle.duration() * (1.0 + 1e-12) {
                let (end, steps) = (cycle.duration(), cycle.steps_done(cycle.duration(), angle));
                return Err(problem(format!(
                    "the cycle ends after {end} s and {steps} steps, expected no more; write duration = \"{end} s\" in [operation], also \
                     where a scene that is extended gives another one, or raise operation.cycle.repeat to play it again"
                )));
            }
            // Also one that never changes: no step goes beyond the end.
            let steps = cycle.steps_done(duration, angle);
            if steps == 0 {
                let [duration, turned, step] = [duration, cycle.angle_at(duration), angle].map(number::plain);
                return Err(problem(format!(
                    "until {duration} s the cycle turns the disc by {turned} rad, less than a step of {step} rad, so nothing would \
                     happen; a longer duration, faster speeds or a smaller numerics.time_acceleration help"
                )));
            }
            Length { steps, duration }
        }
        (None, Some(duration), _) => Length { steps: parameters.steps_of(duration), duration },
        (None, None, _) => {
            let steps = settings.integer("operation.steps")?;
            Length { steps, duration: parameters.clock().time_at(steps) }
        }
    };
    if length.steps > MOST_STEPS {
        let message =
            format!("these are more than {MOST_STEPS} steps, which cannot be counted exactly; shorten the run");
        return Err(problem(message));
    }
    Ok(length)
}
