//! The closed forms of model section 8.
//!
//! Tolerances are derived beside each test: rounding where the discrete problem is solved exactly, the error of the
//! quadrature where a sum over cells stands for an integral.

use std::f64::consts::PI;

use crate::scenes::{Stream, WEAR_RATE, all_primary, primary_stiffness, wear_only};
use plateau_core::model::mesh::Mesh;
use plateau_core::model::parameters::{Integrator, Parameters, PlateauRules};
use plateau_core::model::state::{Base, InitialSurfaces};
use plateau_core::simulation::Simulation;

/// Relative rounding of a sum over a few thousand cells, and of the load balance at tolerance 1e-12.
const ROUNDING: f64 = 4e-12;

fn close(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found / expected - 1.0).abs() <= tolerance, "{what}: found {found:e}, expected {expected:e}");
}

#[test]
fn flat_on_flat_wears_by_the_nominal_pressure() {
    let parameters = wear_only(1, 60, 20);
    let pressure = parameters.normal_force / parameters.mesh.pin_area();
    let stiffness = primary_stiffness(&parameters);
    let sliding = parameters.mesh.radius()[0] * parameters.mesh.column_angle();
    let mut simulation = all_primary(parameters, vec![0.0; 60], vec![0.0; 20]);
    for step in 1..=500 {
        simulation.advance().unwrap();
        let sample = simulation.sample().unwrap();
        close(sample.max_pressure, pressure, ROUNDING, "pressure");
        close(sample.mean_pressure, pressure, ROUNDING, "mean pressure");
        assert_eq!(sample.contact_ratio, 1.0);
        // The pin recedes by κ p per metre, and the displacement follows it at the constant overlap p/k.
        let recession = WEAR_RATE * pressure * sliding * f64::from(step);
        for height in &simulation.pin().unwrap().height {
            close(*height, recession, ROUNDING, "recession");
        }
        let before = recession - WEAR_RATE * pressure * sliding;
        close(sample.displacement, before + pressure / stiffness, ROUNDING, "displacement");
    }
}

#[test]
fn worn_volume_is_wear_rate_times_load_times_distance() {
    // Explicit rule, one row: exact for any distribution of pressure (rough disc here).
    let parameters = wear_only(1, 97, 31);
    let mut stream = Stream(1);
    let disc = (0..97).map(|_| 4e-6 * stream.uniform()).collect();
    let sliding = parameters.mesh.radius()[0] * parameters.mesh.column_angle();
    let force = parameters.normal_force;
    let mut simulation = all_primary(parameters, disc, vec![0.0; 31]);
    for _ in 0..1000 {
        simulation.advance().unwrap();
    }
    close(simulation.sample().unwrap().worn_pin, WEAR_RATE * force * sliding * 1000.0, ROUNDING, "κ F s");
}

/// Holds what the first step on a rough disc wears off, with local debris, a pool and no formation, against κ F s: there is
/// one row. Returns what is deposited of it where debris is local, m³.
fn worn_of_a_step(change: impl Fn(&mut Parameters), wear_rate: f64) -> f64 {
    let mut deposited = 0.0;
    for plateaus in [PlateauRules::LOCAL, PlateauRules::pool(0.06), wear_only(1, 1, 1).plateaus] {
        let mut parameters = Parameters { plateaus, ..wear_only(1, 97, 31) };
        change(&mut parameters);
        let sliding = parameters.mesh.radius()[0] * parameters.mesh.column_angle();
        let force = parameters.normal_force;
        let mut stream = Stream(1);
        let disc = (0..97).map(|_| 4e-6 * stream.uniform()).collect();
        let mut simulation = all_primary(parameters, disc, vec![0.0; 31]);
        simulation.advance().unwrap();
        let sample = simulation.sample().unwrap();
        close(sample.worn_pin, wear_rate * force * sliding, ROUNDING, "κ F s");
        deposited = f64::max(deposited, sample.deposited_pin + sample.deposited_disc);
    }
    deposited
}

#[test]
fn build_up_of_any_stiffness_hides_no_wear_of_the_fibre() {
    // There is no build-up in the first step: whatever its stiffness would be, nothing depends on it.
    let deposited = worn_of_a_step(|_| {}, WEAR_RATE);
    for modulus in [1e20, 1e30, 1e40, 1e60, 1e90] {
        let change = |parameters: &mut Parameters| {
            parameters.materials.pin_secondary.youngs_modulus = modulus;
            parameters.materials.disc_secondary.youngs_modulus = modulus;
        };
        close(worn_of_a_step(change, WEAR_RATE), deposited, ROUNDING, "deposited");
    }
}

