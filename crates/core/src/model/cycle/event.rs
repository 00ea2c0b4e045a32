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
}

impl Cycle {
    /// The maximal stretches of active intervals until a time (s).
    pub fn events(&self, until: f64) -> Vec<Event> {
        let rounds = (0..self.rounds).map(|round| round as f64 * self.period).take_while(|start| *start < until);
        let mut events: Vec<Event> = Vec::new();
        let mut is_open = false;
        for (start, interval) in rounds.flat_map(|start| self.intervals.iter().map(move |interval| (start, interval))) {
            let (start, length) = (start + interval.start.time, interval.length());
            if interval.kind != Kind::Active || start >= until {
                is_open = false;
                continue;
            }
            let last = interval.after(length.min(until - start));
            let end = Node { time: (start + length).min(until), ..last };
            match events.last_mut() {
                Some(event) if is_open => event.end = end,
                _ => events.push(Event { start: Node { time: start, ..interval.start }, end }),
            }
            is_open = true;
        }
        events
    }

    /// By how much the disc turns in an event, rad.
    pub fn angle_of(&self, event: &Event) -> f64 {
        self.angle_at(event.end.time) - self.angle_at(event.start.time)
    }

    /// The largest m with which every event until a time (s) has ten simulated revolutions: below 1 none has.
    pub fn largest_acceleration(&self, until: f64) -> f64 {
        let angles = self.events(until).into_iter().map(|event| self.angle_of(&event));
        angles.fold(f64::INFINITY, f64::min) / (LEAST_REVOLUTIONS * TAU)
    }

    /// How many of the events until a time (s) have fewer, with an acceleration.
    pub fn short_events(&self, until: f64, acceleration: f64) -> usize {
        let least = acceleration * LEAST_REVOLUTIONS * TAU * (1.0 - 1e-9);
        self.events(until).iter().filter(|event| self.angle_of(event) < least).count()
    }
}
