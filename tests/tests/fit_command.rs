//! `plateau fit`: keys that are looked for are found where a closed form says they are, and what cannot be known is said.
//!
//! Expected numbers: what wears off the pin's plateaus is load × sliding distance × specific wear rate, whatever carries the
//! load (model.md, section 8). The distance is 2π · 20.5 mm · 850/60 s⁻¹ · 3 s.

use std::fs;
use std::process::Stdio;

use plateau_tests::figure::Figure;
use plateau_tests::program::{Outcome, WorkingDirectory, kill, scene, wait_until};
use plateau_tests::table::{Row, number, rows};
use serde_json::Value;

/// Sliding distance, m.
const DISTANCE: f64 = std::f64::consts::TAU * 0.0205 * 850.0 / 60.0 * 3.0;
/// Of quick.toml, 1/Pa.
const WEAR_RATE: f64 = 5e-14;

const LOAD: &str = "[[factor]]\nname = \"load\"\nkey = \"operation.normal_force\"\nrange = [\"4 N\", \"12 N\"]\n";
const RATE: &str = "[[factor]]\nname = \"wear rate\"\nkey = \"materials.pin_primary.specific_wear_rate\"\n\
                    range = [\"2e-14 1/Pa\", \"2e-13 1/Pa\"]\nscale = \"logarithmic\"\n";

/// A study of quick.toml, 3 s long; `tables` are factors and responses.
fn study(points: usize, tables: &[&str]) -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    directory.write(
        "fit.toml",
        format!(
            "version = 1\ntitle = \"A fit\"\nbase = \"{}\"\n\
             set = [\"operation.duration = '3 s'\", \"output.sample_every = '0.5 s'\"]\n\
             design = \"sobol\"\npoints = {points}\ndirectory = \"results\"\n{}",
            scene("quick.toml"),
            tables.join("\n")
        ),
    );
    directory
}

/// A response: the volume worn off the pin, as it is with this load.
fn worn(load: f64, uncertainty: f64) -> String {
    let volume = load * DISTANCE * WEAR_RATE * 1e9;
    format!(
        "[[response]]\nname = \"worn\"\ndataset = \"/series/worn_pin\"\nat = \"end\"\nmeasured = \"{volume} mm^3\"\n\
         uncertainty = \"{} mm^3\"\n",
        uncertainty * volume
    )
}

fn fit(directory: &WorkingDirectory, arguments: &[&str]) -> Outcome {
    let outcome = directory.plateau(["fit", "fit.toml"].iter().chain(arguments));
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    outcome
}

fn json(outcome: &Outcome) -> Value {
    serde_json::from_str(&outcome.stdout).unwrap_or_else(|error| panic!("{error}: {outcome:?}"))
}

/// Lines of all records.
fn records(directory: &WorkingDirectory) -> usize {
    let shards = fs::read_dir(directory.path("results/journal")).unwrap();
    shards.map(|shard| fs::read_to_string(shard.unwrap().path()).unwrap().lines().count()).sum()
}

