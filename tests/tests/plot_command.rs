//! `plateau plot`: what the figures show is read off them and compared with the run file.

mod curves;
mod maps;

use std::fs;
use std::process::Stdio;

use plateau_tests::figure::{Figure, Panel};
use plateau_tests::program::{Outcome, WorkingDirectory, kill, quick_scene_with, scene, wait_until};
use plateau_tests::run_file::{RunFile, changed};

/// Colour of the first run.
const FIRST_RUN: &str = "#0072B2";
/// Every figure.
const ALL: [&str; 9] =
    ["build-up", "contact-area", "debris", "filled", "heights", "plateau-sizes", "pressure", "status", "topography"];

/// A directory with `run.h5`, the quick scene with these edits.
fn with_run(edits: &[(&str, &str)]) -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    directory.write("scene.toml", quick_scene_with(edits));
    directory.plateau(["run", "scene.toml", "-o", "run.h5"]).quiet_success();
    directory
}

/// A short run with so few samples that all are shown.
fn short() -> WorkingDirectory {
    with_run(&[("duration = \"60 s\"", "duration = \"10 s\"")])
}

/// The figures of `run.h5` as SVG.
fn plotted(directory: &WorkingDirectory, name: &str) -> Figure {
    directory.plateau(["plot", "run.h5", "-o", "figures", "--format", "svg", "--force"]).quiet_success();
    Figure::read(&fs::read_to_string(directory.path(&format!("figures/{name}.svg"))).unwrap())
}

/// Distance of a place from a polyline, pixels.
fn distance([x, y]: [f64; 2], line: &[[f64; 2]]) -> f64 {
    let from_segment = |pair: &[[f64; 2]]| {
        let along = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
        let length = along[0].powi(2) + along[1].powi(2);
        let part = ((x - pair[0][0]) * along[0] + (y - pair[0][1]) * along[1]) / length;
        let part = if length > 0.0 { part.clamp(0.0, 1.0) } else { 0.0 };
        (x - pair[0][0] - part * along[0]).hypot(y - pair[0][1] - part * along[1])
    };
    line.windows(2).map(from_segment).fold(f64::INFINITY, f64::min)
}

/// Whether a line in a box shows these values at these times, to the width of a drawn line.
fn expect_curve(line: &[[f64; 2]], panel: &Panel, times: &[f64], values: &[f64]) {
    assert!(line.len() >= 2 && times.len() == values.len());
    for (time, value) in times.iter().zip(values) {
        let distance = distance([panel.x.place(*time), panel.y.place(*value)], line);
        assert!(distance < 3.0, "{distance} pixels from {value} at {time}");
    }
}

fn only(outcome: &Outcome) -> Vec<&str> {
    outcome.stderr.lines().collect()
}

#[test]
fn several_runs_share_their_axes() {
    let directory = short();
    directory.plateau(["run", "scene.toml", "-o", "strong.h5", "--set", "operation.normal_force=9 N"]).quiet_success();
    let list = directory.plateau(["plot", "run.h5", "strong.h5", "--format", "svg"]).quiet_success();
    assert_eq!(list.lines().count(), ALL.len(), "{list}");
    let figure = Figure::read(&fs::read_to_string(directory.path("figures/contact-area.svg")).unwrap());
    let panel = figure.panel(figure.boxes()[0]);
    for (name, colour) in [("run.h5", FIRST_RUN), ("strong.h5", "#D55E00")] {
        let run = RunFile::open(directory.path(name));
        let mean: Vec<f64> = run.floats("/series/contact_area_mean").iter().map(|area| area * 1e6).collect();
        expect_curve(&figure.line(colour, panel.frame), &panel, &run.floats("/time"), &mean);
    }
    // Equal titles are told apart by the files.
    for label in ["Quick look (run)", "Quick look (strong)"] {
        assert!(figure.texts.iter().any(|text| text.text == label), "{label}");
    }
}

/// The figures that a call wrote, with their paths; each has to fit into the page of a journal.
fn written(directory: &WorkingDirectory, list: &str) -> Vec<(String, Figure)> {
    let figure = |line: &str| {
        let path = line["wrote ".len()..].split(':').next().unwrap().to_owned();
        let figure = Figure::read(&fs::read_to_string(directory.path(&path)).unwrap());
        let [width, height] = figure.size;
        assert!(width <= 180.0 && height <= 240.0, "{path}: {width} mm x {height} mm");
        (path, figure)
    };
    list.lines().map(figure).collect()
}

