//! Bad input, through the program: exit status 2, one clear message, nothing written or damaged.

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};

use hdf5::H5Type;
use ndarray::{Array2, ArrayView2};
use plateau_tests::program::{DISC, Outcome, WorkingDirectory, quick_scene_with, run};
use plateau_tests::run_file::created;

/// One wrong input: what is put into the working directory, and what the program is asked then.
struct Case {
    name: &'static str,
    prepare: Box<dyn Fn(&WorkingDirectory)>,
    arguments: Vec<&'static str>,
}

fn case(name: &'static str, arguments: &[&'static str], prepare: impl Fn(&WorkingDirectory) + 'static) -> Case {
    Case { name, prepare: Box::new(prepare), arguments: arguments.to_vec() }
}

/// `quick.toml` with one piece of its text replaced.
fn edited(name: &'static str, old: &'static str, new: &'static str) -> Case {
    case(name, &["run", "scene.toml"], move |directory| {
        directory.write("scene.toml", quick_scene_with(&[(old, new)]));
    })
}

/// `quick.toml` with the disc's heights from a file that `make` puts there.
fn disc_file(name: &'static str, source: &'static str, make: impl Fn(&WorkingDirectory) + 'static) -> Case {
    case(name, &["run", "scene.toml"], move |directory| {
        directory.write("scene.toml", quick_scene_with(&[(DISC, source)]));
        make(directory);
    })
}

/// Writes a dataset `/heights` of this shape (columns, rows) into `surface.h5`.
fn heights<T: H5Type + Clone>(directory: &WorkingDirectory, shape: (usize, usize), values: impl Fn(usize) -> T) {
    let values = Array2::from_shape_fn(shape, |(column, row)| values(column * shape.1 + row));
    let file = created(directory.path("surface.h5"));
    file.new_dataset_builder().with_data(ArrayView2::from(&values)).create("heights").unwrap();
    file.close().unwrap();
}

/// Heights in `/heights` for the whole ring of `quick.toml`.
fn ring(directory: &WorkingDirectory, height: impl Fn(usize) -> f64) {
    heights(directory, (690, 20), height);
}

/// An SDF file (ISO 25178-71) of 60 by 24 points 50 µm apart, as ASCII, with its first points not measured.
fn sdf(missing: usize) -> String {
    let points =
        (0..60 * 24).map(|point| if point < missing { "BAD".into() } else { (point * 7919 % 3000).to_string() });
    format!(
        "aISO-1.0\nManufacID = Plateau\nCreateDate = 010120260000\nModDate = 010120260000\nNumPoints = 60\n\
         NumProfiles = 24\nXscale = 5e-5\nYscale = 5e-5\nZscale = 1e-9\nZresolution = 1e-9\nCompression = 0\n\
         DataType = 6\nCheckType = 0\n*\n{}\n*\n",
        points.collect::<Vec<_>>().join("\n")
    )
}

const SDF_SOURCE: &str = "file = \"surface.sdf\"";
const H5_SOURCE: &str = "file = \"surface.h5\"";

fn nothing(_: &WorkingDirectory) {}

fn text_in_place(directory: &WorkingDirectory) {
    directory.write("run.h5", "no HDF5");
}

fn quick(directory: &WorkingDirectory) {
    directory.write("scene.toml", quick_scene_with(&[]));
}

fn measured(directory: &WorkingDirectory) {
    directory.write("surface.sdf", sdf(0));
}

/// The quick scene with the disc of an SDF file.
fn of_sdf(directory: &WorkingDirectory) {
    directory.write("scene.toml", quick_scene_with(&[(DISC, SDF_SOURCE)]));
    measured(directory);
}