#[test]
fn the_smallest_wear_rates_keep_their_digits() {
    for wear_rate in [1e-25, 1e-30, 1e-35, 1e-40, 1e-60, 1e-100] {
        worn_of_a_step(
            |parameters| {
                parameters.materials.pin_primary.specific_wear_rate = wear_rate;
                parameters.materials.pin_secondary.specific_wear_rate = wear_rate;
            },
            wear_rate,
        );
    }
}

#[test]
fn debris_that_is_compacted_to_the_last_is_never_emitted_less_than_not_at_all() {
    // Of each row only the second cell touches, and behind it there is room for all that it loses.
    for modulus in [1e9, 2e9] {
        let mut parameters = Parameters { plateaus: PlateauRules::LOCAL, ..wear_only(12, 97, 2) };
        parameters.materials.pin_secondary.youngs_modulus = modulus;
        let pin = [vec![1e-4; 12], vec![0.0; 12]].concat();
        let mut simulation = all_primary(parameters, vec![0.0; 12 * 97], pin);
        for step in 1..=200 {
            simulation.advance().unwrap();
            let sample = simulation.sample().unwrap();
            close(sample.deposited_pin, sample.worn_pin, ROUNDING, "deposited");
            let emitted = sample.emitted / sample.worn_pin;
            assert!((0.0..=ROUNDING).contains(&emitted), "step {step}: {:e}", sample.emitted);
        }
    }
}

#[test]
fn worn_volume_of_many_rows_is_the_sum_over_cells() {
    // κ Σ F_cell ds_i, with the forces of the step from the pressure map.
    let parameters = wear_only(7, 97, 31);
    let mesh = parameters.mesh.clone();
    let mut stream = Stream(2);
    let disc = (0..mesh.disc_cells()).map(|_| 4e-6 * stream.uniform()).collect();
    let mut simulation = all_primary(parameters, disc, vec![0.0; mesh.pin_cells()]);
    let mut expected = 0.0;
    for _ in 0..200 {
        simulation.advance().unwrap();
        let snapshot = simulation.snapshot(&[plateau_core::observe::Map::Pressure]).unwrap();
        let plateau_core::observe::MapValues::Float(pressure) = &snapshot.maps[0].1 else {
            panic!("pressure is a float")
        };
        for (cell, pressure) in pressure.iter().enumerate() {
            let row = cell % mesh.rows();
            expected += WEAR_RATE * pressure * mesh.area()[row] * mesh.radius()[row] * mesh.column_angle();
        }
    }
    close(simulation.sample().unwrap().worn_pin, expected, ROUNDING, "κ Σ F ds");
}

#[test]
fn the_exponential_rule_wears_less_by_its_factor() {
    // (1 − e^(−Π))/Π per cell; one row, so one Π for all cells.
    let mut parameters = wear_only(1, 40, 15);
    parameters.time_acceleration = 3e2;
    let sliding = parameters.time_acceleration * parameters.mesh.radius()[0] * parameters.mesh.column_angle();
    let number = WEAR_RATE * primary_stiffness(&parameters) * sliding;
    assert!((0.5..5.0).contains(&number), "Π = {number} shows the difference");
    let worn = |integrator| {
        let parameters = Parameters { integrator, ..parameters.clone() };
        let mut simulation = all_primary(parameters, vec![0.0; 40], vec![0.0; 15]);
        simulation.advance().unwrap();
        simulation.sample().unwrap().worn_pin
    };
    let ratio = worn(Integrator::Exponential) / worn(Integrator::Explicit);
    close(ratio, (1.0 - (-number).exp()) / number, ROUNDING, "(1 − e^(−Π))/Π");
}

/// A flat punch of fibre pressed on a surface: separation c = −δ, contact ratio and nominal pressure.
fn punch(heights: &[f64], rows: usize, force: f64) -> (f64, f64, f64, f64) {
    let columns = heights.len() / rows;
    let mut parameters = wear_only(rows, columns, columns);
    parameters.normal_force = force;
    let stiffness = primary_stiffness(&parameters);
    let nominal = force / parameters.mesh.pin_area();
    let mut simulation = all_primary(parameters, heights.to_vec(), vec![0.0; heights.len()]);
    simulation.advance().unwrap();
    let sample = simulation.sample().unwrap();
    (-sample.displacement, sample.contact_ratio, nominal, stiffness)
}

