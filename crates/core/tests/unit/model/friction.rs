use super::*;

const LAW: FrictionLaw = FrictionLaw { pressure_coefficient: 0.33, shear_strength: 0.75e6 };

fn contact(load: f64, area: f64) -> ContactSums {
    ContactSums { load, area, statuses: None }
}

#[test]
fn flat_on_flat_has_the_closed_form_with_its_ceiling() {
    // Model section 12: μ = α + τ₀ ΣA/F, with the ceiling below F = τ₀ ΣA/(μ_max − α).
    let (friction, area) = (Friction::of(LAW, 0.6), 1.6e-5);
    let ceiling = LAW.shear_strength * area / (0.6 - LAW.pressure_coefficient);
    assert!((friction.coefficient(&contact(47.0, area)) - (0.33 + 0.75e6 * 1.6e-5 / 47.0)).abs() < 1e-15);
    assert!(friction.coefficient(&contact(1.001 * ceiling, area)) < 0.6);
    assert_eq!(friction.coefficient(&contact(0.999 * ceiling, area)), 0.6);
}

#[test]
fn one_law_for_all_is_the_same_as_that_law_for_each() {
    let friction = Friction::of(LAW, f64::INFINITY);
    let statuses = [(1e-7, 0.1), (3e-6, 30.0), (2e-6, 16.9)].map(|(area, load)| StatusContact { area, load });
    let apart = ContactSums { statuses: Some(statuses), ..contact(47.0, 5.1e-6) };
    let [one, each] = [contact(47.0, 5.1e-6), apart].map(|contact| friction.coefficient(&contact));
    assert!((one - each).abs() < 1e-15);
    assert!(!friction.depends_on_status());
    let slippery = Friction { resin: FrictionLaw { shear_strength: 0.0, ..LAW }, ..friction };
    assert!(slippery.depends_on_status());
    // What resin does not resist any more is its τ₀ A_s.
    assert!((one - slippery.coefficient(&apart) - 0.75e6 * 1e-7 / 47.0).abs() < 1e-15);
}

#[test]
fn the_mean_is_weighted_by_load_over_one_revolution() {
    let mut account = FrictionAccount::new(2);
    assert!(account.report().coefficient.is_nan() && account.report().coefficient_mean.is_nan());
    let works = [(0.9, 5.0), (0.5, 10.0), (0.2, 30.0)].map(|(mu, load)| account.record(mu, load, 2.0));
    assert_eq!(works, [9.0, 10.0, 12.0]);
    let FrictionReport { coefficient, coefficient_mean, work, load_work } = account.report();
    assert_eq!((coefficient, work, load_work), (0.2, 31.0, 90.0));
    // By hand: (0.5 · 10 + 0.2 · 30)/40.
    assert_eq!(coefficient_mean, 0.275);
}