fn command_lines() -> Vec<Case> {
    vec![
        case("unknown command", &["simulate"], nothing),
        case("no scene", &["run"], nothing),
        case("unknown option", &["run", "scene.toml", "--fast"], quick),
        case("option without its value", &["run", "scene.toml", "--set"], quick),
        case("two scenes", &["run", "scene.toml", "scene.toml"], quick),
        case("scene without a command", &["scene.toml"], quick),
        case("run file without a command", &["run.h5"], nothing),
        case("set with a space", &["run", "scene.toml", "--set", "operation.normal_force=20", "N"], quick),
        case("shell that is none", &["completions", "tcsh"], nothing),
        case("set of no key", &["run", "scene.toml", "--set", "20 N"], quick),
        case("set of an unknown key", &["run", "scene.toml", "--set", "mesh.row=3"], quick),
        case("no workers", &["run", "scene.toml", "--workers", "0"], quick),
        case("workers that are no number", &["run", "scene.toml", "--workers", "many"], quick),
        case("unknown instruction set", &["run", "scene.toml", "--isa", "nonsense"], quick),
        case("run file is missing", &["summary", "run.h5"], nothing),
        case("run file is a text", &["summary", "run.h5"], text_in_place),
        case("text that is watched", &["watch", "run.h5"], text_in_place),
        case("run file of something else", &["summary", "surface.h5"], |directory| ring(directory, |_| 0.0)),
        case("no patience", &["watch", "run.h5", "--timeout", "0"], nothing),
        case("manual pages into a file", &["man", "-o", "scene.toml"], quick),
        // Not even the superuser makes files there.
        case("manual pages where none can be", &["man", "-o", "/proc/man1"], nothing),
        case("picture where none can be", &["surface", "--prepare", "scene.toml", "--plot", "/proc/a.png"], quick),
        case("no instruction set", &["run", "scene.toml", "--isa"], quick),
        // The command that was meant is told, and of the version how it is asked for.
        case("mistyped run", &["rnu"], nothing),
        case("mistyped check", &["chekc"], nothing),
        case("mistyped sweep", &["swep"], nothing),
        case("mistyped command of a command", &["sweep", "rnu", "study.toml"], nothing),
        case("version as a command", &["version"], nothing),
        // What is named in the place of something else is told by what it is.
        case("comma in a decimal", &["surface", "scene.toml", "--pitch", "0,02 mm"], quick),
        case("unknown debris", &["check", "scene.toml", "--set", "plateaus.debris=globl"], quick),
        case("quiet and talkative", &["run", "scene.toml", "-q", "-v"], quick),
        case("quiet without a scene", &["run", "nothing.toml", "-q"], nothing),
        case("pitch of SDF", &["surface", "surface.sdf", "--pitch", "2 um", "--json"], measured),
        case("pitch without a unit", &["surface", "heights.npy", "--pitch", "2"], nothing),
        case("no pitch", &["surface", "heights.npy", "--pitch", "0 um"], nothing),
        case("pitch of a force", &["surface", "heights.npy", "--pitch", "1 um, 2 N"], nothing),
        case("pitch is needed", &["surface", "a.txt", "--unit", "um", "--to", "a.sdf"], |directory| {
            directory.write("a.txt", "1 2 3\n2 3 1\n");
        }),
        case("unknown level", &["surface", "surface.sdf", "--level", "cubic"], measured),
        case("time of no run", &["surface", "surface.sdf", "--at", "1 s"], measured),
        case("preparation of no scene", &["surface", "--prepare", "bad.toml"], |directory| {
            directory.write("bad.toml", "version = 1\n");
        }),
        case("picture into no folder", &["surface", "surface.sdf", "--plot", "nowhere/a.png"], measured),
        case("picture of no format", &["surface", "surface.sdf", "--plot", "a.jpg"], measured),
        case("surface of no format", &["surface", "surface.sdf", "--to", "a.bmp"], measured),
        case("two surfaces into one", &["surface", "surface.sdf", "surface.sdf", "--to", "a.sdf"], measured),
        case("new scene is there", &["new", "scene.toml"], quick),
        case("load in mm", &["new", "other.toml", "--load", "30 mm"], nothing),
        case("negative load", &["new", "other.toml", "--load=-3 N"], nothing),
        case("two shapes", &["new", "other.toml", "--diameter", "5 mm", "--pin-width", "5 mm"], nothing),
        case("scene as a disc", &["new", "other.toml", "--disc", "scene.toml"], quick),
        case("scene as its own disc", &["new", "scene.toml", "--force", "--disc", "scene.toml"], quick),
        // By the option that was given.
        case("pin wider than the ring", &["new", "wide.toml", "--diameter", "60 mm"], nothing),
        case("pin nearly as wide", &["new", "wide.toml", "--diameter", "43.9 mm"], nothing),
        case("pin longer than the ring", &["new", "wide.toml", "--pin-length", "200 mm"], nothing),
    ]
}

