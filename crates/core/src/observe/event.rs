//! Records of the events of a cycle (model 9): the ends of each, the wear in it, and the contact at its ends.

use serde::{Deserialize, Serialize};

use super::extra::Extra;
use super::sample::Sample;
use super::schedule::Moment;
use crate::model::accounts::AccountsReport;
use crate::model::cycle::{Cycle, Event};
use crate::model::parameters::Parameters;
use crate::model::sums::RunningSum;
use crate::observe::extra::{EMISSION, FRICTION, HEAT};

/// Record of an event, in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EventRecord {
    /// Start, s.
    pub start: f64,
    /// End, s.
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
    /// Work of friction, J; NaN without friction.
    pub work: f64,
    /// Coefficient of friction, mean weighted by load; NaN without friction, or a step.
    pub friction_coefficient: f64,
    /// T_c at its start, K; NaN without heat, or a step.
    pub temperature_start: f64,
    /// Largest T_c at the end of an interval, K; NaN without heat, or a step.
    pub temperature_peak: f64,
    /// PM10, kg; NaN without emission.
    pub pm10_mass: f64,
    /// Airborne particles; NaN without emission.
    pub particle_number: f64,
}

/// Name, unit and meaning of one quantity of an event.
#[derive(Debug, Clone, Copy)]
pub struct EventQuantity {
    /// Name in a run file.
    pub name: &'static str,
    /// SI unit as UDUNITS writes it.
    pub unit: &'static str,
    /// Meaning, in words.
    pub long_name: &'static str,
    /// The part of the model that brings it; none where every run with a cycle has it.
    pub part: Option<&'static Extra>,
    /// The value of an event.
    pub value: fn(&EventRecord) -> f64,
}

macro_rules! quantities {
    ($($field:ident, $unit:literal, $long_name:literal, $part:expr;)*) => {
        &[$(EventQuantity {
            name: stringify!($field),
            unit: $unit,
            long_name: $long_name,
            part: $part,
            value: |record| record.$field,
        }),*]
    };
}

/// Quantities that are reported of every event, in this order.
pub const EVENT_QUANTITIES: &[EventQuantity] = quantities! {
    start, "s", "time at the start of the event", None;
    end, "s", "time at the end of the event", None;
    initial_speed, "rad s-1", "rotational speed of the disc at the start of the event", None;
    final_speed, "rad s-1", "rotational speed of the disc at the end of the event", None;
    distance, "m", "sliding distance at the mean radius", None;
    worn, "m3", "volume worn off the simulated pin and the disc", None;
    emitted, "m3", "wear debris that left the contact of the simulated pin", None;
    contact_area_start, "m2", "contact area of the first step", None;
    contact_area_end, "m2", "contact area of the last step", None;
    work, "J", "work of friction of the simulated pin", Some(&FRICTION);
    friction_coefficient, "1", "coefficient of friction, mean weighted by load", Some(&FRICTION);
    temperature_start, "K", "temperature of the contact at the start of the event", Some(&HEAT);
    temperature_peak, "K", "largest temperature of the contact", Some(&HEAT);
    pm10_mass, "kg", "mass that is airborne as PM10, of the simulated pin", Some(&EMISSION);
    particle_number, "1", "number of airborne particles of the simulated pin", Some(&EMISSION);
};

/// Quantities of events in a run with these series besides those of every run.
pub fn event_quantities(extras: &[&Extra]) -> impl Iterator<Item = &'static EventQuantity> {
    EVENT_QUANTITIES.iter().filter(|quantity| quantity.part.is_none_or(|part| extras.contains(&part)))
}

/// The quantity of an event with this name.
pub fn event_quantity(name: &str) -> Option<&'static EventQuantity> {
    EVENT_QUANTITIES.iter().find(|quantity| quantity.name == name)
}

/// An event by the steps that belong to it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Planned {
    event: Event,
    distance: f64,
    /// Steps done before the first of the event.
    before: u64,
    /// Last step of the event.
    last: u64,
    /// The start of the pause that ends it, where the step around that pause is not taken any more.
    closing: Option<Moment>,
}

/// Sums, contact area and temperature at the start of an event that has begun.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct Begun {
    sums: Sums,
    contact_area: Option<f64>,
    temperature: Option<f64>,
}

/// Sums that grow from step to step, as far as a sample has them.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct Sums {
    worn: f64,
    emitted: f64,
    work: f64,
    load_work: f64,
    pm10_mass: f64,
    particle_number: f64,
}

impl Sums {
    fn of(sample: &Sample) -> Self {
        let AccountsReport { friction, emission, .. } = sample.accounts;
        let [work, load_work] = friction.map_or([f64::NAN; 2], |friction| [friction.work, friction.load_work]);
        let [pm10_mass, particle_number] = emission.map_or([f64::NAN; 2], |emission| [emission.pm10, emission.number]);
        let worn = sample.worn_pin + sample.worn_resin + sample.worn_disc;
        Self { worn, emitted: sample.emitted, work, load_work, pm10_mass, particle_number }
    }
}

