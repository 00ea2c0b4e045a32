//! Text, NumPy arrays, images and what we write: read through the door through which every surface file comes in.

use std::fs;
use std::path::{Path, PathBuf};

use ::hdf5::types::{FixedAscii, VarLenUnicode};
use plateau_core::surface::Patch;
use plateau_io::surface::{Decimal, Format, Lay, Measured, ReadOptions, hdf5, read};

use crate::fixtures::place;

pub(crate) fn corpus(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/surfaces").join(name)
}

pub(crate) fn options() -> ReadOptions {
    ReadOptions::default()
}

pub(crate) fn um() -> ReadOptions {
    ReadOptions { unit: Some(1e-6), ..options() }
}

pub(crate) fn black_to_white(height: f64) -> ReadOptions {
    ReadOptions { height_range: Some([0.0, height]), ..options() }
}

/// The heights in µm of 5 x 4 points, which are 4 x + y where none is missing.
fn expect(measured: &Measured, missing: &[usize]) {
    assert_eq!((measured.columns, measured.rows), (5, 4), "{measured:?}");
    for (n, height) in measured.heights.iter().enumerate() {
        if missing.contains(&n) {
            assert!(height.is_nan(), "{n} in {measured:?}");
        } else {
            // A product and a quotient are rounded once each.
            assert!((height * 1e6 - n as f64).abs() <= n as f64 * 4.0 * f64::EPSILON, "{n}: {height}");
        }
    }
}

pub(crate) fn message(path: &Path, options: &ReadOptions) -> String {
    read(path, options).unwrap_err().to_string()
}

#[test]
fn every_file_of_the_corpus_gives_the_heights_it_was_made_of() {
    // The formula of make_tables.py.
    for (name, options, format, missing, pitch) in [
        ("f2.npy", um(), Format::Npy, &[][..], None),
        ("f4be.npy", um(), Format::Npy, &[], None),
        ("f8.npy", um(), Format::Npy, &[], None),
        ("i1.npy", um(), Format::Npy, &[], None),
        ("u2be.npy", um(), Format::Npy, &[], None),
        ("i8.npy", ReadOptions { pitch: Some([1e-5; 2]), ..um() }, Format::Npy, &[], Some([1e-5; 2])),
        ("fortran_holed.npy", um(), Format::Npy, &[9], None),
        ("one_of_two.npz", um(), Format::Npz, &[9], None),
        ("two.npz", ReadOptions { dataset: Some("a".to_owned()), ..um() }, Format::Npz, &[], None),
        ("pitch.h5", options(), Format::Hdf5, &[], Some([5e-5, 2.5e-5])),
        ("matrix.txt", options(), Format::Text, &[], Some([5e-5, 2.5e-5])),
        ("gwyddion.txt", options(), Format::Text, &[], Some([250e-6 / 5.0, 100e-6 / 4.0])),
        ("list.csv", options(), Format::Text, &[9], Some([5e-5, 2.5e-5])),
        ("list.xyz", options(), Format::Text, &[9, 3], Some([5e-5, 2.5e-5])),
        ("comma.csv", options(), Format::Text, &[9], Some([5e-5, 2.5e-5])),
        ("comma.txt", options(), Format::Text, &[9], None),
        ("utf16.csv", options(), Format::Text, &[9], Some([5e-5; 2])),
        ("grey8.png", black_to_white(25.5e-6), Format::Png, &[], None),
        ("grey16.png", black_to_white(21.845e-6), Format::Png, &[], None),
        ("grey8.tif", black_to_white(25.5e-6), Format::Tiff, &[], None),
        ("white_is_zero.tif", black_to_white(25.5e-6), Format::Tiff, &[], None),
        ("grey8deflate.tif", black_to_white(25.5e-6), Format::Tiff, &[], None),
        ("grey16be.tif", black_to_white(21.845e-6), Format::Tiff, &[], None),
        ("grey16big.tif", black_to_white(21.845e-6), Format::Tiff, &[], None),
        ("grey16lzw.tif", black_to_white(21.845e-6), Format::Tiff, &[], None),
        ("decimal.tif", um(), Format::Tiff, &[9], None),
    ] {
        let measured = read(&corpus(name), &options).unwrap_or_else(|error| panic!("{name}: {error}"));
        println!("{name}: {}", measured.describe());
        expect(&measured, missing);
        assert_eq!(measured.format, format, "{name}");
        match (measured.pitch, pitch) {
            (Some(found), Some(pitch)) => {
                assert!(found.iter().zip(pitch).all(|(f, p)| (f - p).abs() < 1e-15), "{name}: {found:?}");
            }
            (found, pitch) => assert_eq!(found, pitch, "{name}"),
        }
        let model = matches!(format, Format::Npy | Format::Npz | Format::Hdf5);
        assert_eq!(measured.instrument, !model, "{name}");
    }
    let levels = read(&corpus("grey1.png"), &black_to_white(1.0)).unwrap().heights;
    assert!(levels.iter().enumerate().all(|(n, level)| *level == (n % 2) as f64));
}

