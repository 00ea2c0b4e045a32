//! The surfaces of a scene, from settings and files.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use hdf5::types::VarLenUnicode;
use ndarray::{Array2, Array3};
use plateau_core::model::mesh::Mesh;
use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::Base;
use plateau_core::observe::schedule::SampleEvery;
use plateau_core::simulation::Decomposition;
use plateau_core::surface::{FibreSynthesis, Fill, HeightSynthesis, Level, Preparation};
use plateau_io::scene::{BaseSource, HeightSettings, HeightSource, OutputSettings, Scene, Workers};
use plateau_io::surface::{Loaded, ReadOptions, load};

use crate::fixtures::place;

pub(crate) const ROWS: usize = 4;
const DISC_COLUMNS: usize = 60;
const PIN_COLUMNS: usize = 6;

/// Flat on flat, all fibre.
pub(crate) fn scene() -> Scene {
    let flat = HeightSettings { source: HeightSource::Flat, mirror: false, preparation: Preparation::default() };
    Scene {
        title: "test".to_owned(),
        path: PathBuf::from("test.toml"),
        steps: 1,
        load_tolerance: 1e-9,
        parameters: Parameters {
            mesh: Mesh::new(ROWS, DISC_COLUMNS, PIN_COLUMNS, 20e-3, 24e-3).unwrap(),
            ..Parameters::paper()
        },
        cycle: None,
        adaptive: None,
        brake: None,
        duration: 1.0,
        disc_surface: flat.clone(),
        pin_surface: flat,
        resin_recess: 0.0,
        pin_base: BaseSource::Uniform(Base::Primary),
        pin_base_mirror: false,
        workers: Workers::Count(1),
        decomposition: Decomposition::Auto,
        output: OutputSettings {
            extras: Vec::new(),
            checkpoint_every: 60.0,
            file: PathBuf::from("test.h5"),
            sample_every: SampleEvery::Steps(1),
            maps_at: Vec::new(),
            maps: Vec::new(),
        },
        seeds: Vec::new(),
        resolved: String::new(),
        files: Vec::new(),
        warnings: Vec::new(),
        places: BTreeMap::new(),
    }
}

fn file(path: &Path, dataset: Option<&str>) -> HeightSource {
    let options = ReadOptions { dataset: dataset.map(str::to_owned), ..ReadOptions::default() };
    HeightSource::File { path: path.to_owned(), options }
}

fn afm() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/surfaces/afm_256x256.sdf")
}

pub(crate) fn message(scene: &Scene) -> String {
    load(scene).unwrap_err().to_string()
}

/// Heights that are all different.
fn heights(columns: usize, rows: usize) -> Array2<f64> {
    Array2::from_shape_fn((columns, rows), |(column, row)| 1e-6 * ((column * 37 + row * 11) as f64).sin())
}

/// A file with everything the tests ask for.
fn hdf5_file(folder: &Path) -> PathBuf {
    let path = folder.join("surfaces.h5");
    let file = hdf5::File::create(&path).unwrap();
    let disc = file.create_group("disc").unwrap();
    let pin = file.create_group("pin").unwrap();
    disc.new_dataset_builder().with_data(&heights(DISC_COLUMNS, ROWS)).create("height").unwrap();
    pin.new_dataset_builder().with_data(&heights(PIN_COLUMNS, ROWS).mapv(|z| z as f32)).create("height").unwrap();
    let base = Array2::from_shape_fn((PIN_COLUMNS, ROWS), |(column, row)| u8::from((column + row) % 3 == 0));
    pin.new_dataset_builder().with_data(&base).create("base").unwrap();
    let mut wrong = base.mapv(i32::from);
    wrong[(4, 2)] = -7;
    pin.new_dataset_builder().with_data(&wrong).create("wrong").unwrap();
    let mut holed = heights(DISC_COLUMNS, ROWS);
    holed[(3, 1)] = f64::NAN;
    holed[(9, 0)] = f64::NAN;
    disc.new_dataset_builder().with_data(&holed).create("holed").unwrap();
    holed[(9, 0)] = f64::INFINITY;
    disc.new_dataset_builder().with_data(&holed).create("infinite").unwrap();
    file.new_dataset_builder().with_data(&Array3::<f64>::zeros((2, 3, 4))).create("cube").unwrap();
    file.new_dataset_builder().with_data(&Array2::<i32>::zeros((ROWS, PIN_COLUMNS))).create("turned").unwrap();
    file.new_dataset::<VarLenUnicode>().create("text").unwrap();
    file.new_dataset::<f64>().chunk((1, 1 << 10)).shape((1 << 30, 1 << 30)).create("promise").unwrap();
    file.close().unwrap();
    path
}