fn scenes() -> Vec<Case> {
    let mut cases = vec![
        case("scene is missing", &["run", "scene.toml"], nothing),
        case("scene is a directory", &["run", "scene.toml"], |directory| {
            fs::create_dir(directory.path("scene.toml")).unwrap();
        }),
        case("extends in a circle", &["run", "scene.toml"], |directory| {
            directory.write("scene.toml", "version = 1\nextends = \"other.toml\"\n");
            directory.write("other.toml", "version = 1\nextends = \"scene.toml\"\n");
        }),
        case("extends what is missing", &["run", "scene.toml"], |directory| {
            directory.write("scene.toml", "version = 1\nextends = \"other.toml\"\n");
        }),
    ];
    let edits = [
        ("no TOML", "[mesh]", "[mesh"),
        ("key is missing", "normal_force = \"5 N\"\n", ""),
        ("key is unknown", "rows = 20", "row = 20"),
        ("more cells than memory", "disc_columns = 690", "disc_columns = 1000000000000"),
        ("two sources", DISC, "flat = true\nfile = \"surface.h5\""),
        ("number in quotes", "rows = 20", "rows = \"20\""),
        ("key is there twice", "rows = 20", "rows = 20\nrows = 41"),
    ];
    cases.extend(edits.map(|(name, old, new)| edited(name, old, new)));
    cases
}

fn surfaces() -> Vec<Case> {
    vec![
        disc_file("surface is missing", H5_SOURCE, nothing),
        disc_file("points are missing in HDF5", H5_SOURCE, |directory| {
            ring(directory, |point| if point % 1000 == 0 { f64::NAN } else { 1e-6 });
        }),
        disc_file("truncated HDF5", H5_SOURCE, |directory| {
            ring(directory, |_| 0.0);
            let bytes = fs::read(directory.path("surface.h5")).unwrap();
            directory.write("surface.h5", &bytes[..bytes.len() / 2]);
        }),
        disc_file("points are missing in SDF", SDF_SOURCE, |directory| drop(directory.write("surface.sdf", sdf(17)))),
        case("patch shorter than the ring", &["run", "scene.toml"], of_sdf),
        case("patch narrower than the track", &["check", "scene.toml", "--set", "disc.prepare.pixel=20 um"], of_sdf),
        case(
            "patch of three cells",
            &["check", "scene.toml", "--set", "disc.prepare.pixel=7 um", "--set", "disc.prepare.extend=statistics"],
            of_sdf,
        ),
        disc_file("truncated SDF", SDF_SOURCE, |directory| {
            let text = sdf(0);
            directory.write("surface.sdf", &text[..text.len() / 2]);
        }),
    ]
}

