use super::*;

/// For u and v normal with variance c = 1/δ² and covariance cr about −Ω, E[e^u e^v] = e^(−2Ω + c(1 + r)); so
/// f(r) = (cosh 2Ω (e^(cr) − 1) + 1 − e^(−cr)) / (cosh 2Ω (e^c − 1) + 1 − e^(−c)), lognormal for Ω → ∞.
fn closed_form(distribution: Johnson, r: f64) -> f64 {
    let (hyperbolic, delta) = match distribution {
        Johnson::Unbounded { gamma, delta } => ((2.0 * gamma / delta).cosh(), delta),
        Johnson::Lognormal { delta, .. } => (1e300, delta),
        _ => panic!("no closed form"),
    };
    let c = 1.0 / (delta * delta);
    let value = |r: f64| hyperbolic * (c * r).exp_m1() - (-c * r).exp_m1();
    value(r) / value(1.0)
}

#[test]
fn the_series_agrees_with_the_closed_forms() {
    for distribution in [
        Johnson::Unbounded { gamma: 0.0, delta: 0.9 },
        Johnson::Unbounded { gamma: 1.0, delta: 2.0 },
        Johnson::Unbounded { gamma: -2.0, delta: 1.5 },
        Johnson::Lognormal { sign: 1.0, delta: 1.1 },
        Johnson::Lognormal { sign: -1.0, delta: 4.0 },
    ] {
        let translation = Translation::new(distribution);
        for step in -10..=10 {
            let r = f64::from(step) / 10.0;
            let (found, expected) = (translation.value(r).0, closed_form(distribution, r));
            assert!((found - expected).abs() < 1e-12, "{distribution:?}: f({r}) = {found}, expected {expected}");
        }
    }
}

/// The definition, E[T(x) T(y)] with y = rx + √(1 − r²) w and w independent of x.
#[test]
fn the_series_of_bounded_distributions_agrees_with_the_double_integral() {
    for (gamma, delta) in [(0.0, 0.3), (0.8, 1.0), (-1.5, 0.5)] {
        let distribution = Johnson::Bounded { gamma, delta };
        let translation = Translation::new(distribution);
        let nodes: Vec<(f64, f64)> = normal_nodes(0.05, 9.0).collect();
        let mean: f64 = nodes.iter().map(|(x, weight)| weight * distribution.height(*x)).sum();
        let covariance = |r: f64| -> f64 {
            let other = |x: f64, w: f64| distribution.height(r * x + (1.0 - r * r).sqrt() * w) - mean;
            let inner = |x: f64| nodes.iter().map(|(w, weight)| weight * other(x, *w)).sum::<f64>();
            nodes.iter().map(|(x, weight)| weight * (distribution.height(*x) - mean) * inner(*x)).sum()
        };
        let variance = covariance(1.0);
        for r in [-0.7, 0.2, 0.5, 0.8] {
            let (found, expected) = (translation.value(r).0, covariance(r) / variance);
            // Powers beyond the 64th, 1e-6 of f(1) at δ = 0.3, times 0.8^64; then rounding of sums of 361² terms.
            assert!((found - expected).abs() < 1e-11, "γ {gamma}, δ {delta}: f({r}) = {found}, not {expected}");
        }
    }
}

#[test]
fn the_inverse_is_one() {
    for distribution in [
        Johnson::Bounded { gamma: 0.8, delta: 0.3 },
        Johnson::Bounded { gamma: 0.0, delta: 0.2 },
        Johnson::Unbounded { gamma: 1.0, delta: 1.2 },
        Johnson::Lognormal { sign: 1.0, delta: 1.1 },
    ] {
        let translation = Translation::new(distribution);
        for step in -100..=100 {
            let r = f64::from(step) / 100.0;
            let (value, slope) = translation.value(r);
            let found = translation.inverse(value);
            assert!((found - r).abs() < 1e-14 * (1.0 + 1.0 / slope), "{distribution:?}: {found} for {r}");
        }
        assert_eq!(translation.inverse(0.0), 0.0);
        assert_eq!(translation.inverse(-2.0), -1.0);
        assert!((translation.inverse(1e-300) / 1e-300 * translation.shares[0] - 1.0).abs() < 1e-12);
    }
}
