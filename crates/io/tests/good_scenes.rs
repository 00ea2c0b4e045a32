//! Scenes that are accepted, and the values they give.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::fs;
use std::path::{Path, PathBuf};

use plateau_core::model::emission::Emission;
use plateau_core::model::friction::{Friction, FrictionLaw};
use plateau_core::model::material::Material;
use plateau_core::model::parameters::{DebrisRule, Integrator, Parameters};
use plateau_core::model::state::{Base, InitialSurfaces};
use plateau_core::model::thermal::{Coating, Disc, Factor, Pin, Substance, Thermal};
use plateau_core::observe::Map;
use plateau_core::observe::schedule::SampleEvery;
use plateau_core::surface::{Crop, FibreSynthesis, Fill, Flip, HeightSynthesis, Level, Preparation, Texture, Unroll};
use plateau_io::input::sha256_of;
use plateau_io::scene::{self, memory_estimate};
use plateau_io::scene::{BaseSource, HeightSettings, HeightSource, Scene, Workers};
use plateau_io::surface::{Decimal, Lay, ReadOptions};

pub fn good(name: &str) -> PathBuf {
    Path::new("tests/scenes/good").join(name)
}

pub fn load(name: &str, sets: &[&str]) -> Scene {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    scene::load(&good(name), &sets).unwrap_or_else(|error| panic!("{error}"))
}

/// A file named by a scene of the folder `good`.
pub fn input(name: &str) -> PathBuf {
    std::path::absolute(good(name)).unwrap()
}

#[test]
fn the_example_of_the_format_gives_its_values() {
    // Expected: the text of full.toml, in SI units.
    let scene = load("full.toml", &[]);
    assert_eq!(scene.title, "Cermet-coated disc, baseline");
    let parameters = &scene.parameters;
    assert_eq!(
        (parameters.mesh.rows(), parameters.mesh.disc_columns(), parameters.mesh.pin_columns()),
        (80, 2764, 161)
    );
    assert_eq!(parameters.mesh.mean_radius(), 0.5 * (0.02 + 0.024));
    assert_eq!(parameters.normal_force, 47.0);
    assert_eq!(parameters.angular_velocity, 850.0 * TAU / 60.0);
    // A revolution takes 60/850 s: 3000 s are 42500 revolutions of 2764 steps.
    assert_eq!(scene.steps, 42_500 * 2764);
    assert_eq!(parameters.foundation_height, 50e-6);
    assert_eq!(scene.load_tolerance, 1e-9);
    let disc = Material { youngs_modulus: 1e11, poisson_ratio: 0.27, specific_wear_rate: 0.0 };
    assert_eq!((parameters.materials.disc_primary, parameters.materials.disc_secondary), (disc, disc));
    assert_eq!(parameters.materials.pin_resin.youngs_modulus, 1e5);
    assert_eq!(parameters.materials.wear_height, 5e-6);
    let plateaus = parameters.plateaus;
    assert_eq!((plateaus.captured_fraction, plateaus.pad_share), (0.06, 0.5));
    assert_eq!((plateaus.debris, plateaus.formation, plateaus.destruction), (DebrisRule::Contact, true, true));
    assert_eq!((parameters.time_acceleration, parameters.integrator), (1.0, Integrator::Explicit));

    let preparation =
        Preparation { level: Level::Plane, pixel: Some(50e-6), cutoff: Some(3e-6), repeat: true, ..Preparation::NONE };
    let source = HeightSource::File { path: input("cermet.sdf"), options: ReadOptions::default() };
    assert_eq!(scene.disc_surface, HeightSettings { source, mirror: false, preparation });
    let synthesis = HeightSynthesis::gaussian(3, 0.5e-6, 100e-6);
    let source = HeightSource::Synthetic(synthesis);
    assert_eq!(scene.pin_surface, HeightSettings { source, mirror: false, preparation: Preparation::NONE });
    assert_eq!(scene.resin_recess, 8e-6);
    let fibres = FibreSynthesis { seed: 2, fibre_fraction: 0.3, fibre_length: 400e-6, fibre_width: 100e-6 };
    assert_eq!(scene.pin_base, BaseSource::Synthetic(fibres));
    assert_eq!(scene.seeds, [("pin.base.synthetic.seed".to_owned(), 2), ("pin.surface.synthetic.seed".to_owned(), 3)]);

    assert_eq!(scene.workers, Workers::Count(1));
    assert_eq!(scene.output.file, Path::new("baseline.h5"));
    assert_eq!(scene.output.sample_every, SampleEvery::Time(1.0));
    assert_eq!(scene.output.maps_at, [0.0, 500.0, 3000.0]);
    assert_eq!(scene.output.maps, Map::CHOICES);
    let digest = sha256_of(&std::fs::read(good("full.toml")).unwrap());
    assert_eq!(scene.files, [(good("full.toml"), digest)]);
    assert_eq!(scene.warnings, []);
}

