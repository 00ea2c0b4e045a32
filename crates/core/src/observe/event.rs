//! What is reported of each event of a cycle (model 9): its ends, what was worn in it, and the contact at its ends.

use serde::{Deserialize, Serialize};

use super::sample::Sample;
use crate::model::cycle::{Cycle, Event};
use crate::model::parameters::Parameters;

/// What is reported of an event, in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EventRecord {
    /// When it began, s.
    pub start: f64,
    /// When it ended, s.
    pub end: f64,
    /// ω at its start, rad/s.
    pub initial_speed: f64,
    /// ω at its end, rad/s.
    pub final_speed: f64,
    /// Distance slid at the mean radius, m.
    pub distance: f64,
    /// Volume worn off pin and disc, m³.
    pub worn: f64,
    /// Debris that left the contact, m³.
    pub emitted: f64,
    /// Contact area of its first step, m²; NaN where it has none.
    pub contact_area_start: f64,
    /// Contact area of its last step, m²; NaN where it has none.
    pub contact_area_end: f64,
}

/// Name, unit and meaning of one quantity of an event.
#[derive(Debug, Clone, Copy)]
pub struct EventQuantity {
    /// Name in a run file.
    pub name: &'static str,
    /// SI unit as UDUNITS writes it.
    pub unit: &'static str,
    /// What it is, in words.
    pub long_name: &'static str,
    /// The value of an event.
    pub value: fn(&EventRecord) -> f64,
}

macro_rules! quantities {
    ($($field:ident, $unit:literal, $long_name:literal;)*) => {
        &[$(EventQuantity {
            name: stringify!($field),
            unit: $unit,
            long_name: $long_name,
            value: |record| record.$field,
        }),*]
    };
}

/// What is reported of every event, in this order.
pub const EVENT_QUANTITIES: &[EventQuantity] = quantities! {
    start, "s", "time at the start of the event";
    end, "s", "time at the end of the event";
    initial_speed, "rad s-1", "rotational speed of the disc at the start of the event";
    final_speed, "rad s-1", "rotational speed of the disc at the end of the event";
    distance, "m", "sliding distance at the mean radius";
    worn, "m3", "volume worn off pin and disc";
    emitted, "m3", "wear debris that left the contact";
    contact_area_start, "m2", "contact area of the first step";
    contact_area_end, "m2", "contact area of the last step";
};

/// The quantity of an event with this name.
pub fn event_quantity(name: &str) -> Option<&'static EventQuantity> {
    EVENT_QUANTITIES.iter().find(|quantity| quantity.name == name)
}

/// An event by the steps that belong to it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Planned {
    event: Event,
    distance: f64,
    /// Steps done before its first.
    before: u64,
    /// Its last step.
    last: u64,
}

/// What an event that has begun needs to know of its start.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct Begun {
    worn: f64,
    emitted: f64,
    contact_area: Option<f64>,
}

/// How far the events of a run have come: what a checkpoint keeps.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct EventProgress {
    /// Those that have ended.
    pub records: Vec<EventRecord>,
    begun: Option<Begun>,
}

/// The events of a run, and what is reported of those that have ended.
///
/// A step that goes on after a pause has its contact before it, and belongs to the event that the pause ends.
#[derive(Debug, Clone, Default)]
pub struct EventLog {
    plan: Vec<Planned>,
    progress: EventProgress,
}

impl EventLog {
    /// The events of a cycle until a time (s) in so many steps; of a run without a cycle none.
    pub fn new(parameters: &Parameters, cycle: Option<&Cycle>, until: f64, steps: u64) -> Self {
        let Some(cycle) = cycle else { return Self::default() };
        let angle = parameters.step_angle();
        let step = |time: f64| cycle.steps_until(time, angle).min(steps);
        let plan = cycle.events(until).into_iter().map(|event| {
            let distance = cycle.angle_of(&event) * parameters.mesh.mean_radius();
            Planned { event, distance, before: step(event.start.time), last: step(event.end.time) }
        });
        let mut log = Self { plan: plan.collect(), progress: EventProgress::default() };
        log.note(&Sample::default());
        log
    }

    /// What has ended so far.
    pub fn progress(&self) -> &EventProgress {
        &self.progress
    }

