use super::*;

const IRON: Substance = Substance { conductivity: 50.0, density: 7200.0, specific_heat: 500.0 };
const CERMET: Substance = Substance { conductivity: 15.0, density: 13500.0, specific_heat: 250.0 };

fn coated(thickness: f64) -> Passing {
    Passing { substrate: IRON, coating: Some(Coating { thickness, substance: CERMET }) }
}

const BARE: Passing = Passing { substrate: IRON, coating: None };

#[test]
fn short_times_see_the_coating_alone_and_long_ones_the_substrate_behind_it() {
    let (thick, thin) = (coated(60e-6), coated(60e-6));
    let coating = Passing { substrate: CERMET, coating: None };
    // Model section 12: U → 2 √(t/π)/b_c for short times.
    for time in [1e-9, 1e-7, 1e-5] {
        assert!((thick.response(time) / coating.response(time) - 1.0).abs() < 1e-14, "{time}");
    }
    // And 2 √(t/π)/b_s + (d/λ_c)(1 − b_c²/b_s²) for long ones; the next term falls as 1/√t.
    let ratio = CERMET.effusivity() / IRON.effusivity();
    for time in [1e2, 1e4, 1e6] {
        let limit = BARE.response(time) + 60e-6 / 15.0 * (1.0 - ratio * ratio);
        assert!((thin.response(time) / limit - 1.0).abs() < 1e-4 / time.sqrt(), "{time}");
    }
}

#[test]
fn a_coating_of_the_same_substance_is_none_whatever_its_thickness() {
    for thickness in [1e-9, 60e-6, 1.0] {
        let same = Passing { substrate: IRON, coating: Some(Coating { thickness, substance: IRON }) };
        assert_eq!(same.response(1e-3), BARE.response(1e-3));
    }
}

#[test]
fn a_coating_of_a_nanometre_is_as_none() {
    // (d/λ_c)(1 − b_c²/b_s²) is what it adds, by the limit for long times.
    let added = coated(1e-9).response(1e-3) - BARE.response(1e-3);
    assert!(added.abs() < 1e-9 / 15.0);
    assert_eq!(coated(1.0).response(1.0), Passing { substrate: CERMET, coating: None }.response(1.0));
}

#[test]
fn the_mean_under_the_pin_is_two_thirds_of_the_trailing_edge() {
    // Jaeger's band at high Péclet number; the sum over columns comes to the integral as 1/columns.
    let mean = BARE.moving_resistance(100_000, 1e-8, 1.0);
    assert!((mean / (2.0 / 3.0 * BARE.response(1e-3)) - 1.0).abs() < 1e-5);
}

#[test]
fn chords_of_different_lengths_take_part_with_their_areas() {
    // By hand: rows of 3 m² and 5 m² a cell, with one and three columns. Of the four cells, the first of both rows are
    // under the pin for one column time, and so on.
    let rises = [1.0, 2.0, 3.0].map(|time| coated(60e-6).response(time * 1e-4));
    let expected = (8.0 * rises[0] + 5.0 * rises[1] + 5.0 * rises[2]) / 18.0 / 18.0;
    let found = coated(60e-6).moving_resistance_of_chords(&[8.0, 5.0, 5.0], 1e-4);
    assert!((found / expected - 1.0).abs() < 1e-14);
    // Rows of equal chords are a rectangle.
    let rectangle = coated(60e-6).resistance(20, 2e-3, 4e-5, 90.0);
    let same = coated(60e-6).resistance_of_chords(&[2e-6; 20], 2e-3, 90.0);
    assert!((same / rectangle - 1.0).abs() < 1e-14);
}

#[test]
fn the_resistance_goes_from_rest_to_fast() {
    let resistance = |speed| coated(60e-6).resistance(161, 2.27e-3, 3.2e-5, speed);
    let at_rest = 0.479 / (50.0 * 3.2e-5_f64.sqrt());
    assert_eq!(resistance(0.0), at_rest);
    assert!((resistance(1e-9) / at_rest - 1.0).abs() < 1e-3);
    assert!((resistance(1e12) / coated(60e-6).moving_resistance(161, 2.27e-15, 3.2e-5) - 1.0).abs() < 1e-6);
    let by_speed = [0.0, 1e-300, 1e-6, 1.0, 89.0, 1e6, 1e300].map(resistance);
    assert!(by_speed.is_sorted_by(|slower, faster| slower >= faster) && by_speed[6] > 0.0);
}

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
            let [found, expected] = [reflections, term_by_term].map(|sum| sum(coating, substrate, depth));
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
        let found = reflections(1.0, substrate, depth);
        // What is added up one by one is rounded against 1/√π.
        let rounding = if substrate < 100.0 { 1e-14 } else { 0.0 };
        assert!((found - expected).abs() < 1e-11 * expected + rounding, "{substrate}: {found:e}, {expected:e}");
    }
}