#[test]
fn flat_and_uniform() {
    let loaded = load(&scene()).unwrap();
    assert!(loaded.surfaces.fits(&scene().parameters.mesh));
    assert!(loaded.surfaces.disc_height.iter().chain(&loaded.surfaces.pin_height).all(|height| *height == 0.0));
    assert!(loaded.surfaces.pin_base.iter().all(|base| *base == Base::Primary));
    assert!(loaded.inputs.is_empty());
}

#[test]
fn synthetic_sources_and_the_resin_recess() {
    let mut scene = scene();
    let synthesis = HeightSynthesis::gaussian(1, 3e-6, 5e-3);
    scene.disc_surface.source = HeightSource::Synthetic(synthesis);
    scene.pin_surface.source = HeightSource::Synthetic(HeightSynthesis { rms_height: 5e-7, ..synthesis });
    scene.pin_base =
        BaseSource::Synthetic(FibreSynthesis { seed: 2, fibre_fraction: 0.5, fibre_length: 4e-3, fibre_width: 2e-3 });
    let plain = load(&scene).unwrap().surfaces;
    scene.resin_recess = 8e-6;
    let Loaded { surfaces, report, .. } = load(&scene).unwrap();
    assert_eq!((&surfaces.disc_height, &surfaces.pin_base), (&plain.disc_height, &plain.pin_base));
    assert!(surfaces.pin_base.contains(&Base::Resin) && surfaces.pin_base.contains(&Base::Primary));
    for ((height, before), base) in surfaces.pin_height.iter().zip(&plain.pin_height).zip(&surfaces.pin_base) {
        assert_eq!(*height, if *base == Base::Resin { before + 8e-6 } else { *before });
    }
    assert!(report.iter().any(|line| line == "pin.surface: resin set back by 8 um"), "{report:?}");
    assert!(report.iter().any(|line| line.starts_with("pin.base: fibre fraction 0.")), "{report:?}");
}

#[test]
fn hdf5_heights_come_through_bit_for_bit_and_base_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let path = hdf5_file(folder.path());
    let mut scene = scene();
    scene.disc_surface.source = file(&path, Some("/disc/height"));
    scene.disc_surface.preparation.repeat = true;
    scene.pin_surface.source = file(&path, Some("pin/height"));
    scene.pin_base = BaseSource::File { path: path.clone(), dataset: Some("/pin/base".to_owned()) };
    let loaded = load(&scene).unwrap();
    assert_eq!(loaded.surfaces.disc_height, heights(DISC_COLUMNS, ROWS).into_raw_vec_and_offset().0);
    let pin: Vec<f64> = heights(PIN_COLUMNS, ROWS).iter().map(|z| f64::from(*z as f32)).collect();
    assert_eq!(loaded.surfaces.pin_height, pin);
    for (cell, base) in loaded.surfaces.pin_base.iter().enumerate() {
        let fibre = (cell / ROWS + cell % ROWS).is_multiple_of(3);
        assert_eq!(*base, if fibre { Base::Primary } else { Base::Resin });
    }
    assert_eq!(loaded.inputs.len(), 1, "one file, read three times");
    // "base" and "wrong" both have the type and shape of a fibre map, so one must be named.
    scene.pin_base = BaseSource::File { path: path.clone(), dataset: None };
    let found = message(&scene);
    assert!(
        found.contains("has 2 datasets with integers and shape (pin_columns, rows) = (6, 4), expected one"),
        "{found}"
    );
    assert!(found.contains("/pin/base (uint8, shape (6, 4))"), "{found}");
}