#[test]
fn every_profile_of_the_corpus_gives_the_heights_it_was_made_of() {
    let options = || ReadOptions { profile_lay: Some(Lay::Across), ..options() };
    // The last coordinate of rounded.csv is 3.2 for 3.1667: half a place over 19 steps is the most that can be off.
    for (name, pitch, error) in [("rounded.csv", 1e-6 / 6.0, 0.05e-6 / 19.0), ("profile.hfm", 1e-6, 1e-17)] {
        let measured = read(&corpus(name), &options()).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!((measured.columns, measured.rows, measured.profile_lay), (20, 1, Some(Lay::Across)));
        let [along, across] = measured.pitch.unwrap();
        assert!((along - pitch).abs() <= error && along == across, "{name}: {along}");
        assert!(
            measured.heights.iter().enumerate().all(|(n, height)| (height * 1e6 - n as f64).abs() < 1e-12),
            "{name}"
        );
        let found = message(&corpus(name), &um());
        assert!(found.contains("for a profile say profile_lay = \"along\""), "{name}: {found}");
    }
    // A line of any format is a profile; more lines are none.
    let folder = tempfile::tempdir().unwrap();
    for (columns, rows) in [(20, 1), (1, 20)] {
        let path = folder.path().join("line.h5");
        let heights = (0..20).map(f64::from).collect();
        let (column_pitch, row_pitch) = if rows == 1 { (1e-6, 3e-3) } else { (3e-3, 1e-6) };
        hdf5::write(&path, &Patch { columns, rows, column_pitch, row_pitch, heights }).unwrap();
        let profile = read(&path, &options()).unwrap();
        assert_eq!((profile.pitch, profile.heights.len(), profile.heights[7]), (Some([1e-6; 2]), 20, 7.0));
        std::fs::remove_file(&path).unwrap();
    }
    let told = [
        ("pitch.h5", options()),
        ("matrix.txt", options()),
        ("rounded.csv", ReadOptions { pitch: Some([1e-6, 2e-6]), ..options() }),
        ("f8.npy", ReadOptions { skip: Some(1), ..options() }),
        ("f8.npy", ReadOptions { decimal: Some(Decimal::Comma), ..options() }),
    ];
    insta::assert_snapshot!(told.map(|(name, more)| message(&corpus(name), &more)).join("\n"));
}

#[test]
fn what_is_needed_or_of_no_use_is_told() {
    let of = |dataset: &str| ReadOptions { dataset: Some(dataset.to_owned()), ..options() };
    let told = [
        ("list.csv", ReadOptions { unit: Some(1e-3), ..options() }),
        ("pitch.h5", ReadOptions { pitch: Some([5e-5; 2]), ..options() }),
        ("grey8.png", options()),
        ("grey8.png", um()),
        ("decimal.tif", options()),
        ("f8.npy", black_to_white(1.0)),
        ("pitch.h5", um()),
        ("f8.npy", of("a")),
        ("two.npz", options()),
        ("two.npz", of("c")),
        ("one_of_two.npz", of("pitch")),
        // The scene must not say another pitch than the coordinates.
        ("packed.nc", ReadOptions { pitch: Some([5e-6, 2e-6]), ..options() }),
        ("packed.nc", ReadOptions { at: Some(1.0), ..options() }),
        ("f8.npy", ReadOptions { at: Some(1.0), ..um() }),
    ];
    insta::assert_snapshot!(told.map(|(name, options)| message(&corpus(name), &options)).join("\n"));
    let integers = read(&corpus("i8.npy"), &options()).unwrap();
    assert_eq!((integers.heights[7], integers.warnings.len()), (7.0, 1));
    // Black may be the higher one.
    let turned = read(&corpus("grey8.png"), &ReadOptions { height_range: Some([1e-6, -1e-6]), ..options() }).unwrap();
    assert_eq!(turned.heights[0], 1e-6);
    assert!((turned.heights[19] - (1e-6 - 2e-6 * 190.0 / 255.0)).abs() < 1e-20);
}

