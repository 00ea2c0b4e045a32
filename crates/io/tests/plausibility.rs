//! Scenes that are legal and cannot be meant: each rule just beyond its bound and just inside it.

use std::f64::consts::{PI, TAU};
use std::path::{Path, PathBuf};

use plateau_core::observe::Sample;
use plateau_io::plausibility::{Recorded, of_scene, of_surfaces};
use plateau_io::scene::Scene;
use plateau_io::scene::{self, Warning};
use plateau_io::study::{Study, plan::Plan};
use plateau_io::surface::npy::write_array;
use plateau_io::surface::{self, Loaded};
use tempfile::TempDir;

/// A pin of fibre on a disc, both flat: 16 by 8 cells of a ring of 276 columns from 20 to 24 mm, at 2 m/s under 4.7 N, the
/// softest plateau of 1 GPa on a foundation of 50 µm.
const FLAT: &str = "tests/scenes/good/minimal.toml";
/// Synthetic surfaces on 40 by 20 cells of a ring of 690 columns from 20 to 21 mm.
const ROUGH: &str = "../../data/scenes/quick.toml";

/// Area of the pin of [`FLAT`], m².
fn pin_area() -> f64 {
    PI * (0.024_f64.powi(2) - 0.02_f64.powi(2)) * 16.0 / 276.0
}

/// E* of fibre (1 GPa) or resin (0.1 MPa) on the disc (100 GPa), ν = 0.27, Pa.
fn combined_modulus(pin: f64) -> f64 {
    1.0 / ((1.0 - 0.27 * 0.27) * (1.0 / pin + 1.0 / 1e11))
}

fn load(path: &str, sets: &[&str]) -> Scene {
    // A scene that leaves the debris rule open is told so, which is not looked at here.
    let sets: Vec<String> = sets.iter().chain(&["plateaus.debris=local"]).map(|set| (*set).to_owned()).collect();
    scene::load(Path::new(path), &sets).unwrap_or_else(|error| panic!("{error}"))
}

/// What is said of a scene before its run.
fn warnings(path: &str, sets: &[&str]) -> Vec<Warning> {
    all_warnings(load(path, sets))
}

fn all_warnings(scene: Scene) -> Vec<Warning> {
    let loaded = surface::load(&scene).unwrap_or_else(|error| panic!("{error}"));
    with_surfaces(scene, &loaded)
}

/// The same with surfaces that are loaded already.
fn with_surfaces(mut scene: Scene, loaded: &Loaded) -> Vec<Warning> {
    scene.warnings.extend(of_scene(&scene));
    scene.warnings.extend(of_surfaces(&scene, loaded));
    scene.warnings
}

/// Beyond the bound there is one warning of the key, with these words and the place; inside it there is none.
#[track_caller]
fn bounds(path: &str, key: &str, beyond: &[&str], inside: &[&str], words: &[&str]) {
    let of_key = |sets| warnings(path, sets).into_iter().filter(|warning| warning.key == key).collect::<Vec<_>>();
    let found = of_key(beyond);
    assert_eq!(found.len(), 1, "{key}, {beyond:?}: {found:?}");
    let text = found[0].to_string();
    assert!(text.contains(&format!(": {key}: ")) && text.contains("; ") && !text.contains('\n'), "{text}");
    for word in words {
        assert!(text.contains(word), "{word} is not in {text}");
    }
    assert_eq!(of_key(inside), [], "{key}, {inside:?}");
}

/// The same for one key that is set.
#[track_caller]
fn bounds_of(path: &str, key: &str, beyond: &str, inside: &str, words: &[&str]) {
    let [beyond, inside] = [beyond, inside].map(|value| format!("{key}={value}"));
    bounds(path, key, &[&beyond], &[&inside], words);
    let place = warnings(path, &[&beyond]).into_iter().find(|warning| warning.key == key).expect("a warning").place;
    assert_eq!(place.to_string(), format!("--set {beyond}"));
}

/// Heights for all cells, m, as NumPy writes them.
fn npy(folder: &TempDir, name: &str, (columns, rows): (usize, usize), height: impl Fn(usize) -> f64) -> PathBuf {
    let heights = (0..columns * rows).flat_map(|cell| height(cell).to_le_bytes());
    let path = folder.path().join(name);
    write_array(&path, "<f8", &[columns, rows], heights).expect("a file");
    path
}

