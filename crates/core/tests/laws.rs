//! Laws of the model over random small scenes.

use crate::scenes::{self, balance_rounding, few_or_all, primary_stiffness, random_surfaces, round_mesh, wear_only};
use plateau_core::engine::kernel::InstructionSet;
use plateau_core::model::material::Status;
use plateau_core::model::mesh::Mesh;
use plateau_core::model::parameters::{DebrisRule, Integrator, Parameters, PlateauRules};
use plateau_core::model::state::{Base, Disc, InitialSurfaces, Pin};
use plateau_core::observe::Sample;
use plateau_core::simulation::{Execution, Simulation};
use proptest::option;
use proptest::prelude::*;

/// Any scene of the model on a small mesh.
fn scenes() -> impl Strategy<Value = (Parameters, u64)> {
    let mesh = (1..12_usize, 2..40_usize).prop_flat_map(|(rows, columns)| (Just(rows), Just(columns), 1..=columns));
    let fractions = (0.0..=1.0, option::of(0.0..=1.0));
    let debris = prop_oneof![Just(DebrisRule::Local), Just(DebrisRule::Contact), Just(DebrisRule::Track)];
    let rules = (fractions, 0.0..=1.0, debris, any::<bool>(), any::<bool>());
    let wear = (0.0..1e-13, 0.0..1e-13, 0.0..1e-14, 0.0..1e-14);
    let round = option::weighted(0.3, (4..14_usize, 1.0..2.0, 0.6..1.0));
    let findings = (option::of(0.3..7.0), option::weighted(0.3, 4.0..9.0), option::weighted(0.3, 0.0..1e-13));
    (mesh, round, rules, wear, findings, 0.01..100.0, 1.0..500.0, any::<bool>(), any::<u64>()).prop_map(
        |((rows, columns, pin), round, rules, wear, findings, force, acceleration, exponential, seed)| {
            let mut parameters = wear_only(rows, columns, pin);
            if let Some((rows, per_row, part)) = round {
                parameters.mesh = round_mesh(rows, per_row, part);
            }
            parameters.normal_force = force;
            parameters.time_acceleration = acceleration;
            parameters.plateaus = PlateauRules {
                captured_fraction: rules.0.0,
                captured_resin_fraction: rules.0.1,
                pad_share: rules.1,
                debris: rules.2,
                formation: rules.3,
                destruction: rules.4,
                transport_length: None,
            };
            if rules.2 == DebrisRule::Local && findings.0.is_some() {
                let column = parameters.mesh.column_width();
                parameters.plateaus.transport_length = findings.0.map(|columns: f64| columns * column);
                parameters.plateaus.captured_resin_fraction = None;
            }
            parameters.materials.strength = findings.1.map(|exponent: f64| 10.0_f64.powf(exponent));
            parameters.materials.pin_primary_against_secondary = findings.2;
            parameters.integrator = if exponential { Integrator::Exponential } else { Integrator::Explicit };
            parameters.materials.pin_primary.specific_wear_rate = wear.0;
            parameters.materials.pin_secondary.specific_wear_rate = wear.1;
            parameters.materials.disc_primary.specific_wear_rate = wear.2;
            parameters.materials.disc_secondary.specific_wear_rate = wear.3;
            parameters.materials.pin_secondary.youngs_modulus = 4e8;
            parameters.materials.disc_secondary.youngs_modulus = 5e9;
            (parameters, seed)
        },
    )
}

fn start(parameters: &Parameters, surfaces: InitialSurfaces) -> Simulation {
    Simulation::new(parameters.clone(), surfaces).expect("surfaces that fit")
}

/// All that two revolutions leave, and what they tell.
fn after_two_revolutions(parameters: &Parameters, seed: u64, execution: Execution) -> (Pin, Disc, Sample) {
    let mut simulation = scenes::start(parameters, seed, execution);
    simulation.advance_to(2 * parameters.mesh.disc_columns() as u64).unwrap();
    (simulation.pin().unwrap(), simulation.disc().unwrap(), simulation.sample().unwrap())
}

