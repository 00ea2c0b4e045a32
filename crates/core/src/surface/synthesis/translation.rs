//! Change of the autocorrelation of a Gaussian field when its heights are given another distribution.
//!
//! A field T(g) of a Gaussian field g of unit variance and autocorrelation r has the autocorrelation
//!
//! ```text
//! f(r) = Σ_{k ≥ 1} a_k² r^k / Σ_{k ≥ 1} a_k²,        a_k = E[T(x) He_k(x)] / √k!,   x standard normal
//! ```
//!
//! (Grigoriu 1984, doi:10.1061/(ASCE)0733-9399(1984)110:4(610); by Mehler's expansion). So that T(g) has the
//! autocorrelation asked for, g is given its inverse f⁻¹.

use super::johnson::{Johnson, normal_nodes};

/// Most terms of the series.
const MOST_TERMS: usize = 64;
/// Share that the powers of r beyond the last may have without being looked at.
const NEGLECTED: f64 = 1e-14;

/// The map f of autocorrelations.
#[derive(Debug)]
pub(in crate::surface) struct Translation {
    /// Share of each power of r, from r¹ on; together 1.
    shares: Vec<f64>,
}

impl Translation {
    pub(super) fn new(distribution: Johnson) -> Self {
        // T grows as exp(x/δ).
        let step = (0.5 * distribution.delta()).min(0.0625);
        Self::of(|x| distribution.height(x), step, 2.0 / distribution.delta())
    }

    /// Map f for the heights T(x) by quadrature with this step; T may grow beyond any bound if `growth` adds to the range of x
    /// what it needs.
    pub(in crate::surface) fn of(height: impl Fn(f64) -> f64, step: f64, growth: f64) -> Self {
        // The product of He_k and the normal density falls as exp(−x²/4) beyond 2√k.
        let reach = 12.0 + 2.0 * (MOST_TERMS as f64).sqrt() + growth;
        let (mut mean, mut square, mut coefficients) = (0.0, 0.0, [0.0; MOST_TERMS]);
        for (x, weight) in normal_nodes(step, reach) {
            let at = height(x);
            let height = weight * at;
            mean += height;
            square += height * at;
            // He_k/√k! by its recurrence.
            let (mut before, mut hermite) = (1.0, x);
            for (k, coefficient) in coefficients.iter_mut().enumerate() {
                *coefficient += height * hermite;
                let k = (k + 1) as f64;
                (before, hermite) = (hermite, (x * hermite - k.sqrt() * before) / (k + 1.0).sqrt());
            }
        }
        let variance = square - mean * mean;
        let mut shares = Vec::with_capacity(MOST_TERMS);
        let mut rest = 1.0;
        for coefficient in coefficients {
            let share = coefficient * coefficient / variance;
            shares.push(share);
            rest -= share;
            if rest < NEGLECTED {
                break;
            }
        }
        // Powers beyond the last count as the last, so that f(1) = 1.
        if let Some(last) = shares.last_mut() {
            *last += rest.max(0.0);
        }
        Self { shares }
    }

    /// f and its derivative at r.
    fn value(&self, r: f64) -> (f64, f64) {
        let (mut value, mut slope) = (0.0, 0.0);
        for share in self.shares.iter().rev() {
            slope = slope * r + value;
            value = value * r + share;
        }
        // So far Σ c_k r^(k−1).
        (value * r, slope * r + value)
    }

    /// Autocorrelation that the Gaussian field must have; f increases from f(−1) to 1.
    ///
    /// An autocorrelation below f(−1), which the distribution cannot have, gives −1.
    pub(in crate::surface) fn inverse(&self, autocorrelation: f64) -> f64 {
        let (mut low, mut high) = (-1.0, 1.0);
        let mut r = autocorrelation.clamp(low, high);
        // Newton's method, kept between bounds that close in.
        for _ in 0..100 {
            let (value, slope) = self.value(r);
            if value < autocorrelation {
                low = r;
            } else {
                high = r;
            }
            let newton = r - (value - autocorrelation) / slope;
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            if (next - r).abs() <= f64::EPSILON * r.abs() {
                break;
            }
            r = next;
        }
        r
    }
}

#[cfg(test)]
#[path = "../../../tests/unit/surface/synthesis/translation.rs"]
mod tests;