#[test]
fn a_load_is_found_from_what_it_wore() {
    let directory = study(6, &[LOAD, &worn(7.0, 0.02), "[fit]\nruns = 20\n"]);
    let planned = json(&fit(&directory, &["--plan", "--json"]));
    assert_eq!((planned["first_runs"].as_u64(), planned["runs_at_most"].as_u64()), (Some(6), Some(20)));
    assert_eq!(directory.names(), ["fit.toml"], "a plan leaves nothing behind");

    let found = json(&fit(&directory, &["--json"]));
    let key = &found["keys"][0];
    let (best, low, high) =
        (key["most_likely"].as_f64().unwrap(), key["interval"][0]["low"].as_f64(), key["interval"][0]["high"].as_f64());
    // The pin touches between 20 and 21 mm, so its mean distance may be up to 2.4 % off: where contact is nearly even, less
    // than a percent. The interval is that of a measurement of 2 % that the surrogate adds nothing to.
    assert!((best - 7.0).abs() < 0.07, "{found}");
    let reach = 1.96 * 0.02 * best;
    assert!((low.unwrap() - (best - reach)).abs() < 0.005 && (high.unwrap() - (best + reach)).abs() < 0.005, "{found}");
    assert_eq!((key["undetermined"].as_bool(), found["ended"].as_str()), (Some(false), Some("settled")));
    assert_eq!(found["degrees_of_freedom"].as_u64(), Some(0));
    let runs = found["runs"].as_u64().unwrap() as usize;
    assert!((6..=20).contains(&runs) && records(&directory) == runs, "{found}");

    // Asked again, it makes no run and says the same.
    assert_eq!(json(&fit(&directory, &["--json"])), found);
    assert_eq!(records(&directory), runs);
    let text = fit(&directory, &[]).stdout;
    assert!(text.contains("load") && text.contains("further runs are expected to change little"), "{text}");

    let table = |name: &str| rows(&fs::read_to_string(directory.path("results/fit").join(name)).unwrap());
    assert_eq!(number(&table("keys.csv")[0], "most_likely"), best);
    assert_eq!(table("runs.csv").len(), runs);
    let profile = table("profiles.csv");
    assert!(profile.len() >= 41 && profile.iter().all(|row| number(row, "rise") >= 0.0));
    let figure = fs::read_to_string(directory.path("results/fit/profiles.svg")).unwrap();
    assert!(Figure::read(&figure).texts.iter().any(|text| text.text.contains("load, N")), "{figure}");
}

#[test]
fn what_is_not_determined_is_said() {
    // Load and wear rate act on this response by their product alone.
    let directory = study(12, &[LOAD, RATE, &worn(7.0, 0.03), "[fit]\nruns = 32\n"]);
    let found = json(&fit(&directory, &["--json"]));
    let determined = found["determined"].as_str().unwrap_or_default();
    let product = determined.strip_prefix("Only ").and_then(|rest| rest.split_once(" = ")).expect("a product").0;
    assert_eq!(product.split(" × ").count(), 2, "{found}");
    // The surrogate knows the direction to a few hundredths: a power of 1, or one that is as good as 1.
    let power = |name: &str| {
        let of = product.split(" × ").find_map(|part| part.strip_prefix(name)).expect("a power of both");
        of.strip_prefix('^').map_or(1.0, |power| power.parse::<f64>().expect("a number"))
    };
    let powers = [power("load"), power("wear rate")];
    assert!(powers.iter().all(|power| (power - 1.0).abs() < 0.03), "{found}");
    // The product is known as well as the measurement, to 3 %: 1.96 times that to either side.
    let ends = determined.split_once('(').and_then(|(_, rest)| rest.split_once(',')).expect("an interval").0;
    let ends: Vec<f64> = ends.replace('\u{2212}', "-").split(" … ").map(|end| end.parse().expect("a number")).collect();
    let half = 0.5 * (ends[1] / ends[0]).ln();
    // With such powers its true value depends on where along the product it is asked for, between the loads of the range.
    let truths = [4.0_f64, 12.0].map(|load| load.powf(powers[0]) * (3.5e-13 / load).powf(powers[1]));
    let (least, most) = (truths[0].min(truths[1]), truths[0].max(truths[1]));
    assert!((half / (1.96 * 0.03) - 1.0).abs() < 0.1 && ends[0] <= most && least <= ends[1], "{determined}");
    // Every load from 4 to 12 N has a wear rate in the range that gives the product of 3.5e-13 N/Pa.
    assert_eq!(found["keys"][0]["undetermined"].as_bool(), Some(true), "{found}");
    // What may be anywhere has no value that is likelier than others, whoever reads it.
    assert!(found["keys"][0]["most_likely"].is_null() && found["keys"][1]["most_likely"].is_f64(), "{found}");
    let table = rows(&fs::read_to_string(directory.path("results/fit/keys.csv")).unwrap());
    assert_eq!((table[0]["key"].as_str(), table[0]["most_likely"].as_str()), ("load", ""), "{table:?}");
    // Of the wear rate, from 3.5e-13/12 to 3.5e-13/4, less and more by what 3 % with 95 % may be off.
    let piece = &found["keys"][1]["interval"][0];
    let (low, high) = (piece["low"].as_f64().unwrap(), piece["high"].as_f64().unwrap());
    let (lower, upper) = (3.5e-13 / 12.0 * (1.0 - 1.96 * 0.03), 3.5e-13 / 4.0 * (1.0 + 1.96 * 0.03));
    assert!((low / lower - 1.0).abs() < 0.03 && (high / upper - 1.0).abs() < 0.03, "{found}");
    let text = fit(&directory, &[]).stdout;
    assert!(text.contains("not determined by these data: anywhere from 4 to 12 N"), "{text}");
    assert!(directory.path("results/fit/region-load-wear-rate.png").exists());
}