#[test]
fn what_heat_is_told_is_looked_at() {
    let hot = "tests/scenes/good/hot.toml";
    for (key, beyond, inside, words) in [
        ("friction.shear_strength", "1.1 GPa", "0.9 GPa", "a shear strength of 1.1 GPa"),
        ("thermal.ambient", "23 K", "-40 degC", "an ambient temperature of 23 K"),
        ("thermal.disc.conductivity", "5 kW/(m K)", "400 W/(m K)", "a conductivity of 5000 W/(m K)"),
        ("thermal.disc.coating.conductivity", "0.01 W/(m K)", "2000 W/(m K)", "a conductivity of 0.01 W/(m K)"),
        ("emission.disc_density", "7.2 kg/m^3", "7.2 g/cm^3", "a density of 7.2 kg/m^3"),
    ] {
        let set = |value: &str| format!("{key}={value}");
        bounds(hot, key, &[&set(beyond)], &[&set(inside)], &[words]);
    }
    let half = 0.5e6 * pin_area();
    let set = |part: f64| format!("thermal.pin.area={} mm^2", part * half);
    // Capacity of the disc over the area of the simulated pin, 4e4 to 8e6 J/(K m^2); 7200 kg/m^3, 500 J/(kg K), 31 cm^2.
    let key = "thermal.disc.thickness";
    let thickness = |capacity: f64| format!("{key}={:e} m", capacity * pin_area() / (7200.0 * 500.0 * 31e-4));
    let words = ["heat capacity over the area of the simulated pin", "outside of 0.04 to 8 J/(K mm^2)", "[brake]"];
    bounds(hot, key, &[&thickness(8.1e6)], &[&thickness(7.9e6)], &words);
    bounds(hot, key, &[&thickness(3.9e4), "thermal.disc.coating.thickness=1 um"], &[&thickness(4.1e4)], &words);
    bounds(hot, "thermal.pin.area", &[&set(0.99)], &[&set(1.01)], &["of the pin in [mesh]"]);
}

#[test]
fn pressure_is_at_most_a_tenth_of_the_softest_plateau() {
    // F_N = 0.1 · 1 GPa · ΣA.
    let bound = 1e8 * pin_area();
    let [beyond, inside] = [1.001, 0.999].map(|factor| format!("{} N", factor * bound));
    let words = ["a nominal pressure of 100.1 MPa", "a tenth of the softest plateau's modulus of 1 GPa"];
    bounds_of(FLAT, "operation.normal_force", &beyond, &inside, &words);
    // A softer disc bears less.
    let soft = ["materials.disc_primary.youngs_modulus=1 MPa", "operation.normal_force=4.7 N"];
    assert!(warnings(FLAT, &soft).iter().any(|warning| warning.key == "operation.normal_force"));
}

#[test]
fn pressure_of_the_first_step_is_that_of_what_touches() {
    // One column of four touches, the others are set back by 1 mm: four times the nominal pressure, F_N = 0.1 · 1 GPa · ΣA/4.
    let folder = tempfile::tempdir().expect("a folder");
    let set_back = npy(&folder, "pin.npy", (16, 8), |cell| if cell / 8 % 4 == 1 { 0.0 } else { 1e-3 });
    let pin = format!("pin.surface.file={}", set_back.display());
    let [beyond, inside] =
        [1.001, 0.999].map(|factor| format!("operation.normal_force={} N", factor * 0.25e8 * pin_area()));
    let words = ["in the first step a mean contact pressure of 100.1 MPa", "modulus of 1 GPa"];
    bounds(FLAT, "operation.normal_force", &[&pin, &beyond], &[&pin, &inside], &words);
}

#[test]
fn overlap_is_at_most_the_height_of_the_foundation() {
    // Flat on flat: u = p h/E*, which is h where p = E*.
    for (base, modulus) in [("primary", 1e9), ("none", 1e5)] {
        let bound = combined_modulus(modulus) * pin_area();
        let base = format!("pin.base.uniform={base}");
        let [beyond, inside] = [1.001, 0.999].map(|factor| format!("operation.normal_force={} N", factor * bound));
        let words =
            ["in the first step an overlap of 50.05 um", "the foundation's height of 50 um", "minimal.toml:17:"];
        bounds(FLAT, "contact.foundation_height", &[&base, &beyond], &[&base, &inside], &words);
    }
}

#[test]
fn fibres_are_at_most_as_long_as_the_pin() {
    // 40 columns at 20.5 mm of 690 round the ring: 7.467 mm; across it is 1 mm.
    let length = 40.0 * TAU * 20.5e-3 / 690.0;
    let [beyond, inside] = [1.001, 0.999].map(|factor| format!("{} mm", factor * length * 1e3));
    let words = ["fibres of 7.474 mm", "longer than the pin of 7.467 mm by 1 mm"];
    bounds_of(ROUGH, "pin.base.synthetic.fibre_length", &beyond, &inside, &words);
    // A pin that is longer across holds longer fibres.
    assert_eq!(warnings(ROUGH, &["mesh.pin_columns=4", "pin.base.synthetic.fibre_length=0.99 mm"]), []);
}

