//! The pictures of `plateau surface --plot`.

use std::fs;

use plateau_tests::figure::{Figure, Frame};
use plateau_tests::program::WorkingDirectory;

use super::{picture, small_sdf};

#[test]
fn a_picture_shows_the_map_the_histogram_and_the_curve() {
    let directory = WorkingDirectory::new();
    // Four quarters: low, high, missing, high; larger than the smallest map.
    let quarter = |x: usize, y: usize| match (x < 30, y < 30) {
        (true, true) => "0 ",
        (true, false) => "BAD ",
        _ => "1 ",
    };
    let lines: String = (0..60).map(|y| (0..60).map(|x| quarter(x, y)).collect::<String>() + "\n").collect();
    let header = small_sdf().replace("NumPoints = 4", "NumPoints = 60").replace("NumProfiles = 3", "NumProfiles = 60");
    let (header, _) = header.split_once("*\n").expect("a header");
    directory.write("quarters.sdf", format!("{header}*\n{lines}*\n"));
    directory.plateau(["surface", "quarters.sdf", "--level", "none", "--plot", "out.png"]).quiet_success();
    let image = picture(&directory, "out.png");
    // Ends of the colour map viridis (its authors' table), and the grey of missing points.
    let (low, high, missing) = ([68, 1, 84], [253, 231, 37], [0xbd; 3]);
    let places = |colour: [u8; 3]| {
        let places = image.enumerate_pixels().filter(|(_, _, pixel)| pixel.0 == colour).map(|(x, y, _)| [x, y]);
        places.fold(([u32::MAX; 2], [0; 2], 0_u32), |(first, last, count), [x, y]| {
            ([first[0].min(x), first[1].min(y)], [last[0].max(x), last[1].max(y)], count + 1)
        })
    };
    let [(_, low_end, low_count), (_, _, high_count), (missing_start, _, missing_count)] =
        [low, high, missing].map(places);
    // The map is 176 by 440 pixels or larger (points 2 µm by 5 µm apart); a quarter of it each, half high; the missing one
    // is above the low one, for y grows upward.
    assert!(low_count > 18_000 && missing_count > 18_000 && high_count > 36_000, "{low_count} {missing_count}");
    assert!((f64::from(low_count) / f64::from(missing_count) - 1.0).abs() < 0.1);
    assert!((f64::from(high_count) / f64::from(low_count) - 2.0).abs() < 0.2);
    assert!(missing_start[1] < low_end[1] / 2, "{missing_start:?} {low_end:?}");
    // Axes and letters; the two bars of the histogram, one of its 64 classes of 360 pixels each, less their outlines.
    for (colour, least) in [([0x22; 3], 5_000), ([0x9d, 0xbf, 0xd6], 1_000)] {
        assert!(places(colour).2 > least, "{colour:?}: {}", places(colour).2);
    }
    // Nothing but white at the edge: no label is cut off.
    let edge = image
        .enumerate_pixels()
        .filter(|(x, y, _)| *x == 0 || *y == 0 || *x == image.width() - 1 || *y == image.height() - 1);
    assert!(edge.into_iter().all(|(_, _, pixel)| pixel.0 == [255; 3]));
}

#[test]
fn pictures_have_the_format_of_their_ending() {
    let directory = WorkingDirectory::new();
    directory.write("small.sdf", small_sdf());
    let micrograph = plateau_tests::program::scene("micrograph.toml");
    for ending in ["png", "svg", "PDF"] {
        let (plot, preview) = (format!("plot.{ending}"), format!("preview.{ending}"));
        directory.plateau(["surface", "small.sdf", "--plot", &plot]).quiet_success();
        directory.plateau(["surface", "--prepare", &micrograph, "--preview", &preview]).quiet_success();
        for name in [plot, preview] {
            let content = fs::read(directory.path(&name)).unwrap();
            match ending {
                "png" => assert!(content.starts_with(b"\x89PNG"), "{name}"),
                "svg" => {
                    let figure = Figure::read(&String::from_utf8(content).unwrap());
                    let pictures = figure.images.iter().filter(|(_, picture)| picture.width() > 1);
                    assert!(pictures.count() > 0 && !figure.texts.is_empty(), "{name}");
                }
                _ => assert!(content.starts_with(b"%PDF-") && content.trim_ascii_end().ends_with(b"%%EOF"), "{name}"),
            }
        }
    }
}

