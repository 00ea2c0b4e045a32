//! How much a response is liked, from 0 to 1.
//!
//! Derringer, G. & Suich, R. (1980): Simultaneous optimization of several response variables. J. Quality Technology 12,
//! 214–219, doi:10.1080/00224065.1980.11980968.

/// What a response should be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wish {
    /// As large as can be: worth nothing up to the first value, everything from the second on.
    Maximum([f64; 2]),
    /// As small as can be: worth everything up to the first value, nothing from the second on.
    Minimum([f64; 2]),
    /// The middle value; worth nothing at the first and the last and beyond them.
    Target([f64; 3]),
}

/// A wish and how it counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// Which response, by index.
    pub response: usize,
    /// What it should be.
    pub wish: Wish,
    /// Power of the part of the way between worth nothing and everything: 1 is a straight line, more asks to come near.
    pub weight: f64,
    /// Power of the desirability in the mean of all.
    pub importance: f64,
}

impl Wish {
    /// How much of the way a response has gone from worth nothing to worth everything; below 0 where it is worth nothing.
    pub fn part(&self, response: f64) -> f64 {
        let part = |from: f64, to: f64| (response - from) / (to - from);
        match *self {
            Self::Maximum([low, high]) => part(low, high),
            Self::Minimum([low, high]) => part(high, low),
            Self::Target([low, target, _]) if response <= target => part(low, target),
            Self::Target([_, target, high]) => part(high, target),
        }
    }

    /// The same, but what is better than its best end counts, too, up to a hundred times as far: to find how good a response may
    /// become.
    #[must_use]
    pub fn without_end(self) -> Self {
        const FAR: f64 = 100.0;
        match self {
            Self::Maximum([low, high]) => Self::Maximum([low - FAR * (high - low), high + FAR * (high - low)]),
            Self::Minimum([low, high]) => Self::Minimum([low - FAR * (high - low), high + FAR * (high - low)]),
            target @ Self::Target(_) => target,
        }
    }

    /// The same with everything at this response, if that is better than where it was.
    #[must_use]
    pub fn up_to(self, response: f64) -> Self {
        match self {
            Self::Maximum([low, high]) => Self::Maximum([low, high.max(response)]),
            Self::Minimum([low, high]) => Self::Minimum([low.min(response), high]),
            target @ Self::Target(_) => target,
        }
    }

    /// Whether its values ascend, so that there is a way between them.
    pub fn is_sound(&self) -> bool {
        match *self {
            Self::Maximum([low, high]) | Self::Minimum([low, high]) => low < high,
            Self::Target([low, target, high]) => low < target && target < high,
        }
    }
}

impl Goal {
    /// How much a response is liked, from 0 to 1.
    pub fn desirability(&self, response: f64) -> f64 {
        let part = self.wish.part(response);
        if part.is_nan() { 0.0 } else { part.clamp(0.0, 1.0).powf(self.weight) }
    }
}

/// The mean of desirabilities: geometric, so that what one response makes worth nothing no other one can save.
pub fn overall(goals: &[Goal], desirabilities: &[f64]) -> f64 {
    let total: f64 = goals.iter().map(|goal| goal.importance).sum();
    if desirabilities.iter().any(|desirability| *desirability <= 0.0) {
        return 0.0;
    }
    let sum: f64 =
        goals.iter().zip(desirabilities).map(|(goal, desirability)| goal.importance * desirability.ln()).sum();
    (sum / total).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn goal(wish: Wish, weight: f64) -> Goal {
        Goal { response: 0, wish, weight, importance: 1.0 }
    }

    #[test]
    fn desirabilities_by_hand() {
        let most = goal(Wish::Maximum([120.0, 170.0]), 1.0);
        assert_eq!([100.0, 120.0, 145.0, 170.0, 200.0].map(|y| most.desirability(y)), [0.0, 0.0, 0.5, 1.0, 1.0]);
        let least = goal(Wish::Minimum([1.0, 3.0]), 2.0);
        assert_eq!([0.0, 1.0, 2.0, 3.0].map(|y| least.desirability(y)), [1.0, 1.0, 0.25, 0.0]);
        let target = goal(Wish::Target([400.0, 500.0, 700.0]), 0.5);
        assert_eq!(
            [399.0, 425.0, 500.0, 550.0, 700.0].map(|y| target.desirability(y)),
            [0.0, 0.5, 1.0, 0.75_f64.sqrt(), 0.0]
        );
        assert_eq!(target.desirability(f64::NAN), 0.0);
    }

    #[test]
    fn the_mean_is_geometric() {
        let goals = [1.0, 3.0].map(|importance| Goal { importance, ..goal(Wish::Maximum([0.0, 1.0]), 1.0) });
        // (0.0625 · 0.5³)^(1/4) = (2⁻⁴ · 2⁻³)^(1/4)
        assert!((overall(&goals, &[0.0625, 0.5]) - 2.0_f64.powf(-1.75)).abs() < 1e-15);
        assert_eq!(overall(&goals, &[0.0, 1.0]), 0.0);
        assert_eq!(overall(&goals, &[1.0, 1.0]), 1.0);
    }
}
