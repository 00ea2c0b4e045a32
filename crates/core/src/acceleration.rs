//! Time acceleration that a run chooses as it goes (model 4.6).
//!
//! Three things bound m, and [`Choice`] takes the largest that keeps within all of them:
//!
//! - *What has passed.* A run begins with m = 1, and no simulated revolution stands for more than a small part of the time
//!   that has passed. What a revolution does to the surfaces is large at the start and small later, so m grows with the
//!   time, each decade of which takes as many steps as the one before.
//! - *What is seen.* A second simulation, the [scout], goes beside the run with [`RATIO`] times its
//!   acceleration. From what the two differ by follows the error of the run: see [`Choice::error`].
//! - *What is resolved.* A window of the contact area's history has a few revolutions, and ends with one: over a part of a
//!   revolution the mean depends on which part of the ring that is.
//!
//! Run and scout together are quicker than m = 1 from `LEAST` on. Where less is allowed, the run goes on alone with m = 1, which
//! adds no error, and comes back after a while with a scout that begins with its surfaces: what the former scout differed by was
//! mostly the error of its own past, which is no measure of what m costs the run now.

pub mod scout;

use serde::{Deserialize, Serialize};

use crate::model::parameters::{Integrator, Parameters};

/// Acceleration of the scout over that of the run: it costs a quarter of the run.
pub const RATIO: u32 = 4;
/// Least length of a window of the contact area's history, s.
const SHORTEST_WINDOW: f64 = 5.0;
/// Windows of a history, at most.
const WINDOWS: f64 = 50.0;
/// Simulated revolutions that a window has at least: the contact area varies round the ring.
const REVOLUTIONS_PER_WINDOW: f64 = 3.0;
/// Windows over which the mean square of the error fades.
const WINDOWS_OF_SQUARE: f64 = 3.0;
/// Stiffness number of the scout that the explicit rule may reach: above 1 it overshoots.
const LARGEST_STIFFNESS_NUMBER: f64 = 0.5;
/// Fraction of the tolerance that is aimed at, 1: the error is only estimated.
const AIM: f64 = 0.7;
/// Largest factor by which the acceleration changes at a time, up or down.
const LARGEST_CHANGE: f64 = 2.0;
/// Smaller changes are not worth it: they would follow the noise.
const SMALLEST_CHANGE: f64 = 1.2;
/// Part of the time passed that a revolution may stand for, over the tolerance (docs/evidence/accuracy.md).
const GROWTH: f64 = 3.5;
/// Least m beside a scout: both together take 5/8 of the steps of m = 1.
const LEAST: f64 = 2.0;
/// Growth of the time passed from an end of the acceleration to its next start, at least.
const PAUSE: f64 = 1.1;
/// Error that a start may add at least, over the error aimed at, 1, however large that of the run is already estimated.
const LEAST_SHARE: f64 = 0.5;
/// Part of a window, or of m, below which times and accelerations are the same: they are rounded.
const ROUNDING: f64 = 1e-6;

/// Settings of a run that chooses its acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adaptive {
    /// Largest relative error of the contact area's history: root mean square over windows of a fiftieth of the duration,
    /// but at least 5 s.
    pub tolerance: f64,
    /// Largest acceleration.
    pub largest: f64,
}

/// The acceleration of a run, from what its contact area and that of its scout have differed by.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    tolerance: f64,
    /// Largest acceleration for which the history has windows and the scout is stable.
    largest: f64,
    /// Length of a window of the history, s.
    window: f64,
    /// Time of a revolution with m = 1, s.
    revolution: f64,
    /// Acceleration m that was wanted, before it was rounded to whole revolutions in a window.
    wanted: f64,
    acceleration: f64,
    /// Relative difference of the scout's contact area from the run's since the scout began, 1.
    difference: FadingMean,
    /// Mean of the square of that mean.
    square: FadingMean,
    /// Time at which the acceleration began or ended last, s.
    since: f64,
    /// Estimate of the relative error that the run had at that time, 1.
    carried: f64,
    /// Largest m so far.
    largest_taken: f64,
    /// Integral of the square of the estimated error over the time, s, until `noted` (s).
    square_integral: f64,
    noted: f64,
}

