//! `plateau plot`: what the figures show is read off them and compared with the run file.

use std::fs;
use std::process::Stdio;

use image::{Rgb, RgbImage};
use plateau_tests::figure::{Figure, Frame, Panel};
use plateau_tests::program::{Outcome, WorkingDirectory, kill, quick_scene_with, scene, wait_until};
use plateau_tests::run_file::{RunFile, changed};

/// Colour of the first run.
const FIRST_RUN: &str = "#0072B2";
/// The same, mixed with as much white.
const FIRST_RUN_PALE: &str = "#80B9D9";
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

/// A series of the contact area, mm².
fn areas(run: &RunFile, name: &str) -> Vec<f64> {
    run.floats(&format!("/series/{name}")).iter().map(|area| area * 1e6).collect()
}

#[test]
fn the_contact_area_is_that_of_the_series() {
    let directory = short();
    let figure = plotted(&directory, "contact-area");
    let run = RunFile::open(directory.path("run.h5"));
    let panel = figure.panel(figure.boxes()[0]);
    for (colour, series) in [(FIRST_RUN, "contact_area_mean"), (FIRST_RUN_PALE, "contact_area")] {
        expect_curve(&figure.line(colour, panel.frame), &panel, &run.floats("/time"), &areas(&run, series));
    }
    assert!(figure.areas.iter().all(|(colour, _)| colour != FIRST_RUN), "a band of few samples");
}

#[test]
fn the_band_of_many_samples_reaches_from_the_least_to_the_greatest() {
    let directory = with_run(&[]);
    let figure = plotted(&directory, "contact-area");
    let run = RunFile::open(directory.path("run.h5"));
    let panel = figure.panel(figure.boxes()[0]);
    let (_, band) = figure.areas.iter().find(|(colour, area)| colour == FIRST_RUN && area.len() > 9).expect("a band");
    let ends = |values: &[f64]| {
        values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(*value), high.max(*value)])
    };
    let [top, bottom] = ends(&band.iter().map(|place| place[1]).collect::<Vec<_>>());
    let [low, high] = ends(&areas(&run, "contact_area"));
    assert!((top - panel.y.place(high)).abs() < 2.0 && (bottom - panel.y.place(low)).abs() < 2.0);
}

#[test]
fn filling_and_coverage_are_those_of_the_series() {
    let directory = short();
    let figure = plotted(&directory, "filled");
    let run = RunFile::open(directory.path("run.h5"));
    let panels: Vec<Panel> = figure.boxes().into_iter().map(|frame| figure.panel(frame)).collect();
    let names = ["filled_fraction", "disc_secondary", "pin_secondary", "pin_primary"];
    assert_eq!(panels.len(), names.len());
    for (panel, name) in panels.iter().zip(names) {
        let per_cent: Vec<f64> = run.floats(&format!("/series/{name}")).iter().map(|part| 100.0 * part).collect();
        expect_curve(&figure.line(FIRST_RUN, panel.frame), panel, &run.floats("/time"), &per_cent);
    }
}

#[test]
fn the_stack_of_debris_reaches_what_was_worn() {
    let directory = short();
    let figure = plotted(&directory, "debris");
    let run = RunFile::open(directory.path("run.h5"));
    let panel = figure.panel(figure.boxes()[0]);
    // In cubic micrometres, or cubic millimetres for more than 1e-13 m³.
    let unit = if figure.texts.iter().any(|text| text.text == "debris, mm³") { 1e9 } else { 1e18 };
    let last = |name: &str| *run.floats(&format!("/series/{name}")).last().unwrap() * unit;
    let supply: f64 = ["worn_pin", "worn_resin", "worn_disc", "returned"].map(last).into_iter().sum();
    let across = |line: &&Vec<[f64; 2]>| {
        line[0][0] == panel.frame.x[0] && line[line.len() - 1][0] == panel.frame.x[1] && line[0] != line[line.len() - 1]
    };
    let curve = figure.lines.iter().map(|(_, line)| line).find(across).expect("the line");
    assert!((curve[curve.len() - 1][1] - panel.y.place(supply)).abs() < 2.0);
    // From below: what the stack holds at the end, part by part.
    let mut sum = 0.0;
    let bands: Vec<_> = figure.areas.iter().filter(|(_, area)| area.len() > 9).collect();
    let parts = ["deposited_disc", "deposited_pin", "emitted", "pool"];
    assert_eq!(bands.len(), parts.len());
    for ((_, band), part) in bands.iter().zip(parts) {
        let right = band.iter().map(|place| place[0]).fold(0.0, f64::max);
        let top = band.iter().filter(|place| place[0] == right).map(|place| place[1]).fold(f64::INFINITY, f64::min);
        sum += last(part);
        assert!((top - panel.y.place(sum)).abs() < 2.0, "{part}");
    }
    assert!((sum / supply - 1.0).abs() < 1e-9);
}