#[test]
fn what_is_absent_gets_the_default_of_the_format() {
    let scene = load("minimal.toml", &[]);
    assert_eq!(scene.title, "minimal");
    let parameters = &scene.parameters;
    // Sliding speed is at the mean radius, 22 mm.
    assert_eq!(parameters.angular_velocity, 2.0 / (0.5 * (0.02 + 0.024)));
    assert_eq!((scene.steps, scene.load_tolerance), (1000, 1e-9));
    let plateaus = parameters.plateaus;
    assert_eq!((plateaus.pad_share, plateaus.debris), (0.5, DebrisRule::Contact));
    assert!(plateaus.formation && plateaus.destruction);
    assert_eq!((parameters.time_acceleration, parameters.integrator), (1.0, Integrator::Explicit));
    assert_eq!(parameters.materials.pin_secondary, parameters.materials.pin_primary);
    assert_eq!(parameters.materials.pin_secondary.specific_wear_rate, 5e-14);
    let flat = HeightSettings { source: HeightSource::Flat, mirror: false, preparation: Preparation::NONE };
    assert_eq!((&scene.disc_surface, &scene.pin_surface), (&flat, &flat));
    assert_eq!((scene.resin_recess, scene.pin_base_mirror), (0.0, false));
    assert_eq!(scene.pin_base, BaseSource::Uniform(Base::Primary));
    assert_eq!(scene.workers, Workers::Count(1));
    assert_eq!(scene.output.file, Path::new("minimal.h5"));
    assert_eq!(scene.output.sample_every, SampleEvery::Steps(276));
    assert_eq!((scene.output.maps_at.as_slice(), scene.output.maps.as_slice()), (&[][..], &Map::CHOICES[..]));
    // State and surfaces of 8·276 and 8·16 cells, two maps' worth of everything under way: the sum is in memory.rs.
    assert_eq!(memory_estimate(&scene), 2208 * 16 + 128 * 33 + 8 * 16 + 2 * (2208 * 17 + 128 * 25));
}

#[test]
fn friction_heat_and_emission_are_read_in_si_units() {
    // Expected: the text of hot.toml.
    let scene = load("hot.toml", &[]);
    let Parameters { friction, thermal, emission, .. } = &scene.parameters;
    let law = |pressure_coefficient, shear_strength| FrictionLaw { pressure_coefficient, shear_strength };
    let (primary, secondary, resin) = (law(0.33, 0.75e6), law(0.33, 1e6), law(0.2, 0.75e6));
    assert_eq!(*friction, Some(Friction { primary, secondary, resin, maximum: 0.6 }));
    let substance = |conductivity, density, specific_heat| Substance { conductivity, density, specific_heat };
    let factor = |points| Factor::new(points).unwrap();
    let coating = Coating { thickness: 60e-6, substance: substance(15.0, 13500.0, 250.0) };
    let expected = Thermal {
        ambient: 296.15,
        disc: Disc {
            substance: substance(50.0, 7200.0, 500.0),
            area: 31e-4,
            thickness: 6e-3,
            cooling: 0.4,
            cooling_per_speed: 2e-3,
            coating: Some(coating),
        },
        pin: Pin { substance: substance(1.5, 2600.0, 900.0), area: 78.5e-6, length: 12e-3, cooling: 0.0 },
        wear_rate_factor: factor(vec![(503.15, 1.0), (673.15, 4.0)]),
        friction_factor: factor(vec![(296.15, 1.0), (600.0, 0.5)]),
    };
    assert_eq!(thermal.as_deref(), Some(&expected));
    let expected = Emission {
        pm10_fraction: 0.4,
        pm25_fraction: 0.15,
        number_per_mass: 1e15,
        pin_density: 2600.0,
        disc_density: 7200.0,
        number_factor: factor(vec![(443.15, 1.0), (463.15, 100.0)]),
    };
    assert_eq!(*emission, Some(expected));
    assert_eq!(scene.output.maps, Map::ALL);
    let names: Vec<_> = scene.extras(false).iter().map(|extra| extra.name).collect();
    assert_eq!(names, ["contact_temperature", "friction", "heat", "emission"]);
    // A scene that asks for none of them has none.
    let Parameters { friction, thermal, emission, .. } = load("minimal.toml", &[]).parameters;
    assert!(friction.is_none() && thermal.is_none() && emission.is_none());
}

