//! What is read is in the file that is named, so that its digest is that of all that was read; and what is no such file is
//! refused at once.

use std::fs;
use std::path::Path;

use hdf5::File;
use plateau_tests::program::{DISC, Outcome, WorkingDirectory, quick_scene_with, run_words, scene};
use plateau_tests::run_file::{changed, created};

const SHAPE: (usize, usize) = (690, 20);

/// Makes an HDF5 file.
fn hdf5_file(path: &Path, fill: impl FnOnce(&File) -> hdf5::Result<()>) {
    let file = created(path);
    fill(&file).unwrap();
    file.close().unwrap();
}

fn heights(file: &File, name: &str) -> hdf5::Result<()> {
    file.new_dataset::<f64>().shape(SHAPE).create(name)?.write_raw(&vec![1e-6; SHAPE.0 * SHAPE.1])
}

/// Every command that reads a surface, told to read this one.
fn read_as_surface(directory: &WorkingDirectory, file: &str) -> Vec<Outcome> {
    let output = format!("run-of-{file}").replace('/', "-");
    directory.write("scene.toml", quick_scene_with(&[(DISC, &format!("file = \"{file}\""))]));
    let commands: [&[&str]; 3] = [&["surface", file], &["check", "scene.toml"], &["run", "scene.toml", "-o", &output]];
    commands.map(|command| directory.limited(command)).into()
}

/// Every command that reads a run file.
fn read_as_run(directory: &WorkingDirectory, file: &str) -> Vec<Outcome> {
    let commands: [&[&str]; 4] = [&["verify", file], &["repair", file], &["summary", file], &["watch", file, "--once"]];
    commands.map(|command| directory.limited(command)).into()
}

fn assert_ends(outcomes: Vec<Outcome>, status: &[i32], said: &str) {
    for outcome in outcomes {
        let text = [outcome.stderr.as_str(), &outcome.stdout].concat();
        let is_known = outcome.status.is_some_and(|found| status.contains(&found));
        assert!(is_known && text.contains(said), "{said}: {outcome:?}");
    }
}

#[test]
fn surfaces_that_are_in_other_files_are_refused_with_what_they_point_to() {
    let directory = WorkingDirectory::new();
    hdf5_file(&directory.path("other.h5"), |file| heights(file, "height"));
    hdf5_file(&directory.path("link.h5"), |file| file.link_external("other.h5", "/height", "height"));
    directory.fifo("fifo");
    hdf5_file(&directory.path("deep.h5"), |file| {
        heights(file, "mine")?;
        file.create_group("deep")?.link_external("fifo", "/height", "height")
    });
    for (name, source) in [("virtual.h5", "other.h5"), ("waits.h5", "fifo"), ("circle.h5", "circle.h5")] {
        hdf5_file(&directory.path(name), |file| {
            let made = file.new_dataset::<f64>().shape(SHAPE);
            made.with_dcpl(|list| list.virtual_map(source, "height", SHAPE, (.., ..), SHAPE, (.., ..)))
                .create("height")?;
            Ok(())
        });
    }
    fs::write(directory.path("raw.bin"), vec![0; 8 * SHAPE.0 * SHAPE.1]).unwrap();
    hdf5_file(&directory.path("raw.h5"), |file| {
        let made = file.new_dataset::<f64>().shape(SHAPE);
        made.with_dcpl(|list| list.external("raw.bin", 0, 8 * SHAPE.0 * SHAPE.1)).create("height")?;
        Ok(())
    });
    for (file, said) in [
        ("link.h5", "/height links to /height in other.h5"),
        ("deep.h5", "/deep/height links to /height in fifo"),
        ("virtual.h5", "/height is a virtual dataset, made of height in other.h5"),
        ("waits.h5", "/height is a virtual dataset, made of height in fifo"),
        ("circle.h5", "/height is a virtual dataset, made of height in circle.h5"),
        ("raw.h5", "/height has its data in raw.bin"),
    ] {
        assert_ends(read_as_surface(&directory, file), &[2], said);
    }
    // What they point to is read.
    assert_ends(read_as_surface(&directory, "other.h5"), &[0], "");
}

#[test]
fn links_in_a_circle_and_shapes_without_data_do_no_harm() {
    let directory = WorkingDirectory::new();
    hdf5_file(&directory.path("circle.h5"), |file| {
        heights(file, "height")?;
        let inner = file.create_group("inner")?;
        for number in 0..30 {
            inner.link_hard("/inner", &format!("again{number}"))?;
            inner.link_soft(&format!("/inner/soft{}", number + 1), &format!("soft{number}"))?;
        }
        inner.link_soft("/height", "soft30")
    });
    assert_ends(read_as_surface(&directory, "circle.h5"), &[0], "");
    directory.limited(["surface", "circle.h5", "--dataset", "/inner/soft0"]).ends(2, &[]);
    directory.limited(["surface", "circle.h5", "--dataset", "/inner/soft30"]).ends(0, &[]);
    // As many points as are read at most, 2 GiB of them, in a file of some kilobytes.
    hdf5_file(&directory.path("hollow.h5"), |file| {
        file.new_dataset::<f64>().chunk((64, 64)).shape((1 << 14, 1 << 14)).create("height")?;
        Ok(())
    });
    assert_ends(read_as_surface(&directory, "hollow.h5"), &[2], "bytes in the file");
}

#[test]
fn run_files_must_be_whole_too() {
    let directory = WorkingDirectory::new();
    directory.plateau(run_words("quick.toml", "run.h5", &["operation.duration=2 s"], &[])).ends(0, &[]);
    let with_change = |name: &str, change: fn(&File) -> hdf5::Result<()>| {
        fs::copy(directory.path("run.h5"), directory.path(name)).unwrap();
        let file = changed(directory.path(name));
        change(&file).unwrap();
        file.close().unwrap();
    };
    with_change("link.h5", |file| {
        file.unlink("time")?;
        file.link_external("run.h5", "/time", "time")
    });
    assert_ends(read_as_run(&directory, "link.h5"), &[2], "/time links to /time in run.h5");
    with_change("hollow.h5", |file| {
        file.unlink("time")?;
        file.new_dataset::<f64>().chunk(1024).shape(1_usize << 40).create("time")?;
        Ok(())
    });
    assert_ends(read_as_run(&directory, "hollow.h5"), &[1, 2], "bytes in the file");
}

#[test]
fn pipes_and_devices_are_refused_and_not_waited_for() {
    let directory = WorkingDirectory::new();
    directory.fifo("fifo");
    for file in ["fifo", "/dev/zero"] {
        let text = "regular file";
        assert_ends(read_as_run(&directory, file), &[2], text);
        assert_ends(read_as_surface(&directory, file), &[2], text);
        for command in [&["run", file][..], &["check", file], &["sweep", "run", file]] {
            assert_ends(vec![directory.limited(command)], &[2], text);
        }
    }
    // Where a checkpoint or the lock would be.
    for name in ["run.h5.checkpoint", "run.h5.lock"] {
        fs::rename(directory.path("fifo"), directory.path(name)).unwrap();
        for more in ["--force", "--resume"] {
            directory.limited(["run", &scene("quick.toml"), "-o", "run.h5", more]).ends(2, &[name]);
        }
        fs::rename(directory.path(name), directory.path("fifo")).unwrap();
    }
}
