//! Report of `plateau check` on parts of a scene: a cycle, a pin that is no rectangle, and the pulses of the contact area, with whether the
//! run is long enough for them.

use plateau_core::model::cycle::Cycle;
use plateau_core::model::mesh::Mesh;
use plateau_core::model::outline::Outline;
use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::Base;
use plateau_core::observe::drift::pulse_time;
use plateau_core::observe::window_mean::LEAST_REVOLUTIONS;
use plateau_io::number;
use plateau_io::scene::Scene;
use serde::Serialize;

/// A cycle as far as the run plays it.
#[derive(Debug, Serialize)]
pub struct CycleReport {
    /// Stretches with load and speed.
    events: usize,
    /// Time that they last in all, s.
    active_time: f64,
    /// Physical time of the run, s.
    duration: f64,
    /// Distance slid at the mean radius, m.
    distance: f64,
    /// Steps of the event with the fewest, and of that with the most.
    steps_per_event: [u64; 2],
    /// The largest acceleration with which every event has ten simulated revolutions; below 1 none has.
    largest_acceleration_without_warning: f64,
}

impl CycleReport {
    /// Of a scene that has a cycle.
    pub fn of(scene: &Scene) -> Option<Self> {
        let cycle: &Cycle = &scene.cycle.as_ref()?.cycle;
        let (parameters, until) = (&scene.parameters, scene.duration);
        let events = cycle.events(until);
        let angle = parameters.step_angle();
        let steps = || {
            let step = |at| Cycle::steps_to(at, angle).min(scene.steps);
            events.iter().map(move |event| step(event.start_angle + event.angle) - step(event.start_angle))
        };
        Some(Self {
            events: events.len(),
            active_time: events.iter().map(|event| event.end.time - event.start.time).sum(),
            duration: until,
            distance: cycle.angle_at(until) * parameters.mesh.mean_radius(),
            steps_per_event: [steps().min().unwrap_or(0), steps().max().unwrap_or(0)],
            largest_acceleration_without_warning: cycle.largest_acceleration(until),
        })
    }

    /// Physical time of the run, s.
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// For the table of the run.
    pub fn rows(&self) -> Vec<(&'static str, String)> {
        let [fewest, most] = self.steps_per_event.map(number::grouped);
        let largest = self.largest_acceleration_without_warning;
        vec![
            (
                "cycle",
                format!(
                    "{}: {} s of {} s with load and speed, {} m",
                    number::count(self.events, "event"),
                    number::short(self.active_time),
                    number::short(self.duration),
                    number::short(self.distance)
                ),
            ),
            ("steps per event", if fewest == most { fewest } else { format!("{fewest} to {most}") }),
            (
                "largest acceleration without a warning",
                if largest < 1.0 {
                    "none: the shortest event has less than ten revolutions".to_owned()
                } else {
                    number::short(number::not_above(largest, 4))
                },
            ),
        ]
    }
}

/// The pin within its outline.
#[derive(Debug, Serialize)]
pub(super) struct OutlineReport {
    shape: &'static str,
    /// m.
    diameter: f64,
    /// Cells of the pin that are there.
    cells: usize,
    /// Their area, m².
    area: f64,
}

impl OutlineReport {
    /// That of a mesh; none for a rectangle.
    pub(super) fn of(mesh: &Mesh) -> Option<Self> {
        match mesh.outline() {
            Outline::Rectangle => None,
            Outline::Disc { radius } => {
                Some(Self { shape: "disc", diameter: 2.0 * radius, cells: mesh.present_cells(), area: mesh.pin_area() })
            }
        }
    }

    /// In words.
    pub(super) fn text(&self) -> String {
        format!(
            "a circle of {} mm in diameter: {} cells, {} mm²",
            number::short(self.diameter * 1e3),
            number::grouped(self.cells as u64),
            number::short(self.area * 1e6)
        )
    }
}

/// Pulses that the last tenth of a run should hold (docs/questions.md).
const WANTED: f64 = 5.0;
/// Part that rounding may take off a number of pulses or revolutions.
const ROUNDING: f64 = 1e-9;

/// The last tenth of a run beside a pulse of its contact area.
#[derive(Debug, Serialize)]
pub(super) struct PulseReport {
    /// Time of a pulse, s, at least.
    pulse_time: f64,
    /// The last tenth of the run, s.
    last_tenth: f64,
    /// Simulated revolutions in it.
    revolutions: f64,
}

impl PulseReport {
    /// That of a run of so many steps; none where nothing pulses, or load and speed change with time.
    pub(super) fn of(parameters: &Parameters, base: &[Base], steps: u64) -> Option<Self> {
        let run = steps as f64;
        Some(Self {
            pulse_time: pulse_time(parameters, base)?,
            last_tenth: 0.1 * run * parameters.step_time(),
            revolutions: 0.1 * run / parameters.mesh.disc_columns() as f64,
        })
    }

    /// In words.
    pub(super) fn text(&self) -> String {
        let Self { pulse_time, last_tenth, revolutions } = *self;
        let enough = |found: f64, wanted: f64| found >= wanted * (1.0 - ROUNDING);
        let seconds = |time: f64| format!("{} s", number::rounded(time, 3));
        let pulses = last_tenth / pulse_time;
        let mut text = format!(
            "the shortest pulse takes {}; the last tenth of the run, {}, has at most {}",
            seconds(pulse_time),
            seconds(last_tenth),
            number::rounded(pulses, 2)
        );
        if !enough(pulses, WANTED) {
            let wanted = seconds(10.0 * WANTED * pulse_time);
            text += &format!(", and a mean needs at least {WANTED}: the run must be longer than {wanted}");
            // As long as the mean is that the run will tell, where the run has so many revolutions.
            if !enough(revolutions, LEAST_REVOLUTIONS) && enough(10.0 * revolutions, LEAST_REVOLUTIONS) {
                let window = seconds(last_tenth * LEAST_REVOLUTIONS / revolutions);
                text += &format!("; its mean is over the last {window}, {LEAST_REVOLUTIONS} simulated revolutions");
            }
        } else if !enough(revolutions, LEAST_REVOLUTIONS) {
            let found = number::rounded(revolutions, 2);
            text += &format!(
                ": a mean needs {LEAST_REVOLUTIONS} simulated revolutions, and these are {found}: a smaller time_acceleration gives more"
            );
        }
        text
    }
}

#[cfg(test)]
#[path = "../../tests/unit/commands/check_parts.rs"]
mod tests;
