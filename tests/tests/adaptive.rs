//! Acceleration that changes, and a run that chooses it itself.

use std::thread;

use plateau_core::simulation::{Execution, Simulation};
use plateau_io::{scene as scene_file, surface};
use plateau_tests::divergence::differences;
use plateau_tests::program::{WorkingDirectory, run_words, scene};
use plateau_tests::run_file::RunFile;
use plateau_tests::scenes::{all_primary, few_or_all, wear_only};
use plateau_tests::table::relative_error;

const CHOSEN: &str = "numerics.time_acceleration={ tolerance = 0.01, max = 1000 }";

/// `quick.toml` at an acceleration of 20, on some workers.
fn quick(workers: usize) -> Simulation {
    let scene = scene_file::load(scene("quick.toml").as_ref(), &[]).unwrap();
    let surfaces = surface::load(&scene).unwrap().surfaces;
    Simulation::with_execution(scene.parameters, surfaces, Execution { workers, ..Execution::default() }).unwrap()
}

#[test]
fn wear_and_time_go_on_with_another_acceleration() {
    // Closed form for flat surfaces of one row: every step wears κ F_N m r Δθ, whatever carries the load.
    let parameters = wear_only(1, 60, 10);
    let (force, radius, angle) = (parameters.normal_force, parameters.mesh.radius()[0], parameters.mesh.column_angle());
    let wear_rate = parameters.materials.pin_primary.specific_wear_rate;
    let step_time = angle / parameters.angular_velocity;
    let mut simulation = all_primary(parameters, vec![0.0; 60], vec![0.0; 10]);
    let mut revolutions = 0.0;
    for (step, acceleration) in [(50, 1.0), (130, 7.0), (131, 1000.0), (400, 2.5)] {
        let steps = step - simulation.steps_done();
        simulation.accelerate(acceleration).unwrap();
        simulation.advance_to(step).unwrap();
        revolutions += acceleration * steps as f64;
        let sample = simulation.sample().unwrap();
        for (found, expected) in [
            (sample.worn_pin, wear_rate * force * radius * angle * revolutions),
            (sample.time, step_time * revolutions),
            (sample.sliding_distance, radius * angle * revolutions),
            (sample.contact_area_integral, sample.contact_area * step_time * revolutions),
        ] {
            assert!((found / expected - 1.0).abs() < 1e-12, "step {step}: {found}, expected {expected}");
        }
    }
}

#[test]
fn the_same_acceleration_once_more_changes_no_bit() {
    let mut pair = [quick(1), quick(1)];
    for step in 1..=40 {
        pair[1].accelerate(20.0).unwrap();
        pair.iter_mut().for_each(|simulation| simulation.advance_to(40 * step).unwrap());
        assert_eq!(differences(&mut pair, 40 * step), []);
    }
}

#[test]
fn workers_agree_on_every_bit_where_the_acceleration_changes() {
    for workers in [2, 3, 5] {
        let mut pair = [quick(1), quick(workers)];
        for (round, acceleration) in [20.0, 3.0, 400.0, 1.0, 700.0, 55.5].into_iter().cycle().take(24).enumerate() {
            let step = 101 * (round as u64 + 1);
            for simulation in &mut pair {
                simulation.accelerate(acceleration).unwrap();
                simulation.advance_to(step).unwrap();
            }
            assert_eq!(differences(&mut pair, step), [], "{workers} workers");
        }
    }
}

/// Runs `quick.toml`, changed, for `duration` seconds, and opens its run file.
fn run(duration: u32, sets: &[String]) -> RunFile {
    run_on(1, duration, sets)
}

/// The same with so many workers, maybe more than there are cores.
fn run_on(workers: u32, duration: u32, sets: &[String]) -> RunFile {
    let directory = WorkingDirectory::new();
    let duration = format!("operation.duration={duration} s");
    let settings = [&duration, "output.maps=[]", "output.sample_every=0.5 s"].into_iter();
    let settings: Vec<&str> = settings.chain(sets.iter().map(String::as_str)).collect();
    let words = run_words("quick.toml", "run.h5", &settings, &["--workers", &workers.to_string()]);
    let done = directory.plateau(words).ends(0, &[]);
    assert!(workers > 1 || !done.stderr.contains("warning"), "{}", done.stderr);
    let is_chosen = sets.iter().any(|set| set == CHOSEN);
    assert_eq!(done.stdout.contains("tolerance 1 % "), is_chosen, "{}", done.stdout);
    directory.run_file("run.h5")
}

/// Means of the contact area over windows of `width` seconds, m².
fn history(run: &RunFile, duration: u32, width: u32) -> Vec<f64> {
    let (time, integral) = (run.floats("/time"), run.floats("/series/contact_area_integral"));
    let at = |moment: f64| {
        let after = time.partition_point(|time| *time < moment).min(time.len() - 1);
        let (start, from) = if after == 0 { (0.0, 0.0) } else { (time[after - 1], integral[after - 1]) };
        from + (integral[after] - from) * (moment - start) / (time[after] - start)
    };
    let edges: Vec<f64> = (0..=duration / width).map(|window| at(f64::from(window * width))).collect();
    edges.windows(2).map(|edge| (edge[1] - edge[0]) / f64::from(width)).collect()
}

