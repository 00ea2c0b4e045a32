//! `plateau report`: what is on the page is what is in the run files.

use std::collections::HashSet;
use std::fs;
use std::io::Read as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;
use hdf5::types::VarLenUnicode;
use plateau_tests::program::{WorkingDirectory, quick_scene_with, scene};
use plateau_tests::run_file::{RunFile, changed, created};
use serde_json::Value;

/// Where the maps of the page are in a run file.
const MAPS: [(&str, &str); 7] = [
    ("disc_height", "/disc/height"),
    ("disc_substrate", "/disc/substrate"),
    ("disc_status", "/disc/status"),
    ("pin_height", "/pin/height"),
    ("pin_substrate", "/pin/substrate"),
    ("pin_status", "/pin/status"),
    ("pressure", "/pin/pressure"),
];

/// A directory with `scene.toml`: the quick scene for a few seconds, with maps at three times.
fn short() -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    let edits =
        [("duration = \"60 s\"", "duration = \"6 s\""), ("maps_at = [\"0 s\"]", "maps_at = [\"0 s\", \"1 s\"]")];
    directory.write("scene.toml", quick_scene_with(&edits));
    directory
}

/// Runs the scene with changes of it.
fn run(directory: &WorkingDirectory, file: &str, sets: &[&str]) {
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    directory.plateau(["run", "scene.toml", "-o", file].into_iter().chain(sets)).quiet_success();
}

/// The page about run files; nothing but what the figures leave out is told.
fn page(directory: &WorkingDirectory, files: &[&str]) -> String {
    let arguments = std::iter::once(&"report").chain(files).chain(&["-o", "report.html", "--force"]);
    let outcome = directory.plateau(arguments);
    assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
    assert!(outcome.stderr.lines().all(|line| line.contains(": left out of ")), "{}", outcome.stderr);
    fs::read_to_string(directory.path("report.html")).unwrap()
}

/// The JSON document of a page.
fn document(page: &str) -> Value {
    let (_, rest) = page.split_once("<script type=\"application/json\" id=\"data\">").expect("the data");
    serde_json::from_str(rest.split_once("</script>").expect("their end").0).expect("a JSON document")
}

/// Numbers of `size` bytes out of a packed text: the lowest bytes of all of them stand first.
fn unpack(packed: &Value, size: usize) -> Vec<Vec<u8>> {
    let mut planes = Vec::new();
    let deflated = STANDARD.decode(packed.as_str().expect("a text")).expect("base64");
    ZlibDecoder::new(&deflated[..]).read_to_end(&mut planes).expect("zlib");
    let count = planes.len() / size;
    (0..count).map(|index| (0..size).map(|plane| planes[plane * count + index]).collect()).collect()
}

fn doubles(packed: &Value) -> Vec<f64> {
    unpack(packed, 8).into_iter().map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap())).collect()
}

fn singles(packed: &Value) -> Vec<f32> {
    unpack(packed, 4).into_iter().map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).collect()
}

fn indices(packed: &Value) -> Vec<usize> {
    let steps = unpack(packed, 4).into_iter().map(|bytes| u32::from_le_bytes(bytes.try_into().unwrap()) as usize);
    steps.scan(0, |at, step| (*at += step, Some(*at)).1).collect()
}

/// Codes of a map, time by time, of the differences that are on the page; `before` is what the first time is told from.
fn codes(map: &Value, before: &[u32]) -> Vec<u32> {
    let wide = map["steps"].as_u64().unwrap() > 255;
    let mut codes: Vec<u32> = unpack(&map["codes"], if wide { 2 } else { 1 })
        .into_iter()
        .map(|bytes| bytes.iter().rev().fold(0, |code, byte| code << 8 | u32::from(*byte)))
        .collect();
    let cells: usize = map["shape"].as_array().unwrap().iter().map(|count| count.as_u64().unwrap() as usize).product();
    let modulus = if wide { 1 << 16 } else { 1 << 8 };
    for index in 0..codes.len() {
        let before = if index < cells { before.get(index).copied().unwrap_or(0) } else { codes[index - cells] };
        codes[index] = (codes[index] + before) % modulus;
    }
    codes
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|number| number.as_f64().expect("a number")).collect()
}

