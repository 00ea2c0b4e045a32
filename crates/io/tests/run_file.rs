//! Run files: what is in them, what is never overwritten, and what is left when something fails.

use std::fs;
use std::path::Path;
use std::time::Duration;

use crate::fixtures::{entries, header, place, run_file, sample, small, snapshot, text};
use plateau_core::observe::{Map, MapValues, QUANTITIES, Snapshot};
use plateau_io::run_file::{End, InputFile, RunFileError, RunWriter, verify};

#[test]
fn a_finished_run_holds_what_was_sent() {
    let (directory, path) = place("run.h5");
    let header = small();
    let mut writer = RunWriter::create(&path, false, &header).unwrap();
    writer.snapshot(snapshot(&header, 0.0)).unwrap();
    for step in 1..=1000 {
        writer.sample(sample(step)).unwrap();
    }
    writer.snapshot(snapshot(&header, 250.0)).unwrap();
    let report = writer.finish(&End::Finished, &[], None).unwrap();
    assert_eq!((report.samples, report.snapshots), (1000, 2));
    assert_eq!(report.bytes, fs::metadata(&path).unwrap().len());
    assert_eq!(entries(directory.path()), ["run.h5"]);

    let file = hdf5::File::open(&path).unwrap();
    assert_eq!(text(&file, "state"), "finished");
    let times = file.dataset("time").unwrap().read_raw::<f64>().unwrap();
    assert_eq!(times, (1..=1000).map(|step| 0.25 * f64::from(step)).collect::<Vec<_>>());
    for quantity in QUANTITIES {
        let series = file.dataset(&format!("series/{}", quantity.name)).unwrap().read_raw::<f64>().unwrap();
        let expected: Vec<_> = (1..=1000).map(|step| quantity.value(&sample(step))).collect();
        for (found, expected) in series.iter().zip(&expected) {
            assert!((found - expected).abs() < 1e-9, "{}: {found} for {expected}", quantity.name);
        }
        assert_eq!(series.len(), 1000, "{}", quantity.name);
    }
    // Column 3, row 2 of the second level: cell 3 · 4 + 2 = 14.
    let height = file.dataset("disc/height").unwrap().read_dyn::<f64>().unwrap();
    assert_eq!(height.shape(), [2, 12, 4]);
    assert_eq!(height[[1, 3, 2]], 14.0 + 250_000.0);
    let pressure = file.dataset("pin/pressure").unwrap().read_dyn::<f64>().unwrap();
    assert_eq!(pressure.shape(), [2, 5, 4]);
    assert_eq!(pressure[[0, 3, 2]], 14.0 + 0.6);
    assert_eq!(file.dataset("map_time").unwrap().read_raw::<f64>().unwrap(), [0.0, 250.0]);
}

#[test]
fn a_finished_run_has_fixed_dimensions_and_a_map_that_never_changes_once() {
    let (_directory, path) = place("run.h5");
    // More cells than deflate looks back over, in two parts of columns.
    let header = header(96, 400, 60, &[Map::DiscHeight, Map::DiscSubstrate, Map::DiscStatus, Map::PinSubstrate]);
    // Bits that nothing shortens, as those of measured heights: a multiplicative congruential generator.
    let mut bits = 1_u64;
    let mut random = |cells: usize| -> Vec<f64> {
        let mut next = |_| {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            f64::from_bits(bits >> 12 | 0x3ff0_0000_0000_0000)
        };
        (0..cells).map(&mut next).collect()
    };
    let (disc, pin) = (header.mesh.disc_cells(), header.mesh.pin_cells());
    let (substrate, pins) = (random(disc), random(3 * pin));
    let mut writer = RunWriter::create(&path, false, &header).unwrap();
    for moment in 0..20 {
        let maps = vec![
            (Map::DiscHeight, MapValues::Float(random(disc))),
            (Map::DiscSubstrate, MapValues::Float(substrate.clone())),
            (Map::DiscStatus, MapValues::Status(vec![1; disc])),
            // It changes once.
            (Map::PinSubstrate, MapValues::Float(pins[if moment < 19 { 0..pin } else { pin..2 * pin }].to_vec())),
        ];
        writer.snapshot(Snapshot { time: moment as f64, maps }).unwrap();
        writer.sample(sample(moment + 1)).unwrap();
    }
    writer.finish(&End::Finished, &[], None).unwrap();

    let file = hdf5::File::open(&path).unwrap();
    let of = |name: &str| file.dataset(name).unwrap();
    for name in ["time", "map_time", "series/pool", "disc/height", "disc/substrate", "disc/status", "pin/substrate"] {
        assert!(!of(name).is_resizable(), "{name}");
    }
    assert_eq!(of("disc/substrate").shape(), [20, 400, 96]);
    let read = of("disc/substrate").read_raw::<f64>().unwrap();
    assert!(read.chunks(disc).all(|map| map == substrate));
    let last = of("pin/substrate").read_slice_2d::<f64, _>(ndarray::s![19, .., ..]).unwrap();
    assert_eq!(last.into_raw_vec_and_offset().0, pins[pin..2 * pin]);
    // Twice ten moments in a chunk: two maps, and a few bytes for every 258 that come again (RFC 1951).
    let one = of("disc/height").storage_size() / 20;
    let stored = of("disc/substrate").storage_size();
    assert!(stored < 3 * one, "{stored} bytes, of one map {one}");
    assert!(of("pin/substrate").storage_size() > 15 * one * pin as u64 / disc as u64);
    drop(file);
    assert_eq!(verify(&path).unwrap().damage, []);
}