#[test]
fn a_fit_to_what_scatters_ends_before_its_budget() {
    // After 40 s the area pulses: its value at one moment differs from load to load by several hundredths of a square millimetre.
    let area = "[[response]]\nname = \"area\"\ndataset = \"/series/contact_area\"\nat = \"end\"\nmeasured = \"0.8 mm^2\"\n\
                uncertainty = \"0.01 mm^2\"\n";
    let directory = study(6, &[LOAD, area, "[fit]\nruns = 60\n"]);
    let text = fs::read_to_string(directory.path("fit.toml")).unwrap();
    directory.write("fit.toml", text.replace("'3 s'", "'40 s'").replace("'0.5 s'", "'2 s'"));
    let found = json(&fit(&directory, &["--json"]));
    assert_eq!(found["ended"].as_str(), Some("no gain"), "{found}");
    assert!(found["runs"].as_u64().unwrap() <= 40, "{found}");
    let said = found["notes"].to_string();
    assert!(said.contains("runs miss what the others forecast of area by") && said.contains("[replicates]"), "{said}");
    let text = fit(&directory, &[]).stdout;
    assert!(text.contains("more would hardly help, for runs scatter too much"), "{text}");
}

#[test]
fn a_measurement_that_no_value_gives_is_told() {
    // Twice what the largest load of the range wears.
    let directory = study(6, &[LOAD, &worn(24.0, 0.02), "[fit]\nruns = 12\n"]);
    let found = json(&fit(&directory, &["--json"]));
    let notes = found["notes"].to_string();
    assert!(notes.contains("no values within these ranges give all that was measured"), "{found}");
    assert_eq!(found["keys"][0]["most_likely"].as_f64(), Some(12.0), "{found}");
}

#[test]
fn a_fit_that_is_killed_goes_on_to_the_same_end() {
    let tables = [LOAD, RATE, &worn(7.0, 0.03), "[fit]\nruns = 18\n"];
    let [undisturbed, killed] = [study(8, &tables), study(8, &tables)];
    let expected = json(&fit(&undisturbed, &["--json"]));
    let mut command = killed.command(["fit", "fit.toml", "--jobs", "1"]);
    let child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let has_some = || killed.path("results/journal").exists() && records(&killed) >= 2;
    assert!(wait_until(has_some), "no result");
    kill(child);
    let before = records(&killed);
    assert_eq!(json(&fit(&killed, &["--json"])), expected);
    // What was there was not made again.
    assert!(before >= 2 && records(&killed) == expected["runs"].as_u64().unwrap() as usize, "{before}");
}

#[test]
fn runs_of_a_sweep_are_the_first_of_a_fit() {
    let directory = study(6, &[LOAD, &worn(7.0, 0.02), "[fit]\nruns = 6\n"]);
    directory.plateau(["sweep", "run", "fit.toml"]).quiet_success();
    let found = json(&fit(&directory, &["--json"]));
    assert_eq!((records(&directory), found["runs"].as_u64(), found["rounds"].as_u64()), (6, Some(6), Some(1)));
}