#[test]
fn a_flat_punch_meets_the_material_ratio_curve() {
    // One row, so all cells have the same area: contact ratio = Smr(c), nominal pressure = k mean((z − c)₊).
    let mut stream = Stream(3);
    let heights: Vec<f64> = (0..5000).map(|_| 6e-6 * stream.uniform().powi(3)).collect();
    for force in [1e-3, 1.0, 30.0] {
        let (separation, ratio, nominal, stiffness) = punch(&heights, 1, force);
        let above: Vec<f64> = heights.iter().map(|z| z - separation).filter(|u| *u > 0.0).collect();
        close(ratio, above.len() as f64 / 5000.0, ROUNDING, "contact ratio");
        close(nominal, stiffness * above.iter().sum::<f64>() / 5000.0, ROUNDING, "nominal pressure");
    }
}

/// φ(x) and Q(x) of the standard normal distribution; Q by libm's erfc.
fn gaussian(x: f64) -> (f64, f64) {
    ((-0.5 * x * x).exp() / (2.0 * PI).sqrt(), 0.5 * libm::erfc(x / 2.0_f64.sqrt()))
}

#[test]
fn gaussian_heights_meet_the_formula() {
    // N independent heights of σ = 1 µm. The ratio is a binomial mean, (z − x)₊ a sample mean; four standard errors
    // each, with E[(z−x)₊²] = (1 + x²) Q − x φ.
    const CELLS: usize = 400_000;
    let sigma = 1e-6;
    let mut stream = Stream(4);
    let heights: Vec<f64> = (0..CELLS)
        .map(|_| sigma * (-2.0 * (1.0 - stream.uniform()).ln()).sqrt() * (2.0 * PI * stream.uniform()).cos())
        .collect();
    for force in [3e1, 3e2, 3e3, 2e4] {
        let (separation, ratio, nominal, stiffness) = punch(&heights, 1, force);
        let x = separation / sigma;
        let (density, tail) = gaussian(x);
        let bound = 4.0 * (tail * (1.0 - tail) / CELLS as f64).sqrt();
        assert!((ratio - tail).abs() <= bound, "x = {x}: ratio {ratio}, expected {tail} ± {bound}");
        let mean = density - x * tail;
        let variance = (1.0 + x * x) * tail - x * density - mean * mean;
        let found = nominal / (stiffness * sigma);
        let bound = 4.0 * (variance / CELLS as f64).sqrt();
        assert!((found - mean).abs() <= bound, "x = {x}: pressure {found}, expected {mean} ± {bound}");
    }
}

#[test]
fn a_sphere_on_a_winkler_foundation() {
    // F = π k R δ² and contact area π a² = 2π R δ. Cells of size d resolve the circle of radius a = n d: the rim's
    // cells are in or out as a whole, so the area is off by at most the rim 2π a d (1/n relative to half the area;
    // errors cancel to n^(−3/2) on average, the bound is 2/n), and the load, whose overlap vanishes at the rim, by
    // less than (2/n)².
    let (rows, columns) = (201, 201);
    let mut parameters = wear_only(rows, 20 * columns, columns);
    let (pitch_r, mesh) = (parameters.mesh.row_height(), parameters.mesh.clone());
    // A radius so small that a = 70 cells; heights follow the true distances on the polar mesh.
    let cells = 70.0;
    let contact_radius = cells * pitch_r;
    let displacement = 2e-6;
    let sphere = contact_radius * contact_radius / (2.0 * displacement);
    parameters.normal_force = PI * primary_stiffness(&parameters) * sphere * displacement * displacement;
    let centre = (mesh.radius()[rows / 2], (columns / 2) as f64 * mesh.column_angle());
    let mut pin = Vec::with_capacity(rows * columns);
    for column in 0..columns {
        let angle = column as f64 * mesh.column_angle() - centre.1;
        for radius in mesh.radius() {
            let distance = radius * radius + centre.0 * centre.0 - 2.0 * radius * centre.0 * angle.cos();
            pin.push(distance / (2.0 * sphere));
        }
    }
    let mut simulation = all_primary(parameters, vec![0.0; mesh.disc_cells()], pin);
    simulation.advance().unwrap();
    let sample = simulation.sample().unwrap();
    // F ∝ δ², so δ is off by half the load's relative error.
    close(sample.displacement, displacement, (2.0 / cells) * (2.0 / cells), "displacement");
    close(sample.contact_area, 2.0 * PI * sphere * sample.displacement, 2.0 / cells, "contact area");
}