#[test]
fn dimensions_named_x_and_y_are_laid_out_by_name() {
    // The formulas with which xarray and h5py wrote the files, as their README has them.
    for (name, dataset, notes) in [
        (
            "packed.nc",
            None,
            &[
                "dataset /height",
                "dimensions (y, x), y decreases in the file",
                "heights are the stored numbers times scale_factor 1e-6 plus add_offset 5e-6",
            ][..],
        ),
        ("labels.h5", Some("z"), &["dataset /z", "dimensions (y, x)"]),
    ] {
        let dataset = dataset.map(str::to_owned);
        let measured = read(&corpus(name), &ReadOptions { dataset, ..options() }).unwrap();
        assert_eq!((measured.columns, measured.rows), (5, 3), "{name}");
        let pitch = measured.pitch.unwrap();
        assert!((pitch[0] - 2e-6).abs() < 1e-18 && (pitch[1] - 5e-6).abs() < 1e-18, "{name}: {pitch:?}");
        for (at, height) in measured.heights.iter().enumerate() {
            let (x, y) = (at / 3, at % 3);
            let expected = 1e-6 * (10 * x + y) as f64;
            let is_right = if (x, y) == (2, 1) { height.is_nan() } else { (height - expected).abs() < 1e-20 };
            assert!(is_right, "{name}: {height} at column {x}, row {y}");
        }
        assert_eq!(measured.notes, notes, "{name}");
    }
}

#[test]
fn packed_numbers_are_what_netcdf_says_also_of_coordinates() {
    let (_folder, path) = place("a.nc");
    // By hand: as 16 bits without a sign, -1 is 65535 and -32768 is 32768, which marks a missing point.
    let file = ::hdf5::File::create(&path).unwrap();
    let dataset = file.new_dataset::<i16>().shape((2, 3)).create("z").unwrap();
    dataset.write_raw(&[0_i16, 1, -1, -2, -32768, 32767]).unwrap();
    set(&dataset, "_FillValue", -32768_i16);
    set(&dataset, "scale_factor", 1e-9);
    // Rows first, in labels of one length.
    attribute(&dataset, "DIMENSION_LABELS", &["y", "x"].map(|label| FixedAscii::<1>::from_ascii(label).unwrap()));
    set(&dataset, "_Unsigned", text("true"));
    drop((dataset, file));
    let measured = read(&path, &options()).unwrap();
    assert_eq!((measured.columns, measured.rows), (3, 2));
    for (found, expected) in measured.heights.iter().zip([0.0, 65534e-9, 1e-9, f64::NAN, 65535e-9, 32767e-9]) {
        let is_right = (found - expected).abs() < 1e-18 || found.is_nan() && expected.is_nan();
        assert!(is_right, "{found}, expected {expected}");
    }
    change(&path, "z", |dataset| set(dataset, "_Unsigned", text("no")));
    assert!(message(&path, &options()).contains("_Unsigned = \"no\", expected \"true\" or \"false\""));
    change(&path, "z", |dataset| set(dataset, "_Unsigned", text("false")));
    change(&path, "z", |dataset| set(dataset, "missing_value", text("32767")));
    assert!(message(&path, &options()).contains("the attribute missing_value, expected a number"));

    fs::copy(corpus("packed.nc"), &path).unwrap();
    change(&path, "x", |x| set(x, "scale_factor", 0.5));
    let pitch = read(&path, &options()).unwrap().pitch.unwrap();
    assert!((pitch[0] - 1e-6).abs() < 1e-18, "{pitch:?}");
    // An offset takes no part in the distance, and what is a mark is no coordinate.
    change(&path, "x", |x| set(x, "add_offset", -3.0));
    let pitch = read(&path, &options()).unwrap().pitch.unwrap();
    assert!((pitch[0] - 1e-6).abs() < 1e-18, "{pitch:?}");
    change(&path, "x", |x| set(x, "missing_value", x.read_raw::<f64>().unwrap()[1]));
    let found = message(&path, &options());
    assert!(found.contains("its dimension /x are not equidistant: number 1 is NaN"), "{found}");
}