#[test]
fn a_load_is_found_from_a_series_of_what_it_wore() {
    // Worn volumes after 1, 2 and 3 s, each known to 3 % of the last one.
    let volumes = [1.0, 2.0, 3.0].map(|time| 7.0 * DISTANCE * WEAR_RATE * 1e9 * time / 3.0);
    let uncertainty = 0.03 * volumes[2];
    let table = |volumes: [f64; 3]| {
        let line = |(time, volume): (usize, f64)| format!("{},{volume},{uncertainty}\n", (time + 1) * 1000);
        let lines: String = volumes.into_iter().enumerate().map(line).collect();
        format!("# rig 2\ntime [ms],worn [mm3],uncertainty [mm3]\n{lines}")
    };
    let series = "[[response]]\nname = \"worn\"\ndataset = \"/series/worn_pin\"\nmeasured_file = \"worn.csv\"\n";
    let directory = study(6, &[LOAD, "[fit]\nruns = 20\n", series]);
    directory.write("worn.csv", table(volumes));
    let planned = fit(&directory, &["--plan"]).stdout;
    assert!(planned.contains("3 points from 1 to 3 s in worn.csv"), "{planned}");
    let found = json(&fit(&directory, &["--json"]));
    // The load is the one that generalised least squares give, with a standard deviation of 1/√(gᵀV⁻¹g): g are volumes for
    // each newton, V are covariances. A run's first second, in which the pin comes to bear, is some percent off.
    let holds = |found: &Value, deviation: f64| {
        let key = &found["keys"][0];
        let ends = ["low", "high"].map(|end| key["interval"][0][end].as_f64().unwrap());
        assert!((key["most_likely"].as_f64().unwrap() - 7.0).abs() < 0.1, "{found}");
        assert!(((ends[1] - ends[0]) / (2.0 * 1.96 * deviation) - 1.0).abs() < 0.03, "{deviation} {found}");
    };
    let slopes = volumes.map(|volume| volume / 7.0 / uncertainty);
    holds(&found, slopes.iter().map(|slope| slope * slope).sum::<f64>().sqrt().recip());
    let series = &found["series"][0];
    assert_eq!((series["points"].as_u64(), series["independent_points"].as_f64()), (Some(3), Some(3.0)), "{found}");
    assert_eq!(found["degrees_of_freedom"].as_u64(), Some(2));
    let rows = rows(&fs::read_to_string(directory.path("results/fit/series.csv")).unwrap());
    assert_eq!(rows.iter().map(|row| number(row, "time")).collect::<Vec<_>>(), [1.0, 2.0, 3.0]);
    for row in &rows {
        assert!((number(row, "forecast") / number(row, "measured") - 1.0).abs() < 0.02, "{rows:?}");
    }
    assert!(directory.path("results/fit/series-worn.png").exists());

    // Errors that are alike for 5 s: with ρ = exp(−1/5) the three points are whitened by hand. No run is made anew.
    let study = fs::read_to_string(directory.path("fit.toml")).unwrap();
    directory.write("fit.toml", format!("{study}correlation_time = \"5 s\"\n"));
    let before = records(&directory);
    let found = json(&fit(&directory, &["--json"]));
    let (rho, rest) = ((-0.2_f64).exp(), (1.0 - (-0.4_f64).exp()).sqrt());
    let white = [slopes[0], (slopes[1] - rho * slopes[0]) / rest, (slopes[2] - rho * slopes[1]) / rest];
    holds(&found, white.iter().map(|slope| slope * slope).sum::<f64>().sqrt().recip());
    assert!((found["series"][0]["independent_points"].as_f64().unwrap() - 1.2).abs() < 0.001, "1 + 2 tanh(0.1)");
    assert!(records(&directory) <= before + 4, "at most one more round");
}