#[test]
fn the_series_of_the_page_are_those_of_the_run_file() {
    let directory = short();
    run(&directory, "all.h5", &["output.roughness=true"]);
    run(&directory, "thinned.h5", &["output.sample_every=0.003 s", "title=Thinned"]);
    let document = document(&page(&directory, &["all.h5", "thinned.h5"]));
    for (run, file) in document["runs"].as_array().unwrap().iter().zip(["all.h5", "thinned.h5"]) {
        let file = RunFile::open(directory.path(file));
        let (time, times) = (doubles(&run["time"]), file.floats("/time"));
        assert_eq!(run["samples"], times.len());
        let names: HashSet<String> =
            file.content().keys().filter_map(|path| path.strip_prefix("/series/").map(str::to_owned)).collect();
        let series = run["series"].as_array().unwrap();
        assert_eq!(
            series.iter().map(|series| series["name"].as_str().unwrap().to_owned()).collect::<HashSet<_>>(),
            names
        );
        for series in series {
            let values = file.floats(&format!("/series/{}", series["name"].as_str().unwrap()));
            let (at, shown) = (indices(&series["at"]), singles(&series["values"]));
            assert_eq!(at.len(), shown.len());
            if times.len() <= 1500 {
                assert_eq!(shown.len(), times.len());
            } else {
                assert!((4..=1500).contains(&shown.len()));
                // The envelope: nothing of the file is beyond what is on the page.
                let ends = |values: &mut dyn Iterator<Item = f32>| {
                    values.fold((f32::MAX, f32::MIN), |(low, high), value| (low.min(value), high.max(value)))
                };
                assert_eq!(ends(&mut shown.iter().copied()), ends(&mut values.iter().map(|value| *value as f32)));
            }
            for (at, shown) in at.iter().zip(shown) {
                let sample = times.iter().position(|there| *there == time[*at]).expect("a time of the file");
                assert_eq!(shown, values[sample] as f32, "{} at {} s", series["name"], time[*at]);
            }
        }
    }
}

/// Demands values within half a step of the codes of a map; answers the step.
fn assert_shown(map: &Value, codes: &[u32], values: &[f64]) -> f64 {
    let (range, steps) = (numbers(&map["range"]), map["steps"].as_f64().unwrap());
    let (reference, cells) = (numbers(&map["reference"]), values.len() / numbers(&map["times"]).len());
    let step = (range[1] - range[0]) / steps;
    assert_eq!(codes.len(), values.len());
    for (index, (code, value)) in codes.iter().zip(values).enumerate() {
        let shown = reference[index / cells] + range[0] + f64::from(*code) * step;
        assert!((shown - value).abs() <= 0.5001 * step, "{}: {value} is shown as {shown}", map["name"]);
    }
    step
}

#[test]
fn the_maps_of_the_page_are_those_of_the_run_file_within_half_a_step() {
    let directory = short();
    run(&directory, "run.h5", &[]);
    let document = document(&page(&directory, &["run.h5"]));
    let file = RunFile::open(directory.path("run.h5"));
    let maps = document["runs"][0]["maps"].as_array().unwrap();
    assert_eq!(maps.iter().map(|map| map["name"].as_str().unwrap()).collect::<Vec<_>>(), MAPS.map(|(name, _)| name));
    for (map, (name, path)) in maps.iter().zip(MAPS) {
        assert_eq!(numbers(&map["times"]), file.floats("/map_time"));
        assert_eq!(map["block"], serde_json::json!([1, 1]));
        let before = maps.iter().find(|other| other["name"] == map["told_from"]);
        assert_eq!(before.is_some(), name.ends_with("substrate"));
        let codes = codes(map, &before.map(|before| codes(before, &[])).unwrap_or_default());
        if map["is_status"] == true {
            let statuses: Vec<u32> = file.statuses(path).into_iter().map(|status| status as u32).collect();
            assert!(codes == statuses, "{name}");
            continue;
        }
        // The pin's heights are shown toward the disc.
        let sign = if name.starts_with("pin_") { -1.0 } else { 1.0 };
        let values: Vec<f64> = file.floats(path).into_iter().map(|value| sign * value).collect();
        // 6 s of wear leave the pin with more relief than 1 um, which is not told apart worse than this.
        let step = assert_shown(map, &codes, &values);
        assert!(step < if name == "pressure" { 1e5 } else { 1e-7 }, "{name}: {step}");
    }
}

#[test]
fn the_tables_tell_how_the_runs_ended_and_differ() {
    let directory = short();
    run(&directory, "one.h5", &[]);
    run(&directory, "two.h5", &["operation.normal_force=10 N", "title=Twice the load"]);
    let page = page(&directory, &["one.h5", "two.h5"]);
    for file in ["one.h5", "two.h5"] {
        let run = RunFile::open(directory.path(file));
        let area = *run.floats("/series/contact_area").last().unwrap() * 1e6;
        let shown = format!("{area:.0$} mm²", if area < 1.0 { 5 } else { 4 });
        assert!(page.contains(&shown), "{shown} is not on the page");
        // All of so short a run is fewer than ten simulated revolutions: the mean is that of the whole, without an error.
        let mean =
            run.floats("/series/contact_area_integral").last().unwrap() / run.floats("/time").last().unwrap() * 1e6;
        let shown = format!("{mean:.0$} mm²", if mean < 1.0 { 5 } else { 4 });
        assert!(page.contains(&shown), "{shown} is not on the page");
    }
    assert!(page.contains("<tr><th scope=\"row\">operation.normal_force</th><td>5 N</td><td>10 N</td></tr>"));
    assert!(!page.contains("<th scope=\"row\">mesh.rows</th>"), "a key that does not differ");
    assert!(page.contains("id=\"comparison\"") && page.contains("Twice the load"));
    let alone = self::page(&directory, &["one.h5"]);
    assert!(!alone.contains("id=\"comparison\"") && alone.contains("id=\"summary\""));
}