/// A file with the packed heights `z` of one row, and attributes that `attributes` writes.
fn packed<T: ::hdf5::H5Type>(folder: &Path, stored: &[T], attributes: impl Fn(&::hdf5::Dataset)) -> PathBuf {
    let path = folder.join("packed.h5");
    let file = ::hdf5::File::create(&path).unwrap();
    let dataset = file.new_dataset::<T>().shape((stored.len(), 1)).create("z").unwrap();
    dataset.write_raw(stored).unwrap();
    set(&dataset, "scale_factor", 1e-9);
    attributes(&dataset);
    path
}

/// Changes a dataset of a file, which is closed then: one that is open for writing is not read.
fn change(path: &Path, name: &str, change: impl Fn(&::hdf5::Dataset)) {
    let file = ::hdf5::File::open_rw(path).unwrap();
    change(&file.dataset(name).unwrap());
}

/// Gives a dataset an attribute that is a list.
fn attribute<T: ::hdf5::H5Type>(dataset: &::hdf5::Dataset, name: &str, values: &[T]) {
    dataset.new_attr::<T>().shape(values.len()).create(name).unwrap().write_raw(values).unwrap();
}

/// Gives a dataset an attribute that is one value, in place of one of that name.
fn set<T: ::hdf5::H5Type>(dataset: &::hdf5::Dataset, name: &str, value: T) {
    let _ = dataset.delete_attr(name);
    dataset.new_attr::<T>().create(name).unwrap().write_scalar(&value).unwrap();
}

fn text(text: &str) -> VarLenUnicode {
    text.parse().unwrap()
}

#[test]
fn stored_numbers_that_are_not_valid_are_missing_points() {
    let folder = tempfile::tempdir().unwrap();
    let heights = |path: &Path| -> Vec<Option<f64>> {
        let heights = read(path, &options()).unwrap().heights;
        heights.iter().map(|height| Some((height * 1e9).round()).filter(|height| !height.is_nan())).collect()
    };
    let stored = [-300_i16, -200, 0, 100, 101];
    let path = packed(folder.path(), &stored, |dataset| attribute(dataset, "valid_range", &[-200_i16, 100]));
    assert_eq!(heights(&path), [None, Some(-200.0), Some(0.0), Some(100.0), None]);
    assert!(
        read(&path, &options()).unwrap().notes[1].ends_with("below -200 or above 100 are not valid and missing points")
    );
    let path = packed(folder.path(), &stored, |dataset| attribute(dataset, "valid_min", &[-200_i64]));
    assert_eq!(heights(&path), [None, Some(-200.0), Some(0.0), Some(100.0), Some(101.0)]);
    let path = packed(folder.path(), &stored, |dataset| attribute(dataset, "valid_max", &[100_i16]));
    assert_eq!(heights(&path), [Some(-300.0), Some(-200.0), Some(0.0), Some(100.0), None]);
    // As bytes without a sign, -56 is 200; what no byte means is beyond all of them.
    for largest in [&[0_i16, 200], &[0, -56]] {
        let path = packed(folder.path(), &[0_i8, 127, -128, -56, -55], |dataset| {
            attribute(dataset, "_Unsigned", &[text("true")]);
            attribute(dataset, "valid_range", largest);
        });
        assert_eq!(heights(&path), [Some(0.0), Some(127.0), Some(128.0), Some(200.0), None]);
    }
    // With a sign, though the type has none: 65535 is -1 and 32768 is -32768, which is the mark.
    let path = packed(folder.path(), &[0_u16, 32767, 32768, 65535], |dataset| {
        attribute(dataset, "_Unsigned", &[text("false")]);
        attribute(dataset, "_FillValue", &[32768_u16]);
    });
    assert_eq!(heights(&path), [Some(0.0), Some(32767.0), None, Some(-1.0)]);
    // A mark that was written with more digits than the heights have.
    let path = packed(folder.path(), &[1.0_f32, -999.9], |dataset| attribute(dataset, "missing_value", &[-999.9_f64]));
    assert_eq!(heights(&path), [Some(1.0), None]);

    let found =
        |attributes: &dyn Fn(&::hdf5::Dataset)| message(&packed(folder.path(), &stored, attributes), &options());
    let told = [
        found(&|dataset| attribute(dataset, "valid_range", &[1_i16])),
        found(&|dataset| attribute(dataset, "valid_min", &[text("0")])),
        found(&|dataset| attribute(dataset, "valid_max", &[1e-7])),
        found(&|dataset| attribute(dataset, "valid_range", &[5_i16, -5])),
    ];
    insta::assert_snapshot!(told.join("\n"));
}

