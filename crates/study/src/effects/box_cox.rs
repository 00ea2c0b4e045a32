//! Which power of a response a model fits best.
//!
//! Box, G. E. P. & Cox, D. R. (1964): An analysis of transformations. J. R. Stat. Soc. B 26, 211–252,
//! doi:10.1111/j.2517-6161.1964.tb00553.x. With u = y/ẏ, ẏ the geometric mean, the log-likelihood of a power λ, maximised
//! over all other parameters, is −n/2·ln RSS(λ) and a constant, with the residual sum of squares of (u^λ − 1)/λ (ln u where
//! λ = 0). The interval has all powers that lose less than half the quantile of χ² of one degree of freedom.

use nalgebra::{DMatrix, DVector};

use super::distribution::half_normal_quantile;
use super::result::Effects;
use super::transform::Transform;

/// Degrees of freedom of the error, at least: the interval takes its scatter for known, and would be a point.
const LEAST_FREEDOM: usize = 3;

/// Powers that are looked at.
const POWERS: [f64; 2] = [-5.0, 5.0];
/// Distance of the powers at which the search begins.
const STEP: f64 = 0.05;
/// Powers below this are the logarithm: the power's own rounding would be larger than what it changes.
const LOGARITHM: f64 = 1e-7;
/// The golden ratio's smaller part.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// The power that fits best.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoxCox {
    /// The power; 1 is the response itself, 0 its logarithm.
    pub power: f64,
    /// Powers that fit hardly worse, at the confidence level of the analysis. They are looked for between −5 and 5.
    pub interval: [f64; 2],
}

impl BoxCox {
    /// Powers between which the best is looked for.
    pub const POWERS: [f64; 2] = POWERS;

    /// Whether a power fits hardly worse than the best.
    pub fn allows(&self, power: f64) -> bool {
        (self.interval[0]..=self.interval[1]).contains(&power)
    }

    /// The transform to try in place of the one that was fitted: none if that one is as good as any, is no power, or no
    /// other one fits.
    pub fn advice(&self, fitted: Option<Transform>) -> Option<Advice> {
        let power = fitted.map_or(Some(1.0), Transform::power)?;
        if self.allows(power) {
            return None;
        }
        if self.allows(1.0) {
            return Some(Advice::NoTransform);
        }
        let others = [Transform::Logarithm, Transform::SquareRoot].into_iter();
        let allowed = others.filter(|other| other.power().is_some_and(|power| self.allows(power)));
        let distance =
            |transform: &Transform| transform.power().map_or(f64::INFINITY, |power| (power - self.power).abs());
        let best = allowed.min_by(|one, other| distance(one).total_cmp(&distance(other)));
        Some(best.map_or(Advice::OtherPower, Advice::Try))
    }
}

/// What the best power says of the transform.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Advice {
    /// This one fits.
    Try(Transform),
    /// The response itself fits.
    NoTransform,
    /// Neither the response nor a transform that there is fits.
    OtherPower,
}

/// Residual sums of squares of powers of a response.
struct Powers {
    /// Logarithms of the responses by their geometric mean.
    logarithms: DVector<f64>,
    /// Orthogonal directions of the model.
    basis: DMatrix<f64>,
}

impl Powers {
    fn log_likelihood(&self, power: f64) -> f64 {
        let transformed = match power.abs() < LOGARITHM {
            true => self.logarithms.clone(),
            false => self.logarithms.map(|logarithm| (power * logarithm).exp_m1() / power),
        };
        let left = &transformed - &self.basis * self.basis.tr_mul(&transformed);
        -0.5 * left.len() as f64 * left.norm_squared().ln()
    }

    /// The power of the largest likelihood, near the best of a grid.
    fn best(&self) -> f64 {
        let count = ((POWERS[1] - POWERS[0]) / STEP).round() as usize;
        let grid = (0..=count).map(|at| POWERS[0] + STEP * at as f64);
        let best = grid.map(|power| (power, self.log_likelihood(power)));
        let best = best.max_by(|one, other| one.1.total_cmp(&other.1)).map_or(1.0, |(power, _)| power);
        let (mut low, mut high) = ((best - STEP).max(POWERS[0]), (best + STEP).min(POWERS[1]));
        // Golden section: each step leaves 0.62 of the interval, 40 of them leave 1e-10.
        for _ in 0..40 {
            let [left, right] = [low + GOLDEN * (high - low), high - GOLDEN * (high - low)];
            if self.log_likelihood(left) > self.log_likelihood(right) { high = right } else { low = left }
        }
        0.5 * (low + high)
    }

    /// How far powers go on one side of the best whose likelihood is at least this.
    fn end(&self, best: f64, least: f64, end: f64) -> f64 {
        let (mut inside, mut outside) = (best, best);
        let step = STEP.copysign(end - best);
        while self.log_likelihood(outside) >= least {
            inside = outside;
            if outside == end {
                return end;
            }
            outside = if (end - outside).abs() <= STEP { end } else { outside + step };
        }
        for _ in 0..50 {
            let middle = 0.5 * (inside + outside);
            if self.log_likelihood(middle) >= least { inside = middle } else { outside = middle }
        }
        inside
    }
}

impl Effects {
    /// The power of the response that this model fits best; `fitted` is what the responses of this analysis were transformed
    /// by. None where a response is not above 0, or the error has fewer than three degrees of freedom.
    pub fn box_cox(&self, fitted: Option<Transform>) -> Option<BoxCox> {
        self.residual_standard_deviation?;
        let inner = &self.inner;
        let original = |response: &f64| fitted.map_or(*response, |transform| transform.back(*response));
        let responses: Vec<f64> = inner.usable.responses.iter().map(original).collect();
        if !responses.iter().all(|response| *response > 0.0) {
            return None;
        }
        let mut logarithms = DVector::from_iterator(responses.len(), responses.iter().map(|response| response.ln()));
        let mean = logarithms.mean();
        logarithms.add_scalar_mut(-mean);
        let basis = self.basis()?;
        if basis.nrows() < basis.ncols() + LEAST_FREEDOM {
            return None;
        }
        let powers = Powers { logarithms, basis };
        let power = powers.best();
        let least = powers.log_likelihood(power) - 0.5 * half_normal_quantile(self.confidence).powi(2);
        Some(BoxCox { power, interval: POWERS.map(|end| powers.end(power, least, end)) })
    }
}
