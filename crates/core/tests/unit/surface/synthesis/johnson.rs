use super::*;

/// Parameters with skewness and kurtosis: scipy 1.17.1, `johnsonsu(γ, δ).stats` and `lognorm(1/δ).stats` (closed
/// forms), and for the bounded ones `integrate.quad` over the definition to 1e-13 (`johnsonsb.stats` is good to
/// 1e-5 only).
const KNOWN: [(Johnson, f64, f64); 13] = [
    (Johnson::Unbounded { gamma: 0.0, delta: 2.0 }, 0.0, 4.5078621849296505),
    (Johnson::Unbounded { gamma: 1.0, delta: 2.0 }, -0.874483851800844, 5.586965781247806),
    (Johnson::Unbounded { gamma: -1.5, delta: 1.8 }, 1.4691934048864015, 8.18969103584745),
    (Johnson::Unbounded { gamma: 0.3, delta: 5.0 }, -0.0374270216431711, 3.1719231932142766),
    (Johnson::Unbounded { gamma: 2.0, delta: 1.5 }, -2.407913947189931, 15.747585345834917),
    (Johnson::Bounded { gamma: 0.0, delta: 0.5 }, 0.0, 1.6272908060148703),
    (Johnson::Bounded { gamma: 0.0, delta: 2.0 }, 0.0, 2.6313253266312797),
    (Johnson::Bounded { gamma: 0.8, delta: 1.0 }, 0.5771102501830966, 2.622019552271528),
    (Johnson::Bounded { gamma: -1.2, delta: 0.7 }, -1.249630867982773, 3.942344212442865),
    (Johnson::Bounded { gamma: 2.5, delta: 2.0 }, 0.7008263161862754, 3.4964463138285167),
    (Johnson::Bounded { gamma: 0.3, delta: 0.25 }, 0.4420105430741206, 1.5191163903721405),
    (Johnson::Lognormal { sign: 1.0, delta: 1.5 }, 2.6628826969179102, 17.801305742892307),
    (Johnson::Lognormal { sign: -1.0, delta: 4.0 }, -0.7782516357974832, 4.095931274730179),
];

fn parameters(distribution: Johnson) -> (u8, f64, f64) {
    match distribution {
        Johnson::Normal => (0, 0.0, 1.0),
        Johnson::Lognormal { sign, delta } => (1, sign, delta),
        Johnson::Unbounded { gamma, delta } => (2, gamma, delta),
        Johnson::Bounded { gamma, delta } => (3, gamma, delta),
    }
}

#[test]
fn moments_give_the_parameters() {
    // The parameters of the unbounded (δ = 5) and bounded distributions nearest to the lognormal line move by some
    // thousand times the last digits of the moments.
    for (expected, skewness, kurtosis) in KNOWN {
        let found = parameters(Johnson::with_moments(skewness, kurtosis).unwrap());
        let expected = parameters(expected);
        assert_eq!(found.0, expected.0, "{skewness} {kurtosis}");
        assert!((found.1 - expected.1).abs() < 1e-9, "γ {} for {}", found.1, expected.1);
        assert!((found.2 - expected.2).abs() < 1e-9, "δ {} for {}", found.2, expected.2);
    }
}

#[test]
fn every_skewness_and_kurtosis_that_is_accepted_is_met() {
    // The moments of what was found, by quadrature; on the lognormal line to the tolerance of that.
    let mut families = [0; 4];
    for skewness in [0.0, 1e-5, 1e-3, 0.05, 0.5, 1.0, 2.0, -0.3, -4.0] {
        let least: f64 = skewness * skewness + 1.0;
        for above in [0.3, 0.5, 1.0, 1.9, 2.0, 2.0001, 2.01, 2.5, 4.0, 10.0, 30.0, 80.0] {
            let Ok(found) = Johnson::with_moments(skewness, least + above) else { continue };
            families[usize::from(parameters(found).0)] += 1;
            let nodes = || {
                normal_nodes((0.5 * found.delta()).min(0.1), 9.0 + 4.0 / found.delta().max(0.5))
                    .map(|(x, weight)| (found.height(x), weight))
            };
            let mean: f64 = nodes().map(|(z, w)| w * z).sum();
            let moment = |power| nodes().map(|(z, w)| w * (z - mean).powi(power)).sum::<f64>();
            let variance = moment(2);
            let tolerance = if let Johnson::Lognormal { .. } | Johnson::Normal = found { 1e-4 } else { 1e-7 };
            let (s, k) = (moment(3) / variance.powf(1.5), moment(4) / (variance * variance));
            assert!((s - skewness).abs() < tolerance, "{found:?}: skewness {s} for {skewness}");
            assert!((k - least - above).abs() < tolerance * k, "{found:?}: kurtosis {k} for {}", least + above);
        }
    }
    assert!(families.iter().all(|count| *count > 0), "{families:?}");
}

#[test]
fn what_has_no_distribution_is_refused_with_the_least_kurtosis() {
    for (skewness, kurtosis) in
        [(0.0, 1.0), (0.0, 0.0), (1.0, 1.9), (1.0, 2.0), (3.0, 9.9), (0.0, 101.0), (0.0, f64::NAN), (f64::NAN, 3.0)]
    {
        let error = Johnson::with_moments(skewness, kurtosis).unwrap_err();
        let SynthesisError::Kurtosis { least, most, .. } = error else { panic!("{error}") };
        if skewness.is_finite() {
            assert!(least > skewness * skewness + 1.0);
            Johnson::with_moments(skewness, least * (1.0 + 1e-12)).unwrap();
            Johnson::with_moments(skewness, most).unwrap();
        }
    }
}