#[test]
fn heights_of_a_run_have_equal_scales_and_stand_on_pages_of_a_journal() {
    let directory = WorkingDirectory::new();
    let scene = plateau_tests::program::scene("quick.toml");
    let maps = "output.maps_at=[\"0 s\", \"1 s\"]";
    directory
        .plateau(["run", &scene, "-o", "run.h5", "--set", "operation.duration=2 s", "--set", maps])
        .quiet_success();
    let times = ["--at", "0 s", "--at", "1 s", "--at", "2 s"];
    let list = directory.plateau(["surface", "run.h5", "--plot", "out.svg"].into_iter().chain(times)).quiet_success();
    assert!(list.contains("wrote out.svg\n") && list.contains("wrote out-2.svg\n"), "{list}");
    assert!(!directory.path("out-3.svg").exists());
    // Of a body, the ends of the axes of the heights.
    let mut ends: [Vec<[f64; 2]>; 2] = [Vec::new(), Vec::new()];
    for page in ["out.svg", "out-2.svg"] {
        let figure = Figure::read(&fs::read_to_string(directory.path(page)).unwrap());
        let [width, height] = figure.size;
        assert!(width <= 180.0 && height <= 240.0, "{page}: {width} mm x {height} mm");
        for (body, ends) in ["disc height", "pin height"].iter().zip(&mut ends) {
            for title in figure.texts.iter().filter(|text| text.text.contains(body)) {
                // Beside the windows of the map the histogram, then the curve, which shares its axis.
                let beside = |frame: &Frame| (title.place[1]..title.place[1] + 250.0).contains(&frame.y[0]);
                let mut boxes: Vec<Frame> = figure.boxes().into_iter().filter(beside).collect();
                boxes.sort_by(|one, other| one.x[0].total_cmp(&other.x[0]));
                let chart = boxes[boxes.len() - 2];
                let axis = figure.y_axis(chart);
                ends.push(chart.y.map(|place| axis.value(place)));
            }
        }
    }
    for ends in ends {
        assert_eq!(ends.len(), 3, "{ends:?}");
        for end in &ends {
            let close = |at: usize| (end[at] - ends[0][at]).abs() < 0.01 * (ends[0][0] - ends[0][1]).abs();
            assert!(close(0) && close(1), "{ends:?}");
        }
    }
}

#[test]
fn no_page_takes_the_place_of_an_input_or_of_another_output() {
    let directory = WorkingDirectory::new();
    let scene = plateau_tests::program::scene("micrograph.toml");
    let picture = |name: &str| directory.path(name).is_file();
    // Surfaces of a run and of a scene have two pages.
    let quick = plateau_tests::program::scene("quick.toml");
    let maps = "output.maps_at=[\"0 s\", \"1 s\"]";
    directory
        .plateau(["run", &quick, "-o", "run.h5", "--set", "operation.duration=2 s", "--set", maps])
        .quiet_success();
    let call = |plot: &str, preview: &str| {
        let always = ["surface", "run.h5", "--prepare", &scene, "--plot", plot, "--preview", preview, "--force"];
        directory.plateau(always)
    };
    for (plot, preview, named) in [("p.png", "./p.png", "./p.png"), ("p.png", "./p-2.png", "./p-2.png")] {
        let outcome = call(plot, preview);
        assert_eq!(outcome.status, Some(2), "{}", outcome.stderr);
        assert!(outcome.stderr.contains(&format!("{named} is named for two outputs")), "{}", outcome.stderr);
        assert!(!picture("p.png") && !picture("p-2.png"));
    }
    let outcome = call("p.png", "q.png");
    assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
    assert!(picture("p.png") && picture("p-2.png") && picture("q.png"));
    // The micrograph of a scene, where a page would be.
    let micrograph = plateau_tests::program::repository().join("data/surfaces/micrograph.png");
    fs::copy(micrograph, directory.path("own-2.png")).unwrap();
    directory.write("own.toml", format!("extends = \"{scene}\"\n[pin.base]\nimage = \"own-2.png\"\n"));
    let before = fs::read(directory.path("own-2.png")).unwrap();
    let outcome = directory.plateau(["surface", "run.h5", "--prepare", "own.toml", "--plot", "own.png", "--force"]);
    assert!(outcome.stderr.contains("own-2.png is an input and is not replaced"), "{}", outcome.stderr);
    assert!(fs::read(directory.path("own-2.png")).unwrap() == before && !picture("own.png"));
}
