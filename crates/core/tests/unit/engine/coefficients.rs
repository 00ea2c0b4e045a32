use super::*;

#[test]
fn the_exponential_rule_wears_less_by_the_known_factor() {
    // Closed form (model section 8): (1 − e^(−Π))/Π per cell.
    for number in [1e-8, 1e-3, 1.0, 50.0] {
        let ratio = wear_factor(Integrator::Exponential, number, 0.0, 1.0)
            / wear_factor(Integrator::Explicit, number, 0.0, 1.0);
        let expected = -libm::expm1(-number) / number;
        assert!((ratio / expected - 1.0).abs() < 1e-15, "Π = {number}");
    }
}

#[test]
fn the_exponential_rule_never_takes_more_than_the_overlap() {
    let pin = wear_factor(Integrator::Exponential, 3e-3, 1e-3, 1e6);
    let disc = wear_factor(Integrator::Exponential, 1e-3, 3e-3, 1e6);
    assert_eq!(pin + disc, 1.0);
    assert!((pin / disc - 3.0).abs() < 1e-15);
}