fn outputs() -> Vec<Case> {
    let run_into = |output: &'static str| ["run", "scene.toml", "-o", output];
    vec![
        case("output directory is missing", &run_into("results/run.h5"), quick),
        case("output directory is a file", &run_into("scene.toml/run.h5"), quick),
        // Not even the superuser makes files there.
        case("output directory takes no files", &run_into("/proc/run.h5"), quick),
        case("output exists", &run_into("run.h5"), move |directory| {
            quick(directory);
            directory.write("run.h5", "precious");
        }),
        case("output of the scene exists", &["run", "scene.toml"], move |directory| {
            quick(directory);
            directory.write("quick.h5", "precious");
        }),
        case("output is a directory", &["run", "scene.toml", "-o", ".", "--force"], quick),
        case("output is a link to nothing", &run_into("run.h5"), move |directory| {
            quick(directory);
            symlink("nowhere.h5", directory.path("run.h5")).unwrap();
        }),
        case("output is the scene", &["run", "scene.toml", "-o", "./scene.toml", "--force"], quick),
        case("output is a surface", &["run", "scene.toml", "-o", "surface.h5", "--force"], |directory| {
            directory.write("scene.toml", quick_scene_with(&[(DISC, H5_SOURCE)]));
            ring(directory, |_| 0.0);
        }),
        case("bad scene with --force", &["run", "scene.toml", "-o", "run.h5", "--force"], |directory| {
            directory.write("scene.toml", quick_scene_with(&[("rows = 20", "rows = 0")]));
            directory.write("run.h5", "precious");
        }),
        case("bad surface with --force", &["run", "scene.toml", "-o", "run.h5", "--force"], |directory| {
            directory.write("scene.toml", quick_scene_with(&[(DISC, H5_SOURCE)]));
            directory.write("run.h5", "precious");
        }),
    ]
}

/// The message of a wrong input, after checking that it is all that the program left.
fn refusal(directory: &WorkingDirectory, name: &str, outcome: &Outcome) -> String {
    let Outcome { status, stdout, stderr, .. } = outcome;
    assert_eq!(*status, Some(2), "{name}: {stdout}{stderr}");
    assert_eq!(stdout, "", "{name}");
    let message = stderr.strip_prefix("plateau: ").unwrap_or_else(|| panic!("{name}: {stderr}"));
    assert!(!stderr.contains("\nplateau: "), "{name}, more than one message: {stderr}");
    for noise in ["panicked", "RUST_BACKTRACE", "HDF5-DIAG", "warning", "\u{1b}"] {
        assert!(!stderr.contains(noise), "{name}: {stderr}");
    }
    directory.without_path(message)
}

fn without_memory(text: &str) -> String {
    without(text, "of memory and ", " are available", "[memory]")
}

/// Runs the cases and gives their messages for a snapshot.
fn messages(cases: Vec<Case>) -> String {
    let mut messages = Vec::new();
    for Case { name, prepare, arguments } in cases {
        let directory = WorkingDirectory::new();
        prepare(&directory);
        let before = directory.content();
        let message = refusal(&directory, name, &directory.plateau(&arguments));
        assert!(directory.content() == before, "{name}: the program changed {:?}", directory.names());
        if arguments == ["run", "scene.toml"] && !message.contains("--force") {
            let checked = refusal(&directory, name, &directory.plateau(["check", "scene.toml"]));
            // What is free changes from one moment to the next.
            let [checked, message] = [&checked, &message].map(|message| without_memory(message));
            assert_eq!(checked, message, "{name}: `plateau check` says something else");
        }
        messages.push(format!("# {name}: plateau {}\n{message}", arguments.join(" ")));
    }
    let text = without_memory(&messages.join("\n"));
    let text = without(&text, "this processor has ", "\n", "[instruction sets]");
    without(&text, "cannot be read as HDF5: ", "\n", "[what the HDF5 library says]")
}

/// The text with what stands between `start` and `end` replaced: it differs between machines.
fn without(text: &str, start: &str, end: &str, replacement: &str) -> String {
    let Some((before, after)) = text.split_once(start) else { return text.to_owned() };
    let length = after.find(end).unwrap_or(after.len());
    format!("{before}{start}{replacement}{}", &after[length..])
}