/// The disc's field seen from `columns` columns further: column c of the result is column c − `columns`.
fn rotated(mesh: &Mesh, field: &[f64], columns: usize) -> Vec<f64> {
    let mut rotated = field.to_vec();
    rotated.rotate_right(columns % mesh.disc_columns() * mesh.rows());
    rotated
}

/// A cell that is filled up to z_ref takes over its bits, with those that an instruction set does at a time; after few steps not yet
/// everywhere.
#[test]
fn every_instruction_set_gives_the_same_bits_on_a_disc_of_minus_zero() {
    let parameters = Parameters { plateaus: PlateauRules::LOCAL, normal_force: 0.3, ..wear_only(8, 106, 33) };
    let surfaces = InitialSurfaces {
        disc_height: vec![-0.0; parameters.mesh.disc_cells()],
        ..random_surfaces(&parameters.mesh, 5)
    };
    let bits = |instructions| {
        let execution = Execution { instructions, ..Execution::default() };
        let mut simulation = Simulation::with_execution(parameters.clone(), surfaces.clone(), execution).unwrap();
        simulation.advance_to(3).unwrap();
        simulation.disc().unwrap().height.iter().map(|height| height.to_bits()).collect::<Vec<_>>()
    };
    for instructions in InstructionSet::available() {
        assert_eq!(bits(instructions), bits(InstructionSet::PORTABLE), "{}", instructions.name());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: few_or_all(32, 96), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_rotated_disc_gives_the_same_bits((parameters, seed) in scenes(), columns in 0..50_usize) {
        let mesh = &parameters.mesh;
        let surfaces = random_surfaces(mesh, seed);
        let mut still = start(&parameters, surfaces.clone());
        // Step n of the turned run lies over the columns of step n + turn, so the disc is moved back by as much.
        let turn = (mesh.disc_columns() - columns % mesh.disc_columns()) as u64;
        let disc_height = rotated(mesh, &surfaces.disc_height, columns);
        let surfaces = InitialSurfaces { disc_height, ..surfaces };
        let mut turned =
            Simulation::with_disc_turned(parameters.clone(), surfaces, Execution::default(), turn).expect("surfaces that fit");
        for _ in 0..2 * mesh.disc_columns() {
            still.advance().unwrap();
            turned.advance().unwrap();
            let (still, turned) = (still.sample().unwrap(), turned.sample().unwrap());
            prop_assert_eq!(still.displacement.to_bits(), turned.displacement.to_bits());
            prop_assert_eq!(still.pool.to_bits(), turned.pool.to_bits());
        }
        prop_assert_eq!(still.pin().unwrap(), turned.pin().unwrap());
        prop_assert_eq!(&rotated(mesh, &still.disc().unwrap().height, columns), &turned.disc().unwrap().height);
        prop_assert_eq!(&rotated(mesh, &still.disc().unwrap().substrate, columns), &turned.disc().unwrap().substrate);
    }

    #[test]
    fn every_instruction_set_gives_the_same_bits((parameters, seed) in scenes()) {
        let run = |instructions| after_two_revolutions(&parameters, seed, Execution { instructions, ..Execution::default() });
        let plain = run(InstructionSet::PORTABLE);
        for instructions in InstructionSet::available() {
            prop_assert_eq!(&run(instructions), &plain, "{}", instructions.name());
        }
    }

    #[test]
    fn any_number_of_workers_gives_the_same_bits((parameters, seed) in scenes(), workers in 2..9_usize) {
        let run = |workers| after_two_revolutions(&parameters, seed, Execution { workers, ..Execution::default() });
        prop_assert_eq!(run(workers), run(1));
    }

    #[test]
    fn without_formation_the_pool_has_the_captured_fraction_of_each((mut parameters, seed) in scenes()) {
        parameters.plateaus.formation = false;
        let mut simulation = start(&parameters, random_surfaces(&parameters.mesh, seed));
        simulation.advance_to(parameters.mesh.disc_columns() as u64).unwrap();
        let sample = simulation.sample().unwrap();
        let PlateauRules { captured_fraction, captured_resin_fraction, .. } = parameters.plateaus;
        let plateaus = sample.worn_pin + sample.worn_disc;
        // Without a pool all of it leaves the contact.
        let local = parameters.plateaus.debris == DebrisRule::Local;
        let captured = if local { 0.0 } else { captured_fraction * plateaus
            + captured_resin_fraction.unwrap_or(captured_fraction) * sample.worn_resin };
        let worn = plateaus + sample.worn_resin;
        prop_assert!((sample.pool - captured).abs() <= 1e-12 * worn, "{:e} of {:e}", sample.pool - captured, worn);
        prop_assert!((sample.emitted - (worn - captured)).abs() <= 1e-12 * worn);
    }

    #[test]
    fn the_state_stays_within_its_bounds((parameters, seed) in scenes()) {
        let mesh = &parameters.mesh;
        let mut simulation = start(&parameters, random_surfaces(mesh, seed));
        // Heights within 1e-4 m and δ are rounded by half a unit in the last place each, which the whole pin at its
        // largest stiffness makes a load of; below that share of the load no displacement comes nearer.
        let rounding = 2.0 * f64::EPSILON * 1e-4 * primary_stiffness(&parameters) * mesh.pin_area()
            / parameters.normal_force;
        for _ in 0..3 * mesh.disc_columns() {
            simulation.advance().unwrap();
            let sample = simulation.sample().unwrap();
            // Above this the balance is refined.
            prop_assert!(sample.load_residual <= 1e-10_f64.max(rounding), "{:e}", sample.load_residual);
            let rounding = balance_rounding(&parameters, 1e-4, &sample);
            prop_assert!(sample.balance_residual.abs() <= 1e-12_f64.max(rounding), "balance {:e}", sample.balance_residual);
            prop_assert!((sample.pin_none + sample.pin_primary + sample.pin_secondary - 1.0).abs() < 1e-13);
            prop_assert!((0.0..=1.0 + 1e-13).contains(&sample.disc_secondary));
            prop_assert!(sample.contact_area > 0.0 && sample.contact_ratio <= 1.0 + 1e-13);
        }
        let (pin, disc) = (simulation.pin().unwrap(), simulation.disc().unwrap());
        prop_assert!(pin.height.iter().chain(&pin.substrate).chain(&disc.height).chain(&disc.substrate).all(|z| z.is_finite()));
        prop_assert!(pin.height.iter().zip(&pin.substrate).all(|(z, b)| z <= b), "z_p ≤ b_p");
        prop_assert!(disc.height.iter().zip(&disc.substrate).all(|(z, b)| z >= b), "z_d ≥ b_d");
        prop_assert!(disc.reported_statuses().all(|status| status != Status::Resin));
    }

    #[test]
    fn a_pin_loses_what_its_heights_tell((parameters, seed) in scenes()) {
        let mesh = &parameters.mesh;
        let surfaces = random_surfaces(mesh, seed);
        let initial = surfaces.pin_height.clone();
        let mut simulation = start(&parameters, surfaces);
        let steps = 2 * mesh.disc_columns() as u64;
        simulation.advance_to(steps).unwrap();
        let height = simulation.pin().unwrap().height;
        let cells = height.iter().zip(&initial).zip(mesh.pin_areas());
        let receded: f64 = cells.map(|((now, before), area)| (now - before) * area).sum();
        // Wear, destruction and formation each round once a step in each cell; volumes are rounded on their own.
        let largest = height.iter().chain(&initial).fold(0.0_f64, |largest, z| largest.max(z.abs()));
        let sample = simulation.sample().unwrap();
        let rounding =
            3.0 * steps as f64 * mesh.pin_area() * largest * f64::EPSILON + 1e-12 * sample.worn_whole_pin();
        let lost = sample.lost_pin();
        prop_assert!((receded - lost).abs() <= rounding, "{:e} m³ by the heights, {:e}", receded, lost);
    }

    #[test]
    fn local_debris_neither_overtops_the_disc_nor_goes_anywhere_but_behind_what_wears((mut parameters, seed) in scenes()) {
        parameters.plateaus.debris = DebrisRule::Local;
        let (mesh, rows) = (&parameters.mesh, parameters.mesh.rows());
        let surfaces = random_surfaces(mesh, seed);
        let reference = surfaces.disc_height.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut simulation = start(&parameters, surfaces);
        let mut before = simulation.pin().unwrap().height;
        for step in 1..=2 * mesh.disc_columns() as u64 {
            simulation.advance().unwrap();
            let sample = simulation.sample().unwrap();
            prop_assert_eq!(sample.pool, 0.0);
            prop_assert!(sample.returned == 0.0 || parameters.materials.strength.is_some());
            let account = sample.worn_pin + sample.worn_resin + sample.worn_disc + sample.returned
                - (sample.deposited_pin + sample.deposited_disc) - sample.emitted;
            prop_assert!(account.abs() <= 1e-15 * (sample.emitted + sample.deposited_pin), "step {}: {:e}", step, account);
            let rounding = balance_rounding(&parameters, 1e-4, &sample);
            prop_assert!(sample.balance_residual.abs() <= 1e-12_f64.max(rounding), "step {}: {:e}", step, sample.balance_residual);
            prop_assert!(simulation.disc_height().unwrap().into_iter().all(|z_d| z_d <= reference), "step {}", step);
            let after = simulation.pin().unwrap().height;
            for cell in (0..after.len()).filter(|cell| after[*cell] < before[*cell]) {
                // It grew toward the disc: flush at the most with the cell ahead, which wears away from it.
                let ahead = cell + rows;
                prop_assert!(ahead < after.len(), "step {}: the last column grew", step);
                prop_assert!(after[cell] >= before[ahead], "step {}, cell {}", step, cell);
            }
            before = after;
        }
    }

    #[test]
    fn heights_scale_with_load_and_foundation((parameters, seed) in scenes(), power in -8..8_i32) {
        // All lengths in z times λ: the overlap scales by λ and k by 1/λ (the foundation is λ times as high), so
        // pressure and load stay, and a loss κ p ds scales by λ when κ does. With λ a power of two nothing is rounded
        // differently, but for the exponential rule's factor, which needs the same argument: κ k ds is unchanged.
        let scale = 2.0_f64.powi(power);
        let mesh = &parameters.mesh;
        let surfaces = random_surfaces(mesh, seed);
        let mut scaled_parameters = parameters.clone();
        scaled_parameters.foundation_height *= scale;
        scaled_parameters.materials.wear_height *= scale;
        for material in [
            &mut scaled_parameters.materials.pin_primary,
            &mut scaled_parameters.materials.pin_secondary,
            &mut scaled_parameters.materials.disc_primary,
            &mut scaled_parameters.materials.disc_secondary,
        ] {
            material.specific_wear_rate *= scale;
        }
        let against = &mut scaled_parameters.materials.pin_primary_against_secondary;
        *against = against.map(|rate| rate * scale);
        let scaled_surfaces = InitialSurfaces {
            disc_height: surfaces.disc_height.iter().map(|z| z * scale).collect(),
            pin_height: surfaces.pin_height.iter().map(|z| z * scale).collect(),
            pin_base: surfaces.pin_base.clone(),
        };
        let (mut plain, mut scaled) = (start(&parameters, surfaces), start(&scaled_parameters, scaled_surfaces));
        for _ in 0..mesh.disc_columns() {
            plain.advance().unwrap();
            scaled.advance().unwrap();
        }
        let times = |heights: &[f64]| heights.iter().map(|z| z * scale).collect::<Vec<_>>();
        prop_assert_eq!(&times(&plain.pin().unwrap().height), &scaled.pin().unwrap().height);
        prop_assert_eq!(&times(&plain.disc().unwrap().height), &scaled.disc().unwrap().height);
        prop_assert_eq!(plain.sample().unwrap().contact_area, scaled.sample().unwrap().contact_area);
        prop_assert_eq!(plain.sample().unwrap().max_pressure, scaled.sample().unwrap().max_pressure);
    }

    #[test]
    fn pressure_scales_with_load_at_the_same_heights((parameters, seed) in scenes(), power in -8..8_i32) {
        // Moduli and load times λ, wear rates divided by λ: the same heights to the bit, pressures times λ.
        let scale = 2.0_f64.powi(power);
        let mut stiffer = parameters.clone();
        stiffer.normal_force *= scale;
        let materials = &mut stiffer.materials;
        for material in [
            &mut materials.pin_primary,
            &mut materials.pin_secondary,
            &mut materials.pin_resin,
            &mut materials.disc_primary,
            &mut materials.disc_secondary,
        ] {
            material.youngs_modulus *= scale;
            material.specific_wear_rate /= scale;
        }
        materials.pin_primary_against_secondary = materials.pin_primary_against_secondary.map(|rate| rate / scale);
        materials.strength = materials.strength.map(|strength| strength * scale);
        let surfaces = random_surfaces(&parameters.mesh, seed);
        let (mut plain, mut scaled) = (start(&parameters, surfaces.clone()), start(&stiffer, surfaces));
        for _ in 0..parameters.mesh.disc_columns() {
            plain.advance().unwrap();
            scaled.advance().unwrap();
        }
        prop_assert_eq!(plain.pin().unwrap(), scaled.pin().unwrap());
        prop_assert_eq!(plain.disc().unwrap(), scaled.disc().unwrap());
        prop_assert_eq!(plain.sample().unwrap().max_pressure * scale, scaled.sample().unwrap().max_pressure);
    }
}

/// Model 4P: where every open cell got its whole share, the pool is empty to the last bit. What rounding leaves in it makes
/// cells secondary in the next step, with another stiffness.
#[test]
fn a_pool_that_has_given_all_is_exactly_empty() {
    for debris in [DebrisRule::Contact, DebrisRule::Track] {
        for tenths in 1..=10 {
            let mut parameters = wear_only(13, 40, 9);
            parameters.plateaus = PlateauRules {
                debris,
                captured_fraction: f64::from(tenths) / 10.0,
                captured_resin_fraction: None,
                pad_share: 0.3,
                formation: true,
                destruction: true,
                transport_length: None,
            };
            parameters.materials.pin_primary.specific_wear_rate = 0.0;
            parameters.materials.pin_secondary.specific_wear_rate = 0.0;
            // Fibre carries the load at height 0. One cell of resin in each row touches once and is worn clear; the rest
            // is far away.
            let mesh = &parameters.mesh;
            let column = |cell: usize| cell / mesh.rows();
            let surfaces = InitialSurfaces {
                disc_height: vec![0.0; mesh.disc_cells()],
                pin_height: (0..mesh.pin_cells()).map(|cell| if column(cell) < 2 { 0.0 } else { 50e-6 }).collect(),
                pin_base: (0..mesh.pin_cells())
                    .map(|cell| if column(cell) == 0 { Base::Primary } else { Base::Resin })
                    .collect(),
            };
            let mut simulation = start(&parameters, surfaces);
            let mut pools = Vec::new();
            for _ in 0..2 {
                simulation.advance().unwrap();
                pools.push(simulation.sample().unwrap().pool);
            }
            assert!(pools[0] > 1e-14, "{debris:?}, {tenths}: nothing was captured");
            assert_eq!(pools[1], 0.0, "{debris:?}, {tenths}");
        }
    }
}
