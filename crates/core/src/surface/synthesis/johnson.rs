//! Johnson's system of distributions: one for every skewness and kurtosis that a distribution can have.
//!
//! With x standard normal a height is, up to its mean and scale,
//!
//! ```text
//! normal      x                                 skewness 0, kurtosis 3
//! lognormal   exp(x/δ)                          kurtosis of the lognormal line
//! unbounded   sinh((x − γ)/δ)                   kurtosis above that line
//! bounded     1/(1 + exp(−(x − γ)/δ))           kurtosis below it, down to skewness² + 1 (two heights only)
//! ```
//!
//! Johnson (1949, doi:10.1093/biomet/36.1-2.149); the choice of the family and the fit by moments as in Hill, Hill and
//! Holder (1976, doi:10.2307/2346692, AS 99). Kurtosis is that of ISO 25178-2, 3 for a normal distribution.

use std::f64::consts::TAU;

use crate::surface::error::SynthesisError;

/// Points and weights of the trapezoidal rule for means over the standard normal distribution, from −`reach` to `reach`.
///
/// For smooth functions its error falls as exp(−2π²/step²), and with a singularity at the distance d from the real axis
/// as exp(−2πd/step).
pub(super) fn normal_nodes(step: f64, reach: f64) -> impl Iterator<Item = (f64, f64)> {
    let last = libm::ceil(reach / step) as i32;
    (-last..=last).map(move |index| {
        let x = f64::from(index) * step;
        (x, step * libm::exp(-0.5 * x * x) / TAU.sqrt())
    })
}

/// Kurtosis closer than this to the lognormal line, and skewness closer than this to 0, count as on it. The parameters
/// of the other families run to infinity there.
const ON_THE_LINE: f64 = 1e-4;
/// Smallest δ of a bounded distribution; below it all but two heights are rare.
const SHARPEST: f64 = 0.2;
/// Largest kurtosis. Beyond, a few cells of even a large field make up the moment.
const LARGEST_KURTOSIS: f64 = 100.0;
/// Halvings of an interval: more than a double has digits.
const HALVINGS: usize = 64;

/// A distribution of the system, without its mean and scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Johnson {
    Normal,
    /// Lognormal heights, γ = 0; the other sign for negative skewness.
    Lognormal {
        sign: f64,
        delta: f64,
    },
    Unbounded {
        gamma: f64,
        delta: f64,
    },
    Bounded {
        gamma: f64,
        delta: f64,
    },
}

impl Johnson {
    /// The distribution with this skewness and kurtosis, to [`ON_THE_LINE`] or better.
    ///
    /// # Errors
    /// [`SynthesisError::Kurtosis`] when there is none, or when it is all but two heights or all but a few spikes.
    pub(super) fn with_moments(skewness: f64, kurtosis: f64) -> Result<Self, SynthesisError> {
        let least = skewness * skewness + 1.0;
        let refuse = |least, most| Err(SynthesisError::Kurtosis { skewness, found: kurtosis, least, most });
        if !(kurtosis > least && kurtosis <= LARGEST_KURTOSIS && skewness.is_finite()) {
            return refuse(least.max(bounded_kurtosis(skewness.abs(), SHARPEST)), LARGEST_KURTOSIS);
        }
        let size = skewness.abs();
        let lognormal = lognormal_with(size);
        if (kurtosis - lognormal_kurtosis(lognormal)).abs() < ON_THE_LINE {
            return Ok(if size < ON_THE_LINE {
                Self::Normal
            } else {
                Self::Lognormal { sign: skewness.signum(), delta: 1.0 / libm::log(lognormal).sqrt() }
            });
        }
        if kurtosis > lognormal_kurtosis(lognormal) {
            let (gamma, delta) = unbounded(size, kurtosis);
            return Ok(Self::Unbounded { gamma: -skewness.signum() * gamma, delta });
        }
        let sharpest = bounded_kurtosis(size, SHARPEST);
        if kurtosis < sharpest {
            return refuse(sharpest, LARGEST_KURTOSIS);
        }
        // The largest δ for this skewness is that of the lognormal distribution, which has γ = ∞.
        let widest = if size > 0.0 { (1.0 / libm::log(lognormal).sqrt()).min(1e3) } else { 1e3 };
        let delta = bisect(SHARPEST, widest, |delta| bounded_kurtosis(size, delta) < kurtosis);
        let gamma = bounded_gamma(size, delta);
        Ok(Self::Bounded { gamma: gamma.copysign(skewness), delta })
    }

    /// The height that belongs to a standard normal number; increasing.
    pub(super) fn height(self, x: f64) -> f64 {
        match self {
            Self::Normal => x,
            Self::Lognormal { sign, delta } => sign * libm::exp(sign * x / delta),
            Self::Unbounded { gamma, delta } => libm::sinh((x - gamma) / delta),
            Self::Bounded { gamma, delta } => 1.0 / (1.0 + libm::exp(-(x - gamma) / delta)),
        }
    }

