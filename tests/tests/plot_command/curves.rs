//! What the curves show.

use plateau_tests::figure::Panel;
use plateau_tests::run_file::RunFile;

use super::{FIRST_RUN, distance, expect_curve, plotted, short, with_run};

/// The colour of the first run, mixed with as much white.
const FIRST_RUN_PALE: &str = "#80B9D9";

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
    // From below: what the stacks hold at the end, part by part. The second one has an axis of its own, without what was emitted.
    let bands: Vec<_> = figure.areas.iter().filter(|(_, area)| area.len() > 9).collect();
    // Local debris has no pool, which is then no band.
    let there = |name: &&str| last(name) > 0.0;
    let all: Vec<&str> = ["deposited_disc", "deposited_pin", "emitted", "pool"].into_iter().filter(there).collect();
    let kept: Vec<&str> = all.iter().copied().filter(|name| *name != "emitted").collect();
    assert_eq!(bands.len(), all.len() + kept.len());
    let own = figure.panel(figure.boxes()[1]);
    let kept_unit = if figure.texts.iter().any(|text| text.text == "laid down so far, mm³") { 1e9 } else { 1e18 };
    let mut sums = [0.0; 2];
    let places = [(0, &panel, &all[..], 1.0), (1, &own, &kept[..], kept_unit / unit)];
    let placed = places
        .into_iter()
        .flat_map(|(stack, panel, parts, scale)| parts.iter().map(move |part| (stack, panel, part, scale)));
    for ((_, band), (stack, panel, part, scale)) in bands.iter().zip(placed) {
        let right = band.iter().map(|place| place[0]).fold(0.0, f64::max);
        let top = band.iter().filter(|place| place[0] == right).map(|place| place[1]).fold(f64::INFINITY, f64::min);
        sums[stack] += last(part) * scale;
        assert!((top - panel.y.place(sums[stack])).abs() < 2.0, "{part}, stack {stack}");
    }
    assert!((sums[0] / supply - 1.0).abs() < 1e-9);
}

#[test]
fn heights_are_those_that_parts_of_the_cells_reach() {
    let directory = short();
    let figure = plotted(&directory, "heights");
    let run = RunFile::open(directory.path("run.h5"));
    let disc = run.last_map("/disc/height");
    let pin = run.last_map("/pin/height");
    let mean = pin.iter().sum::<f64>() / pin.len() as f64;
    // The pin's z grows away from the disc, and what reaches toward it is high.
    let pin: Vec<f64> = pin.iter().map(|height| mean - height).collect();
    // Only the first box of a row has numbers on the left: the second one has the same axis.
    let boxes = figure.boxes();
    assert_eq!(boxes.len(), 4);
    // From the peaks on.
    for (row, mut heights) in [(0, disc), (1, pin)] {
        heights.sort_by(|one, other| other.total_cmp(one));
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
fn the_number_of_contact_spots_is_counted() {
    let directory = short();
    let figure = plotted(&directory, "plateau-sizes");
    let run = RunFile::open(directory.path("run.h5"));
    let in_contact: Vec<bool> = run.last_map("/pin/pressure").iter().map(|pressure| *pressure > 0.0).collect();
    // Another way to count than the program's: labels that spread until nothing changes.
    let mut labels: Vec<usize> = (0..in_contact.len()).collect();
    loop {
        let before = labels.clone();
        for cell in (0..in_contact.len()).filter(|cell| in_contact[*cell]) {
            let (column, row) = (cell / 20, cell % 20);
            let near = [
                (row > 0).then(|| cell - 1),
                (row < 19).then_some(cell + 1),
                (column > 0).then(|| cell - 20),
                (column < 39).then_some(cell + 20),
            ];
            let near = near.into_iter().flatten().filter(|other| in_contact[*other]);
            labels[cell] = near.map(|other| labels[other]).fold(labels[cell], usize::min);
        }
        if labels == before {
            break;
        }
    }
    let count = (0..in_contact.len()).filter(|cell| in_contact[*cell] && labels[*cell] == *cell).count();
    let panel = figure.panel(figure.boxes()[0]);
    // It begins at the left with all of them.
    let begin = figure.line(FIRST_RUN, panel.frame)[0];
    assert!(count > 1 && (panel.y.value(begin[1]) / count as f64 - 1.0).abs() < 0.05, "{count}: {begin:?}");
}
