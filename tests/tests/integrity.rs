//! What a run file holds is what was written, or `plateau verify` names what is not.

use std::fs;

use hdf5::H5Type;
use hdf5::types::VarLenUnicode;
use plateau_tests::program::{WorkingDirectory, kill, run_words, scene, start, wait_until};
use plateau_tests::run_file::{RunFile, changed, differences};
use plateau_tests::scenes::Stream;

/// A short run with maps of two moments.
fn run(directory: &WorkingDirectory, file: &str) {
    let settings = ["operation.duration=20 s", "output.maps_at=[\"0 s\"]"];
    directory.plateau(run_words("quick.toml", file, &settings, &[])).quiet_success();
}

fn verdict(directory: &WorkingDirectory, file: &str) -> (Option<i32>, serde_json::Value) {
    let outcome = directory.plateau(["verify", file, "--json"]);
    let document: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap_or_default();
    (outcome.status, document[0].clone())
}

#[test]
fn a_flipped_bit_is_found_or_changes_nothing() {
    let directory = WorkingDirectory::new();
    run(&directory, "run.h5");
    assert_eq!(verdict(&directory, "run.h5").1["verdict"], "intact");
    let whole = fs::read(directory.path("run.h5")).unwrap();
    let content = directory.run_file("run.h5").content();
    let mut random = Stream(12);
    let mut found = 0;
    for _ in 0..150 {
        let mut bytes = whole.clone();
        let (at, bit) = ((random.uniform() * bytes.len() as f64) as usize, (random.uniform() * 8.0) as u32);
        bytes[at] ^= 1 << bit;
        directory.write("flipped.h5", &bytes);
        let (status, document) = verdict(&directory, "flipped.h5");
        match status {
            Some(0) => {
                let flipped = directory.run_file("flipped.h5");
                assert_eq!(differences(&content, &flipped.content()), [""; 0], "bit {bit} of byte {at}");
            }
            // A file that is no longer known as a run file has nothing more to be named.
            Some(2) => found += 1,
            Some(1) => {
                assert_eq!(document["verdict"], "damaged", "bit {bit} of byte {at}");
                assert_ne!(document["damage"][0]["place"], "", "bit {bit} of byte {at}");
                found += 1;
            }
            other => panic!("{other:?} for bit {bit} of byte {at}"),
        }
    }
    // Nearly all of a file is data.
    assert!(found > 100, "{found}");
}

#[test]
fn what_is_damaged_is_named() {
    let directory = WorkingDirectory::new();
    run(&directory, "run.h5");
    let whole = fs::read(directory.path("run.h5")).unwrap();
    // The title is a text of which HDF5 keeps no checksum.
    let title = b"Quick look";
    let at = whole.windows(title.len()).position(|bytes| bytes == title).unwrap();
    let mut bytes = whole.clone();
    bytes[at] ^= 1;
    directory.write("title.h5", &bytes);
    let (status, document) = verdict(&directory, "title.h5");
    assert_eq!((status, &document["damage"][0]["place"]), (Some(1), &"attributes".into()), "{document}");

    // What HDF5 sees nothing wrong with: values written by somebody else.
    directory.write("value.h5", &whole);
    let file = changed(directory.path("value.h5"));
    file.dataset("series/pool").unwrap().write_slice(&[1.0], 3..4).unwrap();
    file.close().unwrap();
    let (status, document) = verdict(&directory, "value.h5");
    assert_eq!((status, &document["damage"][0]["place"]), (Some(1), &"/series/pool".into()), "{document}");

    // Values and maps behind those that have a time: a dataset cannot grow any more, but another one can take its place.
    for path in ["series/pool", "pin/pressure", "disc/height"] {
        directory.write("longer.h5", &whole);
        let file = changed(directory.path("longer.h5"));
        let mut shape = file.dataset(path).unwrap().shape();
        assert!(file.dataset(path).unwrap().resize(shape.iter().map(|length| length + 1).collect::<Vec<_>>()).is_err());
        shape[0] += 1;
        file.unlink(path).unwrap();
        file.new_dataset::<f64>().shape(shape).create(path).unwrap();
        file.close().unwrap();
        let (status, document) = verdict(&directory, "longer.h5");
        assert_eq!((status, &document["damage"][0]["place"]), (Some(1), &format!("/{path}").into()), "{document}");
        let problem = document["damage"][0]["problem"].as_str().unwrap();
        assert!(problem.starts_with("it is longer than what was written"), "{document}");
    }

    // A link that leads elsewhere.
    directory.write("link.h5", &whole);
    let file = changed(directory.path("link.h5"));
    file.unlink("series/time").unwrap();
    file.link_soft("/radius", "series/time").unwrap();
    file.close().unwrap();
    let (status, document) = verdict(&directory, "link.h5");
    assert_eq!((status, &document["damage"][0]["place"]), (Some(1), &"attributes".into()), "{document}");
    let both = directory.plateau(["verify", "run.h5", "value.h5"]).ends(1, &[]);
    assert!(both.stdout.contains("intact") && both.stdout.contains("/series/pool: it is not what was written"));
    let scene = scene("quick.toml");
    directory.plateau(["verify", &scene]).ends(2, &[&format!("which `plateau run {scene}` writes")]);
}

/// Makes the file what somebody else may make of it.
fn edit(directory: &WorkingDirectory, from: &str, to: &str, edit: impl Fn(&hdf5::File)) {
    fs::copy(directory.path(from), directory.path(to)).unwrap();
    let file = changed(directory.path(to));
    edit(&file);
    file.close().unwrap();
}