#[test]
fn a_table_that_is_no_series_is_refused_with_its_place() {
    let series = "[[response]]\nname = \"worn\"\ndataset = \"/series/worn_pin\"\nmeasured_file = \"t.csv\"\n";
    let refused = |more: &str, table: &str, expected: &str| {
        let directory = study(6, &[LOAD, series, more]);
        directory.write("t.csv", table);
        let outcome = directory.plateau(["fit", "fit.toml"]);
        assert_eq!(outcome.status, Some(2), "{outcome:?}");
        assert!(outcome.stderr.contains(expected), "{expected:?} in {}", outcome.stderr);
        assert_eq!(directory.names(), ["fit.toml", "t.csv"]);
    };
    let good = "time [s],worn [mm3],uncertainty\n1,1e-3,1e-13\n3,2e-3,1e-13\n";
    refused("", "time [s],worn\n1,1\n2,x\n", "t.csv:1: no column \"uncertainty\"");
    refused("uncertainty = 1e-13\n", "time [s],worn\n1,1\n2,x\n", "fit.toml:");
    refused("uncertainty = 1e-13\n", "time [s],worn\n1,1\n2,x\n", "t.csv:3: \"worn\" is \"x\", expected a number");
    refused(
        "",
        &good.replace("\n3,", "\n3.1,"),
        "t.csv:3: the time is 3.1 s, and the runs end at 3 s: make them longer",
    );
    refused("at = \"end\"\n", good, "a whole series is compared at its times: take out at, mean, reaches and event");
    refused("measured = 2e-12\nuncertainty = 1e-13\n", good, "measured and measured_file are given together, keep one");
    refused("correlation_time = \"-1 s\"\n", good, "expected a time of 0 or more");
    refused("correlation_time = \"1 m\"\n", good, "response.correlation_time");
    let alone =
        "[[response]]\nname = \"end\"\ndataset = \"/series/worn_pin\"\nat = \"end\"\ncorrelation_time = \"1 s\"\n";
    refused(alone, good, "it belongs to measured_file");
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let refused = |tables: &[&str], expected: &str| {
        let directory = study(6, tables);
        let outcome = directory.plateau(["fit", "fit.toml"]);
        assert_eq!(outcome.status, Some(2), "{outcome:?}");
        assert!(outcome.stderr.contains(expected), "{expected:?} in {}", outcome.stderr);
        assert_eq!(directory.names(), ["fit.toml"]);
    };
    let plain = "[[response]]\nname = \"worn\"\ndataset = \"/series/worn_pin\"\nat = \"end\"\n";
    refused(&[LOAD, plain], "nothing was measured");
    let levels = "[[factor]]\nkey = \"operation.normal_force\"\nlevels = [\"4 N\", \"12 N\"]\n";
    let expected = "factor \"operation.normal_force\" (operation.normal_force) has levels, and a fit looks for numbers between \
                    two ends: give range = [lower, upper] in place of levels";
    refused(&[levels, &worn(7.0, 0.02)], expected);
    let words =
        "[[factor]]\nname = \"rule\"\nkey = \"plateaus.debris\"\nlevels = [\"contact\", \"track\", \"local\"]\n";
    let expected = "factor \"rule\" (plateaus.debris) has levels, and a fit looks for numbers between two ends: these are words, \
                    \"contact\", \"track\", \"local\". Make one study for each word, with set = \
                    [\"plateaus.debris='contact'\"]";
    refused(&[LOAD, words, &worn(7.0, 0.02)], expected);
    refused(&[LOAD, plain, "measured = 2e-12\n"], "measured and uncertainty belong together");
    refused(&[LOAD, plain, "measured = \"2 mm^2\"\nuncertainty = 1e-13\n"], "it is an area, expected a number in m3");
    refused(&[LOAD, plain, "measured = \"much\"\nuncertainty = 1e-13\n"], "it does not start with a number");
    refused(&[LOAD, plain, "measured = 2e-12\nuncertainty = 0\n"], "expected more than 0");
    refused(&[LOAD, &worn(7.0, 0.02), "[fit]\nconfidence = 1.0\n"], "more than 0 and less than 1");
    refused(&[LOAD, &worn(7.0, 0.02), "[fit]\nrun = 9\n"], "unknown key `run`");
}

