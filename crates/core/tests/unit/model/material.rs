use super::*;

#[test]
fn equal_bodies_share_the_compliance() {
    // Closed form: two equal bodies have E* = E / (2 (1 − ν²)).
    let steel = Material { youngs_modulus: 2e11, poisson_ratio: 0.3, specific_wear_rate: 0.0 };
    let materials = Materials {
        disc_primary: steel,
        disc_secondary: steel,
        pin_primary: steel,
        pin_secondary: steel,
        pin_resin: Material { youngs_modulus: 1e5, ..steel },
        wear_height: 5e-6,
        pin_primary_against_secondary: None,
        pin_secondary_against_secondary: None,
        strength: None,
    };
    let expected = 2e11 / (2.0 * (1.0 - 0.09));
    assert!((materials.combined_modulus(Status::Primary, false) / expected - 1.0).abs() < 1e-15);
    // A side that is a million times softer decides alone.
    let soft = 1e5 / (1.0 - 0.09);
    assert!((materials.combined_modulus(Status::Resin, true) / soft - 1.0).abs() < 1e-6);
}
