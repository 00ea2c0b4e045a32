//! The test vectors of an independent implementation (tests/vectors), through the whole program: scene in, run file out.

use std::fmt;

use plateau_io::scene;
use plateau_tests::program::{WorkingDirectory, vector as path_of};
use plateau_tests::run_file::RunFile;
use plateau_tests::vector;

/// Accepted deviation of heights, m.
const HEIGHT: f64 = 1e-12;
/// Accepted relative deviation of everything else.
const RELATIVE: f64 = 1e-9;

/// The largest deviation of one quantity.
#[derive(Debug)]
struct Deviation {
    quantity: String,
    /// Where it is: a step, or a cell.
    place: String,
    found: f64,
    expected: f64,
    size: f64,
    accepted: f64,
}

impl Deviation {
    /// The largest of `size(found, expected)`; `place` names an index.
    fn largest(
        quantity: &str,
        [found, expected]: [&[f64]; 2],
        size: impl Fn(f64, f64) -> f64,
        accepted: f64,
        place: impl Fn(usize) -> String,
    ) -> Self {
        assert_eq!(found.len(), expected.len(), "number of values of {quantity}");
        let sizes = found.iter().zip(expected).map(|(found, expected)| size(*found, *expected));
        // In the total order NaN is larger than every number.
        let (index, size) = sizes.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).expect("values");
        let (found, expected) = (found[index], expected[index]);
        Self { quantity: quantity.to_owned(), place: place(index), found, expected, size, accepted }
    }

    fn is_accepted(&self) -> bool {
        self.size <= self.accepted
    }
}

impl fmt::Display for Deviation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { quantity, place, found, expected, size, accepted } = self;
        write!(f, "{quantity}, {place}: {found:e}, expected {expected:e}: deviation {size:.1e}, accepted {accepted:e}")
    }
}

/// |found − expected| / scale; 0 where both are equal, even to 0, or no numbers.
fn relative(found: f64, expected: f64, scale: f64) -> f64 {
    if found == expected || (found.is_nan() && expected.is_nan()) { 0.0 } else { ((found - expected) / scale).abs() }
}

fn largest_value(values: &[f64]) -> f64 {
    values.iter().copied().map(f64::abs).fold(0.0, f64::max)
}

/// Deviations of maps after the last step.
fn map_deviations(run: &RunFile, expected: &RunFile) -> Vec<Deviation> {
    ["/disc/height", "/pin/height", "/pin/pressure"]
        .map(|map| {
            let rows = expected.shape(map)[1];
            assert_eq!(run.shape(map)[1..], expected.shape(map), "shape of {map}");
            let (found, expected) = (run.last_map(map), expected.floats(map));
            let cell = |index| format!("column {}, row {}", index / rows, index % rows);
            if map == "/pin/pressure" {
                let scale = largest_value(&expected);
                Deviation::largest(map, [&found, &expected], |a, b| relative(a, b, scale), RELATIVE, cell)
            } else {
                Deviation::largest(map, [&found, &expected], |a, b| (a - b).abs(), HEIGHT, cell)
            }
        })
        .into()
}

/// Deviations of what is recorded in every step.
fn series_deviations(run: &RunFile, expected: &RunFile) -> Vec<Deviation> {
    let load = |run: &RunFile| -> Vec<f64> {
        let pressure = run.floats("/series/mean_pressure");
        pressure.iter().zip(run.floats("/series/contact_area")).map(|(pressure, area)| pressure * area).collect()
    };
    let recorded = run.content();
    // The load of constant operation is no series of its own.
    let is_recorded =
        |name: &&str| matches!(*name, "time" | "load") || recorded.contains_key(&format!("/series/{name}"));
    let content = expected.content();
    content
        .keys()
        .filter_map(|path| path.strip_prefix("/series/"))
        .filter(is_recorded)
        .map(|name| {
            let path = format!("/series/{name}");
            let mut found = match name {
                "time" => run.floats("/time"),
                "load" => load(run),
                _ => run.floats(&path),
            };
            let expected = expected.floats(&path);
            // A run that ends in a pause has a sample of its end.
            found.truncate(expected.len());
            let largest = largest_value(&expected);
            let size = |a, b: f64| relative(a, b, if name == "pool" { largest } else { b });
            Deviation::largest(&path, [&found, &expected], size, RELATIVE, |index| format!("step {}", index + 1))
        })
        .collect()
}