#[test]
fn the_scenes_of_the_reference_vectors_give_their_values() {
    for (name, [rows, disc_columns, pin_columns], force, steps) in
        [("flat", [6, 40, 10], 2.0, 120), ("rough", [16, 240, 48], 30.0, 700), ("track", [12, 150, 30], 12.0, 450)]
    {
        let scene = load(&format!("vector-{name}.toml"), &[]);
        let parameters = &scene.parameters;
        let mesh = &parameters.mesh;
        assert_eq!([mesh.rows(), mesh.disc_columns(), mesh.pin_columns()], [rows, disc_columns, pin_columns]);
        assert_eq!((parameters.normal_force, scene.steps), (force, steps));
        assert_eq!(scene.load_tolerance, 1e-12);
        let file = |dataset: &str| (input("init.h5"), Some(dataset.to_owned()));
        let (path, dataset) = file("/disc/height");
        let options = ReadOptions { dataset, ..ReadOptions::default() };
        assert_eq!(scene.disc_surface.source, HeightSource::File { path, options });
        let (path, dataset) = file("/pin/base");
        assert_eq!(scene.pin_base, BaseSource::File { path, dataset });
        assert_eq!(scene.output.sample_every, SampleEvery::Steps(1));
    }
    let track = load("vector-track.toml", &[]).parameters;
    assert_eq!((track.plateaus.debris, track.integrator), (DebrisRule::Track, Integrator::Exponential));
    assert_eq!(track.time_acceleration, 10.0);
    let secondary = Material { youngs_modulus: 5e9, poisson_ratio: 0.33, specific_wear_rate: 2e-14 };
    assert_eq!(track.materials.disc_secondary, secondary);
    assert_eq!((track.materials.wear_height, track.materials.pin_resin.poisson_ratio), (2e-6, 0.45));
}

#[test]
fn what_a_scene_says_of_a_file_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let minimal = good("minimal.toml").canonicalize().unwrap();
    let path = folder.path().join("scene.toml");
    let text = format!(
        "extends = {minimal:?}\n[disc.surface]\nfile = \"a.txt\"\nunit = \"nm\"\npitch = [\"50 um\", \"25 um\"]\n\
         decimal = \",\"\nskip = 3\nprofile_lay = \"across\"\n\
         [pin.surface]\nfile = \"a.png\"\npitch = \"10 um\"\nheight_range = [\"3 um\", \"-0.1 um\"]\n"
    );
    fs::write(&path, text).unwrap();
    let scene = scene::load(&path, &[]).unwrap();
    let options = |source: &HeightSource| match source {
        HeightSource::File { options, .. } => options.clone(),
        other => panic!("{other:?}"),
    };
    let nothing = ReadOptions::default();
    let disc = ReadOptions {
        unit: Some(1e-9),
        pitch: Some([50e-6, 25e-6]),
        decimal: Some(Decimal::Comma),
        skip: Some(3),
        profile_lay: Some(Lay::Across),
        ..nothing.clone()
    };
    let pin = ReadOptions { pitch: Some([1e-5; 2]), height_range: Some([3e-6, -1e-7]), ..nothing };
    assert_eq!(options(&scene.disc_surface.source), disc);
    assert_eq!(options(&scene.pin_surface.source), pin);
    fs::write(&path, &scene.resolved).unwrap();
    let again = scene::load(&path, &["pin.surface.unit=0.5 um".to_owned()]).unwrap();
    assert_eq!(options(&again.disc_surface.source), disc);
    assert_eq!(options(&again.pin_surface.source), ReadOptions { unit: Some(5e-7), ..pin });
    // Another source takes them along.
    let flat = scene::load(&path, &["disc.surface.flat=true".to_owned()]).unwrap();
    assert!(flat.resolved.contains("[disc.surface]\nflat = true\nmirror"), "{}", flat.resolved);
}

#[test]
fn synthetic_heights_have_one_texture_and_the_moments_of_a_normal_distribution_unless_told() {
    let synthesis = |sets: &[&str]| match load("full.toml", sets).pin_surface.source {
        HeightSource::Synthetic(synthesis) => synthesis,
        other => panic!("{other:?}"),
    };
    let plain = synthesis(&[]);
    assert_eq!((plain.skewness, plain.kurtosis), (0.0, 3.0));
    let lay = synthesis(&["pin.surface.synthetic.correlation_length_across=20 um"]);
    assert_eq!(lay.texture, Texture::Correlation { along: 100e-6, across: 20e-6 });
    // A power law takes the place of the correlation lengths, and the other way round.
    let power_law = ["pin.surface.synthetic.roll_off=0.5 mm", "pin.surface.synthetic.hurst=0.8"];
    let found = synthesis(&power_law);
    assert_eq!(found.texture, Texture::PowerLaw { hurst: 0.8, roll_off: 5e-4, short_cutoff: None });
    assert_eq!((found.seed, found.rms_height), (plain.seed, plain.rms_height));
    let moments = synthesis(&["pin.surface.synthetic.skewness=-1", "pin.surface.synthetic.kurtosis=5.5"]);
    assert_eq!(moments, HeightSynthesis { skewness: -1.0, kurtosis: 5.5, ..plain });
}

