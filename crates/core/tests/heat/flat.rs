//! Friction and emission of a whole simulation where they have closed forms (model 12).

use std::sync::Arc;

use super::{off, thermal};
use crate::scenes::{all_primary, engines, start, wear_only};
use plateau_core::model::emission::Emission;
use plateau_core::model::friction::{Friction, FrictionLaw};
use plateau_core::model::parameters::{DebrisRule, Parameters, PlateauRules};
use plateau_core::model::thermal::Factor;

const LAW: FrictionLaw = FrictionLaw { pressure_coefficient: 0.33, shear_strength: 0.75e6 };

#[test]
fn flat_on_flat_rubs_by_the_law_down_to_the_load_of_the_ceiling() {
    let mesh = wear_only(1, 60, 12).mesh;
    // μ = α + τ₀ ΣA/F, with the ceiling below F = τ₀ ΣA/(μ_max − α).
    let ceiling = 0.75e6 * mesh.pin_area() / (0.6 - 0.33);
    for (load, coefficient) in [
        (0.5 * ceiling, 0.6),
        (0.999 * ceiling, 0.6),
        (1.001 * ceiling, 0.33 + 0.75e6 * mesh.pin_area() / (1.001 * ceiling)),
        (100.0 * ceiling, 0.33 + 0.75e6 * mesh.pin_area() / (100.0 * ceiling)),
    ] {
        let friction = Some(Friction::of(LAW, 0.6));
        let parameters = Parameters { normal_force: load, friction, time_acceleration: 3.0, ..wear_only(1, 60, 12) };
        let mut simulation = all_primary(parameters, vec![0.0; mesh.disc_cells()], vec![0.0; mesh.pin_cells()]);
        for steps in [1, 59, 150] {
            simulation.advance_to(steps).unwrap();
            let found = simulation.sample().unwrap().accounts.friction.unwrap();
            assert!(off(found.coefficient, coefficient) < 1e-14, "{load}: {found:?}");
            assert!(off(found.coefficient_mean, coefficient) < 1e-14, "{load}: {found:?}");
            // μ F r̄ times the angle: three columns a step.
            let distance = mesh.mean_radius() * 3.0 * mesh.column_angle() * steps as f64;
            assert!(off(found.work, coefficient * load * distance) < 1e-13, "{load}: {found:?}");
            assert!(off(found.load_work, load * distance) < 1e-13, "{load}: {found:?}");
        }
    }
}

fn emission() -> Emission {
    Emission {
        pm10_fraction: 0.4,
        pm25_fraction: 0.15,
        number_per_mass: 1e15,
        pin_density: 2600.0,
        disc_density: 2600.0,
        number_factor: Factor::new(vec![(100.0, 7.0)]).unwrap(),
    }
}

#[test]
fn pm10_is_its_part_of_the_density_times_the_emitted_volume() {
    for execution in engines() {
        for (debris, captured_fraction) in
            [(DebrisRule::Local, 1.0), (DebrisRule::Contact, 0.3), (DebrisRule::Track, 0.0)]
        {
            let plateaus = PlateauRules { debris, captured_fraction, ..PlateauRules::LOCAL };
            let friction = Some(Friction::of(LAW, 0.6));
            let base = Parameters { plateaus, friction, emission: Some(emission()), ..wear_only(5, 60, 12) };
            let heated = Parameters { thermal: Some(Arc::new(thermal())), ..base.clone() };
            // Without temperatures f_N is left out, with them it is 7 at any; and friction is not needed.
            let alone = Parameters { friction: None, ..base.clone() };
            for (parameters, factor) in [(base, 1.0), (heated, 7.0), (alone, 1.0)] {
                let mut simulation = start(&parameters, 5, execution);
                // A whole number of revolutions: all particles are counted.
                simulation.advance_to(120).unwrap();
                let sample = simulation.sample().unwrap();
                let found = sample.accounts.emission.unwrap();
                assert!(sample.emitted > 0.0);
                // One density, whatever wears. A step's volume is rounded as the pin's, of which little may be emitted.
                assert!(off(found.mass, 2600.0 * sample.emitted) < 1e-12, "{debris:?}: {found:?}");
                assert!(off(found.pm10, 0.4 * 2600.0 * sample.emitted) < 1e-12, "{debris:?}: {found:?}");
                assert!(off(found.pm25, 0.15 * 2600.0 * sample.emitted) < 1e-12, "{debris:?}: {found:?}");
                assert!(
                    off(found.number, factor * 1e15 * 0.4 * 2600.0 * sample.emitted) < 1e-12,
                    "{factor}: {found:?}"
                );
            }
        }
    }
}
