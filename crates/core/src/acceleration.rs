//! Time acceleration that a run chooses as it goes (model 4.6).
//!
//! What acceleration costs is measured: a second simulation of the same surfaces, the [scout](crate::scout), goes beside
//! the run with [`RATIO`] times its acceleration. The error of the contact area grows at most in proportion to m, so the
//! run is nearer to m = 1 than to its scout, and [`Choice`] keeps m where the two differ by the tolerance.

use serde::{Deserialize, Serialize};

use crate::parameters::{Integrator, Parameters};

/// Acceleration of the scout over that of the run: it costs a quarter of the run.
pub const RATIO: u32 = 4;
/// Least length of a window of the contact area's history, s.
const SHORTEST_WINDOW: f64 = 5.0;
/// Windows of a history, at most.
const WINDOWS: f64 = 50.0;
/// Simulated revolutions that a window has at least: the contact area varies round the ring.
const REVOLUTIONS_PER_WINDOW: f64 = 3.0;
/// Stiffness number of the scout that the explicit rule may reach: above 1 it overshoots.
const LARGEST_STIFFNESS_NUMBER: f64 = 0.5;
/// What is aimed at, of the tolerance: the error is only estimated.
const AIM: f64 = 0.7;
/// Acceleration changes at most by this factor, or its inverse, at a time.
const LARGEST_CHANGE: f64 = 2.0;
/// Smaller changes are not worth it: they would follow the noise.
const SMALLEST_CHANGE: f64 = 1.2;

/// What the user asks of a run that chooses its acceleration.
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
    /// A window of the history, s.
    window: f64,
    acceleration: f64,
    /// Relative difference from the scout's contact area.
    difference: FadingMean,
    /// Square of that mean.
    square: FadingMean,
}

impl Choice {
    /// The choice of a run of this duration (s), which begins with m = 1.
    pub fn new(adaptive: &Adaptive, parameters: &Parameters, duration: f64) -> Self {
        let window = (duration / WINDOWS).max(SHORTEST_WINDOW);
        let unaccelerated = Parameters { time_acceleration: 1.0, ..parameters.clone() };
        let revolution = unaccelerated.step_time() * parameters.mesh.disc_columns() as f64;
        let resolved = window / (REVOLUTIONS_PER_WINDOW * revolution);
        let stable = match parameters.integrator {
            Integrator::Explicit => LARGEST_STIFFNESS_NUMBER / (f64::from(RATIO) * unaccelerated.stiffness_number()),
            Integrator::Exponential => f64::INFINITY,
        };
        Self::within(adaptive.tolerance, adaptive.largest.min(resolved).min(stable).max(1.0), window)
    }

    fn within(tolerance: f64, largest: f64, window: f64) -> Self {
        let (difference, square) = Default::default();
        Self { tolerance, largest, window, acceleration: 1.0, difference, square }
    }

    /// m of the coming steps.
    pub fn acceleration(&self) -> f64 {
        self.acceleration
    }

    /// Whether there is a choice at all.
    pub fn is_free(&self) -> bool {
        self.largest > 1.0
    }

    /// Estimate of the relative error of the contact area: what it differed from the scout's by, lately.
    pub fn error(&self) -> f64 {
        self.square.value().sqrt().max(self.difference.value().abs())
    }

    /// Goes back to m = 1, whose error is 0.
    pub fn give_up(&mut self) {
        *self = Self::within(self.tolerance, 1.0, self.window);
    }

    /// Takes note that over the last `elapsed` seconds the scout's contact area differed from that of the run by
    /// `difference`, relative to it, and chooses anew.
    pub fn note(&mut self, difference: f64, elapsed: f64) {
        self.difference.add(difference, elapsed / self.window);
        self.square.add(self.difference.value().powi(2), elapsed / (REVOLUTIONS_PER_WINDOW * self.window));
        let error = self.error();
        let wanted = if error > 0.0 { AIM * self.tolerance / error } else { LARGEST_CHANGE };
        if (1.0 / SMALLEST_CHANGE..SMALLEST_CHANGE).contains(&wanted) {
            return;
        }
        let change = wanted.clamp(1.0 / LARGEST_CHANGE, LARGEST_CHANGE);
        let before = self.acceleration;
        self.acceleration = (before * change).clamp(1.0, self.largest);
        // What was seen so far counts as if it had been seen at the new acceleration.
        let change = self.acceleration / before;
        self.difference.scale(change);
        self.square.scale(change * change);
    }
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

    /// 0 before anything was added.
    fn value(&self) -> f64 {
        if self.weight > 0.0 { self.sum / self.weight } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The acceleration after 200 looks at differences, each after four simulated revolutions of 1 s.
    fn settled(mut choice: Choice, difference: impl Fn(u32, f64) -> f64) -> f64 {
        for look in 0..200 {
            let acceleration = choice.acceleration();
            choice.note(difference(look, acceleration), f64::from(RATIO) * acceleration);
        }
        choice.acceleration()
    }

    #[test]
    fn the_difference_becomes_the_tolerance() {
        // By hand: where scout and run differ by 0.02 % per unit of m, AIM · 1 % is at m = AIM · 50.
        for sign in [1.0, -1.0] {
            let acceleration = settled(Choice::within(0.01, 1000.0, 100.0), |_, m| sign * 2e-4 * m);
            assert!(
                (AIM * 50.0 / SMALLEST_CHANGE..=AIM * 50.0 * SMALLEST_CHANGE).contains(&acceleration),
                "{acceleration}"
            );
        }
    }

    #[test]
    fn what_changes_its_sign_counts_too() {
        // ± 10 % from one look to the next is noise that means take away, but not all of it.
        let noisy = settled(Choice::within(0.01, 1000.0, 100.0), |look, _| if look % 2 == 0 { 0.1 } else { -0.1 });
        assert!(noisy < 20.0, "{noisy}");
    }

    #[test]
    fn nothing_to_see_leads_to_the_largest_and_too_much_to_none() {
        assert_eq!(settled(Choice::within(0.01, 300.0, 100.0), |_, _| 0.0), 300.0);
        assert_eq!(settled(Choice::within(0.01, 300.0, 100.0), |_, _| 0.5), 1.0);
        assert!(!Choice::within(0.01, 1.0, 100.0).is_free());
        // From 1 by doubling.
        let mut choice = Choice::within(0.01, 300.0, 100.0);
        let mut seen = Vec::new();
        for _ in 0..10 {
            choice.note(0.0, 1.0);
            seen.push(choice.acceleration());
        }
        assert_eq!(seen, [2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0, 256.0, 300.0, 300.0]);
    }

    #[test]
    fn a_fading_mean_is_the_exponential_mean() {
        // Closed form: weights 1 − 1/e for the last and (1 − 1/e)/e for the one before, over their sum.
        let mut mean = FadingMean::default();
        mean.add(3.0, 1.0);
        assert_eq!(mean.value(), 3.0);
        mean.add(1.0, 1.0);
        let e = std::f64::consts::E;
        assert!((mean.value() - (1.0 + 3.0 / e) / (1.0 + 1.0 / e)).abs() < 1e-15);
    }
}