#[test]
fn maps_of_many_runs_stand_on_several_pages_of_a_journal() {
    let directory = short();
    let names: Vec<String> = (2..=8).map(|number| format!("{number}.h5")).collect();
    names.iter().for_each(|name| {
        fs::copy(directory.path("run.h5"), directory.path(name)).unwrap();
    });
    let plot = |runs: usize| {
        let runs = std::iter::once("run.h5").chain(names.iter().map(String::as_str)).take(runs);
        directory.plateau(["plot", "-o", "figures", "--format", "svg", "--force"].into_iter().chain(runs))
    };
    // Three runs stand beside each other, four as two and two.
    for (runs, pages) in [(8, 3), (4, 2)] {
        let list = plot(runs).stdout;
        let figures = written(&directory, &list);
        for name in ["topography", "status"] {
            let of_figure = || figures.iter().filter(|(path, _)| path.starts_with(&format!("figures/{name}")));
            assert_eq!(of_figure().count(), pages, "{name}: {list}");
            // Each run is named once.
            let names = of_figure().flat_map(|(_, figure)| &figure.texts);
            assert_eq!(names.filter(|text| text.text.starts_with("Quick look")).count(), runs, "{name}");
        }
        assert!(list.contains(&format!("topography-2.svg: Topography of disc and pin, page 2 of {pages}\n")), "{list}");
    }
    // Pages of the call before stay, and are told.
    let outcome = plot(1);
    let said = "plateau: warning: figures/topography-2.svg is a page of an earlier call";
    assert!(outcome.status == Some(0) && only(&outcome).contains(&said), "{}", outcome.stderr);
}

#[test]
fn maps_at_many_moments_stand_on_several_pages_of_a_journal() {
    let directory = with_run(&[
        ("duration = \"60 s\"", "duration = \"10 s\""),
        ("maps_at = [\"0 s\"]", "maps_at = [\"0 s\", \"2 s\", \"4 s\", \"6 s\", \"8 s\"]"),
    ]);
    fs::copy(directory.path("run.h5"), directory.path("2.h5")).unwrap();
    let at: Vec<String> = (0..=5).map(|number| format!("--at={} s", 2 * number)).collect();
    for (runs, shape) in [(1, None), (1, Some("--polar")), (2, None), (2, Some("--polar"))] {
        let arguments = ["plot", "run.h5", "2.h5"].into_iter().take(1 + runs).chain(at.iter().map(String::as_str));
        let always = ["-o", "figures", "--format", "svg", "--force"];
        let list = directory.plateau(arguments.chain(shape).chain(always)).stdout;
        // Every moment of every run is there once.
        for (name, body) in [("topography", "disc"), ("topography", "pin"), ("pressure", "pin")] {
            let figures = written(&directory, &list);
            let texts = figures.iter().filter(|(path, _)| path.starts_with(&format!("figures/{name}")));
            let mut moments: Vec<&str> = texts
                .flat_map(|(_, figure)| &figure.texts)
                .filter_map(|text| text.text.strip_prefix(&format!("{body}, ")))
                .collect();
            moments.sort_unstable();
            // Maps are of the next step.
            let expected = ["0 s", "10 s", "2.001 s", "4 s", "6.001 s", "8 s"];
            let expected = expected.into_iter().filter(|moment| name != "pressure" || *moment != "0 s");
            assert_eq!(moments, expected.flat_map(|moment| vec![moment; runs]).collect::<Vec<_>>(), "{name} {shape:?}");
        }
    }
}

#[test]
fn every_format_has_every_figure() {
    let directory = short();
    for (format, polar) in [("png", false), ("svg", true), ("pdf", true)] {
        let mut arguments = vec!["plot", "run.h5", "-o", format, "--format", format];
        arguments.extend(polar.then_some("--polar"));
        directory.plateau(arguments).quiet_success();
        for name in ALL {
            let content = fs::read(directory.path(&format!("{format}/{name}.{format}"))).unwrap();
            match format {
                "png" => {
                    let picture = image::load_from_memory(&content).unwrap().into_rgb8();
                    let first = picture.get_pixel(0, 0);
                    assert!(picture.pixels().any(|pixel| pixel != first), "{name} is empty");
                }
                "svg" => assert!(!Figure::read(&String::from_utf8(content).unwrap()).texts.is_empty()),
                _ => {
                    assert!(content.starts_with(b"%PDF-") && content.trim_ascii_end().ends_with(b"%%EOF"), "{name}");
                    assert!(
                        content.windows(11).any(|bytes| bytes == b"DejaVuSans "
                            || bytes == b"DejaVuSans/"
                            || bytes == b"DejaVuSans\n")
                    );
                }
            }
        }
    }
}

#[test]
fn what_was_not_recorded_is_left_out_and_said_so() {
    let directory = with_run(&[
        ("duration = \"60 s\"", "duration = \"2 s\""),
        ("maps_at = [\"0 s\"]", "maps = [\"pressure\", \"pin_height\"]"),
    ]);
    let outcome = directory.plateau(["plot", "run.h5"]);
    assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
    let expected = [
        "plateau: run.h5 has no map disc_height: left out of topography, heights",
        "plateau: run.h5 has no map disc_status: left out of status, plateau-sizes",
        "plateau: run.h5 has no map pin_status: left out of status, plateau-sizes",
        "plateau: run.h5 has no map disc_substrate: left out of build-up",
        "plateau: run.h5 has no map pin_substrate: left out of build-up",
    ];
    assert_eq!(only(&outcome), expected);
    let names: Vec<String> = outcome.stdout.lines().map(|line| line.replace("wrote run/", "")).collect();
    let shown = |name: &str| names.iter().any(|line| line.starts_with(&format!("{name}.png: ")));
    assert_eq!(ALL.map(shown), [false, true, true, true, true, true, true, false, true], "{names:?}");
    // Of a part that the scene does without nothing was said; whoever asks for it is told.
    let asked = directory.plateau(["plot", "run.h5", "-o", "asked", "--figure", "temperature"]);
    assert_eq!(asked.status, Some(2));
    assert!(
        asked.stderr.starts_with("plateau: run.h5 has nothing of the kind: left out of temperature\n"),
        "{}",
        asked.stderr
    );
    assert!(asked.stderr.contains("no run has what temperature shows") && !directory.path("asked").exists());
}