/// Record of the acceleration of a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Chosen {
    /// Relative error that the scene allows, 1.
    pub tolerance: f64,
    /// Smallest m: every run begins with 1.
    pub smallest: f64,
    /// Largest m.
    pub largest: f64,
    /// Last m.
    pub last: f64,
    /// Estimate of the relative error of the contact area's history: root mean square of [`Choice::error`] over the time.
    pub estimated_error: f64,
    /// True if the estimated error is within the tolerance.
    pub met: bool,
}

impl Chosen {
    /// Returns the record of a run that goes with m = 1 all the time.
    pub fn never(tolerance: f64) -> Self {
        Self { tolerance, smallest: 1.0, largest: 1.0, last: 1.0, estimated_error: 0.0, met: true }
    }
}

impl Choice {
    /// The choice of a run of this duration (s), which begins with m = 1.
    pub fn new(adaptive: &Adaptive, parameters: &Parameters, duration: f64) -> Self {
        let window = (duration / WINDOWS).max(SHORTEST_WINDOW);
        let unaccelerated = Parameters { time_acceleration: 1.0, ..parameters.clone() };
        let revolution = unaccelerated.step_time() * parameters.mesh.disc_columns() as f64;
        let resolved = window / (REVOLUTIONS_PER_WINDOW * revolution);
        let stable = match parameters.integrator {
            Integrator::Explicit => {
                LARGEST_STIFFNESS_NUMBER / (f64::from(RATIO) * unaccelerated.first_stiffness_number())
            }
            Integrator::Exponential => f64::INFINITY,
        };
        Self::within(adaptive.tolerance, adaptive.largest.min(resolved).min(stable).max(1.0), window, revolution)
    }

    fn within(tolerance: f64, largest: f64, window: f64, revolution: f64) -> Self {
        Self {
            tolerance,
            largest,
            window,
            revolution,
            wanted: 1.0,
            acceleration: 1.0,
            difference: FadingMean::default(),
            square: FadingMean::default(),
            since: 0.0,
            carried: 0.0,
            largest_taken: 1.0,
            square_integral: 0.0,
            noted: 0.0,
        }
    }

    /// Acceleration m of the coming steps.
    pub fn acceleration(&self) -> f64 {
        self.acceleration
    }

    /// Tells whether the run may be accelerated at all.
    pub fn is_free(&self) -> bool {
        self.largest >= LEAST
    }

    /// Returns the record of the acceleration up to a time, s.
    pub fn chosen(&self, time: f64) -> Chosen {
        let square_integral = self.square_integral + self.error().powi(2) * (time - self.noted).max(0.0);
        let estimated_error = if time > 0.0 { (square_integral / time).sqrt() } else { 0.0 };
        Chosen {
            tolerance: self.tolerance,
            smallest: 1.0,
            largest: self.largest_taken,
            last: self.acceleration,
            estimated_error,
            met: estimated_error <= self.tolerance,
        }
    }

    /// Estimate of the relative error of the contact area: of what the run had when the scout began, and of what has come since,
    /// which are independent.
    pub fn error(&self) -> f64 {
        libm::hypot(self.carried, self.added())
    }

    /// Estimate of the error that has come since the scout began, from what the two differed by, lately.
    ///
    /// It is an upper bound of the error where that grows as a power of m between 0 and 1; above m = 4, more than the
    /// difference.
    fn added(&self) -> f64 {
        from_difference(self.square.value().sqrt().max(self.difference.value().abs()), self.acceleration)
    }

    /// Goes on with m = 1, for good.
    pub(crate) fn give_up(&mut self) {
        self.begin(self.noted, 1.0);
    }

    /// Goes on from a time (s) with this m; what is seen from then on is new.
    fn begin(&mut self, time: f64, acceleration: f64) {
        (self.carried, self.since) = (self.error(), time);
        (self.difference, self.square) = Default::default();
        (self.wanted, self.acceleration) = (acceleration, acceleration);
        self.largest_taken = self.largest_taken.max(acceleration);
    }

    /// The m that the time passed (s) allows.
    fn allowed_at(&self, time: f64) -> f64 {
        (GROWTH * self.tolerance * time / self.revolution).min(self.largest)
    }