#[test]
fn the_only_suitable_dataset_needs_no_name() {
    let (_folder, path) = place("one.h5");
    let out = hdf5::File::create(&path).unwrap();
    let group = out.create_group("a").unwrap().create_group("b").unwrap();
    group.new_dataset_builder().with_data(&heights(DISC_COLUMNS, ROWS)).create("z").unwrap();
    let base = Array2::from_elem((PIN_COLUMNS, ROWS), true);
    group.new_dataset_builder().with_data(&base).create("fibre").unwrap();
    // A link to a group above must not send the search round and round.
    out.link_hard("/a", "/a/b/again").unwrap();
    drop(group);
    out.close().unwrap();
    let mut scene = scene();
    scene.disc_surface.source = file(&path, None);
    scene.pin_base = BaseSource::File { path: path.clone(), dataset: None };
    let surfaces = load(&scene).unwrap().surfaces;
    assert_eq!(surfaces.disc_height, heights(DISC_COLUMNS, ROWS).into_raw_vec_and_offset().0);
    assert_eq!(surfaces.pin_base, vec![Base::Primary; PIN_COLUMNS * ROWS]);
}

#[test]
fn a_base_may_be_an_enumeration_as_in_run_files() {
    #[derive(hdf5::H5Type, Clone, Copy)]
    #[repr(u8)]
    #[allow(dead_code)]
    enum Status {
        None = 0,
        Primary = 1,
        Secondary = 2,
    }
    let (_folder, path) = place("run.h5");
    let out = hdf5::File::create(&path).unwrap();
    let status = |(column, _)| if column < 2 { Status::Primary } else { Status::None };
    let base = Array2::from_shape_fn((PIN_COLUMNS, ROWS), status);
    out.new_dataset_builder().with_data(&base).create("base").unwrap();
    out.close().unwrap();
    let mut scene = scene();
    scene.pin_base = BaseSource::File { path, dataset: Some("base".to_owned()) };
    let found = load(&scene).unwrap().surfaces.pin_base;
    assert_eq!(found[..2 * ROWS], [Base::Primary; 2 * ROWS]);
    assert_eq!(found[2 * ROWS..], [Base::Resin; 4 * ROWS]);
}

#[test]
fn a_base_whose_dimensions_are_named_y_and_x_is_laid_out_by_name() {
    let (_folder, path) = place("base.h5");
    let file = hdf5::File::create(&path).unwrap();
    let base = Array2::from_shape_fn((ROWS, PIN_COLUMNS), |(row, column)| u8::from(column == 1 && row == 0));
    let dataset = file.new_dataset_builder().with_data(&base).create("base").unwrap();
    let labels: Vec<VarLenUnicode> = ["y", "x"].map(|label| label.parse().unwrap()).into();
    dataset.new_attr::<VarLenUnicode>().shape(2).create("DIMENSION_LABELS").unwrap().write_raw(&labels).unwrap();
    drop((dataset, file));
    let mut scene = scene();
    scene.pin_base = BaseSource::File { path, dataset: None };
    let loaded = load(&scene).unwrap().surfaces.pin_base;
    let fibres: Vec<usize> = (0..loaded.len()).filter(|cell| loaded[*cell] == Base::Primary).collect();
    assert_eq!(fibres, [ROWS]);
}

#[test]
fn unsuitable_hdf5_content_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = hdf5_file(folder.path());
    let disc = |dataset: &str, preparation: Preparation| {
        let mut scene = scene();
        scene.disc_surface.source = file(&path, Some(dataset));
        scene.disc_surface.preparation = preparation;
        message(&scene)
    };
    let datasets =
        ["/disc/heigth", "/disc", "cube", "pin/base", "text", "pin/height", "promise", "disc/infinite", "disc/holed"];
    let told = datasets.map(|dataset| disc(dataset, Preparation::default()));
    let mut filled = scene();
    filled.disc_surface.source = file(&path, Some("disc/holed"));
    filled.disc_surface.preparation.fill = Some(Fill::Level);
    assert!(load(&filled).unwrap().surfaces.disc_height.iter().all(|height| height.is_finite()));

    let base = |dataset: &str| {
        let mut scene = scene();
        scene.pin_base = BaseSource::File { path: path.clone(), dataset: Some(dataset.to_owned()) };
        message(&scene)
    };
    let bases = ["pin/wrong", "turned", "pin/height", "cube"].map(base);
    insta::assert_snapshot!([&told[..], &bases].concat().join("\n").replace(&path.display().to_string(), "FILE"));
}