#[test]
fn the_preparation_is_read() {
    let sets = ["disc.prepare.level=quadratic", "disc.prepare.outliers=6", "disc.prepare.fill=interpolate"];
    let found = load("minimal.toml", &sets).disc_surface.preparation;
    let expected = Preparation {
        level: Level::Quadratic,
        outliers: Some(6.0),
        fill: Some(Fill::Interpolate),
        ..Preparation::NONE
    };
    assert_eq!(found, expected);
}

#[test]
fn the_steps_that_straighten_and_filter_a_surface_are_read() {
    let sets = [
        "pin.prepare.crop={ along = [\"1 mm\", \"9 mm\"] }",
        "pin.prepare.unroll.centre=[\"4 mm\", \"-20 mm\"]",
        "pin.prepare.unroll.radii=[\"20 mm\", \"24 mm\"]",
        "pin.prepare.rotate=90 deg",
        "pin.prepare.flip=across",
        "pin.prepare.outlier_slope=1.5",
        "pin.prepare.s_filter=25 um",
        "pin.prepare.l_filter=2 mm",
    ];
    let scene = load("minimal.toml", &sets);
    let expected = Preparation {
        crop: Some(Crop { along: Some([1e-3, 9e-3]), across: None }),
        unroll: Some(Unroll { centre: [4e-3, -20e-3], radii: Some([20e-3, 24e-3]) }),
        rotate: FRAC_PI_2,
        flip: Some(Flip::Across),
        outlier_slope: Some(1.5),
        s_filter: Some(25e-6),
        l_filter: Some(2e-3),
        ..Preparation::NONE
    };
    assert_eq!(scene.pin_surface.preparation, expected);
    assert_eq!(scene.disc_surface.preparation.crop, None);
    // The resolved scene has them in the order in which they are done, and reads back as the same.
    let names = "crop.along unroll.centre unroll.radii rotate flip level outlier_slope s_filter l_filter";
    let of_pin = scene.resolved.split("[pin.prepare]").nth(1).unwrap();
    let place = |name: &str| of_pin.find(&format!("\n{name} = ")).unwrap_or_else(|| panic!("{name}: {of_pin}"));
    assert!(names.split(' ').map(place).is_sorted(), "{of_pin}");
    assert!(of_pin.contains("\nrotate = \"90 deg\"\n"), "{of_pin}");
}

#[test]
fn a_duration_of_whole_steps_is_not_rounded_up() {
    let steps = |sets: &[&str]| {
        let quick = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/scenes/quick.toml");
        let sets: Vec<String> = sets.iter().map(|set| format!("operation.{set}")).collect();
        scene::load(&quick, &sets).unwrap_or_else(|error| panic!("{error}")).steps
    };
    // A step of the quick scene lasts 20 · 60 s/(850 · 690) = 4/1955 s. 60 s are 29 325 of them and 0.8 s 391: no step more because
    // of rounding. What ends within a step takes the whole step, but for 1e-9 of one.
    for (duration, expected) in [
        ("60 s", 29_325),
        ("0.8 s", 391),
        ("400 s", 195_500),
        ("1 h", 1_759_500),
        ("1 s", 489),
        ("4 ms", 2),
        ("2 ms", 1),
        ("1 us", 1),
        ("0.8000000000008 s", 391),
        ("0.80000000008 s", 392),
    ] {
        assert_eq!(steps(&[&format!("duration={duration}")]), expected, "{duration}");
    }
    assert_eq!(steps(&["steps=17"]), 17);
    // One revolution in 1 s and 100 columns: a step lasts 0.01 s, which no double is.
    let load = |duration: &str| {
        let duration = format!("operation.duration={duration}");
        load("minimal.toml", &["mesh.disc_columns=100", "operation.rotational_speed=60 rpm", &duration]).steps
    };
    assert_eq!(["0.29 s", "0.57 s", "0.571 s", "1e-15 s"].map(load), [29, 57, 58, 1]);
}

#[test]
fn the_papers_case_of_core_is_the_shipped_scene() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/scenes/cermet.toml");
    let scene = scene::load(&path, &[]).unwrap();
    assert_eq!(scene.parameters, Parameters { time_acceleration: 100.0, ..Parameters::paper() });
    let surfaces = plateau_io::surface::load(&scene).unwrap().surfaces;
    assert!(surfaces == InitialSurfaces::like_the_papers(&scene.parameters.mesh).unwrap(), "other surfaces");
}