/// The bitmaps of maps put together from windows, so that they hold `cells` columns; from the top row.
fn windows<'a>(images: &mut impl Iterator<Item = &'a (Frame, RgbImage)>, columns: usize) -> Vec<Vec<Rgb<u8>>> {
    let mut map: Vec<Vec<Rgb<u8>>> = Vec::new();
    while map.len() < columns {
        let (_, image) = images.next().expect("a window");
        map.extend((0..image.width()).map(|x| (0..image.height()).rev().map(|y| *image.get_pixel(x, y)).collect()));
    }
    assert_eq!(map.len(), columns);
    map
}

/// Whether every cell has the colour that its value has on a colour bar; cells with `None` have none of them.
fn expect_colours(
    figure: &Figure,
    (frame, bar): &(Frame, RgbImage),
    map: &[Vec<Rgb<u8>>],
    value: impl Fn(usize) -> Option<f64>,
) {
    let scale = figure.colour_scale(*frame);
    // The middle of the colour's part of the bar; the first and the last colour begin at its ends.
    let place = |pixel: u32| frame.y[0] + (frame.y[1] - frame.y[0]) * f64::from(pixel) / f64::from(bar.height() - 1);
    let step = (frame.y[1] - frame.y[0]) / f64::from(bar.height() - 1);
    for (column, cells) in map.iter().enumerate() {
        for (row, colour) in cells.iter().enumerate() {
            // Some colours are on it more than once, one after the other.
            let on_bar: Vec<u32> = (0..bar.height()).filter(|pixel| bar.get_pixel(0, *pixel) == colour).collect();
            match (value(column * cells.len() + row), &on_bar[..]) {
                (None, []) => {}
                (Some(value), [_, ..]) => {
                    let expected = scale.place(value).clamp(frame.y[0], frame.y[1]);
                    let distances = on_bar.iter().map(|pixel| (place(*pixel) - expected).abs());
                    let distance = distances.fold(f64::INFINITY, f64::min);
                    // Half a step, and what rounding places to pixels makes of the scale.
                    assert!(distance < 0.5 * step + 1.5, "{value} in column {column}, row {row}: {distance} pixels");
                }
                (value, _) => panic!("{value:?} has the colour {colour:?} in column {column}, row {row}"),
            }
        }
    }
}

#[test]
fn topography_shows_the_heights_of_every_cell() {
    let directory = short();
    let figure = plotted(&directory, "topography");
    let run = RunFile::open(directory.path("run.h5"));
    let (bars, images): (Vec<_>, Vec<_>) = figure.images.iter().partition(|(_, image)| image.width() == 1);
    assert_eq!(bars.len(), 2);
    let mut images = images.into_iter();
    for moment in [0, 1] {
        let heights = run.map("/disc/height", moment);
        expect_colours(&figure, bars[0], &windows(&mut images, 690), |cell| Some(heights[cell] * 1e6));
    }
    for moment in [0, 1] {
        let heights = run.map("/pin/height", moment);
        let mean = heights.iter().sum::<f64>() / heights.len() as f64;
        expect_colours(&figure, bars[1], &windows(&mut images, 40), |cell| Some((heights[cell] - mean) * 1e6));
    }
    assert!(images.next().is_none());
}

#[test]
fn pressure_shows_contact_and_its_pressure() {
    let directory = short();
    let figure = plotted(&directory, "pressure");
    let pressures = RunFile::open(directory.path("run.h5")).last_map("/pin/pressure");
    let (bars, images): (Vec<_>, Vec<_>) = figure.images.iter().partition(|(_, image)| image.width() == 1);
    let map = windows(&mut images.into_iter(), 40);
    let unit = if figure.texts.iter().any(|text| text.text == "pressure, MPa") { 1e-6 } else { 1e-3 };
    expect_colours(&figure, bars[0], &map, |cell| (pressures[cell] > 0.0).then_some(pressures[cell] * unit));
    assert!(pressures.contains(&0.0) && pressures.iter().any(|pressure| *pressure > 0.0));
}

#[test]
fn status_shows_the_status_of_every_cell() {
    let directory = short();
    let figure = plotted(&directory, "status");
    let run = RunFile::open(directory.path("run.h5"));
    // Grey, blue and orange, as in the legend.
    let colours = [Rgb([0xe4, 0xe4, 0xe4]), Rgb([0x00, 0x5a, 0x9c]), Rgb([0xe6, 0x9f, 0x00])];
    let mut images = figure.images.iter();
    for (dataset, columns) in [("/disc/status", 690), ("/pin/status", 40)] {
        let statuses = run.statuses(dataset);
        for moment in statuses.chunks(20 * columns) {
            let map = windows(&mut images, columns).concat();
            let same = map.iter().zip(moment).all(|(colour, status)| *colour == colours[*status as usize]);
            assert!(same, "{dataset}");
        }
    }
    // The series are area fractions as well.
    let last = |name: &str| 100.0 * run.floats(&format!("/series/{name}")).last().unwrap();
    let remark = figure.texts.iter().rfind(|text| text.text.starts_with("none ")).expect("fractions");
    let numbers: Vec<f64> = remark.text.split(' ').filter_map(|word| word.trim_matches(',').parse().ok()).collect();
    for (number, name) in numbers.iter().zip(["pin_none", "pin_primary", "pin_secondary"]) {
        assert!((number - last(name)).abs() < 0.06, "{name}: {number}");
    }
}