    /// Width in x over which the height changes, for choosing points of a quadrature.
    pub(super) fn delta(self) -> f64 {
        match self {
            Self::Normal => 1.0,
            Self::Lognormal { delta, .. } | Self::Unbounded { delta, .. } | Self::Bounded { delta, .. } => delta,
        }
    }

    /// Skewness and kurtosis of a bounded distribution, by quadrature: they have no closed form.
    fn moments(self) -> [f64; 2] {
        let reach = 9.0;
        let nodes = || normal_nodes((0.5 * self.delta()).min(0.25), reach).map(|(x, weight)| (self.height(x), weight));
        let mean = nodes().map(|(height, weight)| weight * height).sum::<f64>();
        let mut sums = [0.0; 3];
        for (height, weight) in nodes() {
            let deviation = height - mean;
            let square = deviation * deviation;
            let powers = [square, square * deviation, square * square];
            sums.iter_mut().zip(powers).for_each(|(sum, power)| *sum += weight * power);
        }
        let [square, cube, fourth] = sums;
        [cube / (square * square.sqrt()), fourth / (square * square)]
    }
}

/// Finds the place where a condition that holds at `low` and not at `high` ceases to hold.
fn bisect(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// ω = exp(1/δ²) of the lognormal distribution with this skewness: (ω − 1)(ω + 2)² = skewness².
fn lognormal_with(skewness: f64) -> f64 {
    let square = skewness * skewness;
    1.0 + bisect(0.0, square / 9.0, |excess| excess * (excess + 3.0) * (excess + 3.0) < square)
}

/// Kurtosis of the lognormal distribution with ω = exp(1/δ²).
fn lognormal_kurtosis(omega: f64) -> f64 {
    let square = omega * omega;
    square * (square + 2.0 * omega + 3.0) - 3.0
}

/// |γ| and δ of the unbounded distribution with |skewness| and kurtosis.
///
/// With ω = exp(1/δ²), Ω = γ/δ and C = cosh 2Ω the moments are (Johnson 1949)
///
/// ```text
/// skewness² = ω (ω − 1) sinh²Ω (ω (ω + 2)(2C + 1) + 3)² / (2 (ωC + 1)³)
/// kurtosis  = (ω² (ω⁴ + 2ω³ + 3ω² − 3)(2C² − 1) + 4ω² (ω + 2) C + 3 (2ω + 1)) / (2 (ωC + 1)²)
/// ```
///
/// For a given kurtosis the second is a quadratic equation for C, and the first falls from the lognormal skewness to 0
/// as ω runs from the lognormal value to that of the symmetric distribution (Tuenter 2001,
/// doi:10.1080/00949650108812126).
fn unbounded(skewness: f64, kurtosis: f64) -> (f64, f64) {
    let cosh = |omega: f64| {
        let square = omega * omega;
        let a = square * lognormal_kurtosis(omega);
        let quadratic = 2.0 * (a - kurtosis * square);
        let linear = 4.0 * omega * (square + 2.0 * omega - kurtosis);
        let constant = 3.0 * (2.0 * omega + 1.0) - a - 2.0 * kurtosis;
        let root = (linear * linear - 4.0 * quadratic * constant).max(0.0).sqrt();
        ((root - linear) / (2.0 * quadratic)).max(1.0)
    };
    let skewness_at = |omega: f64| {
        let c = cosh(omega);
        let bracket = omega * (omega + 2.0) * (2.0 * c + 1.0) + 3.0;
        let below = omega * c + 1.0;
        (omega * (omega - 1.0) * 0.5 * (c - 1.0) / (2.0 * below)).sqrt() * bracket / below
    };
    let symmetric = ((2.0 * kurtosis - 2.0).sqrt() - 1.0).sqrt();
    let lognormal = bisect(1.0, symmetric, |omega| lognormal_kurtosis(omega) < kurtosis);
    let omega = bisect(lognormal, symmetric, |omega| skewness_at(omega) > skewness);
    let delta = 1.0 / libm::log(omega).sqrt();
    (delta * libm::asinh((0.5 * (cosh(omega) - 1.0)).sqrt()), delta)
}

/// γ ≥ 0 of the bounded distribution with this δ and |skewness|, which grows with γ.
fn bounded_gamma(skewness: f64, delta: f64) -> f64 {
    if skewness == 0.0 {
        return 0.0;
    }
    let below = |gamma: f64| Johnson::Bounded { gamma, delta }.moments()[0] < skewness;
    let mut high = 1.0;
    // Beyond 100 δ the distribution is lognormal to the last digit.
    while below(high) && high < 1.0 + 100.0 * delta {
        high *= 2.0;
    }
    bisect(0.0, high, below)
}

/// Kurtosis of the bounded distribution with this δ and |skewness|.
fn bounded_kurtosis(skewness: f64, delta: f64) -> f64 {
    Johnson::Bounded { gamma: bounded_gamma(skewness, delta), delta }.moments()[1]
}

#[cfg(test)]
#[path = "../../../tests/unit/surface/synthesis/johnson.rs"]
mod tests;
