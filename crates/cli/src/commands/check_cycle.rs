//! What `plateau check` says of a cycle of load and speed.

use plateau_core::model::cycle::Cycle;
use plateau_io::scene::Scene;
use serde::Serialize;

use crate::number;

/// A cycle as far as the run plays it.
#[derive(Debug, Serialize)]
pub struct CycleReport {
    /// Stretches with load and speed.
    events: usize,
    /// How long they last in all, s.
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
