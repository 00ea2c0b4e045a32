//! The time between two neighbouring nodes of a cycle, in closed form (model 9).

use std::ops::Range;

/// Load and speed at a moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// t, s.
    pub time: f64,
    /// F, N.
    pub force: f64,
    /// ω, rad/s.
    pub speed: f64,
    /// Speed of the vehicle, m/s; it changes no step.
    pub road_speed: f64,
}

impl Node {
    /// Load (N) and speed (rad/s) at a time (s), of no vehicle.
    pub const fn new(time: f64, force: f64, speed: f64) -> Self {
        Self { time, force, speed, road_speed: 0.0 }
    }
}

/// Kind of the time between two neighbouring nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Load somewhere in it, and speed somewhere: steps are taken.
    Active,
    /// A pause without load.
    Lifted,
    /// A pause under load.
    Standing,
}

/// The time between two neighbouring nodes, over which F and ω are straight lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    pub start: Node,
    pub end: Node,
    pub kind: Kind,
    /// ψ from the start of the round to its end, rad.
    pub angle: f64,
    /// Time under load, moving or not, from the start of the round to its end, s.
    pub loaded: f64,
    /// Distance that the vehicle travels from the start of the round to its end, m.
    pub road: f64,
}

impl Interval {
    /// Interval from one node to a later one, after an interval or none.
    pub fn between(start: Node, end: Node, before: Option<&Self>) -> Self {
        let somewhere = |one: f64, other: f64| one > 0.0 || other > 0.0;
        let kind = match (somewhere(start.force, end.force), somewhere(start.speed, end.speed)) {
            (true, true) => Kind::Active,
            (false, _) => Kind::Lifted,
            (true, false) => Kind::Standing,
        };
        let (angle, loaded, road) = before.map_or((0.0, 0.0, 0.0), |before| (before.angle, before.loaded, before.road));
        let mut interval = Self { start, end, kind, angle, loaded, road };
        interval.angle += interval.turned();
        interval.road += interval.travelled(interval.length());
        interval.loaded += if interval.kind == Kind::Lifted { 0.0 } else { interval.length() };
        interval
    }

    /// D, s.
    pub fn length(&self) -> f64 {
        self.end.time - self.start.time
    }

    /// Δψ = D (ω₀ + ω₁)/2, rad; 0 in a pause.
    pub fn turned(&self) -> f64 {
        if self.kind == Kind::Active { self.length() * (self.start.speed + self.end.speed) / 2.0 } else { 0.0 }
    }

    /// ψ a time (s) after its start, from the start of the round, rad.
    pub fn angle_after(&self, time: f64) -> f64 {
        let turned =
            if self.kind == Kind::Active { time * (self.start.speed + self.after(time).speed) / 2.0 } else { 0.0 };
        self.angle - self.turned() + turned
    }

    /// Distance that the vehicle travels in a time (s) after its start, m.
    fn travelled(&self, time: f64) -> f64 {
        time * (self.start.road_speed + self.after(time).road_speed) / 2.0
    }

    /// Distance that the vehicle travels until a time (s) after its start, from the start of the round, m.
    pub fn road_after(&self, time: f64) -> f64 {
        self.road - self.travelled(self.length()) + self.travelled(time)
    }

    /// Time under load until a time (s) after its start, from the start of the round, s.
    pub fn loaded_after(&self, time: f64) -> f64 {
        if self.kind == Kind::Lifted { self.loaded } else { self.loaded - self.length() + time }
    }

    /// F and ω a time (s) after its start.
    pub fn after(&self, time: f64) -> Node {
        let part = time / self.length();
        let between = |one: f64, other: f64| if one == other { one } else { one + (other - one) * part };
        Node {
            time: self.start.time + time,
            force: between(self.start.force, self.end.force),
            speed: between(self.start.speed, self.end.speed),
            road_speed: between(self.start.road_speed, self.end.road_speed),
        }
    }

    /// Time after its start at which ψ has come to a value (rad), s: the root of ω₀ τ + (ω₁ − ω₀) τ²/(2 D) in the form that
    /// loses no digits.
    pub fn time_to(&self, angle: f64) -> f64 {
        let (angle, turned) = (angle - (self.angle - self.turned()), self.turned());
        if angle >= turned {
            return self.length();
        }
        if angle <= 0.0 {
            return 0.0;
        }
        let (first, rise) = (self.start.speed, (self.end.speed - self.start.speed) / (2.0 * self.length()));
        let root = (first * first + 4.0 * rise * angle).max(0.0).sqrt();
        (2.0 * angle / (first + root)).min(self.length())
    }

    /// Mean of F over the angle between two times (s) after its start, N, and that angle, rad, from
    /// ΔW = Δt (2F₀ω₀ + 2F₁ω₁ + F₀ω₁ + F₁ω₀)/6.
    pub fn mean_force(&self, times: Range<f64>) -> (f64, f64) {
        let (one, other) = (self.after(times.start), self.after(times.end));
        let speeds = one.speed + other.speed;
        let angle = (times.end - times.start) * speeds / 2.0;
        if one.force == other.force || speeds == 0.0 {
            return (one.force, angle);
        }
        let own = one.force * one.speed + other.force * other.speed;
        let cross = one.force * other.speed + other.force * one.speed;
        ((2.0 * own + cross) / (3.0 * speeds), angle)
    }
}