#[test]
fn damaged_hdf5_files_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let content = fs::read(hdf5_file(folder.path())).unwrap();
    let path = folder.path().join("damaged.h5");
    let mut scene = scene();
    scene.disc_surface.source = file(&path, Some("/disc/height"));
    for length in [8, 9, 40, 96, 512, content.len() / 2, content.len() - 1] {
        fs::write(&path, &content[..length]).unwrap();
        let found = message(&scene);
        assert!(found.contains("damaged.h5: cannot be read as HDF5: "), "{length} bytes: {found}");
        assert!(!found.contains('\n'), "{found}");
    }
}

#[test]
fn a_measured_patch_on_disc_and_pin() {
    let mut scene = scene();
    let preparation = Preparation {
        level: Level::Plane,
        pixel: Some(50e-6),
        cutoff: Some(1e-8),
        repeat: true,
        scale: 300.0,
        ..Preparation::default()
    };
    scene.disc_surface = HeightSettings { source: file(&afm(), None), mirror: false, preparation };
    scene.pin_surface = scene.disc_surface.clone();
    let Loaded { surfaces, inputs, report, .. } = load(&scene).unwrap();
    // The heights are levelled, so their mean is 0 and the cut at 10 nm becomes a highest height of 3 um.
    let highest = surfaces.disc_height.iter().copied().fold(f64::MIN, f64::max);
    assert!(highest <= 3e-6 * (1.0 + 1e-9) && highest > 1e-6, "{highest}");
    // sha256sum of the file.
    let digest = "d6e9309c26f3fc1b8f5f398a1f3f46264b4fb77e89e6e9632cbb65b25d06052e".to_owned();
    assert_eq!(inputs, [(afm(), digest)]);
    // The pin lies on the first columns; its z grows away from the disc, and the cut took the peaks.
    for (pin, disc) in surfaces.pin_height.iter().zip(&surfaces.disc_height) {
        assert!((pin + disc).abs() < 1e-18, "{pin} {disc}");
    }
    insta::assert_snapshot!(report.join("\n").replace(&afm().display().to_string(), "FILE"));
    // A patch as small as the file says does not cover the track, and tiled it is flat: all of it lies in a hundredth of a cell.
    scene.disc_surface.preparation.pixel = None;
    let warned = load(&scene).unwrap().report;
    let warning = "is smaller than a cell of";
    assert!(warned.iter().any(|line| line.contains(warning)), "{warned:#?}");
    scene.disc_surface.preparation.repeat = false;
    let found = message(&scene);
    let expected = ".sdf: the patch is 500 nm wide in r, the track 4 mm: repeat = true";
    assert!(found.starts_with("disc.prepare: ") && found.contains(expected), "{found}");
}

#[test]
fn files_that_are_not_read_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, content: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, content).unwrap();
        path
    };
    let error = |path: &Path| {
        let mut scene = scene();
        scene.disc_surface.source = file(path, None);
        let found = message(&scene);
        let start = format!("disc.surface: {}: ", path.display());
        found.strip_prefix(&start).unwrap_or_else(|| panic!("{found}")).to_owned()
    };
    let mut told = vec![error(folder.path()), error(&folder.path().join("absent.sdf")), error(Path::new("/dev/null"))];
    for (name, content) in [
        ("empty.sdf", &b""[..]),
        ("a.jpg", b"\xff\xd8\xff\xe0\0\x10JFIF"),
        ("a.gif", b"GIF89a\0"),
        ("a.npz", b"PK\x03\x04"),
        ("a.al3d", b"AliconaImaging\0\r\n"),
        ("b.csv", b"1,2\n3,4\n"),
        ("a.csv", b"1.5,2\n3,4\n"),
        ("utf16.txt", b"\xff\xfe1\x00 \x002\x00"),
        ("a.txt", b"# unit: um\n1 2\n3 4\n"),
        ("a.npy", b"\x93NUMPY\x01\0"),
    ] {
        told.push(error(&write(name, content)));
    }
    let mut scene = scene();
    scene.disc_surface.source = file(&afm(), Some("/disc/height"));
    let afm_path = afm().display().to_string();
    told.push(message(&scene).replace(&afm_path, "FILE"));
    scene.disc_surface.source = HeightSource::Flat;
    scene.pin_base = BaseSource::File { path: afm(), dataset: None };
    told.push(message(&scene).replace(&afm_path, "FILE"));
    insta::assert_snapshot!(told.join("\n"));
}