#[test]
fn only_the_maps_asked_for_exist() {
    let (_directory, path) = place("run.h5");
    let header = header(4, 12, 5, &[Map::Pressure]);
    let mut writer = RunWriter::create(&path, false, &header).unwrap();
    writer.snapshot(snapshot(&header, 1.0)).unwrap();
    writer.finish(&End::Finished, &[], None).unwrap();
    let file = hdf5::File::open(&path).unwrap();
    assert_eq!(file.group("disc").unwrap().member_names().unwrap(), [""; 0]);
    assert_eq!(file.group("pin").unwrap().member_names().unwrap(), ["pressure", "base"]);
    drop(file);

    let bare = self::header(4, 12, 5, &[]);
    RunWriter::create(&path, true, &bare).unwrap().finish(&End::Finished, &[], None).unwrap();
    let file = hdf5::File::open(&path).unwrap();
    assert_eq!(file.group("pin").unwrap().member_names().unwrap(), ["base"]);
    assert!(!file.link_exists("map_time") && file.link_exists("time"));
}

#[test]
fn the_attributes_say_where_the_run_comes_from() {
    let (_directory, path) = place("run.h5");
    let mut header = small();
    // Longer than the 64 KiB that an object header can hold.
    header.scene = "# a long scene, µm\n".repeat(11_000);
    header.title = "null\0inside".into();
    let writer = RunWriter::create(&path, false, &header).unwrap();
    std::thread::sleep(Duration::from_millis(20));
    writer.finish(&End::Failed("out of luck".into()), &[], None).unwrap();

    let file = hdf5::File::open(&path).unwrap();
    assert!(header.scene.len() > 200_000);
    assert_eq!(text(&file, "scene"), header.scene);
    assert_eq!(text(&file, "title"), "null\u{fffd}inside");
    assert_eq!(text(&file, "program"), "plateau 0.1.0");
    assert_eq!(text(&file, "conventions"), "CF-1.11");
    assert_eq!(text(&file, "state"), "failed");
    assert_eq!(text(&file, "error"), "out of luck");
    assert_eq!(file.attr("format_version").unwrap().read_scalar::<i64>().unwrap(), 1);
    assert_eq!(file.attr("workers").unwrap().read_scalar::<i64>().unwrap(), 2);
    assert!(file.attr("wall_time").unwrap().read_scalar::<f64>().unwrap() >= 0.02);
    let inputs: serde_json::Value = serde_json::from_str(&text(&file, "inputs")).unwrap();
    assert_eq!(inputs, serde_json::json!([{ "path": "scene.toml", "sha256": "ab".repeat(32) }]));
    assert_eq!(text(&file, "surfaces"), "disc.surface: flat\npin.surface: flat");
    let seeds: serde_json::Value = serde_json::from_str(&text(&file, "seeds")).unwrap();
    assert_eq!(seeds, serde_json::json!({ "disc.surface.synthetic.seed": u64::MAX }));
    assert!(text(&file, "start_time") <= text(&file, "end_time"));
}

#[test]
fn digests_are_those_of_the_standard() {
    // FIPS 180-2, appendix B.1: SHA-256 of "abc".
    let file = tempfile::NamedTempFile::new().unwrap();
    fs::write(file.path(), "abc").unwrap();
    assert_eq!(
        InputFile::read(file.path()).unwrap().sha256,
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    );
}

