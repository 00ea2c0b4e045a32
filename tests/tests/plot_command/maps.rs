//! What the maps show.

use std::fs;

use image::{Rgb, RgbImage};
use plateau_tests::figure::{Figure, Frame};
use plateau_tests::run_file::RunFile;

use super::{plotted, short, with_run};

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
        // The pin's z grows away from the disc, and what reaches toward it is high.
        expect_colours(&figure, bars[1], &windows(&mut images, 40), |cell| Some((mean - heights[cell]) * 1e6));
    }
    assert!(images.next().is_none());
    assert!(figure.texts.iter().any(|text| text.text == "height toward the disc, µm"), "{:?}", figure.texts);
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
    // Grey, blue and orange, as in the legend; paler orange where debris is thin.
    let (colours, film) =
        ([Rgb([0xe4, 0xe4, 0xe4]), Rgb([0x00, 0x5a, 0x9c]), Rgb([0xe6, 0x9f, 0x00])], Rgb([244, 212, 140]));
    assert!(figure.texts.iter().any(|text| text.text == "the same, thinner than 0.1 µm"), "{:?}", figure.texts);
    let mut images = figure.images.iter();
    for (body, columns, toward) in [("disc", 690, 1.0), ("pin", 40, -1.0)] {
        let statuses = run.statuses(&format!("/{body}/status"));
        let [heights, substrates] = ["height", "substrate"].map(|name| run.floats(&format!("/{body}/{name}")));
        let least = 0.1e-6;
        let mut films = 0;
        for (number, moment) in statuses.chunks(20 * columns).enumerate() {
            let map = windows(&mut images, columns).concat();
            for (cell, (colour, status)) in map.iter().zip(moment).enumerate() {
                let at = number * 20 * columns + cell;
                let is_film = *status as u8 == 2 && toward * (heights[at] - substrates[at]) < least;
                films += usize::from(is_film);
                assert_eq!(*colour, if is_film { film } else { colours[*status as usize] }, "{body}, {at}");
            }
        }
        assert!(films > 0, "{body}: no film");
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
fn the_moment_the_width_and_the_colours_can_be_asked_for() {
    let directory = with_run(&[
        ("duration = \"60 s\"", "duration = \"10 s\""),
        ("maps_at = [\"0 s\"]", "maps_at = [\"0 s\", \"4 s\", \"7 s\"]"),
    ]);
    let asked = |more: &[&str]| {
        let always = ["plot", "run.h5", "-o", "figures", "--format", "svg", "--force", "--figure", "status"];
        directory.plateau(always.iter().chain(more)).quiet_success();
        fs::read_to_string(directory.path("figures/status.svg")).unwrap()
    };
    let svg = asked(&["--at", "4.4 s", "--width", "120 mm"]);
    // 12 pixels to the millimetre.
    assert!(svg.contains("width=\"1440\""), "{}", &svg[..200]);
    let run = RunFile::open(directory.path("run.h5"));
    // The second of four maps, and of all runs that alone.
    let figure = Figure::read(&svg);
    assert_eq!(figure.texts.iter().filter(|text| text.text.starts_with("none ")).count(), 2);
    let statuses = run.statuses("/pin/status");
    let map = windows(&mut figure.images.iter().rev(), 40).concat();
    let primary = map
        .iter()
        .zip(&statuses[20 * 40..])
        .all(|(colour, status)| (*colour == Rgb([0x00, 0x5a, 0x9c])) == (*status as u8 == 1));
    assert!(primary);

    // Grey levels have equal parts of red, green and blue.
    let always = ["plot", "run.h5", "-o", "figures", "--format", "svg", "--force", "--figure", "topography"];
    directory.plateau(always.iter().chain(&["--cmap", "greys"])).quiet_success();
    let figure = Figure::read(&fs::read_to_string(directory.path("figures/topography.svg")).unwrap());
    assert!(figure.images.len() > 4, "{}", figure.images.len());
    assert!(
        figure
            .images
            .iter()
            .all(|(_, image)| image.pixels().all(|Rgb([red, green, blue])| red == green && green == blue))
    );

    let outcome = directory.plateau(["plot", "run.h5", "-o", "late", "--figure", "pressure", "--at", "1e9 s"]);
    let said = "plateau: warning: run.h5: 1e9 s is after the last recorded map, that of ";
    assert!(outcome.status == Some(0) && outcome.stderr.starts_with(said), "{}", outcome.stderr);

    for (option, value, reason) in [
        ("--at", "-1 s", "-1 s is before the start of a run"),
        ("--at", "4", "\"4\" has no unit"),
        ("--width", "10", "10 has no unit, expected a width such as \"88 mm\""),
        ("--width", "3 mm", "3 mm is not a width from 60 mm to 1000 mm"),
        ("--cmap", "jet", "possible values: viridis"),
    ] {
        let outcome = directory.plateau(["plot", "run.h5", option, value]);
        assert!(outcome.status == Some(2) && outcome.stderr.contains(reason), "{}", outcome.stderr);
    }
}