#[test]
fn a_run_without_samples_has_maps_only() {
    let directory = short();
    let file = changed(directory.path("run.h5"));
    file.dataset("time").unwrap().resize(0).unwrap();
    file.close().unwrap();
    let outcome = directory.plateau(["plot", "run.h5"]);
    assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
    assert_eq!(only(&outcome), ["plateau: run.h5 has no samples: left out of contact-area, filled, debris"]);
    assert_eq!(outcome.stdout.lines().count(), 6, "{}", outcome.stdout);
}

#[test]
fn a_run_that_was_killed_is_drawn() {
    let directory = WorkingDirectory::new();
    let mut command = directory.command(["run", &scene("cermet.toml"), "-o", "run.h5"]);
    let child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let samples = || RunFile::follow(directory.path("run.h5")).map_or(0, |run| run.shape("/time")[0]);
    let sampled = wait_until(|| samples() >= 2);
    kill(child);
    assert!(sampled, "no samples were written");
    let outcome = directory.plateau(["plot", "run.h5"]);
    assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
    assert!(outcome.stdout.contains("wrote run/contact-area.png"), "{}", outcome.stdout);
}

#[test]
fn damaged_files_are_refused_and_nothing_is_written() {
    let directory = short();
    let whole = fs::read(directory.path("run.h5")).unwrap();
    directory.write("cut.h5", &whole[..whole.len() / 2]);
    let names = directory.names();
    let outcome = directory.plateau(["plot", "run.h5", "cut.h5"]);
    assert_eq!((outcome.status, outcome.stdout.as_str()), (Some(2), ""));
    assert!(outcome.stderr.contains("cut.h5 is damaged"), "{}", outcome.stderr);
    assert_eq!(directory.names(), names);
}

#[test]
fn figures_are_replaced_only_on_demand() {
    let directory = short();
    directory.write("run/status.png", "mine");
    let outcome = directory.plateau(["plot", "run.h5"]);
    assert_eq!((outcome.status, outcome.stdout.as_str()), (Some(2), ""));
    assert!(outcome.stderr.contains("run/status.png exists; give --force"), "{}", outcome.stderr);
    assert_eq!(fs::read_dir(directory.path("run")).unwrap().count(), 1, "either all figures are written or none");
    directory.plateau(["plot", "run.h5", "--force"]).quiet_success();
    assert!(fs::read(directory.path("run/status.png")).unwrap().starts_with(b"\x89PNG"));
    // A file stands where the folder should be.
    directory.write("taken", "");
    let outcome = directory.plateau(["plot", "run.h5", "-o", "taken"]);
    assert_eq!(outcome.status, Some(2));
    assert!(outcome.stderr.contains("cannot make the folder taken"), "{}", outcome.stderr);
}

#[test]
fn one_cell_is_enough() {
    let edits = [
        ("rows = 20", "rows = 1"),
        ("disc_columns = 690", "disc_columns = 1"),
        ("pin_columns = 40", "pin_columns = 1"),
        ("synthetic = { seed = 1, rms_height = \"3 um\", correlation_length = \"200 um\" }", "flat = true"),
        (
            "synthetic = { seed = 2, fibre_fraction = 0.3, fibre_length = \"600 um\", fibre_width = \"200 um\" }",
            "uniform = \"primary\"",
        ),
        ("synthetic = { seed = 3, rms_height = \"0.5 um\", correlation_length = \"200 um\" }", "flat = true"),
        ("duration = \"60 s\"", "steps = 1"),
    ];
    let directory = WorkingDirectory::new();
    directory.write("scene.toml", quick_scene_with(&edits));
    // With a warning: such a step is long.
    assert_eq!(directory.plateau(["run", "scene.toml", "-o", "run.h5"]).status, Some(0));
    let list = directory.plateau(["plot", "run.h5", "--format", "svg"]).quiet_success();
    assert_eq!(list.lines().count(), ALL.len(), "{list}");
    // The one sample is a dot.
    let figure = Figure::read(&fs::read_to_string(directory.path("run/contact-area.svg")).unwrap());
    assert!(figure.areas.iter().any(|(colour, dot)| colour == FIRST_RUN && dot.len() == 4));
}