/// Deviations of the volumes moved since the start.
fn volume_deviations(run: &RunFile, expected: &RunFile) -> Vec<Deviation> {
    let last = |name| *run.floats(&format!("/series/{name}")).last().expect("a sample");
    [
        ("worn_pin", "worn_pin"),
        ("worn_resin", "worn_resin"),
        ("worn_disc", "worn_disc"),
        ("returned", "destroyed"),
        ("emitted", "emitted"),
        ("deposited_pin", "deposited_pin"),
        ("deposited_disc", "deposited_disc"),
        ("pm10_mass", "pm10_mass"),
    ]
    .into_iter()
    .filter(|(_, attribute)| expected.attributes().contains_key(*attribute))
    .map(|(name, attribute)| {
        let pair = [&[last(name)][..], &[expected.number(attribute)][..]];
        Deviation::largest(name, pair, |a, b| relative(a, b, b), RELATIVE, |_| "end".into())
    })
    .collect()
}

/// All of them.
const NAMES: [&str; 9] = ["flat", "rough", "track", "local", "cycle", "heat", "pair", "reach", "torque"];

/// How many quantities a vector has: those of every one, and what its parts add.
fn quantities(name: &str) -> usize {
    match name {
        "cycle" => 17,
        "heat" => 24,
        "torque" => 25,
        _ => 16,
    }
}

/// Runs a vector's scene with changes and options of `run`, and gives the quantities that deviate more than is accepted.
fn refused(name: &str, sets: &[&str], options: &[&str]) -> Vec<Deviation> {
    let directory = WorkingDirectory::new();
    let scene = path_of(name, "scene.toml");
    let mut arguments = vec!["run", &scene, "-o", "run.h5"];
    arguments.extend(sets.iter().flat_map(|set| ["--set", set]));
    arguments.extend(options);
    // Three workers may be more than there are cores, which is said.
    directory.plateau(arguments).ends(0, &[]);
    let (run, expected) = (directory.run_file("run.h5"), RunFile::open(path_of(name, "expected.h5")));
    assert_eq!(run.text("state"), "finished");
    let mut deviations = map_deviations(&run, &expected);
    deviations.extend(series_deviations(&run, &expected));
    deviations.extend(volume_deviations(&run, &expected));
    assert_eq!(deviations.len(), quantities(name));
    deviations.retain(|deviation| !deviation.is_accepted());
    deviations
}

#[test]
fn every_vector_is_reproduced() {
    for name in NAMES {
        for options in [&[][..], &["--workers", "3"], &["--engine", "plain"]] {
            let refused: Vec<_> = refused(name, &[], options).iter().map(Deviation::to_string).collect();
            assert!(refused.is_empty(), "{name} {options:?}:\n{}", refused.join("\n"));
        }
    }
}