#[test]
fn correlation_lengths_have_at_least_two_cells() {
    for body in ["disc", "pin"] {
        // One length for both directions: two of the shorter sides, 50 µm.
        let key = format!("{body}.surface.synthetic.correlation_length");
        let words = ["99.9 um, which is 1.998 cells of 50 um", "less than 2 cells"];
        bounds_of(ROUGH, &key, "99.9 um", "100 um", &words);
        // Two lengths: two columns of 2π 20.5 mm/690 = 186.7 µm, two rows of 50 µm.
        let across = format!("{key}_across");
        let [narrow, wide] = ["99.9 um", "100 um"].map(|length| format!("{across}={length}"));
        bounds(ROUGH, &across, &[&narrow], &[&wide], &["1.998 cells of 50 um"]);
        let [short, long] = ["373.3 um", "373.4 um"].map(|length| format!("{key}={length}"));
        bounds(ROUGH, &key, &[&short, &wide], &[&long, &wide], &["cells of 186.7 um"]);
    }
}

#[test]
fn a_patch_has_at_least_ten_correlation_lengths() {
    let words = ["1.99 mm, which is 9.95 correlation lengths of 200 um", "less than 10 of them"];
    bounds_of(ROUGH, "disc.surface.synthetic.patch", "1.99 mm", "2 mm", &words);
}

#[test]
fn moduli_are_those_of_materials() {
    for material in ["disc_primary", "disc_secondary", "pin_primary", "pin_secondary", "pin_resin"] {
        let key = format!("materials.{material}.youngs_modulus");
        bounds_of(FLAT, &key, "999 Pa", "1 kPa", &["a modulus of 999 Pa", "outside of 1 kPa to 1000 GPa"]);
        bounds_of(FLAT, &key, "1001 GPa", "1000 GPa", &["a modulus of 1001 GPa"]);
    }
    // A build-up that has the modulus of its substrate is not named besides.
    let found = warnings(FLAT, &["materials.disc_primary.youngs_modulus=1001 GPa"]);
    assert_eq!(found.len(), 1, "{found:?}");
}

#[test]
fn brakes_slide_at_200_metres_per_second_at_most() {
    let words = ["sliding at 200.1 m/s at the mean radius", "more than 200 m/s"];
    bounds_of(FLAT, "operation.sliding_speed", "200.1 m/s", "200 m/s", &words);
    // ω = 200 m/s / 20.5 mm = 9756.1 rad/s.
    bounds_of(ROUGH, "operation.rotational_speed", "9757 rad/s", "9756 rad/s", &["sliding at 200 m/s"]);
}

#[test]
fn a_cutoff_cuts_peaks() {
    let folder = tempfile::tempdir().expect("a folder");
    for (body, columns) in [("disc", 276), ("pin", 16)] {
        let key = format!("{body}.prepare.cutoff");
        let cells = columns * 8;
        // So many cells 1 µm above the others, whose mean is 1 µm times their part above the lower ones.
        let source = |name: &str, high: usize| {
            let path =
                npy(&folder, &format!("{body}-{name}.npy"), (columns, 8), |cell| if cell < high { 1e-6 } else { 0.0 });
            format!("{body}.surface.file={}", path.display())
        };
        let [half, less] = [source("half", cells / 2), source("less", cells / 2 - 1)];
        let cutoff = |height: f64| format!("{key}={} um", height);
        let words = ["at 0 m above the mean it cuts 50 % of the points", "half of them or more"];
        bounds(FLAT, &key, &[&half, &cutoff(0.0)], &[&less, &cutoff(0.0)], &words);
        // The upper half is 0.5 µm above the mean of all.
        let words =
            ["at 501 nm above the mean it cuts 0 % of the points", "no point at all", "or say cutoff = \"none\""];
        bounds(FLAT, &key, &[&half, &cutoff(0.501)], &[&less, &cutoff(0.499)], &words);
    }
    assert_eq!(warnings(FLAT, &["disc.prepare.cutoff=3 um", "pin.prepare.cutoff=0 um"]), []);
}

