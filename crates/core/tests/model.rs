//! The engine takes the steps of the plain model, in hundreds or thousands of random small scenes with every option;
//! its first contact is the one that is told before.

use crate::scenes::{engines, few_or_all, random_round_scene, random_scene, start};
use plateau_core::engine::kernel::InstructionSet;
use plateau_core::model::accounts::AccountsReport;
use plateau_core::model::emission::EmissionReport;
use plateau_core::model::first_contact::FirstContact;
use plateau_core::model::friction::FrictionReport;
use plateau_core::model::heat::account::HeatReport;
use plateau_core::model::mesh::Mesh;
use plateau_core::model::parameters::{DebrisRule, Parameters, PlateauRules};
use plateau_core::model::state::{Base, Disc, InitialSurfaces, Pin};
use plateau_core::observe::{Map, Sample};
use plateau_core::simulation::{Decomposition, Engine, Execution, Simulation};

/// Accepted deviation of heights, m.
const HEIGHT: f64 = 1e-12;
/// Accepted relative deviation of everything else.
const RELATIVE: f64 = 1e-9;

/// What two samples differ in: name, both values, and how much is accepted.
fn differences(plain: &Sample, fast: &Sample, parameters: &Parameters) -> Vec<String> {
    let worn = plain.worn_pin + plain.worn_resin + plain.worn_disc + plain.returned;
    let pressure = parameters.normal_force / parameters.mesh.pin_area();
    let quantities = [
        ("displacement", plain.displacement, fast.displacement, HEIGHT / RELATIVE),
        ("contact area", plain.contact_area, fast.contact_area, parameters.mesh.pin_area()),
        ("largest pressure", plain.max_pressure, fast.max_pressure, pressure.max(plain.max_pressure)),
        ("mean pressure", plain.mean_pressure, fast.mean_pressure, plain.mean_pressure),
        ("worn pin", plain.worn_pin, fast.worn_pin, worn),
        ("worn resin", plain.worn_resin, fast.worn_resin, worn),
        ("worn disc", plain.worn_disc, fast.worn_disc, worn),
        ("returned", plain.returned, fast.returned, worn),
        ("pool", plain.pool, fast.pool, worn),
        ("emitted", plain.emitted, fast.emitted, worn),
        ("deposited on the pin", plain.deposited_pin, fast.deposited_pin, worn),
        ("deposited on the disc", plain.deposited_disc, fast.deposited_disc, worn),
        ("pin secondary", plain.pin_secondary, fast.pin_secondary, 1.0),
        ("disc secondary", plain.disc_secondary, fast.disc_secondary, 1.0),
        ("filled fraction", plain.filled_fraction, fast.filled_fraction, 1.0),
        ("contact area, mean", plain.contact_area_mean, fast.contact_area_mean, parameters.mesh.pin_area()),
    ];
    // What is no number differs.
    let agree = |plain: f64, fast: f64, scale: f64| (plain - fast).abs() <= RELATIVE * scale;
    let dissipated = accounted(plain, parameters, worn).into_iter().zip(accounted(fast, parameters, worn));
    // Without contact, and before the first interval of an event has ended, there is no number in either.
    let dissipated = dissipated.filter(|((_, plain, _), (_, fast, _))| !(plain.is_nan() && fast.is_nan()));
    let dissipated = dissipated.map(|((name, plain, scale), (_, fast, _))| (name, plain, fast, scale));
    let differ =
        quantities.into_iter().chain(dissipated).filter(|(_, plain, fast, scale)| !agree(*plain, *fast, *scale));
    differ.map(|(name, plain, fast, _)| format!("{name}: plain {plain:e}, fast {fast:e}")).collect()
}

/// Every number of friction, heat and emission: name, value, and the size that deviations are held against.
fn accounted(sample: &Sample, parameters: &Parameters, worn: f64) -> Vec<(&'static str, f64, f64)> {
    let AccountsReport { friction, heat, emission } = sample.accounts;
    assert_eq!(
        [friction.is_some(), heat.is_some(), emission.is_some()],
        [parameters.friction.is_some(), parameters.thermal.is_some(), parameters.emission.is_some()]
    );
    let mut numbers = Vec::new();
    if let Some(FrictionReport { coefficient, coefficient_mean, work, load_work }) = friction {
        numbers.extend([("μ", coefficient), ("mean μ", coefficient_mean), ("work", work), ("work of 1", load_work)]);
    }
    let mut numbers: Vec<_> = numbers.into_iter().map(|(name, value)| (name, value, value)).collect();
    if let Some(heat) = heat {
        // What of a temperature is no rise above the ambient says nothing; some 1e-13 K are rounding.
        let ambient = parameters.thermal.as_ref().map_or(0.0, |thermal| thermal.ambient);
        let HeatReport { contact, disc, pin, face, share, lost, residual, event_start, event_peak } = heat;
        for (name, value) in [
            ("contact temperature", contact),
            ("disc temperature", disc),
            ("pin temperature", pin),
            ("face temperature", face),
            ("temperature at the start of the event", event_start),
            ("largest temperature of the event", event_peak),
        ] {
            numbers.push((name, value, (value - ambient).abs() + 1e-3));
        }
        numbers.extend([
            ("share of the disc", share, 1.0),
            ("heat lost", lost, lost),
            ("residual of heat", residual, 1e-3),
        ]);
    }
    if let (Some(report), Some(emission)) = (emission, &parameters.emission) {
        let mass = worn * emission.pin_density.max(emission.disc_density);
        let EmissionReport { mass: emitted, pm10, pm25, number } = report;
        numbers.extend([("emitted mass", emitted, mass), ("PM10", pm10, mass), ("PM2.5", pm25, mass)]);
        numbers.push(("particles", number, mass * emission.number_per_mass));
    }
    numbers
}