/// Numbers that look like chance, the same each time: a linear congruential generator (D. E. Knuth's MMIX), even in (0, 1).
struct Lot(u64);

impl Lot {
    fn even(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// Standard normal, by Box and Muller.
    fn normal(&mut self) -> f64 {
        (-2.0 * self.even().ln()).sqrt() * (std::f64::consts::TAU * self.even()).cos()
    }
}

/// What studies of the truth and fits to it have in common.
fn head() -> String {
    let set = "[\"operation.duration = '3 s'\", \"output.sample_every = '0.5 s'\"]";
    format!("version = 1\nbase = \"{}\"\nset = {set}\n", scene("quick.toml"))
}

fn seeds(seeds: &str) -> String {
    let keys = "[\"disc.surface.synthetic.seed\", \"pin.base.synthetic.seed\", \"pin.surface.synthetic.seed\"]";
    format!("[replicates]\nkeys = {keys}\nseeds = {seeds}\n")
}

const TWO: [&str; 2] = [
    "[[factor]]\nname = \"load\"\nkey = \"operation.normal_force\"\n",
    "[[factor]]\nname = \"fibres\"\nkey = \"pin.base.synthetic.fibre_fraction\"\n",
];
const RANGES: [&str; 2] = ["range = [\"4 N\", \"12 N\"]\n", "range = [0.2, 0.4]\n"];
/// Responses, the columns of their results, and how uncertain they are measured.
const RESPONSES: [(&str, &str, f64); 2] = [
    ("[[response]]\nname = \"worn\"\ndataset = \"/series/worn_pin\"\nat = \"end\"\n", "worn [m3]", 0.03),
    ("[[response]]\nname = \"area\"\ndataset = \"/series/contact_area_mean\"\nat = \"end\"\n", "area [m2]", 0.08),
];

/// What runs with these keys give on surfaces that no run of a fit has.
fn specimens(directory: &WorkingDirectory, truths: &[[f64; 2]]) -> Vec<Row> {
    let points: String = truths.iter().map(|[load, fibres]| format!("{load} N,{fibres}\n")).collect();
    directory.write("truths.csv", format!("load,fibres\n{points}"));
    let design =
        format!("{}design = \"csv\"\nfile = \"truths.csv\"\ndirectory = \"truths\"\n{}", head(), seeds("[77]"));
    let responses = RESPONSES.map(|(text, ..)| text);
    directory.write("truths.toml", [design, TWO.concat(), responses.concat()].concat());
    directory.plateau(["sweep", "run", "truths.toml"]).quiet_success();
    directory.plateau(["sweep", "collect", "truths.toml"]).quiet_success();
    rows(&fs::read_to_string(directory.path("truths/results.csv")).unwrap())
}

#[test]
fn a_weighed_pin_tells_the_wear_rate_of_its_fibres() {
    // A lab weighs a pin, of which nothing is known but its surfaces: the run with this wear rate.
    let truth = 6.3e-14;
    let directory = WorkingDirectory::new();
    let base = scene("quick.toml");
    let with = |rate: f64| {
        let rate = format!("materials.pin_primary.specific_wear_rate={rate:e} 1/Pa");
        let sets = [&rate, "operation.duration=600 s", "output.sample_every=10 s", "output.maps_at=[]"];
        let sets = sets.iter().flat_map(|set| ["--set", set]);
        json(&directory.plateau(["run", &base, "-o", "lab.h5", "--force", "--json"].into_iter().chain(sets)))
    };
    let weighed = with(truth);
    let value = |summary: &Value, key: &str| summary[key].as_f64().unwrap();
    // By the recipe of docs/values.md. The rate of the whole pin in the place of that of the fibres wears twice as fast.
    let rate = value(&weighed, "specific_wear_rate_whole_pin");
    let mut tried = with(rate);
    assert!(value(&tried, "lost_pin") > 2.0 * value(&weighed, "lost_pin"), "{tried}");
    for near in [0.08, 0.04] {
        let found = rate * value(&tried, "worn_pin") / value(&tried, "lost_pin");
        assert!((found / truth - 1.0).abs() < near, "{found:e}");
        tried = with(found);
    }
    // And by a fit to the mass.
    let lost = value(&weighed, "lost_pin");
    directory.write(
        "fit.toml",
        format!(
            "version = 1\nbase = {base:?}\ndesign = \"sobol\"\npoints = 6\ndirectory = \"results\"\n\
             set = [\"operation.duration = '600 s'\", \"output.sample_every = '10 s'\"]\n\
             [[factor]]\nname = \"rate\"\nkey = \"materials.pin_primary.specific_wear_rate\"\n\
             range = [\"1e-14 1/Pa\", \"3e-13 1/Pa\"]\nscale = \"logarithmic\"\n\
             [[response]]\nname = \"lost\"\ndataset = \"/series/lost_pin\"\nat = \"end\"\n\
             measured = {lost:e}\nuncertainty = {:e}\n[fit]\nruns = 16\n",
            0.02 * lost
        ),
    );
    let found = json(&fit(&directory, &["--json"]));
    let fitted = found["keys"][0]["most_likely"].as_f64().unwrap();
    assert!((fitted / truth - 1.0).abs() < 0.04, "{fitted:e}");
}

#[test]
fn fits_find_the_keys_that_other_surfaces_were_run_with() {
    let trials = if std::env::var_os("PLATEAU_LONG").is_some() { 40 } else { 4 };
    let mut lot = Lot(3);
    let truths: Vec<[f64; 2]> = (0..trials).map(|_| [5.0 + 6.0 * lot.even(), 0.22 + 0.16 * lot.even()]).collect();
    let directory = WorkingDirectory::new();
    let factors = TWO.iter().zip(RANGES).map(|(factor, range)| format!("{factor}{range}")).collect::<String>();
    let mut within = 0;
    for (row, truth) in specimens(&directory, &truths).iter().zip(&truths) {
        // Specimens differ by some percent in area. That belongs into the uncertainty: here seven tenths of it are errors of
        // the measurement, the rest is that.
        let measured = RESPONSES.map(|(text, column, share)| {
            let (value, uncertainty) = (number(row, column), share * number(row, column));
            format!("{text}measured = {:e}\nuncertainty = {uncertainty:e}\n", value + 0.7 * uncertainty * lot.normal())
        });
        let design = format!("{}design = \"sobol\"\npoints = 10\ndirectory = \"results\"\n{}", head(), seeds("[1, 2]"));
        directory.write("fit.toml", [&design, &factors, &measured.concat(), "[fit]\nruns = 40\n"].concat());
        let found = json(&fit(&directory, &["--json"]));
        for (key, truth) in truth.iter().enumerate() {
            let pieces = found["keys"][key]["interval"].as_array().unwrap();
            let holds =
                |piece: &Value| (piece["low"].as_f64().unwrap()..=piece["high"].as_f64().unwrap()).contains(truth);
            within += usize::from(pieces.iter().any(holds));
        }
    }
    println!("{within} of {} intervals have the truth in them", 2 * trials);
    // Of 80 intervals 76 are expected, with a standard deviation of 2; of 8 at least 6 in 99.4 of 100 cases.
    assert!(within >= if trials == 40 { 70 } else { 6 }, "{within} of {} intervals", 2 * trials);
}