fn set<T: H5Type>(file: &hdf5::File, name: &str, value: T) {
    file.delete_attr(name).unwrap();
    file.new_attr::<T>().create(name).unwrap().write_scalar(&value).unwrap();
}

#[test]
fn numbers_among_the_attributes_are_what_was_written() {
    let directory = WorkingDirectory::new();
    run(&directory, "run.h5");
    let places = |what: &str, change: &dyn Fn(&hdf5::File)| {
        edit(&directory, "run.h5", "changed.h5", change);
        let (status, document) = verdict(&directory, "changed.h5");
        assert_eq!(status, Some(1), "{what}: {document}");
        let damage = document["damage"].as_array().unwrap().iter();
        damage.map(|damage| damage["place"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    let (attributes, numbers) = ("attributes", "numbers among the attributes");
    let execution = "attributes of machine and time";
    let text =
        |file: &hdf5::File, name: &str| set::<VarLenUnicode>(file, name, "2001-01-01T00:00:00Z".parse().unwrap());
    assert_eq!(places("workers", &|file| set(file, "workers", 64_i64)), [execution]);
    assert_eq!(places("wall_time", &|file| set(file, "wall_time", 1e-3)), [execution]);
    let machine = ["decomposition", "workers", "host", "instruction_set"];
    for name in machine.into_iter().chain(["wall_time", "start_time", "end_time", "execution_sha256"]) {
        assert_eq!(places(name, &|file| file.delete_attr(name).unwrap()), [execution], "{name}");
    }
    assert_eq!(places("start_time", &|file| text(file, "start_time")), [execution]);
    let more = |file: &hdf5::File| file.new_attr::<f64>().create("more").unwrap().write_scalar(&1.0).unwrap();
    assert_eq!(places("more", &more), [numbers]);
    let flags = |file: &hdf5::File| file.dataset("disc/status").unwrap().delete_attr("flag_values").unwrap();
    assert_eq!(places("flag_values", &flags), [numbers]);
    // The digest that tells of the others is itself told of.
    let without = |file: &hdf5::File| {
        file.delete_attr("numbers_sha256").unwrap();
        set(file, "workers", 64_i64);
    };
    assert_eq!(places("numbers_sha256", &without), [attributes]);
    // A number of another width is the same number.
    edit(&directory, "run.h5", "width.h5", |file| {
        let workers = file.attr("workers").unwrap().read_scalar::<i64>().unwrap();
        set(file, "workers", i32::try_from(workers).unwrap());
        set(file, "format_version", 1_i64);
    });
    assert_eq!(verdict(&directory, "width.h5").1["verdict"], "intact");
}

#[test]
fn a_format_version_that_is_none_is_refused() {
    let directory = WorkingDirectory::new();
    run(&directory, "run.h5");
    for (version, found) in [(f64::NAN, "NaN"), (f64::NEG_INFINITY, "-inf"), (1.5, "1.5"), (0.0, "0"), (-1.0, "-1")] {
        edit(&directory, "run.h5", "version.h5", |file| set(file, "format_version", version));
        let said = format!("its format_version is {found}, expected a whole number from 1 to 1");
        directory.plateau(["summary", "version.h5"]).ends(2, &[&said]);
        let (status, document) = verdict(&directory, "version.h5");
        assert_eq!((status, &document["verdict"]), (Some(1), &"damaged".into()), "{version}: {document}");
    }
    edit(&directory, "run.h5", "version.h5", |file| set(file, "format_version", i64::MIN));
    let watched = directory.plateau(["watch", "version.h5", "--once"]).stderr;
    assert!(watched.contains("is -9.223372036854776e18, expected a whole"), "{watched}");
    edit(&directory, "run.h5", "version.h5", |file| set(file, "format_version", 2_u8));
    assert!(directory.plateau(["verify", "version.h5"]).stderr.contains("format_version 2, expected at most 1"));
}

#[test]
fn a_killed_run_is_repaired_and_a_healthy_file_is_left_alone() {
    let directory = WorkingDirectory::new();
    let long = ["--set", "operation.duration=1 h", "--set", "numerics.time_acceleration=1"];
    let arguments = ["run", &scene("quick.toml"), "-o", "run.h5"];
    let child = start(directory.command(arguments.iter().chain(&long)));
    let file = directory.path("run.h5");
    assert!(wait_until(|| RunFile::follow(&file).is_ok_and(|run| run.shape("/time")[0] > 1)));
    let live = fs::read(&file).unwrap().len();
    directory.plateau(["repair", "run.h5"]).ends(2, &[&format!("being written by process {}", child.id())]);
    for more in ["--force", "--resume"] {
        directory.plateau(arguments.iter().chain(&[more])).ends(2, &[]);
    }
    kill(child);
    assert_eq!(verdict(&directory, "run.h5").1["verdict"], "not-closed");
    let before = fs::read(&file).unwrap();
    assert!(before.len() >= live);
    let samples = RunFile::follow(&file).unwrap().floats("/time");

    directory.plateau(["repair", "run.h5"]).ends(0, &[]);
    let run = RunFile::open(&file);
    assert_eq!((run.text("state").as_str(), run.floats("/time")), ("interrupted", samples));
    let document = verdict(&directory, "run.h5").1;
    assert_eq!((&document["verdict"], &document["covers_numbers"]), (&"intact".into(), &true.into()), "{document}");
    assert!(fs::read(directory.path("run.h5.before-repair")).unwrap() == before);

    let healthy = directory.content();
    assert!(directory.plateau(["repair", "run.h5"]).quiet_success().contains("healthy"));
    assert!(directory.content() == healthy);
}