#[test]
fn build_up_shows_how_thick_it_is() {
    let directory = short();
    let figure = plotted(&directory, "build-up");
    let run = RunFile::open(directory.path("run.h5"));
    for (body, toward) in [("disc", 1.0), ("pin", -1.0)] {
        let last = |name: &str| -> Vec<f64> {
            let values = run.floats(&format!("/{body}/{name}"));
            let cells: usize = run.shape(&format!("/{body}/{name}"))[1..].iter().product();
            values[values.len() - cells..].to_vec()
        };
        let (heights, substrates) = (last("height"), last("substrate"));
        let thickness: Vec<f64> = heights.iter().zip(&substrates).map(|(z, b)| toward * (z - b)).collect();
        assert!(thickness.iter().all(|thickness| *thickness >= 0.0), "{body}");
        // Cells of one row are alike, and so each row counts with its radius.
        let rows = run.shape(&format!("/{body}/height"))[2];
        let radius = |cell: usize| 20.0 + ((cell % rows) as f64 + 0.5) / rows as f64;
        let share = |covered: bool| -> f64 {
            let cells = thickness.iter().enumerate().filter(|(_, thickness)| !covered || **thickness > 0.0);
            cells.map(|(cell, _)| radius(cell)).sum()
        };
        let percent = 100.0 * share(true) / share(false);
        let said = figure.texts.iter().filter_map(|text| text.text.strip_prefix("on ")?.split_once(" % of the area"));
        let nearest = said.map(|(number, _)| (number.parse::<f64>().unwrap() - percent).abs()).fold(f64::MAX, f64::min);
        // Three digits.
        assert!(nearest <= 0.5e-2 * percent, "{body}: {percent} %, off by {nearest}");
    }
}

#[test]
fn heights_are_those_that_parts_of_the_cells_reach() {
    let directory = short();
    let figure = plotted(&directory, "heights");
    let run = RunFile::open(directory.path("run.h5"));
    let disc = run.last_map("/disc/height");
    let pin = run.last_map("/pin/height");
    let mean = pin.iter().sum::<f64>() / pin.len() as f64;
    let pin: Vec<f64> = pin.iter().map(|height| height - mean).collect();
    // Only the first box of a row has numbers on the left: the second one has the same axis.
    let boxes = figure.boxes();
    assert_eq!(boxes.len(), 4);
    // From the peaks on, which point down on the pin.
    for (row, mut heights, peak) in [(0, disc, 1.0), (1, pin, -1.0)] {
        heights.sort_by(|one, other| (peak * other).total_cmp(&(peak * one)));
        let (left, frame) = (figure.panel(boxes[2 * row]), boxes[2 * row + 1]);
        let curve = figure.line(FIRST_RUN, frame);
        for per_cent in [5, 25, 50, 75, 95] {
            let x = frame.x[0] + (frame.x[1] - frame.x[0]) * f64::from(per_cent) / 100.0;
            // By the definition of the material ratio.
            let expected = heights[(heights.len() * per_cent as usize / 100).saturating_sub(1)] * 1e6;
            assert!(distance([x, left.y.place(expected)], &curve) < 3.0, "row {row}, {per_cent} %");
        }
    }
}

#[test]
fn the_number_of_plateaus_is_counted() {
    let directory = short();
    let figure = plotted(&directory, "plateau-sizes");
    let run = RunFile::open(directory.path("run.h5"));
    let statuses = run.statuses("/pin/status");
    let first: Vec<bool> = statuses[..20 * 40].iter().map(|status| *status as u8 == 1).collect();
    // Another way to count than the program's: labels that spread until nothing changes.
    let mut labels: Vec<usize> = (0..first.len()).collect();
    loop {
        let before = labels.clone();
        for cell in (0..first.len()).filter(|cell| first[*cell]) {
            let (column, row) = (cell / 20, cell % 20);
            let near = [
                (row > 0).then(|| cell - 1),
                (row < 19).then_some(cell + 1),
                (column > 0).then(|| cell - 20),
                (column < 39).then_some(cell + 20),
            ];
            let near = near.into_iter().flatten().filter(|other| first[*other]);
            labels[cell] = near.map(|other| labels[other]).fold(labels[cell], usize::min);
        }
        if labels == before {
            break;
        }
    }
    let count = (0..first.len()).filter(|cell| first[*cell] && labels[*cell] == *cell).count();
    let panel = figure.panel(figure.boxes()[0]);
    // The line of the first map is paler; it begins at the left with all plateaus.
    let pale = "#8CC0DC";
    let begin = figure.line(pale, panel.frame)[0];
    assert!((panel.y.value(begin[1]) / count as f64 - 1.0).abs() < 0.05, "{count}: {begin:?}");
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
    assert_eq!(ALL.map(shown), [false, true, true, true, true, false, true, false, true], "{names:?}");
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
