use super::*;

fn emission() -> Emission {
    Emission {
        pm10_fraction: 0.4,
        pm25_fraction: 0.15,
        number_per_mass: 1e15,
        pin_density: 2600.0,
        disc_density: 7200.0,
        number_factor: Factor::new(vec![(443.15, 1.0), (463.15, 100.0)]).unwrap(),
    }
}

#[test]
fn what_leaves_has_the_mean_density_of_what_wore() {
    let moved = Volumes { worn_pin: 2e-15, worn_resin: 1e-15, worn_disc: 1e-15, emitted: 2e-15, ..Volumes::default() };
    // Three parts of 2600 and one of 7200 kg/m³ are 3750 kg/m³ in the mean.
    assert!((emission().mass(&moved) / (2e-15 * 3750.0) - 1.0).abs() < 1e-15);
    assert_eq!(emission().mass(&Volumes::default()), 0.0);
}

#[test]
fn particles_are_counted_at_the_temperature_of_their_interval() {
    let (emission, mut account) = (emission(), EmissionAccount::default());
    account.record(1e-9);
    account.record(2e-9);
    assert_eq!(account.report(&emission).number, 0.0);
    account.count(&emission, Some(300.0));
    assert!((account.report(&emission).number / 1.2e6 - 1.0).abs() < 1e-15);
    account.record(1e-9);
    account.count(&emission, Some(453.15));
    // Half-way between 1 and 100.
    let EmissionReport { mass, pm10, pm25, number } = account.report(&emission);
    assert!((number / (1.2e6 + 0.4e6 * 50.5) - 1.0).abs() < 1e-12);
    assert!((mass - 4e-9).abs() < 1e-24 && (pm10 - 1.6e-9).abs() < 1e-24 && (pm25 - 6e-10).abs() < 1e-24);
}