fn largest_deviation(plain: &[f64], fast: &[f64]) -> f64 {
    plain.iter().zip(fast).map(|(plain, fast)| (plain - fast).abs()).fold(0.0, f64::max)
}

/// How a comparison ends.
enum End {
    /// Both took the same steps.
    Equal,
    /// A build-up was worn through to the last bit, as where one cell carries all the load and loses what the cell
    /// ahead of it lost and left there: on which side of nothing rounding leaves it, is chance.
    Tie,
    /// They differ.
    Different(String),
}

/// Whether some build-up is no more than what rounding leaves.
fn is_tie(heights: &[f64], substrates: &[f64]) -> bool {
    heights.iter().zip(substrates).map(|(height, substrate)| (height - substrate).abs()).any(|t| t > 0.0 && t < 1e-19)
}

/// Takes so many steps of one scene with both engines, up to the first in which they differ.
fn compare(parameters: &Parameters, seed: u64, steps: u64, execution: Execution) -> End {
    let mut plain = start(parameters, seed, Execution { engine: Engine::Plain, ..Execution::default() });
    let mut fast = start(parameters, seed, execution);
    for step in 1..=steps {
        if let (Err(_), Err(_)) = (plain.advance(), fast.advance()) {
            return End::Equal;
        }
        let mut differences = differences(&plain.sample().unwrap(), &fast.sample().unwrap(), parameters);
        let (pins, discs) = (
            [&mut plain, &mut fast].map(|each| each.pin().unwrap()),
            [&mut plain, &mut fast].map(|each| each.disc().unwrap()),
        );
        for (name, [plain, fast]) in [
            ("z_p", pins.each_ref().map(|pin| &pin.height)),
            ("b_p", pins.each_ref().map(|pin| &pin.substrate)),
            ("z_d", discs.each_ref().map(|disc| &disc.height)),
            ("b_d", discs.each_ref().map(|disc| &disc.substrate)),
        ] {
            let deviation = largest_deviation(plain, fast);
            if deviation > HEIGHT || !deviation.is_finite() {
                differences.push(format!("{name} by up to {deviation:e} m"));
            }
        }
        let tie = |pin: &Pin, disc: &Disc| is_tie(&pin.height, &pin.substrate) || is_tie(&disc.height, &disc.substrate);
        if pins.iter().zip(&discs).any(|(pin, disc)| tie(pin, disc)) {
            return End::Tie;
        }
        if !differences.is_empty() {
            return End::Different(format!("seed {seed}, step {step}: {differences:#?}\n{parameters:#?}"));
        }
    }
    End::Equal
}

/// Scenes with a rule; instruction set, number of workers and the kernel's shortcut change from scene to scene.
fn agrees(debris: DebrisRule) {
    let sets: Vec<InstructionSet> = InstructionSet::available().collect();
    let scenes = few_or_all(100, 3000);
    let mut ties = 0;
    for seed in 0..scenes {
        // Some pins are round.
        let parameters = if seed % 3 == 0 { random_round_scene(seed, debris) } else { random_scene(seed, debris) };
        let instructions = sets[seed as usize % sets.len()];
        let execution = Execution {
            instructions,
            workers: 1 + seed as usize / 3 % 4,
            decomposition: [Decomposition::Sectors, Decomposition::Auto, Decomposition::Bands][seed as usize % 3],
            shortcut: seed % 5 != 0,
            ..Execution::default()
        };
        let steps = 2 * parameters.mesh.disc_columns() as u64 + 20;
        match compare(&parameters, seed, steps, execution) {
            End::Equal => {}
            End::Tie => ties += 1,
            End::Different(difference) => panic!("{execution:?}, {difference}"),
        }
    }
    assert!(ties <= scenes / 20, "{ties} of {scenes} scenes have a tie");
}

#[test]
fn the_engine_agrees_with_the_plain_model_with_local_debris() {
    agrees(DebrisRule::Local);
}