#[test]
fn an_existing_file_is_replaced_only_on_demand_and_only_by_a_complete_one() {
    let (directory, path) = place("run.h5");
    fs::write(&path, "precious").unwrap();
    let error = RunWriter::create(&path, false, &small()).unwrap_err();
    assert_eq!(error, RunFileError::Exists(path.clone()));
    assert!(error.to_string().contains("--force"), "{error}");

    // A header that does not fit must not cost the old file, even with --force.
    let mut wrong = small();
    wrong.pin_base.pop();
    let error = RunWriter::create(&path, true, &wrong).unwrap_err();
    assert_eq!(error.to_string(), "pin base has 19 values, expected 20 for this mesh");
    assert_eq!(fs::read(&path).unwrap(), b"precious");
    assert_eq!(entries(directory.path()), ["run.h5"]);

    RunWriter::create(&path, true, &small()).unwrap().finish(&End::Interrupted, &[], None).unwrap();
    assert_eq!(text(&hdf5::File::open(&path).unwrap(), "state"), "interrupted");
    assert_eq!(entries(directory.path()), ["run.h5"]);
}

#[test]
fn an_output_that_cannot_be_made_is_named() {
    use std::os::unix::ffi::OsStrExt;
    let (directory, file) = place("file");
    fs::write(&file, "").unwrap();
    let said = |path: &Path, replace: bool| {
        let error = RunWriter::create(path, replace, &small()).unwrap_err().to_string();
        error.replace(&directory.path().display().to_string(), "[directory]")
    };
    // Not even the superuser makes files in /proc; HDF5 takes no name that is no UTF-8.
    let told = [
        said(&directory.path().join("missing/run.h5"), false),
        said(&file.join("run.h5"), false),
        said(Path::new("/proc/run.h5"), false),
        said(&directory.path().join(std::ffi::OsStr::from_bytes(b"run\xff.h5")), false),
        said(directory.path(), true),
        said(Path::new("/dev/null"), true),
    ];
    assert_eq!(entries(directory.path()), ["file"]);
    insta::assert_snapshot!(told.join("\n"));
}

#[test]
fn maps_that_do_not_fit_are_refused_and_the_run_goes_on() {
    let (_directory, path) = place("run.h5");
    let header = small();
    let mut writer = RunWriter::create(&path, false, &header).unwrap();
    let mut lacking = snapshot(&header, 1.0);
    lacking.maps.retain(|(map, _)| *map != Map::PinHeight);
    let error = writer.snapshot(lacking).unwrap_err();
    assert!(error.to_string().starts_with("a snapshot lacks the map pin_height,"), "{error}");
    let mut short = snapshot(&header, 1.0);
    short.maps[0].1 = MapValues::Float(vec![0.0; 47]);
    let error = writer.snapshot(short).unwrap_err();
    assert_eq!(error.to_string(), "disc_height has 47 values, expected 48 for this mesh");
    writer.snapshot(snapshot(&header, 2.0)).unwrap();
    assert_eq!(writer.finish(&End::Finished, &[], None).unwrap().snapshots, 1);
}

#[test]
fn a_run_that_is_given_up_is_marked_failed() {
    let (_directory, path) = place("run.h5");
    let mut writer = RunWriter::create(&path, false, &small()).unwrap();
    writer.sample(sample(1)).unwrap();
    drop(writer);
    let file = hdf5::File::open(&path).unwrap();
    assert_eq!(text(&file, "state"), "failed");
    assert_eq!(file.dataset("time").unwrap().size(), 1);
}

/// For the scripts in tests/python: `RUN_FILE=run.h5 cargo test … -- --ignored --exact run_file::writes_a_run_for_the_readers`.
#[test]
#[ignore = "writes the file named by RUN_FILE, for three seconds"]
fn writes_a_run_for_the_readers() {
    let header = header(40, 600, 80, &Map::ALL);
    let mut writer = RunWriter::create(&run_file(), false, &header).unwrap();
    for step in 1..=300 {
        if step % 100 == 1 {
            writer.snapshot(snapshot(&header, (step / 100) as f64)).unwrap();
        }
        writer.sample(sample(step)).unwrap();
        std::thread::sleep(Duration::from_millis(10));
    }
    println!("{:?}", writer.finish(&End::Finished, &[], None).unwrap());
}