#[test]
fn a_page_needs_nothing_from_elsewhere() {
    let directory = short();
    run(&directory, "run.h5", &[]);
    let page = page(&directory, &["run.h5"]);
    assert!(page.contains("content=\"default-src 'none';"));
    for outside in ["src=\"", "@import", "<link rel=\"stylesheet\"", "url("] {
        assert!(!page.contains(outside), "{outside}");
    }
    // The same run files give the same page.
    assert!(self::page(&directory, &["run.h5"]) == page);
}

#[test]
fn texts_of_run_files_are_shown_as_they_are() {
    let directory = short();
    let title = "</script><b>bold</b>{{script}} & \"quoted\" <!-- 'x' µ";
    run(&directory, "<i>.h5", &[&format!("title={}", toml_string(title))]);
    let page = page(&directory, &["<i>.h5"]);
    for raw in ["</script><b>", "<b>bold", "<i>", "<!--"] {
        assert!(!page.contains(raw), "{raw}");
    }
    // That of the data and that of the scripts.
    assert_eq!(page.matches("</script").count(), 2);
    assert_eq!(document(&page)["runs"][0]["label"], title);
    let shown =
        "<h1>&lt;/script&gt;&lt;b&gt;bold&lt;/b&gt;{{script}} &amp; &quot;quoted&quot; &lt;!-- &#39;x&#39; µ</h1>";
    assert!(page.contains(shown));
    assert!(page.contains("&lt;i&gt;.h5"));
}

fn toml_string(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\\\""))
}

#[test]
fn what_was_not_recorded_is_left_out() {
    let directory = short();
    run(&directory, "run.h5", &["output.maps=[]"]);
    let page = page(&directory, &["run.h5"]);
    assert!(!page.contains("<section id=\"maps\"") && page.contains("the runs did not record any"));
    let document = document(&page);
    assert_eq!(document["runs"][0]["maps"], serde_json::json!([]));
    // Of the figures, those of maps.
    let figures: Vec<&str> =
        document["pictures"].as_array().unwrap().iter().map(|picture| picture["name"].as_str().unwrap()).collect();
    assert!(page.contains("<section id=\"series\"") && page.contains("<section id=\"figures\""));
    assert!(!figures.is_empty() && figures.iter().all(|name| !name.contains("map")), "{figures:?}");
}

#[test]
fn a_substrate_needs_no_height_beside_it() {
    let directory = short();
    run(&directory, "run.h5", &["output.maps=[\"pin_substrate\"]"]);
    let document = document(&page(&directory, &["run.h5"]));
    let map = &document["runs"][0]["maps"][0];
    assert_eq!((&map["name"], &map["told_from"]), (&"pin_substrate".into(), &Value::Null));
    let values = RunFile::open(directory.path("run.h5")).floats("/pin/substrate");
    let values: Vec<f64> = values.into_iter().map(|value| -value).collect();
    assert_shown(map, &codes(map, &[]), &values);
}

#[test]
fn one_cell_is_enough() {
    let directory = short();
    let mesh = ["mesh.rows=1", "mesh.disc_columns=1", "mesh.pin_columns=1", "disc.surface.flat=true"];
    let pin = ["pin.surface.flat=true", "pin.base.uniform=primary", "numerics.time_acceleration=1"];
    let steps =
        ["operation.steps=3", "output.sample_every_steps=1", "output.maps_at=[]", "numerics.integrator=exponential"];
    run(&directory, "run.h5", &[&mesh[..], &pin, &steps].concat());
    let document = document(&page(&directory, &["run.h5"]));
    let map = &document["runs"][0]["maps"][0];
    assert_eq!((&map["shape"], codes(map, &[]).len()), (&serde_json::json!([1, 1]), numbers(&map["times"]).len()));
}

/// Changes a run file.
fn change(directory: &WorkingDirectory, name: &str, change: impl Fn(&hdf5::File)) {
    let file = changed(directory.path(name));
    change(&file);
    file.close().unwrap();
}

