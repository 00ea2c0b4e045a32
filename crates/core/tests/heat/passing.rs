//! The contact temperature map, and the passing under the pin at extremes (model 11).

use super::{CERMET, IRON, off, thermal};
use plateau_core::model::heat::passing::{self, Passing};
use plateau_core::model::mesh::Mesh;
use plateau_core::model::thermal::{Coating, Disc, Substance};

fn passing(substance: Substance, coating: Option<(f64, Substance)>) -> Passing {
    let coating = coating.map(|(thickness, substance)| Coating { thickness, substance });
    Passing::of(&Disc { substance, coating, ..thermal().disc })
}

/// 3 rows, 100 columns around, 20 of them under the pin.
fn mesh() -> Mesh {
    Mesh::new(3, 100, 20, 20e-3, 20.4e-3).unwrap()
}

#[test]
fn a_uniform_pressure_warms_each_column_by_the_response_to_its_time_under_the_pin() {
    let (mesh, face, speed, flux) = (mesh(), 350.0, 89.0, 0.7);
    for coating in [None, Some((60e-6, CERMET))] {
        let passing = passing(IRON, coating);
        let pressure = vec![1.5e6; mesh.pin_cells()];
        let found = passing::temperatures(&passing, &mesh, &pressure, flux, face, speed);
        for column in 0..20 {
            // The sum of its w over the columns before is U((j+1) Δt), for the ones between cancel.
            let rise = flux * 1.5e6 * passing.response((column + 1) as f64 * mesh.column_angle() / speed);
            // 20 terms, each rounded against the temperature they are added to.
            let rounding = 21.0 * f64::EPSILON * (face + rise);
            assert!(found[mesh.column(column)].iter().all(|cell| (cell - face - rise).abs() <= rounding), "{column}");
        }
        // The mean is 2/3 of the trailing edge's (Jaeger), but for 20 columns
        // instead of many: Σ √j/(20 √20) = 2/3 + 1/40 − …
        let rises: Vec<f64> = found.iter().map(|cell| cell - face).collect();
        let mean = rises.iter().sum::<f64>() / rises.len() as f64;
        let trailing = rises[mesh.column(19).start];
        let sum: f64 = (1..=20).map(|column| f64::from(column).sqrt()).sum::<f64>() / (20.0 * 20.0_f64.sqrt());
        if coating.is_none() {
            assert!(off(mean, sum * trailing) < 1e-12);
            assert!((sum - 2.0 / 3.0 - 1.0 / 40.0).abs() < 0.01);
        }
    }
}

#[test]
fn a_hot_spot_warms_what_follows_it_in_its_row_and_nothing_else() {
    let (mesh, passing) = (mesh(), passing(IRON, None));
    let mut pressure = vec![0.0; mesh.pin_cells()];
    let (row, column) = (1, 4);
    pressure[mesh.column(column).start + row] = 2e7;
    let found = passing::temperatures(&passing, &mesh, &pressure, 0.5, 300.0, 89.0);
    let time = |columns: usize| columns as f64 * mesh.column_angle() / 89.0;
    for (cell, found) in found.iter().enumerate() {
        let (at, in_row) = (cell / 3, cell % 3 == row);
        // Heated while the spot is over it, left to itself since: U(t) − U(t − Δt).
        let rise = match at.checked_sub(column) {
            Some(since) if in_row => 1e7 * (passing.response(time(since + 1)) - passing.response(time(since))),
            _ => 0.0,
        };
        assert!((found - 300.0 - rise).abs() < 1e-12 * (300.0 + rise), "{cell}: {found}");
    }
    let hottest = found.iter().copied().fold(0.0, f64::max);
    assert_eq!(hottest, found[mesh.column(column).start + row]);
}

#[test]
fn nothing_that_slides_or_presses_warms_nothing() {
    let (mesh, passing) = (mesh(), passing(IRON, None));
    let pressure = vec![1e6; 60];
    assert_eq!(passing::temperatures(&passing, &mesh, &pressure, 0.0, 300.0, 0.0), vec![300.0; 60]);
    assert_eq!(passing::temperatures(&passing, &mesh, &[0.0; 60], 0.5, 300.0, 89.0), vec![300.0; 60]);
    let lifted = passing::temperatures(&passing, &mesh, &[0.0; 60], 0.5, f64::NAN, 89.0);
    assert!(lifted.len() == 60 && lifted.iter().all(|cell| cell.is_nan()));
}

#[test]
fn the_response_rises_with_time_for_any_coating() {
    let extreme = |conductivity| Substance { conductivity, ..CERMET };
    for substrate in [1e-12, 50.0, 1e12] {
        let substrate = Substance { conductivity: substrate, ..IRON };
        for conductivity in [1e-12, 15.0, 1e12] {
            for thickness in [0.0, 1e-9, 60e-6, 1e-3, 1.0] {
                let coated = passing(substrate, Some((thickness, extreme(conductivity))));
                let [coating_alone, none] = [passing(extreme(conductivity), None), passing(substrate, None)];
                let mut before = 0.0;
                for exponent in -15..=15 {
                    let time = 10.0_f64.powi(exponent);
                    let what = format!("{substrate:?} {conductivity:e} {thickness} {time}");
                    let found = coated.response(time);
                    assert!(found.is_finite() && found > before, "{what}: {found:e} after {before:e}");
                    // Between what coating and substrate would do alone.
                    let [one, other] = [&coating_alone, &none].map(|alone| alone.response(time));
                    let range = one.min(other) * (1.0 - 1e-10)..=one.max(other) * (1.0 + 1e-10);
                    assert!(range.contains(&found), "{what}: {found:e} in {range:?}");
                    before = found;
                }
                if thickness == 0.0 {
                    assert_eq!(coated, none);
                }
            }
        }
    }
}

#[test]
fn the_resistance_is_finite_and_falls_with_speed_for_any_peclet_number() {
    // Pe = v ℓ/a with ℓ the length of the pin, 161 of 2764 columns at 22 mm, and v = ω 22 mm.
    let (columns, angle, area) = (161, std::f64::consts::TAU / 2764.0, 32e-6);
    let length = 161.0 * angle * 22e-3;
    let at_rest = 0.479 / (50.0 * 32e-6_f64.sqrt());
    for coating in [None, Some((60e-6, CERMET)), Some((1.0, CERMET))] {
        let passing = passing(IRON, coating);
        let mut before = at_rest;
        assert_eq!(passing.resistance(columns, angle, area, 0.0), at_rest);
        for exponent in -6..=6 {
            let speed = 10.0_f64.powi(exponent) * IRON.diffusivity() / length / 22e-3;
            let found = passing.resistance(columns, angle, area, speed);
            // At 1e-6 it is that at rest to the last digits: then no more than not rising.
            assert!(found.is_finite() && found > 0.0 && found <= before, "{exponent}: {found:e} after {before:e}");
            let moving = passing.moving_resistance(columns, angle / speed, area);
            let expected = (1.0 / (1.0 / (moving * moving) + 1.0 / (at_rest * at_rest))).sqrt();
            assert!(off(found, expected) < 1e-14, "{exponent}");
            before = found;
        }
        assert!(before < 0.01 * at_rest || coating.is_some());
    }
}