#[test]
fn shipped_studies_are_plausible() {
    let data = Path::new("../../data");
    let mut checked = 0;
    for folder in ["studies", "studies/published", "studies/riva2019"] {
        let files = std::fs::read_dir(data.join(folder)).expect("the shipped studies");
        let files = files.map(|entry| entry.expect("an entry").path());
        for path in files.filter(|path| path.extension().is_some_and(|ending| ending == "toml")) {
            if !std::fs::read_to_string(&path).expect("a scene or a study").contains("\ndesign = ") {
                continue;
            }
            let plan = Plan::new(Study::load(&path).unwrap_or_else(|error| panic!("{error}"))).expect("a plan");
            let base = scene::load(plan.study().base.as_deref().expect("a base"), &[]).expect("the base");
            // A study that varies the mesh does so to learn what a coarse one loses.
            let scenes = (1..=plan.runs()).map(|number| plan.scene(&plan.run(number)).expect("a scene"));
            let scenes = scenes.filter(|scene| scene.parameters.mesh == base.parameters.mesh);
            let found: Vec<Warning> = scenes.flat_map(|scene| of_scene(&scene)).collect();
            assert_eq!(found, [], "{}", path.display());
            checked += 1;
        }
    }
    assert!(checked >= 5, "{checked}");
}

/// What is said of a run of [`FLAT`] with these samples.
fn recorded(samples: &[Sample]) -> Vec<Warning> {
    let scene = load(FLAT, &[]);
    let mut recorded = Recorded::new(&scene.parameters);
    samples.iter().for_each(|sample| recorded.add(sample));
    recorded.warnings(&scene)
}

/// A sample of a run of fibre on the coating alone, with nothing in it that is odd.
fn sample(time: f64) -> Sample {
    Sample {
        time,
        mean_pressure: 1e6,
        max_pressure: 2e6,
        filled_fraction: 0.5,
        pin_none: 0.0,
        pin_primary: 1.0,
        pin_secondary: 0.0,
        disc_secondary: 0.0,
        ..crate::fixtures::sample(0)
    }
}

#[test]
fn a_run_tells_what_it_reached() {
    assert_eq!(recorded(&[]), []);
    assert_eq!(recorded(&[sample(1.0), sample(2.0)]), []);
    let says = |odd: Sample, key: &str, words: &[&str]| {
        let found = recorded(&[sample(1.0), odd, sample(3.0)]);
        assert_eq!(found.iter().map(|warning| warning.key.as_str()).collect::<Vec<_>>(), [key]);
        let text = found[0].to_string();
        words.iter().for_each(|word| assert!(text.contains(word), "{word} is not in {text}"));
    };
    let pressure = |mean_pressure| Sample { mean_pressure, ..sample(2.0) };
    says(pressure(1.001e8), "operation.normal_force", &["at 2 s a mean contact pressure of 100.1 MPa"]);
    assert_eq!(recorded(&[pressure(0.999e8)]), []);

    // u = p h/E* of the only pair that there is; with resin beside it the fibre is the stiffer and may bear the pressure.
    let resin = combined_modulus(1e5);
    let overlap =
        |max_pressure, fibre| Sample { max_pressure, pin_none: 1.0 - fibre, pin_primary: fibre, ..sample(2.0) };
    let words = ["at 2 s an overlap of at least 50.05 um", "the foundation's height of 50 um"];
    says(overlap(1.001 * resin, 0.0), "contact.foundation_height", &words);
    for inside in [overlap(0.999 * resin, 0.0), overlap(1.001 * resin, 0.1)] {
        assert_eq!(recorded(&[inside]), []);
    }
    says(overlap(1.001 * combined_modulus(1e9), 0.1), "contact.foundation_height", &words);

    let filled = |filled_fraction| Sample { filled_fraction, ..sample(2.0) };
    for (fraction, inside, text) in [(-0.25, 0.0, "-0.25"), (-0.0011, -0.0009, "-0.0011"), (1.0011, 1.0009, "1.001")] {
        let words =
            [&format!("at 2 s a filled fraction of {text}, outside of 0 to 1 by more than 0.001"), "minimal.toml:22:"];
        says(filled(fraction), "materials.disc_primary.specific_wear_rate", &words.map(|word: &str| word));
        assert_eq!(recorded(&[filled(inside)]), []);
    }
}

#[test]
fn a_key_is_named_once() {
    let mut scene = load(FLAT, &["operation.normal_force=5 MN"]);
    scene.warnings.extend(of_scene(&scene));
    let loaded = surface::load(&scene).unwrap();
    scene.warnings.extend(of_surfaces(&scene, &loaded));
    let mut recorded = Recorded::new(&scene.parameters);
    recorded.add(&Sample { mean_pressure: 1e12, max_pressure: 1e12, ..sample(1.0) });
    assert_eq!(recorded.warnings(&scene), []);
    let keys: Vec<&str> = scene.warnings.iter().map(|warning| warning.key.as_str()).collect();
    assert_eq!(keys, ["operation.normal_force", "contact.foundation_height"]);
}