/// What is written for those who write the model anew is the independent implementation's too.
#[test]
fn a_vector_made_here_is_the_same() {
    for name in NAMES {
        let directory = WorkingDirectory::new();
        let scene = scene::load(path_of(name, "scene.toml").as_ref(), &[]).expect("the vector's scene");
        vector::write(&scene, directory.path("").as_ref()).expect("a vector");
        for file in ["init.h5", "expected.h5"] {
            let (made, there) = (directory.run_file(file), RunFile::open(path_of(name, file)));
            let (made, there) = (made.content(), there.content());
            assert_eq!(made.keys().collect::<Vec<_>>(), there.keys().collect::<Vec<_>>(), "{name}/{file}");
            if file == "init.h5" {
                assert_eq!(made, there, "{name}/{file}");
            }
        }
        let (made, expected) = (directory.run_file("expected.h5"), RunFile::open(path_of(name, "expected.h5")));
        let mut deviations = Vec::new();
        for (path, content) in expected.content() {
            let accepted = if path.ends_with("/height") { HEIGHT } else { RELATIVE };
            let values = [&made, &expected].map(|file| file.floats(&path));
            // Pressures may be 0 and pools may run empty, so their unit is the largest.
            let scale = largest_value(&values[1]);
            let size = |a: f64, b: f64| if path.ends_with("/height") { (a - b).abs() } else { relative(a, b, scale) };
            assert_eq!(made.shape(&path), content.shape, "{name}: shape of {path}");
            deviations
                .push(Deviation::largest(&path, [&values[0], &values[1]], size, accepted, |index| index.to_string()));
        }
        for volume in expected.attributes().keys() {
            let pair = [&made, &expected].map(|file| [file.number(volume)]);
            let size = |a, b: f64| relative(a, b, b);
            deviations.push(Deviation::largest(volume, [&pair[0], &pair[1]], size, RELATIVE, |_| "end".into()));
        }
        // The load, also where it is constant.
        assert_eq!(deviations.len(), quantities(name) + usize::from(name == "heat"));
        deviations.retain(|deviation| !deviation.is_accepted());
        let refused: Vec<_> = deviations.iter().map(Deviation::to_string).collect();
        assert!(refused.is_empty(), "{name}:\n{}", refused.join("\n"));
    }
}

#[test]
fn what_is_wrong_by_a_millionth_is_noticed() {
    let pooled = &["emitted", "/series/pool"][..];
    for (name, set, noticed) in [
        ("local", "plateaus.captured_fraction=0.999999", &["deposited_disc"][..]),
        ("flat", "plateaus.captured_fraction=0.3000003", pooled),
        ("rough", "plateaus.captured_fraction=0.25000025", pooled),
        ("track", "plateaus.captured_fraction=0.6000006", pooled),
        ("heat", "friction.pressure_coefficient=0.33000033", &["/series/friction_work"]),
        ("heat", "thermal.disc.coating.thickness=\"60.06 um\"", &["/series/contact_temperature"]),
        ("heat", "thermal.disc.cooling=\"0.4000004 W/K\"", &["/series/heat_lost"]),
        ("heat", "emission.number_per_mass=\"1.000001e15 1/kg\"", &["/series/particle_number"]),
    ] {
        let refused = refused(name, &[set], &[]);
        let is_refused = |quantity: &&str| refused.iter().any(|deviation| deviation.quantity == *quantity);
        assert!(noticed.iter().all(is_refused), "{name}, {set}: expected {noticed:?}, {refused:?}");
    }
}

#[test]
fn a_single_value_that_is_wrong_is_noticed_and_named() {
    let expected = [0.0, 1e-6, 3e-6];
    for wrong in [1e-6 + 2e-12, f64::NAN] {
        let found = [0.0, wrong, 3e-6];
        let size = |a: f64, b: f64| (a - b).abs();
        let deviation =
            Deviation::largest("height", [&found, &expected], size, HEIGHT, |index| format!("cell {index}"));
        assert!(!deviation.is_accepted(), "{deviation}");
        assert_eq!(deviation.place, "cell 1");
        let right = Deviation::largest("height", [&expected, &expected], size, HEIGHT, |index| index.to_string());
        assert!(right.is_accepted(), "{right}");
    }
    // A quantity that is 0 must be 0, and what differs from 0 is infinitely wrong.
    assert_eq!(relative(0.0, 0.0, 0.0), 0.0);
    assert_eq!(relative(1e-300, 0.0, 0.0), f64::INFINITY);
}