#[test]
fn a_run_that_did_not_finish_is_told_of() {
    let directory = short();
    run(&directory, "run.h5", &[]);
    change(&directory, "run.h5", |file| {
        let state: VarLenUnicode = "running".parse().unwrap();
        file.attr("state").unwrap().write_scalar(&state).unwrap();
        file.delete_attr("wall_time").unwrap();
        // As if it had been killed before its first sample and its first map.
        file.dataset("time").unwrap().resize(0).unwrap();
        file.dataset("map_time").unwrap().resize(0).unwrap();
    });
    let outcome = directory.plateau(["report", "run.h5"]);
    assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("run.h5 is not finished: its state is running"), "{}", outcome.stderr);
    let page = fs::read_to_string(directory.path("run.html")).unwrap();
    assert!(page.contains("Quick look is not finished: its state is running. It has no samples."));
    for left_out in ["series", "maps", "residuals"] {
        assert!(!page.contains(&format!("<section id=\"{left_out}\"")), "{left_out}");
    }
}

#[test]
fn what_is_left_out_and_a_run_named_twice_are_told() {
    let directory = short();
    run(&directory, "run.h5", &["output.maps=[]"]);
    let outcome = directory.plateau(["report", "run.h5", "./run.h5"]);
    assert_eq!(outcome.status, Some(0), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("plateau: warning: ./run.h5 is named more than once"), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("plateau: run.h5 has no map pressure: left out of pressure"), "{}", outcome.stderr);
    // The runs go by the same names on the page and in figures.
    let page = fs::read_to_string(directory.path("report.html")).unwrap();
    assert_eq!(directory.plateau(["plot", "run.h5", "./run.h5", "--format", "svg"]).status, Some(0));
    let figure = fs::read_to_string(directory.path("figures/contact-area.svg")).unwrap();
    for label in ["Quick look (run)", "Quick look (./run)"] {
        assert!(page.contains(&format!(">{label}</th>")) && figure.contains(label), "{label}");
    }
}

#[test]
fn what_is_no_run_file_is_refused() {
    let directory = short();
    run(&directory, "run.h5", &[]);
    fs::copy(directory.path("run.h5"), directory.path("cut.h5")).unwrap();
    let bytes = fs::read(directory.path("run.h5")).unwrap();
    directory.write("cut.h5", &bytes[..bytes.len() / 2]);
    directory.write("text.h5", "no HDF5");
    directory.write("taken.html", "mine");
    {
        created(directory.path("foreign.h5")).close().unwrap();
    }
    let before = directory.content();
    for (arguments, message) in [
        (&["missing.h5"][..], "cannot read missing.h5"),
        (&["text.h5"], "text.h5 is not an HDF5 file"),
        (&["run.h5", "foreign.h5"], "foreign.h5 is not a run file of plateau: it has no root attribute format_version"),
        (&["cut.h5"], "cut.h5 is damaged"),
        (&["run.h5", "-o", "taken.html"], "taken.html exists; give --force to replace it"),
        (&["run.h5", "-o", "run.h5", "--force"], "run.h5 is an input and is not replaced"),
        (&["run.h5", "-o", "nowhere/report.html"], "nowhere is not a directory"),
        (&["run.h5"; 9], "9 runs: expected at most 8"),
        (&[], "<RUN>..."),
    ] {
        let outcome = directory.plateau(std::iter::once(&"report").chain(arguments));
        assert_eq!(outcome.status, Some(2), "{arguments:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(message) && outcome.stdout.is_empty(), "{arguments:?}: {}", outcome.stderr);
    }
    assert!(directory.content() == before, "a refused report wrote something");
}

#[test]
fn a_report_of_three_runs_of_the_papers_size_takes_five_megabytes_at_most() {
    let directory = WorkingDirectory::new();
    let cermet = scene("cermet.toml");
    let times = "output.maps_at=[\"0 s\", \"1 s\", \"2 s\", \"5 s\", \"10 s\", \"20 s\", \"30 s\"]";
    for name in ["one", "two"] {
        let (file, title) = (format!("{name}.h5"), format!("title={name}"));
        // Rough to different degrees, as the paper's discs are.
        let scale = format!("disc.prepare.scale={}", if name == "one" { "1.0" } else { "0.1" });
        let sets = ["operation.duration=40 s", "output.sample_every=0.01 s", times, &title, &scale];
        let sets = sets.iter().flat_map(|set| ["--set", set]);
        directory.plateau(["run", &cermet, "-o", &file].into_iter().chain(sets)).quiet_success();
    }
    fs::copy(directory.path("two.h5"), directory.path("three.h5")).unwrap();
    let page = page(&directory, &["one.h5", "two.h5", "three.h5"]);
    assert!(page.len() <= 5_000_000, "{} bytes", page.len());
    let document = document(&page);
    for run in document["runs"].as_array().unwrap() {
        assert_eq!(run["maps"].as_array().unwrap().len(), 7);
        assert_eq!(numbers(&run["maps"][0]["times"]).len(), 8);
    }
}
