//! Events of a cycle: its maximal active stretches (model 9).

use std::f64::consts::TAU;

use super::Cycle;
use super::interval::{Kind, Node};

/// Simulated revolutions below which an event is too short for its mean to say much.
const LEAST_REVOLUTIONS: f64 = 10.0;

/// A maximal stretch of active intervals, such as one stop of a car.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// When it begins, with F and ω then.
    pub start: Node,
    /// When it ends, with F and ω then.
    pub end: Node,
    /// ψ at its start, rad.
    pub start_angle: f64,
    /// By how much the disc turns in it, rad.
    pub angle: f64,
}

impl Cycle {
    /// The maximal stretches of active intervals until a time (s).
    pub fn events(&self, until: f64) -> Vec<Event> {
        let mut events: Vec<Event> = Vec::new();
        // The round and the angle in it, rad, with which the event begins that goes on.
        let mut open = None;
        let places = (0..self.rounds).flat_map(|round| self.intervals.iter().map(move |interval| (round, interval)));
        for (round, interval) in places {
            let before = round as f64 * self.period;
            let (start, rounding) = (before + interval.start.time, Self::rounding(until));
            if start >= until - rounding {
                break;
            }
            if interval.kind != Kind::Active {
                open = None;
                continue;
            }
            let is_whole = before + interval.end.time <= until + rounding;
            let end = if is_whole {
                Node { time: before + interval.end.time, ..interval.end }
            } else {
                Node { time: until, ..interval.after(until - start) }
            };
            let first = interval.angle - interval.turned();
            let (first_round, first) = *open.get_or_insert_with(|| {
                let start_angle = round as f64 * self.angle + first;
                events.push(Event { start: Node { time: start, ..interval.start }, end, start_angle, angle: 0.0 });
                (round, first)
            });
            let last = if is_whole { interval.angle } else { interval.angle_after(until - start) };
            if let Some(event) = events.last_mut() {
                event.end = end;
                event.angle = (round - first_round) as f64 * self.angle + (last - first);
            }
        }
        events
    }

    /// The largest m with which every event until a time (s) has ten simulated revolutions: below 1 none has.
    pub fn largest_acceleration(&self, until: f64) -> f64 {
        let angles = self.events(until).into_iter().map(|event| event.angle);
        angles.fold(f64::INFINITY, f64::min) / (LEAST_REVOLUTIONS * TAU)
    }

    /// How many of the events until a time (s) have fewer, with an acceleration.
    pub fn short_events(&self, until: f64, acceleration: f64) -> usize {
        let least = acceleration * LEAST_REVOLUTIONS * TAU * (1.0 - 1e-9);
        self.events(until).iter().filter(|event| event.angle < least).count()
    }
}