#[test]
fn units_and_labels_that_are_no_texts_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let found =
        |attributes: &dyn Fn(&::hdf5::Dataset)| message(&packed(folder.path(), &[1.0, 2.0], attributes), &options());
    let two = ["m", "m"].map(text);
    let told = [
        found(&|dataset| attribute(dataset, "units", &[1e-6])),
        found(&|dataset| attribute(dataset, "units", &two)),
        found(&|dataset| attribute(dataset, "DIMENSION_LABELS", &[1_i32, 2])),
        found(&|dataset| attribute(dataset, "DIMENSION_LABELS", &two[..1])),
    ];
    let path = folder.path().join("a.nc");
    fs::copy(corpus("packed.nc"), &path).unwrap();
    change(&path, "x", |x| {
        x.delete_attr("units").unwrap();
        attribute(x, "units", &[1e-3]);
    });
    insta::assert_snapshot!(format!("{}\n{}", told.join("\n"), message(&path, &options())));
}

#[test]
fn a_file_of_an_instrument_is_to_be_converted_whatever_is_said_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let told = |name: &str, content: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, content).unwrap();
        message(&path, &ReadOptions { dataset: Some("a".to_owned()), ..um() })
    };
    let plu = [&b"Fri Mar 15 10:12:00 2013\0"[..], &[0; 200]].concat();
    let wide: Vec<u8> = "\u{feff}fileformat = bcrstm_unicode\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    let contents = [
        &b"AliconaImaging\0\r\n"[..],
        b"\x01\0Directory\0",
        b"\0\0\0\x0ahdat_3.4.x",
        &plu,
        &wide,
        b"fileformat = bcrf\n",
        b"CDF\x02\0\0",
        b"fileType      Image\n",
        b"[DataSet]\r\nVersion=2\r\n",
        b"SIMPLE  =                    T",
        b"h=3 w=4\npixel size=1e-6 m\nheight conversion factor (-> m)=1e-9\n",
        b"\"Measured\",\"now\"\r\n\"XY Calibration\",\"1\",\"um\"\r\n",
    ];
    let said = contents.map(|content| told("a", content)).join("\n");
    insta::assert_snapshot!(said + "\n" + &told("wave.IBW", b"\x05\0\0\x01"));
    // A text may begin with a day, and other bytes as a format that has more of them.
    assert!(told("a", b"Fri Mar 15 10:12:00 2013\n1 2\n3 4\n").starts_with("dataset = \"a\", expected the number"));
    assert!(told("a", b"Alicona\0").starts_with("this is not a surface file that is known"));
}