/// Progress of the events of a run: what a checkpoint keeps.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct EventProgress {
    /// Records of the events that have ended.
    pub records: Vec<EventRecord>,
    begun: Option<Begun>,
    /// Events that ended with the last step: the end of a run may have cut them short, and the next one begins with the sums of the last.
    ended: Vec<Ended>,
}

/// Start and sums of an event that has ended.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Ended {
    begun: Begun,
    /// Last step of the event.
    step: u64,
    sums: Sums,
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
        let plan = cycle.events(until).into_iter().map(|event| {
            let [before, end] =
                [event.start_angle, event.start_angle + event.angle].map(|at| Cycle::steps_to(at, angle));
            let pause = cycle.pause_in(event.end.time, until).filter(|pause| end > steps && pause.start < until);
            let closing = pause.map(|pause| Moment {
                step: steps,
                time: event.end.time,
                pause: Some(pause.kind),
                ..Moment::default()
            });
            let distance = event.angle * parameters.mesh.mean_radius();
            Planned { event, distance, before: before.min(steps), last: end.min(steps), closing }
        });
        let mut log = Self { plan: plan.collect(), progress: EventProgress::default() };
        log.take(Sums::default(), &Sample::default());
        log
    }

    /// Returns the events that have ended so far.
    pub fn progress(&self) -> &EventProgress {
        &self.progress
    }

    /// Goes on from what was kept. An event that the end of the former run cut short has not ended.
    pub fn restore(&mut self, progress: EventProgress) {
        self.progress = progress;
        let EventProgress { records, begun, ended } = &mut self.progress;
        while let (Some(record), Some(last)) = (records.last(), ended.last())
            && let Some(planned) = self.plan.get(records.len() - 1)
            && (planned.event.end.time != record.end || planned.last != last.step)
        {
            *begun = Some(last.begun);
            records.pop();
            ended.pop();
        }
    }

    /// The next step after which a sample is needed.
    pub fn next(&self, steps_done: u64) -> Option<u64> {
        let Planned { before, last, .. } = self.plan.get(self.progress.records.len())?;
        [*before, before + 1, *last].into_iter().find(|step| *step > steps_done)
    }

    /// The pause that ends an event with this step, so that its account is that of this moment, where the step around the pause is not
    /// taken any more.
    pub fn closing(&self, step: u64) -> Option<&Moment> {
        let Planned { last, closing, .. } = self.plan.get(self.progress.records.len())?;
        closing.as_ref().filter(|_| step >= *last)
    }

    /// Takes what a sample of the step just done says of the event to which it belongs, and of those that begin or end with it.
    pub fn note(&mut self, sample: &Sample) {
        self.take(Sums::of(sample), sample);
    }

    fn take(&mut self, sums: Sums, sample: &Sample) {
        while let Some(planned) = self.plan.get(self.progress.records.len()).copied() {
            let Planned { event, distance, before, last, .. } = planned;
            if sample.step >= before {
                // Nothing wears in the pause before it.
                let former = self.progress.ended.last().map_or(Sums::default(), |ended| ended.sums);
                let begun = self.progress.begun.get_or_insert(Begun { sums: former, ..Begun::default() });
                if sample.step > before {
                    begun.contact_area.get_or_insert(sample.contact_area);
                    begun.temperature = begun.temperature.or(sample.accounts.heat.map(|heat| heat.event_start));
                }
            }
            let Some(begun) = self.progress.begun.filter(|_| sample.step >= last) else { return };
            self.progress.begun = None;
            self.progress.ended.retain(|ended| ended.step == last);
            self.progress.ended.push(Ended { begun, step: last, sums });
            let heat = sample.accounts.heat.filter(|_| last > before);
            let left = |sum: fn(&Sums) -> f64| RunningSum::from(sum(&sums) - sum(&begun.sums)).amount();
            self.progress.records.push(EventRecord {
                start: event.start.time,
                end: event.end.time,
                initial_speed: event.start.speed,
                final_speed: event.end.speed,
                distance,
                worn: sums.worn - begun.sums.worn,
                emitted: left(|sums| sums.emitted),
                contact_area_start: begun.contact_area.unwrap_or(f64::NAN),
                contact_area_end: if last > before { sample.contact_area } else { f64::NAN },
                work: sums.work - begun.sums.work,
                friction_coefficient: (sums.work - begun.sums.work) / (sums.load_work - begun.sums.load_work),
                temperature_start: begun.temperature.unwrap_or(f64::NAN),
                temperature_peak: heat.map_or(f64::NAN, |heat| heat.event_peak),
                pm10_mass: left(|sums| sums.pm10_mass),
                particle_number: left(|sums| sums.particle_number),
            });
        }
    }
}