#[test]
fn two_levels_in_permanent_contact_approach_exponentially() {
    // Their height difference decays by e^(−Π) a step with the exponential rule, by 1 − Π with the explicit one.
    for (integrator, acceleration) in [(Integrator::Exponential, 2e3), (Integrator::Explicit, 2e2)] {
        let mut parameters = wear_only(1, 64, 16);
        parameters.normal_force = 40.0;
        parameters.integrator = integrator;
        parameters.time_acceleration = acceleration;
        let sliding = acceleration * parameters.mesh.radius()[0] * parameters.mesh.column_angle();
        let number = WEAR_RATE * primary_stiffness(&parameters) * sliding;
        let decay = match integrator {
            Integrator::Exponential => (-number).exp(),
            Integrator::Explicit => 1.0 - number,
        };
        let pin = (0..16).map(|column| if column % 2 == 0 { 0.0 } else { 0.2e-6 }).collect();
        let mut simulation = all_primary(parameters, vec![0.0; 64], pin);
        let mut expected = 0.2e-6;
        for _ in 0..20 {
            simulation.advance().unwrap();
            assert_eq!(simulation.sample().unwrap().contact_ratio, 1.0);
            expected *= decay;
            let difference = simulation.pin().unwrap().height[1] - simulation.pin().unwrap().height[0];
            // Heights up to 1e-5 m are rounded to 1e-21 m; the difference stays above 1e-8 m.
            assert!((difference - expected).abs() < 1e-18, "{difference:e}, expected {expected:e}");
        }
    }
}

#[test]
fn a_step_that_moves_litres_moves_them_all() {
    // Closed form (model 4L): of four columns of a ring of 1 to 2 m two of resin touch and lose the wear height; all of it
    // finds room behind them, where the disc is lower. That is more than a tenth of a litre in each column.
    let mesh = Mesh::new(4, 4, 4, 1.0, 2.0).unwrap();
    let wear_height = 0.2e-3;
    let mut parameters = Parameters { mesh, normal_force: 1e6, ..Parameters::paper() };
    parameters.materials.wear_height = wear_height;
    let mesh = &parameters.mesh;
    let by_column =
        |heights: [f64; 4]| heights.iter().flat_map(|height| vec![*height; mesh.rows()]).collect::<Vec<_>>();
    let surfaces = InitialSurfaces {
        disc_height: by_column([-1e-3, 0.0, -1e-3, 0.0]),
        pin_height: by_column([0.0; 4]),
        pin_base: vec![Base::Resin; mesh.pin_cells()],
    };
    let mut simulation = Simulation::new(parameters.clone(), surfaces).unwrap();
    simulation.advance().unwrap();
    let sample = simulation.sample().unwrap();
    let expected = PI * (4.0 - 1.0) / 2.0 * wear_height;
    assert!((expected - 9.42e-4).abs() < 1e-6);
    for (name, found) in [("worn", sample.worn_resin), ("deposited", sample.deposited_disc + sample.deposited_pin)] {
        assert!((found / expected - 1.0).abs() < 1e-12, "{name}: {found:e}, expected {expected:e}");
    }
    assert!(sample.emitted.abs() < 1e-12 * expected, "{:e}", sample.emitted);
    assert!(sample.balance_residual.abs() < 1e-12, "{:e}", sample.balance_residual);
}

#[test]
fn a_film_that_is_worn_through_counts_to_its_last_digit() {
    // Closed form (model 4P and 4.2): a cell of resin loses the wear height h; half of it comes upon the other cell of resin,
    // the fraction β of that on the pin, for there is fibre ahead. When that cell touches it loses this film and no more,
    // though its raw loss, all of the overlap, is 1e11 times as much.
    let mesh = Mesh::new(1, 8, 3, 20e-3, 20.05e-3).unwrap();
    let (pad_share, wear_height) = (1e-15, 1e-6);
    let mut parameters = Parameters { mesh, plateaus: PlateauRules::pool(1.0), ..Parameters::paper() };
    let area = parameters.mesh.area()[0];
    parameters.plateaus.pad_share = pad_share;
    parameters.integrator = Integrator::Exponential;
    // An overlap of resin of half the wear height.
    parameters.normal_force = 1e5 / parameters.foundation_height * area * 0.5e-6;
    let materials = &mut parameters.materials;
    materials.wear_height = wear_height;
    materials.pin_primary.specific_wear_rate = 1e-3;
    materials.pin_secondary = materials.pin_primary;
    // Columns 0 and 2 of the pin are resin. Of the first three steps the second cell touches in two, then the first.
    let surfaces = InitialSurfaces {
        disc_height: [-20.0, 5.0, 0.0, -20.0, -20.0, -20.0, 50.0, -20.0].map(|height| height * 1e-6).to_vec(),
        pin_height: vec![0.0, 1e-3, 0.0],
        pin_base: vec![Base::Resin, Base::Primary, Base::Resin],
    };
    let mut simulation = Simulation::new(parameters, surfaces).unwrap();
    for expected in [0.0, 0.0, pad_share * 0.5 * wear_height * area] {
        simulation.advance().unwrap();
        let found = simulation.sample().unwrap().worn_pin;
        assert!((found - expected).abs() <= 1e-12 * expected, "{found:e}, expected {expected:e}");
    }
}