    /// Takes note that the run came to a time (s) with m = 1, and begins to accelerate it where that is allowed (again). Returns whether
    /// it does; a scout with the surfaces of the run is to begin then.
    pub fn start(&mut self, time: f64) -> bool {
        self.integrate(time);
        let starts = time >= PAUSE * self.since && self.allowed_at(time) >= LEAST;
        if starts {
            self.begin(time, LEAST);
        }
        starts
    }

    /// Takes note that over the last `elapsed` of `time` seconds the scout's contact area differed from that of the run by
    /// `difference`, relative to it, and chooses anew.
    pub fn note(&mut self, difference: f64, elapsed: f64, time: f64) {
        self.difference.add(difference, elapsed / self.window);
        self.square.add(self.difference.value().powi(2), elapsed / (WINDOWS_OF_SQUARE * self.window));
        self.integrate(time);
        let aim = AIM * self.tolerance;
        let left = (aim * aim - self.carried * self.carried).max(0.0).sqrt().max(LEAST_SHARE * aim);
        let added = self.added();
        let change = if added > 0.0 { left / added } else { LARGEST_CHANGE };
        if !(1.0 / SMALLEST_CHANGE..SMALLEST_CHANGE).contains(&change) {
            self.wanted *= change.clamp(1.0 / LARGEST_CHANGE, LARGEST_CHANGE);
        }
        self.wanted = self.wanted.min(self.allowed_at(time));
        if self.wanted < LEAST {
            return self.begin(time, 1.0);
        }
        let whole = whole_revolutions(self.wanted, self.revolution, self.window - time % self.window, self.window);
        self.take(whole.max(LEAST));
    }

    /// Adds the error up to a time (s) to the integral.
    fn integrate(&mut self, time: f64) {
        self.square_integral += self.error().powi(2) * (time - self.noted);
        self.noted = time;
    }

    /// Goes on with this m, if it is another one.
    fn take(&mut self, acceleration: f64) {
        let change = acceleration / self.acceleration;
        if (change - 1.0).abs() > ROUNDING {
            self.acceleration = acceleration;
            self.largest_taken = self.largest_taken.max(acceleration);
            // What was seen so far counts as if it had been seen at the new acceleration.
            self.difference.scale(change);
            self.square.scale(change * change);
        }
    }
}

/// Estimate of the error of a run with m = `acceleration` whose scout has [`RATIO`] times that, from their relative
/// difference D.
///
/// Where the error grows as a power of m between 0 (as ln m) and 1, from 0 at m = 1, it is (m^p − 1)/(m^p (4^p − 1)) D, which
/// is largest for p = 0: D ln m/ln 4. So that is an upper bound; up to m = 4 it is not used, for D is all there is to see.
fn from_difference(difference: f64, acceleration: f64) -> f64 {
    difference * (libm::log(acceleration) / libm::log(f64::from(RATIO))).max(1.0)
}

/// The largest m up to `wanted` with which whole revolutions, of `revolution` (s) at m = 1, fit into what is `left` (s) of a
/// window; at least 1.
fn whole_revolutions(wanted: f64, revolution: f64, left: f64, window: f64) -> f64 {
    let left = if left > ROUNDING * window { left } else { window };
    let count = (left / (wanted * revolution) - ROUNDING).ceil().max(1.0);
    (left / (count * revolution)).clamp(1.0, wanted)
}

/// A mean in which what was added fades, over a time that is the unit of the weights.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct FadingMean {
    sum: f64,
    weight: f64,
}

impl FadingMean {
    fn add(&mut self, value: f64, elapsed: f64) {
        let kept = libm::exp(-elapsed);
        self.sum = kept * self.sum + (1.0 - kept) * value;
        self.weight = kept * self.weight + (1.0 - kept);
    }

    fn scale(&mut self, factor: f64) {
        self.sum *= factor;
    }

    /// Mean of what was added; 0 before anything was.
    fn value(&self) -> f64 {
        if self.weight > 0.0 { self.sum / self.weight } else { 0.0 }
    }
}

#[cfg(test)]
#[path = "../tests/unit/acceleration.rs"]
mod tests;
