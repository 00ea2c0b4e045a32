//! Run files are read back as they were sent; what is none, or is damaged, is told.

use std::fs;
use std::path::{Path, PathBuf};

use hdf5::Extents;
use hdf5::types::VarLenUnicode;

use crate::fixtures::{header, place, sample, small, snapshot};
use plateau_core::observe::{Map, QUANTITIES};
use plateau_io::run_file::{End, ReadError, RunFile, RunWriter, State};

/// A run of 100 samples and two moments with maps.
fn write(path: &Path, maps: &[Map]) {
    let header = header(4, 12, 5, maps);
    let mut writer = RunWriter::create(path, false, &header).unwrap();
    writer.snapshot(snapshot(&header, 0.0)).unwrap();
    (1..=100).for_each(|step| writer.sample(sample(step)).unwrap());
    writer.snapshot(snapshot(&header, 25.0)).unwrap();
    writer.finish(&End::Finished, &[], None).unwrap();
}

fn refused(path: &Path) -> ReadError {
    RunFile::open(path).map(|_| ()).expect_err("must be refused")
}

/// A file with these bytes.
fn file(folder: &tempfile::TempDir, name: &str, content: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    path
}

#[test]
fn a_finished_run_is_read_as_it_was_sent() {
    let (_folder, path) = place("run.h5");
    write(&path, &Map::ALL);
    let run = RunFile::open(&path).unwrap();
    assert_eq!((run.title(), run.state()), ("Größe", State::Finished));
    assert_eq!(run.attribute("host").as_deref(), Some("bench"));
    assert_eq!(run.number("workers"), Some(2.0));
    assert_eq!((run.attribute("error"), run.number("nothing")), (None, None));
    assert_eq!(*run.mesh(), header(4, 12, 5, &[]).mesh);
    assert_eq!(run.time(), (1..=100).map(|step| 0.25 * f64::from(step)).collect::<Vec<_>>());
    assert_eq!(run.map_time(), [0.0, 25.0]);
    assert_eq!(run.series().len(), QUANTITIES.len());
    assert!(run.series().iter().zip(QUANTITIES).all(|(series, quantity)| series.name == quantity.name));
    for quantity in QUANTITIES {
        let series = run.series().iter().find(|series| series.name == quantity.name).unwrap();
        assert_eq!((series.unit.as_str(), series.long_name.as_str()), (quantity.unit, quantity.long_name));
        let sent: Vec<f64> = (1..=100).map(|step| quantity.value(&sample(step))).collect();
        assert_eq!(run.values(quantity.name).unwrap(), Some(sent), "{}", quantity.name);
    }
    for (index, time) in [(0, 0.0), (1, 25.0)] {
        for (map, values) in snapshot(&small(), time).maps {
            assert_eq!(run.map(map, index).unwrap(), Some(values), "{} at {time} s", map.name());
        }
    }
    assert!(run.map(Map::Pressure, 2).is_err());
}

#[test]
fn what_was_not_recorded_is_not_there() {
    let (_folder, path) = place("run.h5");
    write(&path, &[Map::DiscHeight]);
    let run = RunFile::open(&path).unwrap();
    assert_eq!(run.values("disc_sa").unwrap(), None);
    assert!(run.has_map(Map::DiscHeight) && !run.has_map(Map::Pressure));
    assert_eq!(run.map(Map::Pressure, 0).unwrap(), None);
}

#[test]
fn a_run_that_goes_on_is_read_up_to_its_last_complete_sample() {
    let (folder, path) = place("run.h5");
    let header = small();
    let mut writer = RunWriter::create(&path, false, &header).unwrap();
    (1..=10).for_each(|step| writer.sample(sample(step)).unwrap());
    let patience = std::time::Instant::now();
    // A copy, since the HDF5 library opens a file only once in a process; it is what a killed run leaves.
    let copy = folder.path().join("copy.h5");
    let samples = loop {
        fs::copy(&path, &copy).unwrap();
        let run = RunFile::open(&copy).unwrap();
        assert_eq!(run.state(), State::Running);
        let samples = run.time().len();
        assert_eq!(run.values("pool").unwrap().unwrap().len(), samples);
        if samples > 0 || patience.elapsed().as_secs() > 60 {
            break samples;
        }
    };
    assert!(samples > 0, "the samples must arrive");
    writer.finish(&End::Interrupted, &[], None).unwrap();
    assert_eq!(RunFile::open(&path).unwrap().state(), State::Interrupted);
}