/// Seeds of all three surfaces.
fn seeds(seed: u32) -> impl Iterator<Item = String> {
    let surfaces = ["disc.surface", "pin.base", "pin.surface"];
    (0..).zip(surfaces).map(move |(which, key)| format!("{key}.synthetic.seed={}", 100 * which + seed))
}

/// Holds a run with a tolerance of 1 % against m = 1; gives its last acceleration.
fn kept(sets: impl IntoIterator<Item = String>) -> f64 {
    const DURATION: u32 = 60;
    let mut sets: Vec<_> = sets.into_iter().collect();
    sets.push("numerics.time_acceleration=1".into());
    let reference = history(&run(DURATION, &sets), DURATION, 5);
    sets.pop();
    sets.push(CHOSEN.into());
    let run = run(DURATION, &sets);
    let error = relative_error(&history(&run, DURATION, 5), &reference);
    assert!(error < 0.01, "{sets:?}: {error}");
    *run.floats("/series/time_acceleration").last().unwrap()
}

#[test]
fn the_tolerance_is_kept_on_small_scenes() {
    // Rough discs and smooth ones, 3 um to 0.03 um.
    const SCALES: [f64; 4] = [1.0, 0.3, 0.1, 0.01];
    let check = |seed: u32| {
        let scale = SCALES[seed as usize % SCALES.len()];
        let last = kept(seeds(seed).chain([format!("disc.prepare.scale={scale}")]));
        // It is worth having: the last windows are run at a multiple of the speed.
        assert!(last > 3.0, "seed {seed}, heights times {scale}: {last}");
    };
    thread::scope(|scope| {
        for first in [1, 2] {
            scope.spawn(move || (first..=few_or_all(4, 20)).step_by(2).for_each(check));
        }
    });
}

#[test]
fn the_tolerance_is_kept_with_pooled_debris_on_rough_discs() {
    let scenes = [(1, "contact"), (3, "track"), (2, "contact"), (4, "track")];
    // The plain model takes a minute and a half for each.
    for &(seed, pool) in few_or_all(&scenes[..0], &scenes) {
        let pooled = [format!("plateaus.debris=\"{pool}\""), "plateaus.captured_fraction=0.06".to_owned()];
        let last = kept(seeds(seed).chain(pooled));
        assert!(last > 3.0, "seed {seed}, {pool}: {last}");
    }
}

#[test]
fn no_bit_of_a_run_that_chooses_depends_on_the_workers() {
    let chosen = |workers: u32| {
        let run = run_on(workers, 12, &[CHOSEN.to_owned()]);
        let series = ["time_acceleration", "acceleration_error", "contact_area_integral", "filled_fraction"];
        series.map(|name| run.floats(&format!("/series/{name}")).into_iter().map(f64::to_bits).collect::<Vec<_>>())
    };
    let one = chosen(1);
    let accelerations: Vec<f64> = one[0].iter().copied().map(f64::from_bits).collect();
    assert!(accelerations.last() > Some(&2.0), "{accelerations:?}");
    for workers in [2, 3] {
        assert!(chosen(workers) == one, "{workers} workers");
    }
}

#[test]
fn the_run_file_tells_how_the_acceleration_was_chosen() {
    let chosen = run(100, &[CHOSEN.to_owned()]);
    let accelerations = chosen.floats("/series/time_acceleration");
    assert_eq!(accelerations[0], 1.0, "it begins with 1");
    // Windows of 5 s that hold three revolutions of 60/850 s: m is at most 23.6.
    assert!(accelerations.iter().all(|acceleration| (1.0..=850.0 / 36.0).contains(acceleration)));
    assert!(accelerations.iter().any(|acceleration| *acceleration > 5.0));
    // No revolution stands for more than 3.5 times the tolerance, 3.5 %, of the time that has passed.
    let revolution = 60.0 / 850.0;
    for (time, acceleration) in chosen.floats("/time").iter().zip(&accelerations) {
        assert!(*acceleration <= (0.035 * time / revolution).max(1.0) * (1.0 + 1e-9), "{time} s: {acceleration}");
    }
    let errors = chosen.floats("/series/acceleration_error");
    assert!(errors.iter().all(|error| (0.0..0.1).contains(error)) && errors.last() > Some(&0.0));
    // A step ends at most m Δt after a sample's time, and the run after its end; Δt = 60 s/(850 · 690).
    let step = 60.0 / (850.0 * 690.0);
    let time = chosen.floats("/time");
    assert_eq!(time.len(), 200);
    for (sample, (time, acceleration)) in time.iter().zip(&accelerations).enumerate() {
        let late = time - 0.5 * (sample + 1) as f64;
        assert!(late > -1e-9 && late < acceleration * step, "sample {sample}: {late} s late");
    }
    assert!(!run(1, &[]).has("/series/time_acceleration"), "a number that never changes is in the scene");
}