#[test]
fn wrong_command_lines_are_refused() {
    insta::assert_snapshot!("command_lines", messages(command_lines()));
}

#[test]
fn bad_scenes_are_refused() {
    insta::assert_snapshot!("scenes", messages(scenes()));
}

#[test]
fn bad_surfaces_are_refused() {
    insta::assert_snapshot!("surfaces", messages(surfaces()));
}

#[test]
fn outputs_that_cannot_be_written_are_refused() {
    insta::assert_snapshot!("outputs", messages(outputs()));
}

#[test]
fn missing_points_are_counted_and_the_advice_helps() {
    let directory = WorkingDirectory::with("surface.sdf", sdf(17));
    let source = (DISC, SDF_SOURCE);
    let prepared = |keys: &str| quick_scene_with(&[source, ("cutoff = \"3 um\"", keys)]);
    directory.write("scene.toml", prepared("repeat = true"));
    let message = refusal(&directory, "missing points", &directory.plateau(["check", "scene.toml"]));
    assert!(message.contains("17") && message.contains("fill = \"level\""), "{message}");
    directory.write("scene.toml", prepared("repeat = true\nfill = \"level\""));
    directory.plateau(["check", "scene.toml"]).quiet_success();
    // The file of these tests is a good one where nothing is taken from it.
    directory.write("surface.sdf", sdf(0));
    directory.write("scene.toml", prepared("repeat = true"));
    directory.plateau(["check", "scene.toml"]).quiet_success();
}

#[test]
fn a_read_only_directory_is_named() {
    let directory = WorkingDirectory::with_scene(&[]);
    directory.write("results/old.h5", "precious");
    let results = directory.path("results");
    fs::set_permissions(&results, fs::Permissions::from_mode(0o555)).unwrap();
    if fs::write(results.join("probe"), "").is_ok() {
        println!("skipped: this user may write into read-only directories");
        return;
    }
    let outcome = directory.plateau(["run", "scene.toml", "-o", "results/run.h5"]);
    let message = refusal(&directory, "read-only directory", &outcome);
    assert!(message.contains("cannot make a file in results: Permission denied"), "{message}");
    let content = directory.content();
    fs::set_permissions(&results, fs::Permissions::from_mode(0o755)).unwrap();
    assert_eq!(content.len(), 3, "{:?}", content.keys());
}

#[test]
fn the_exit_status_does_not_depend_on_standard_error() {
    let directory = WorkingDirectory::new();
    let outcome = run(directory.command_after("exec 2>/dev/full", ["run", "scene.toml"]));
    assert_eq!((outcome.status, outcome.stdout.as_str()), (Some(2), ""));
    // Results that cannot be told are a failure.
    directory.write("scene.toml", quick_scene_with(&[("duration = \"60 s\"", "steps = 3")]));
    run(directory.command_after("exec >/dev/full", ["check", "scene.toml"]))
        .ends(1, &["cannot write to standard output: "]);
    for asked in [&["--help"][..], &["-h"], &["--version"], &["help", "run"], &["sweep", "run", "--help"]] {
        run(directory.command_after("exec >/dev/full", asked)).ends(1, &["cannot write to standard output: "]);
    }
}

#[test]
fn how_the_environment_would_have_hdf5_read_files_has_no_effect() {
    let directory = WorkingDirectory::with_scene(&[("duration = \"60 s\"", "steps = 3")]);
    directory.plateau(["run", "scene.toml", "-o", "run.h5"]).ends(0, &[]);
    for variables in ["HDF5_DRIVER=nonsense", "HDF5_DRIVER=family", "HDF5_DRIVER=split HDF5_VOL_CONNECTOR=nonsense"] {
        let outcome = run(directory.command_after(&format!("export {variables}"), ["verify", "run.h5"]));
        assert_eq!((outcome.status, outcome.stderr.as_str()), (Some(0), ""), "{variables}");
    }
}