#[test]
fn the_engine_agrees_with_the_plain_model_on_a_pin_whose_strips_are_fetched() {
    // z_p, b_p and z_d take 5 MB: more than a core has in its second cache.
    let mesh = crate::scenes::wear_only(200, 1200, 1000).mesh;
    let mut equal = 0;
    for seed in 0..8 {
        let mut parameters = random_scene(seed, DebrisRule::Local);
        let lengths = &mut parameters.plateaus.transport_length;
        *lengths = lengths.map(|length| length * mesh.column_width() / parameters.mesh.column_width());
        parameters.normal_force *= mesh.pin_area() / parameters.mesh.pin_area();
        (parameters.mesh, parameters.cycle) = (mesh.clone(), None);
        let execution = Execution { workers: 1 + seed as usize % 2, ..Execution::default() };
        match compare(&parameters, seed, 10, execution) {
            End::Equal => equal += 1,
            End::Tie => (),
            End::Different(difference) => panic!("{difference}"),
        }
    }
    assert!(equal > 4, "{equal} scenes have no tie");
}

#[test]
fn the_engine_agrees_with_the_plain_model_with_one_pool() {
    agrees(DebrisRule::Contact);
}

#[test]
fn the_engine_agrees_with_the_plain_model_with_a_pool_for_each_track() {
    agrees(DebrisRule::Track);
}

#[test]
fn the_first_contact_is_that_of_the_first_step() {
    for normal_force in [1e-3, 1.0, 1e4] {
        let mesh = Mesh::new(7, 60, 11, 20e-3, 21e-3).unwrap();
        let parameters = Parameters { mesh, normal_force, plateaus: PlateauRules::pool(0.5), ..Parameters::paper() };
        let mesh = &parameters.mesh;
        // Heights of no pattern, from 0 to 3 µm on the disc; the pin starts on other columns than it ends on.
        let heights = |cells: usize, prime: usize| (0..cells).map(|cell| (cell * prime % 1009) as f64 * 3e-9).collect();
        let surfaces = InitialSurfaces {
            disc_height: heights(mesh.disc_cells(), 7919),
            pin_height: heights(mesh.pin_cells(), 104_729),
            pin_base: (0..mesh.pin_cells()).map(|cell| [Base::Resin, Base::Primary][cell * 31 % 3 % 2]).collect(),
        };
        let first = FirstContact::of(&parameters, &surfaces).unwrap();
        let mut simulation = Simulation::new(parameters, surfaces).unwrap();
        simulation.advance().unwrap();
        let sample = simulation.sample().unwrap();
        assert!((first.displacement - sample.displacement).abs() < 1e-9 * 3e-6, "{first:?}, {sample:?}");
        assert!((first.contact_area / sample.contact_area - 1.0).abs() < 1e-12);
        assert!((first.mean_pressure / sample.mean_pressure - 1.0).abs() < 1e-8);
    }
}

/// Model 2: reports count build-ups of 1e-15 m and more, the rules all of them.
#[test]
fn a_build_up_thinner_than_1e_minus_15_m_is_reported_as_none() {
    let mut parameters = crate::scenes::wear_only(6, 60, 16);
    parameters.plateaus = PlateauRules::LOCAL;
    // Some 1e-17 m in a step, and none from resin.
    parameters.materials.wear_height = 0.0;
    for material in [&mut parameters.materials.pin_primary, &mut parameters.materials.pin_secondary] {
        material.specific_wear_rate = 3e-20;
    }
    let mesh = parameters.mesh.clone();
    for execution in engines() {
        let mut simulation = start(&parameters, 7, execution);
        simulation.advance_to(200).unwrap();
        let maps =
            [Map::PinStatus, Map::PinHeight, Map::PinSubstrate, Map::DiscStatus, Map::DiscHeight, Map::DiscSubstrate];
        let maps = simulation.snapshot(&maps).unwrap().maps;
        let fields: Vec<Vec<f64>> = maps.into_iter().map(|(_, values)| values.into_numbers()).collect();
        let sample = simulation.sample().unwrap();
        for (fields, sign, all, reported) in [
            (&fields[..3], 1.0, mesh.pin_area(), sample.pin_secondary),
            (&fields[3..], -1.0, mesh.disc_area(), sample.disc_secondary),
        ] {
            let (mut thin, mut area) = (0, 0.0);
            for (cell, status) in fields[0].iter().enumerate() {
                let build_up = sign * (fields[2][cell] - fields[1][cell]);
                thin += usize::from(build_up > 0.0 && build_up < 1e-15);
                area += if build_up >= 1e-15 { mesh.area()[cell % mesh.rows()] } else { 0.0 };
                assert_eq!(
                    *status == 2.0,
                    build_up >= 1e-15,
                    "{execution:?}, cell {cell}: {status} with {build_up:e} m"
                );
            }
            assert!(thin > 0 && area > 0.0, "{execution:?}: {thin} thin, {area} m²");
            assert!((reported - area / all).abs() < 1e-12, "{execution:?}: {reported}, {}", area / all);
        }
    }
}