#[test]
fn a_run_goes_on_with_a_larger_acceleration_after_the_error_was_estimated_too_large() {
    // Here the estimate exceeds the tolerance, from some 90 s on.
    let directory = WorkingDirectory::new();
    let sets = ["operation.normal_force=20 N", "operation.duration=300 s", "output.maps=[]", CHOSEN];
    let told = directory.plateau(run_words("quick.toml", "run.h5", &sets, &["--json"])).ends(0, &[]);
    let run = directory.run_file("run.h5");
    let (time, accelerations) = (run.floats("/time"), run.floats("/series/time_acceleration"));
    let late: Vec<f64> = time.iter().zip(&accelerations).filter(|(time, _)| **time > 200.0).map(|(_, m)| *m).collect();
    let returns = late.windows(2).filter(|two| two[0] == 1.0 && two[1] > 1.0).count();
    assert!(returns > 0, "{late:?}");
    // Simulated revolutions of the run, and of a scout where there is one, against those of m = 1; samples are one of them apart.
    let mut before = 0.0;
    let revolutions: f64 = (time.iter().zip(&accelerations))
        .map(|(time, m)| {
            let passed = (time - before) / (60.0 / 850.0);
            before = *time;
            passed / m * if *m > 1.0 { 1.25 } else { 1.0 }
        })
        .sum();
    let all = 300.0 / (60.0 / 850.0);
    assert!(revolutions < 0.5 * all, "{revolutions} of {all}");
    // What it did is in the summary, in the file and in the report: the same.
    let summary = &told.json()["time_acceleration"];
    let of_file: serde_json::Value = serde_json::from_str(&run.text("time_acceleration")).unwrap();
    assert_eq!(*summary, of_file);
    assert_eq!((&summary["tolerance"], &summary["smallest"]), (&0.01.into(), &1.0.into()));
    let number = |name: &str| summary[name].as_f64().unwrap();
    let largest = accelerations.iter().copied().fold(0.0, f64::max);
    assert!((number("largest") / largest - 1.0).abs() < 1e-12 && number("last") == *accelerations.last().unwrap());
    // The error over the time, from the series, which has every estimate four simulated revolutions later than it holds.
    let errors = run.floats("/series/acceleration_error");
    let squares: f64 = errors.iter().zip(time.windows(2)).map(|(error, two)| error * error * (two[1] - two[0])).sum();
    let estimated = (squares / 300.0).sqrt();
    assert!((number("estimated_error") / estimated - 1.0).abs() < 0.1, "{summary}, expected {estimated}");
    assert_eq!(summary["met"], estimated <= 0.01);
    let page = directory.plateau(["summary", "run.h5"]).quiet_success();
    let met = if estimated <= 0.01 { "tolerance 1 % met" } else { "tolerance 1 % not met" };
    assert!(page.contains("estimated error of the contact area") && page.contains(met));
}

#[test]
fn a_disc_too_smooth_is_not_accelerated_where_debris_is_pooled() {
    // The fibres recede by κ F_N 2π r̄/A_fibre a revolution: 14 nm; the limit is 20 times that, and a disc of 0.1 µm is
    // below it, one of 3 µm above.
    let directory = WorkingDirectory::new();
    let run = |sets: &[&str]| {
        let settings = [&[CHOSEN, "operation.duration=0.5 s"], sets].concat();
        let done = directory.plateau(run_words("quick.toml", "run.h5", &settings, &["--force"])).ends(0, &[]);
        let chosen = directory.run_file("run.h5").has("/series/time_acceleration");
        assert_eq!(done.stderr.contains("as smooth as this"), !chosen, "{}", done.stderr);
        chosen
    };
    let (smooth, pool) = ("disc.surface.synthetic.rms_height=0.1 um", "plateaus.debris=contact");
    let captured = "plateaus.captured_fraction=0.06";
    assert!(run(&[pool, captured]));
    assert!(!run(&[smooth, pool, captured]));
    // Local debris goes where the cell ahead was: no disc is too smooth.
    assert!(run(&[smooth]));
    // Without debris that is compacted, nothing depends on where resin touches.
    assert!(run(&[smooth, pool, "plateaus.captured_fraction=0"]));
    assert!(run(&[smooth, pool, captured, "plateaus.formation=false"]));
    // Where the pin hardly wears, the disc is rough enough.
    assert!(run(&[smooth, pool, captured, "materials.pin_primary.specific_wear_rate=1e-15 1/Pa"]));
}

#[test]
fn what_leaves_nothing_to_choose_is_said() {
    let directory = WorkingDirectory::new();
    let run = |settings: &[&str]| directory.plateau(run_words("quick.toml", "run.h5", settings, &[]));
    run(&[CHOSEN, "operation.steps=10"]).ends(2, &["give operation.duration"]);
    run(&["numerics.time_acceleration={ tolerance = 0.01, max = 1 }", "operation.duration=0.1 s"])
        .ends(0, &["nothing to choose"]);
}
