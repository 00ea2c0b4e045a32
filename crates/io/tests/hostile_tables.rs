//! Tables, arrays and images that are damaged, or promise more than they hold: an error each, and bounded memory.

use std::fs;
use std::io::Write;
use std::path::PathBuf;

use plateau_io::surface::{ReadOptions, read};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use crate::few_or_all;
use crate::fixtures::place;
use crate::tables::{black_to_white, corpus, message, options, um};

/// A version 1.0 header with this dictionary and this much data.
fn array(dictionary: &str, data: usize) -> Vec<u8> {
    let mut content = b"\x93NUMPY\x01\x00".to_vec();
    content.extend((dictionary.len() as u16).to_le_bytes());
    content.extend(dictionary.as_bytes());
    content.extend(vec![0; data]);
    content
}

#[test]
fn npy_headers_that_promise_or_hold_something_else() {
    let (_folder, path) = place("a.npy");
    let case = |content: &[u8]| {
        fs::write(&path, content).unwrap();
        read(&path, &options()).map(|_| ()).map_err(|error| error.to_string())
    };
    let dictionary =
        |descr: &str, shape: &str| format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}}}\n");
    assert_eq!(case(&array(&dictionary("'<f8'", "(2, 3L)"), 48)), Ok(()));
    for (descr, shape, data, expected) in [
        ("'<f8'", "(2, 3)", 47, "the data have 47 bytes, expected 48 for shape (2, 3)"),
        ("'<f8'", "(2, 3)", 49, "the data have 49 bytes, expected 48"),
        ("'<f8'", "(2147483648, 2)", 9, "the array has shape (2147483648, 2), which is more than the 268435456 points"),
        ("'<f8'", "(18446744073709551615, 18446744073709551615)", 9, "the array has shape (18446744073709551615, "),
        ("'<f8'", "(99999999999999999999, 1)", 9, "the header is damaged: found "),
        ("'<f8'", "(6,)", 48, "the array has shape (6), expected 2 dimensions"),
        ("'<f8'", "()", 48, "the array has shape (), expected 2 dimensions"),
        ("'<f8'", "(0, 3)", 0, "the array has shape (0, 3), expected 2 dimensions (columns, rows), none of them 0"),
        ("'<f8'", "(-2, 3)", 48, "the header is damaged: found \"-2, 3)}\", expected a size of 64 bits"),
        ("'|O'", "(2, 3)", 48, "the array has type \"|O\", expected floating-point numbers or integers"),
        ("'<c16'", "(2, 3)", 96, "the array has type \"<c16\""),
        ("[('z', '<f8')]", "(2, 3)", 48, "the array has type record"),
        ("(((((((", "(2, 3)", 48, "the header is damaged: "),
    ] {
        let found = case(&array(&dictionary(descr, shape), data)).unwrap_err();
        assert!(found.starts_with(expected), "{found}\nexpected {expected}");
    }
    let mut long = b"\x93NUMPY\x02\x00\xff\xff\xff\xff".to_vec();
    long.extend(b"{'descr'");
    assert!(case(&long).unwrap_err().ends_with("expected a header of at most 10000 bytes"));
    let mut infinite = array(&dictionary("'<f4'", "(1, 2)"), 8);
    let at = infinite.len() - 4;
    infinite[at..].copy_from_slice(&f32::INFINITY.to_le_bytes());
    assert!(case(&infinite).unwrap_err().starts_with("1 of 2 heights are infinite"));
}