#[test]
fn coordinates_that_are_no_grid_are_refused() {
    let (_folder, path) = place("a.nc");
    // Every coordinate of x, and its unit, in a copy of the file of xarray.
    let case = |x: [f64; 5], units: &str| {
        fs::copy(corpus("packed.nc"), &path).unwrap();
        change(&path, "x", |dataset| {
            dataset.write_raw(&x).unwrap();
            dataset.delete_attr("units").unwrap();
            // In a list of one, as netCDF has texts.
            attribute(dataset, "units", &[text(units)]);
        });
        read(&path, &options()).map(|measured| measured.pitch.unwrap()[0]).map_err(|error| error.to_string())
    };
    let pitch = case([0.0, 2.0, 4.0, 6.0, 8.0], "mm").unwrap();
    assert!((pitch - 2e-3).abs() < 1e-17, "{pitch}");
    let refused = [
        case([0.0, 2.0, 4.0, 6.1, 8.0], "um"),
        case([3.0; 5], "um"),
        case([0.0, 1.0, f64::NAN, 3.0, 4.0], "m"),
        case([0.0, 1.0, 2.0, 3.0, 4.0], "degrees_east"),
    ];
    insta::assert_snapshot!(refused.map(Result::unwrap_err).join("\n"));
}

#[test]
fn attributes_that_say_otherwise_are_refused() {
    let (_folder, path) = place("a.h5");
    let case = |units: &str, pitch: &[f64]| {
        let file = ::hdf5::File::create(&path).unwrap();
        let dataset = file.new_dataset_builder().with_data(&ndarray::arr2(&[[1.0, 2.0]])).create("z").unwrap();
        set(&dataset, "units", text(units));
        attribute(&dataset, "pitch", pitch);
        drop((dataset, file));
        read(&path, &options())
    };
    assert_eq!(case("m", &[1e-5]).unwrap().pitch, Some([1e-5; 2]));
    let mut said = vec![case("um", &[1e-5]).unwrap_err().to_string()];
    for pitch in [&[1e-5, 0.0][..], &[f64::NAN], &[1.0, 2.0, 3.0], &[-1.0], &[f64::INFINITY, 1.0]] {
        said.push(case("m", pitch).unwrap_err().to_string());
    }
    let file = ::hdf5::File::create(&path).unwrap();
    let dataset = file.new_dataset_builder().with_data(&ndarray::arr2(&[[1.0, 2.0]])).create("Surface").unwrap();
    set(&dataset, "Z Converter", 1.0);
    drop((dataset, file));
    said.push(message(&path, &options()));
    insta::assert_snapshot!(said.join("\n"));
}

#[test]
fn images_that_are_no_heights() {
    let (_folder, path) = place("a.png");
    let case = |colour: png::ColorType, depth: png::BitDepth, data: &[u8]| {
        let mut encoder = png::Encoder::new(fs::File::create(&path).unwrap(), 2, 1);
        encoder.set_color(colour);
        encoder.set_depth(depth);
        if colour == png::ColorType::Indexed {
            encoder.set_palette(vec![0, 0, 0, 255, 0, 0]);
        }
        encoder.write_header().unwrap().write_image_data(data).unwrap();
        read(&path, &black_to_white(1.0)).map_err(|error| error.to_string())
    };
    use png::{BitDepth, ColorType};
    let expected = "expected grey pixels without transparency: colours are not heights, save the image as grey levels";
    for (colour, data, found) in [
        (ColorType::Rgb, &[0; 6][..], "colours"),
        (ColorType::Rgba, &[0; 8], "colours"),
        (ColorType::Indexed, &[0, 1], "colours"),
        (ColorType::GrayscaleAlpha, &[0; 4], "transparency"),
    ] {
        assert_eq!(case(colour, BitDepth::Eight, data).unwrap_err(), format!("the image has {found}, {expected}"));
    }
    let grey = case(ColorType::Grayscale, BitDepth::Sixteen, &[0xff, 0xff, 0, 1]).unwrap();
    assert_eq!(grey.heights, [1.0, 1.0 / 65535.0]);
}

#[test]
fn a_workbook_is_named_with_what_to_do() {
    let (_folder, path) = place("heights.csv");
    let mut archive = zip::ZipWriter::new(fs::File::create(&path).unwrap());
    archive.start_file("content.xml", zip::write::SimpleFileOptions::default()).unwrap();
    archive.finish().unwrap();
    let expected = "this is a workbook (.ods), which is not read: save the sheet with the heights as CSV";
    assert_eq!(message(&path, &um()), expected);
}