    /// Goes on from what was kept.
    pub fn restore(&mut self, progress: EventProgress) {
        self.progress = progress;
    }

    /// The next step after which a sample is needed.
    pub fn next(&self, steps_done: u64) -> Option<u64> {
        let Planned { before, last, .. } = self.plan.get(self.progress.records.len())?;
        [*before, before + 1, *last].into_iter().find(|step| *step > steps_done)
    }

    /// Takes what a sample of the step just done says of the event to which it belongs, and of those that begin or end with it.
    pub fn note(&mut self, sample: &Sample) {
        while let Some(planned) = self.plan.get(self.progress.records.len()).copied() {
            let Planned { event, distance, before, last } = planned;
            let (worn, emitted) = (sample.worn_pin + sample.worn_resin + sample.worn_disc, sample.emitted);
            if sample.step >= before {
                let begun = self.progress.begun.get_or_insert(Begun { worn, emitted, contact_area: None });
                if sample.step > before {
                    begun.contact_area.get_or_insert(sample.contact_area);
                }
            }
            let Some(begun) = self.progress.begun.filter(|_| sample.step >= last) else { return };
            self.progress.begun = None;
            self.progress.records.push(EventRecord {
                start: event.start.time,
                end: event.end.time,
                initial_speed: event.start.speed,
                final_speed: event.end.speed,
                distance,
                worn: worn - begun.worn,
                emitted: emitted - begun.emitted,
                contact_area_start: begun.contact_area.unwrap_or(f64::NAN),
                contact_area_end: if last > before { sample.contact_area } else { f64::NAN },
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::cycle::{Interpolation, Node};
    use std::f64::consts::TAU;

    /// Ten revolutions a second for a second, a second of rest, five revolutions: steps of half a revolution on two columns.
    fn log() -> EventLog {
        let paper = Parameters::paper();
        let mesh = crate::model::mesh::Mesh::new(1, 2, 1, 1.0, 3.0).unwrap();
        let parameters = Parameters { mesh, ..paper };
        let node = |time, force| Node::new(time, force, 10.0 * TAU);
        let nodes = [node(0.0, 1.0), node(1.0, 1.0), node(1.0, 0.0), node(2.0, 0.0), node(2.0, 1.0), node(2.5, 1.0)];
        let cycle = Cycle::new(&nodes, Interpolation::Linear, 1).unwrap();
        EventLog::new(&parameters, Some(&cycle), 2.5, 30)
    }

    fn sample(step: u64) -> Sample {
        let (worn, area) = (step as f64, 100.0 + step as f64);
        Sample { step, worn_pin: worn, emitted: 0.5 * worn, contact_area: area, ..Sample::default() }
    }

    #[test]
    fn each_event_has_what_was_worn_between_its_ends() {
        let mut log = log();
        let mut asked = Vec::new();
        let mut done = 0;
        while let Some(step) = log.next(done) {
            asked.push(step);
            log.note(&sample(step));
            done = step;
        }
        assert_eq!(asked, [1, 20, 21, 30]);
        let [first, second] = log.progress().records[..] else { panic!("{log:?}") };
        assert_eq!((first.start, first.end, second.start, second.end), (0.0, 1.0, 2.0, 2.5));
        assert_eq!((first.worn, second.worn, second.emitted), (20.0, 10.0, 5.0));
        assert_eq!((first.contact_area_start, first.contact_area_end), (101.0, 120.0));
        assert_eq!((second.contact_area_start, second.contact_area_end), (121.0, 130.0));
        // Ten and five revolutions at a mean radius of 2 m.
        assert!((first.distance - 20.0 * TAU).abs() < 1e-9 && (second.distance - 10.0 * TAU).abs() < 1e-9);
    }

    #[test]
    fn a_log_that_was_kept_within_an_event_goes_on() {
        let (mut whole, mut stopped) = (log(), log());
        for step in [1, 20, 21, 30] {
            whole.note(&sample(step));
            stopped.note(&sample(step));
            let kept = serde_json::to_string(stopped.progress()).unwrap();
            stopped = log();
            stopped.restore(serde_json::from_str(&kept).unwrap());
        }
        assert_eq!(stopped.progress(), whole.progress());
    }
}