#[test]
fn npy_numbers_of_every_type_in_both_orders() {
    let (_folder, path) = place("a.npy");
    let one = |descr: &str, bytes: &[u8]| {
        let dictionary = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': (1, 1)}}\n");
        fs::write(&path, [array(&dictionary, 0), bytes.to_vec()].concat()).unwrap();
        // So small a unit, a power of two, that every number is a height.
        let options = ReadOptions { unit: Some(2.0_f64.powi(-60)), ..options() };
        read(&path, &options).map(|read| read.heights[0] * 2.0_f64.powi(60)).map_err(|error| error.to_string())
    };
    for (descr, bytes, expected) in [
        ("|u1", vec![0xfe], 254.0),
        ("|i1", vec![0xfe], -2.0),
        ("<i1", vec![0x7f], 127.0),
        ("<u2", vec![0x34, 0x12], 4660.0),
        (">u2", vec![0x12, 0x34], 4660.0),
        ("<i2", vec![0xff, 0xff], -1.0),
        (">i4", vec![0xff, 0xff, 0xff, 0x00], -256.0),
        ("<u4", vec![0, 0, 0, 0x80], 2_147_483_648.0),
        ("<i8", (-5_i64).to_le_bytes().to_vec(), -5.0),
        (">u8", u64::MAX.to_be_bytes().to_vec(), 18_446_744_073_709_551_616.0),
        ("<f4", 0.1_f32.to_le_bytes().to_vec(), f64::from(0.1_f32)),
        (">f8", (-1.5e-6_f64).to_be_bytes().to_vec(), -1.5e-6),
        // Examples of IEEE 754 binary16: 1/3, the largest number, the smallest subnormal one, -2.
        ("<f2", vec![0x55, 0x35], 0.333_251_953_125),
        (">f2", vec![0x7b, 0xff], 65504.0),
        ("<f2", vec![0x01, 0x00], 5.960_464_477_539_063e-8),
        ("<f2", vec![0x00, 0xc0], -2.0),
    ] {
        assert_eq!(one(descr, &bytes), Ok(expected), "{descr}");
    }
    assert!(one("<f2", &[0x01, 0x7c]).unwrap().is_nan());
    assert!(one("<f2", &[0x00, 0xfc]).unwrap_err().starts_with("1 of 1 heights are infinite"));
    for descr in ["|b1", "<c16", "|O", "<U3", "|S5", "<f16", "<M8[ns]", "f8", "|f8", "=f8", "<f1", "", "<", "é"] {
        assert!(one(descr, &[0; 8]).unwrap_err().starts_with("the array has type "), "{descr}");
    }
}

#[test]
fn zip_bombs_and_lies_are_refused() {
    let (_folder, path) = place("a.npz");
    let case = |arrays: &[(&str, &[u8])], method: CompressionMethod| {
        let mut zip = ZipWriter::new(fs::File::create(&path).unwrap());
        for (name, content) in arrays {
            zip.start_file(*name, SimpleFileOptions::default().compression_method(method)).unwrap();
            zip.write_all(content).unwrap();
        }
        zip.finish().unwrap();
        read(&path, &options()).map_err(|error| error.to_string())
    };
    let shape =
        |columns: u64, rows: u64| format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({columns}, {rows})}}");
    // 64 MiB of zeros in 64 KiB: what deflate can do is read.
    let large = array(&shape(4096, 2048), 8 << 23);
    let zeros = case(&[("z.npy", &large)], CompressionMethod::Deflated).unwrap();
    assert_eq!(zeros.heights.len(), 4096 * 2048);
    // A promise beyond that, and one that the member does not keep.
    let found = case(&[("z.npy", &array(&shape(16384, 16384), 8))], CompressionMethod::Deflated).unwrap_err();
    assert!(found.starts_with("array \"z\": the array has shape (16384, 16384), which is more than the "), "{found}");
    for method in [CompressionMethod::Stored, CompressionMethod::Deflated] {
        let found = case(&[("z.npy", &array(&shape(5, 4), 159))], method).unwrap_err();
        assert_eq!(found, "array \"z\": the data have 159 bytes, expected 160 for shape (5, 4)");
        let found = case(&[("z.npy", &array(&shape(5, 4), 1 << 22))], method).unwrap_err();
        assert_eq!(found, "array \"z\": the data have 161 bytes, expected 160 for shape (5, 4)");
    }
    // The checksum of the archive.
    let mut content = fs::read(corpus("one_of_two.npz")).unwrap();
    let at = content.windows(8).position(|part| part == 19.0_f64.to_le_bytes()).unwrap();
    content[at + 7] ^= 1;
    fs::write(&path, &content).unwrap();
    assert_eq!(message(&path, &options()), "array \"z\": cannot be decompressed: Invalid checksum");
}