#[test]
fn what_is_no_run_file_is_told() {
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(refused(&folder.path().join("absent.h5")), ReadError::System { .. }));
    assert!(matches!(refused(folder.path()), ReadError::System { .. }));
    assert!(matches!(refused(&file(&folder, "empty.h5", b"")), ReadError::NotHdf5 { .. }));
    assert!(matches!(refused(&file(&folder, "text.h5", b"version = 1\n")), ReadError::NotHdf5 { .. }));
    let foreign = folder.path().join("foreign.h5");
    hdf5::File::create(&foreign).unwrap().new_dataset::<f64>().shape(3).create("time").unwrap();
    assert_eq!(
        refused(&foreign).to_string(),
        format!("{} is not a run file of plateau: it has no root attribute format_version", foreign.display())
    );
}

#[test]
fn a_damaged_run_file_is_told() {
    let (folder, whole) = place("whole.h5");
    write(&whole, &Map::ALL);
    let content = fs::read(&whole).unwrap();
    let cut = file(&folder, "cut.h5", &content[..content.len() / 2]);
    assert!(matches!(refused(&cut), ReadError::Damaged { .. }));

    let change = |name: &str, change: &dyn Fn(&hdf5::File)| {
        let path = file(&folder, name, &content);
        let file = hdf5::File::open_rw(&path).unwrap();
        change(&file);
        file.close().unwrap();
        path
    };
    let newer = change("newer.h5", &|file| file.attr("format_version").unwrap().write_scalar(&2).unwrap());
    assert!(matches!(refused(&newer), ReadError::Newer(_, 2)));
    // An attribute without data is not what the memory held before.
    let empty = change("empty_attributes.h5", &|file| {
        for name in ["workers", "host"] {
            file.delete_attr(name).unwrap();
        }
        file.new_attr::<i64>().shape(Extents::Null).create("workers").unwrap();
        file.new_attr::<VarLenUnicode>().shape(Extents::Null).create("host").unwrap();
    });
    let empty = RunFile::open(&empty).unwrap();
    assert_eq!((empty.number("workers"), empty.attribute("host")), (None, None));
    let no_version = change("no_version.h5", &|file| {
        file.delete_attr("format_version").unwrap();
        file.new_attr::<i64>().shape(Extents::Null).create("format_version").unwrap();
    });
    assert!(matches!(refused(&no_version), ReadError::Foreign { .. }));
    let short = change("short.h5", &|file| file.dataset("series/pool").unwrap().resize(5).unwrap());
    let short = RunFile::open(&short).unwrap();
    assert!(matches!(short.values("pool"), Err(ReadError::Damaged { .. })));
    assert!(short.values("emitted").is_ok());
    let lacking = change("lacking.h5", &|file| file.unlink("radius").unwrap());
    assert!(matches!(refused(&lacking), ReadError::Foreign { .. }));
}

/// The file that makes the HDF5 library go round for ever is refused before it is opened.
#[test]
fn a_global_heap_without_end_is_refused() {
    let (folder, path) = place("run.h5");
    write(&path, &[]);
    let mut content = fs::read(&path).unwrap();
    let heap = content.windows(5).position(|bytes| bytes == b"GCOL\x01").unwrap();
    // The first object of the heap becomes free space of size 0.
    content[heap + 16..heap + 32].fill(0);
    let message = refused(&file(&folder, "endless.h5", &content)).to_string();
    assert!(message.contains(&format!("global heap is damaged at byte {}", heap + 16)), "{message}");
}
