//! The series of a coated half-space: what its surface sees of every passage through the coating (model 11, passing
//! under the pin).

use std::f64::consts::PI;

/// Terms up to which the series is added up one by one.
const MOST_TERMS: f64 = 1000.0;
/// Intervals of the trapezoidal rule for longer ones.
const INTERVALS: u32 = 1000;

/// 1/√π + 2 Σ_{k ≥ 1} Γᵏ ierfc(k ε), Γ = (b_c − b_s)/(b_c + b_s), with the effusivities of coating and substrate and
/// the depth ε = d/√(a_c t) of the coating.
pub(super) fn sum(coating: f64, substrate: f64, depth: f64) -> f64 {
    let reflection = (coating - substrate) / (coating + substrate);
    // λ = −ln |Γ| without the rounding of Γ near 1.
    let decay = 2.0 * libm::atanh((substrate / coating).min(coating / substrate));
    // Beyond, e^(−λk) or ierfc is below 1e-16.
    let terms = (37.0 / decay).min(6.0 / depth);
    if terms > MOST_TERMS {
        return if reflection > 0.0 { of_one_sign(decay, depth, terms) } else { alternating(decay, depth) };
    }
    let (mut sum, mut power) = (1.0 / PI.sqrt(), 1.0);
    let mut number = 0.0;
    loop {
        number += 1.0;
        power *= reflection;
        let term = 2.0 * power * ierfc(number * depth);
        sum += term;
        if term.abs() < 1e-16 * sum || number > 2.0 * MOST_TERMS {
            return sum;
        }
    }
}

/// The sum for Γ > 0 by the formula of Euler and Maclaurin, once with the terms and once with the trapezoidal rule for
/// the integral that both have in common.
fn of_one_sign(decay: f64, depth: f64, terms: f64) -> f64 {
    let width = terms / f64::from(INTERVALS);
    let term = |number: f64| libm::exp(-decay * number) * ierfc(number * depth);
    let [first, third, fifth] = derivatives(decay, depth);
    let inner: f64 = (1..=INTERVALS).map(|interval| term(f64::from(interval) * width)).sum();
    let start = 1.0 / PI.sqrt();
    let square = width * width;
    let sum = width * (start / 2.0 + inner) - start / 2.0 + (square - 1.0) * first / 12.0
        - (square * square - 1.0) * third / 720.0
        + (square * square * square - 1.0) * fifth / 30240.0;
    start + 2.0 * sum
}

/// The sum for Γ < 0 by the formula of Boole, of which 1/√π leaves only the derivatives.
fn alternating(decay: f64, depth: f64) -> f64 {
    let [first, third, fifth] = derivatives(decay, depth);
    -first / 2.0 + third / 24.0 - fifth / 240.0
}

/// First, third and fifth derivative of e^(−λk) ierfc(k ε) by k at k = 0.
fn derivatives(decay: f64, depth: f64) -> [f64; 3] {
    let root = PI.sqrt();
    // ierfc(x) = 1/√π − x + x²/√π − x⁴/(6 √π) + …
    let (square, fourth) = (depth * depth / root, -depth.powi(4) / (6.0 * root));
    let first = -decay / root - depth;
    let third = -decay.powi(3) / 6.0 / root - decay.powi(2) / 2.0 * depth - decay * square;
    let fifth =
        -decay.powi(5) / 120.0 / root - decay.powi(4) / 24.0 * depth - decay.powi(3) / 6.0 * square - decay * fourth;
    [first, 6.0 * third, 120.0 * fifth]
}

/// ierfc(x) = exp(−x²)/√π − x erfc(x).
fn ierfc(x: f64) -> f64 {
    (libm::exp(-x * x) / PI.sqrt() - x * libm::erfc(x)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The series as it stands, term by term.
    fn term_by_term(coating: f64, substrate: f64, depth: f64) -> f64 {
        let reflection = (coating - substrate) / (coating + substrate);
        let term = |number: u32| reflection.powi(number as i32) * ierfc(f64::from(number) * depth);
        // The small ones first, and signs in pairs; as far as a term is more than 1e-16.
        let most = (40.0 / (2.0 * (substrate / coating).min(coating / substrate))).min(6.0 / depth);
        let pairs = (0..most as u32 / 2 + 1).rev().map(|pair| term(2 * pair + 1) + term(2 * pair + 2));
        1.0 / PI.sqrt() + 2.0 * pairs.sum::<f64>()
    }

    #[test]
    fn the_formulas_for_long_series_are_the_series() {
        // 37/0.0359 and 6/0.00599 terms are just above the limit; the remainder of Boole's formula is 17 λ⁶/20160
        // there.
        for (ratio, depth, tolerance) in [
            (0.01795, 1e-9, 1e-11),
            (0.01795, 1e-3, 1e-11),
            (1e-3, 0.00599, 1e-11),
            (1e-4, 1e-4, 1e-11),
            (1e-12, 1e-3, 1e-11),
        ] {
            for (coating, substrate) in [(1.0, ratio), (ratio, 1.0)] {
                let [found, expected] = [sum, term_by_term].map(|sum| sum(coating, substrate, depth));
                // Cancellation leaves the alternating series no more than some ulps of its first term.
                let rounding = 1e-14;
                assert!(
                    (found - expected).abs() <= tolerance * expected.abs() + rounding,
                    "{coating} {substrate} {depth}: {found:e}, {expected:e}"
                );
            }
        }
    }

    #[test]
    fn a_coating_far_thinner_than_heat_gets_shows_the_substrate() {
        // Model 12: 2 √(t/π)/b_s + (d/λ_c)(1 − b_c²/b_s²) for long times, in units of 2 √t/b_c; the next term is of
        // order ε².
        let depth = 1e-13;
        for substrate in [1e-3, 1e-2, 0.1, 10.0, 1e3, 1e9] {
            let expected = 1.0 / PI.sqrt() / substrate + depth / 2.0 * (1.0 - 1.0 / (substrate * substrate));
            let found = sum(1.0, substrate, depth);
            // What is added up one by one is rounded against 1/√π.
            let rounding = if substrate < 100.0 { 1e-14 } else { 0.0 };
            assert!((found - expected).abs() < 1e-11 * expected + rounding, "{substrate}: {found:e}, {expected:e}");
        }
    }
}