#[test]
fn images_that_promise_more_than_they_hold() {
    let (_folder, path) = place("a.png");
    // An image of 2^31 - 1 lines: the checksum of the header is made to fit.
    let mut content = fs::read(corpus("grey8.png")).unwrap();
    content[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
    let crc = crc32(&content[12..29]).to_be_bytes();
    content[29..33].copy_from_slice(&crc);
    fs::write(&path, &content).unwrap();
    let found = message(&path, &black_to_white(1.0));
    assert!(found.starts_with("the image has 2147483647 x 2147483647 pixels, which a file of 79 bytes"), "{found}");
    content[16..24].copy_from_slice(&[0, 0, 0x20, 0, 0, 0, 0x20, 0]);
    let crc = crc32(&content[12..29]).to_be_bytes();
    content[29..33].copy_from_slice(&crc);
    fs::write(&path, &content).unwrap();
    let found = message(&path, &black_to_white(1.0));
    assert!(found.starts_with("the image has 8192 x 8192 pixels, which a file of 79 bytes"), "{found}");
    // A tag of 2^23 values, for which the decoder would ask for 256 MiB; the name ends in .png, the content decides.
    for (name, first, width) in [("grey8.tif", 10, 4), ("grey16be.tif", 10, 4), ("grey16big.tif", 24, 8)] {
        let mut content = fs::read(corpus(name)).unwrap();
        let count = &mut content[first + 4..first + 4 + width];
        if name == "grey16be.tif" {
            count.copy_from_slice(&(1_u32 << 23).to_be_bytes());
        } else {
            count.copy_from_slice(&(1_u64 << 23).to_le_bytes()[..width]);
        }
        fs::write(&path, &content).unwrap();
        let expected =
            format!("the image has a tag of 8388608 values, which a file of {} bytes does not hold", content.len());
        assert_eq!(message(&path, &black_to_white(1.0)), expected, "{name}");
    }
}

/// ISO 3309, the checksum of PNG chunks and of records.
pub(crate) fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, byte: &u8| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 })
    };
    !bytes.iter().fold(!0, step)
}

/// The files of the corpus that this test can read, each with what is needed to read it.
fn readable() -> Vec<(PathBuf, ReadOptions)> {
    let mut files: Vec<PathBuf> = fs::read_dir(corpus("")).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let options = files.into_iter().map(|path| {
        let dataset = path.ends_with("two.npz").then(|| "a".to_owned());
        let options = match path.extension().and_then(|ending| ending.to_str()) {
            Some("png") => black_to_white(1e-6),
            Some("tif") if !path.ends_with("decimal.tif") => black_to_white(1e-6),
            Some("tif" | "npy" | "npz") => ReadOptions { dataset, ..um() },
            _ => ReadOptions::default(),
        };
        (path, options)
    });
    options.filter(|(path, options)| read(path, options).is_ok()).collect()
}

#[test]
fn a_file_cut_at_any_byte_is_an_error_or_a_smaller_text() {
    let folder = tempfile::tempdir().unwrap();
    for (path, options) in readable() {
        let ending = path.extension().unwrap_or_default();
        if ending == "h5" || ending == "sdf" {
            continue;
        }
        let cut = folder.path().join("cut").with_extension(ending);
        let content = fs::read(&path).unwrap();
        // In the short form every byte of the head, and every seventh of what follows.
        let step = few_or_all(7, 1);
        for length in (0..content.len()).filter(|length| *length < 200 || length.is_multiple_of(step)) {
            fs::write(&cut, &content[..length]).unwrap();
            let result = read(&cut, &options);
            let text = ["txt", "csv", "xyz", "asc"].iter().any(|known| ending == *known);
            assert!(result.is_err() || text, "{} cut at {length}: {result:?}", path.display());
        }
    }
}
