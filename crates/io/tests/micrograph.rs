//! The pin's base from a micrograph, from scene to cells.

use std::fs;
use std::path::{Path, PathBuf};

use plateau_core::model::state::Base;
use plateau_core::surface::micrograph::{Enlargement, Fibres, Micrograph, Threshold};
use plateau_io::scene;
use plateau_io::scene::{BaseSource, Scene};
use plateau_io::surface::{Loaded, load, micrograph, stated_pixel};
use png::{BitDepth, ColorType};

use crate::fixtures::place;

/// Square cells of 100 µm, a pin of 3 mm by 2 mm; without `[pin.base]`.
const SCENE: &str = r#"
version = 1
[mesh]
inner_radius = "21 mm"
outer_radius = "23 mm"
rows = 20
disc_columns = 1382
pin_columns = 30
[operation]
normal_force = "5 N"
rotational_speed = "850 rpm"
steps = 1
[contact]
foundation_height = "50 um"
[materials]
disc_primary = { youngs_modulus = "1e11 Pa", poisson_ratio = 0.27, specific_wear_rate = "0 1/Pa" }
pin_primary = { youngs_modulus = "1e9 Pa", poisson_ratio = 0.27, specific_wear_rate = "5e-14 1/Pa" }
pin_resin = { youngs_modulus = "1e5 Pa", poisson_ratio = 0.27, wear_height = "5 um" }
[plateaus]
captured_fraction = 0.06
[disc.surface]
flat = true
[pin.surface]
flat = true
[pin.base]
image = "pin.png"
"#;

const SIZE: (usize, usize) = (160, 120);

/// Writes an image of 160 x 120 pixels.
fn png(path: &Path, colour: ColorType, depth: BitDepth, pixel: impl Fn(usize, usize) -> Vec<u8>) {
    let mut encoder = png::Encoder::new(fs::File::create(path).unwrap(), SIZE.0 as u32, SIZE.1 as u32);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    let data: Vec<u8> = (0..SIZE.0 * SIZE.1).flat_map(|at| pixel(at % SIZE.0, at / SIZE.0)).collect();
    encoder.write_header().unwrap().write_image_data(&data).unwrap();
}

/// Fibre right of the middle, and a bar along the top.
fn fibre(x: usize, line: usize) -> bool {
    x >= 80 || line < 30
}

/// A folder with the picture and a scene with these keys of `[pin.base]`.
fn case<P>(colour: ColorType, depth: BitDepth, pixel: P, keys: &str) -> (tempfile::TempDir, PathBuf)
where
    P: Fn(usize, usize) -> Vec<u8>,
{
    let folder = tempfile::tempdir().unwrap();
    png(&folder.path().join("pin.png"), colour, depth, pixel);
    let path = folder.path().join("scene.toml");
    fs::write(&path, format!("{SCENE}{keys}\n")).unwrap();
    (folder, path)
}

fn grey(keys: &str) -> (tempfile::TempDir, Scene) {
    let level = |x, line| vec![if fibre(x, line) { 200 } else { 50 }];
    let (folder, path) = case(ColorType::Grayscale, BitDepth::Eight, level, keys);
    (folder, scene::load(&path, &[]).unwrap())
}

/// A text with the path of its folder left out.
fn of_folder(folder: &tempfile::TempDir, text: &str) -> String {
    text.replace(&folder.path().display().to_string(), "[folder]")
}

/// Why there are no surfaces of a scene.
fn refusal((folder, path): (tempfile::TempDir, PathBuf)) -> String {
    of_folder(&folder, &load(&scene::load(&path, &[]).unwrap()).unwrap_err().to_string())
}

/// Base at a column of 30 and a row of 20.
fn at(loaded: &Loaded, column: usize, row: usize) -> bool {
    loaded.surfaces.pin_base[column * 20 + row] == Base::Primary
}

#[test]
fn the_keys_of_a_scene_say_how() {
    let (_folder, scene) = grey("pixel = \"20 um\"");
    let BaseSource::Image { micrograph, .. } = scene.pin_base else { panic!("{:?}", scene.pin_base) };
    let plain = Micrograph {
        pixel: 2e-5,
        quarters: 0,
        smooth: None,
        threshold: Threshold::Otsu,
        fibres: Fibres::Bright,
        despeckle: None,
        enlargement: None,
    };
    assert_eq!(micrograph, plain);
    for key in ["rotate = \"0 deg\"", "threshold = \"otsu\"", "fibres = \"bright\""] {
        assert!(scene.resolved.contains(key), "{}", scene.resolved);
    }
    let keys = "pixel = \"20 um\"\nthreshold = 0.5\nsmooth = \"15 um\"\ndespeckle = \"2000 um^2\"\nrotate = \"270 deg\"\n\
                fibres = \"dark\"\nmirror = true";
    let (folder, scene) = grey(keys);
    let BaseSource::Image { micrograph, .. } = scene.pin_base else { panic!("{:?}", scene.pin_base) };
    let full = Micrograph {
        quarters: 3,
        smooth: Some(15e-6),
        threshold: Threshold::Level(0.5),
        fibres: Fibres::Dark,
        despeckle: Some(2000e-12),
        ..plain
    };
    assert_eq!(micrograph, full);
    for (keys, enlargement, resolved) in [
        ("repeat = true", Enlargement::Tiles, "repeat = true"),
        ("extend = \"statistics\"", Enlargement::Statistics { seed: 0 }, "extend_seed = 0"),
        ("extend = \"statistics\"\nextend_seed = 7", Enlargement::Statistics { seed: 7 }, "extend_seed = 7"),
    ] {
        let (_folder, scene) = grey(&format!("pixel = \"20 um\"\n{keys}"));
        let BaseSource::Image { micrograph, .. } = scene.pin_base else { panic!("{:?}", scene.pin_base) };
        assert_eq!(micrograph, Micrograph { enlargement: Some(enlargement), ..plain });
        assert!(scene.resolved.contains(resolved), "{}", scene.resolved);
    }
    // What is resolved reads back as the same.
    let again = folder.path().join("again.toml");
    fs::write(&again, &scene.resolved).unwrap();
    assert_eq!(scene::load(&again, &[]).unwrap().resolved, scene.resolved);
    // Another source takes the companions of the image with it.
    let other = scene::load(&folder.path().join("scene.toml"), &["pin.base.uniform=primary".to_owned()]).unwrap();
    assert_eq!(other.pin_base, BaseSource::Uniform(Base::Primary));
    assert!(!other.resolved.contains("threshold"), "{}", other.resolved);
}

#[test]
fn every_step_is_reported_and_the_cells_lie_where_the_picture_shows_them() {
    let (folder, scene) = grey("pixel = \"20 um\"\ndespeckle = \"2000 um^2\"");
    let loaded = load(&scene).unwrap();
    // The bar covers what is more than 0.6 mm beyond the mean radius: the outer 4 rows of 20.
    assert!(at(&loaded, 20, 5) && !at(&loaded, 10, 5) && at(&loaded, 10, 18) && !at(&loaded, 10, 14));
    assert_eq!(loaded.inputs.len(), 1);
    let report = loaded.report.iter().filter(|line| line.starts_with("pin.base: "));
    insta::assert_snapshot!(of_folder(&folder, &report.cloned().collect::<Vec<_>>().join("\n")));
}

#[test]
fn the_example_has_the_fibres_it_was_drawn_with() {
    // data/surfaces/README.md: 25.11 % of the picture is fibre by construction. Fillers and uneven light keep Otsu's
    // level from the middle between fibre and resin, where a smoothed edge stays in place: a quarter of the smoothing's
    // standard deviation of one pixel is granted, on both sides of fibres that are six wide.
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/scenes/micrograph.toml");
    let report = load(&scene::load(&path, &[]).unwrap()).unwrap().report;
    let line = report.iter().find(|line| line.contains("removed, fibre fraction of the picture then ")).unwrap();
    let found: f64 = line.rsplit(' ').next().unwrap().parse().unwrap();
    assert!((found - 0.2511).abs() < 0.2511 * 2.0 * 0.25 / 6.0, "{line}");
}

#[test]
fn mirror_and_rotation_turn_the_picture() {
    let (_folder, scene) = grey("pixel = \"20 um\"\nmirror = true");
    let mirrored = load(&scene).unwrap();
    assert!(!at(&mirrored, 20, 5) && at(&mirrored, 10, 5) && at(&mirrored, 20, 18));
    assert!(mirrored.report.iter().any(|line| line == "pin.base: mirrored along the sliding direction"));
    let (_folder, scene) = grey("pixel = \"20 um\"\nrotate = \"180 deg\"");
    let turned = load(&scene).unwrap();
    assert!(!at(&turned, 20, 14) && at(&turned, 10, 14) && at(&turned, 20, 1));
}

#[test]
fn colours_become_luma_and_sixteen_bits_are_read() {
    let (_folder, grey_scene) = grey("pixel = \"20 um\"");
    let expected = load(&grey_scene).unwrap().surfaces.pin_base;
    // Pure green has luma 0.7152, pure red 0.2126, pure blue 0.0722; the resin here is the reddest.
    let colour = |x, line| if fibre(x, line) { vec![0, 255, 0] } else { vec![255, 0, 255] };
    let opaque = |x, line| [colour(x, line), vec![255]].concat();
    let deep = |x, line| if fibre(x, line) { vec![0x80, 0x01] } else { vec![0x80, 0x00] };
    for (_folder, path) in [
        case(ColorType::Rgb, BitDepth::Eight, colour, "pixel = \"20 um\"\nthreshold = 0.5"),
        case(ColorType::Rgba, BitDepth::Eight, opaque, "pixel = \"20 um\"\nthreshold = 0.5"),
        case(ColorType::Grayscale, BitDepth::Sixteen, deep, "pixel = \"20 um\""),
    ] {
        let loaded = load(&scene::load(&path, &[]).unwrap()).unwrap();
        assert_eq!(loaded.surfaces.pin_base, expected, "{:?}", loaded.report);
    }
}

#[test]
fn what_gives_no_fibre_map_is_told() {
    let level = |x, line| vec![if fibre(x, line) { 200 } else { 50 }];
    let plain = |keys: &str| case(ColorType::Grayscale, BitDepth::Eight, level, keys);
    let text = plain("pixel = \"20 um\"");
    fs::write(text.0.path().join("pin.png"), "1 2\n3 4\n").unwrap();
    let said = [
        plain("pixel = \"10 um\""),
        case(ColorType::GrayscaleAlpha, BitDepth::Eight, |_, _| vec![200, 100], "pixel = \"20 um\""),
        case(ColorType::Grayscale, BitDepth::Eight, |_, _| vec![7], "pixel = \"20 um\""),
        text,
        jpeg("turned.jpg", "pixel = \"20 um\""),
        jpeg("cmyk.jpg", "pixel = \"20 um\""),
    ];
    insta::assert_snapshot!(said.map(refusal).join("\n"));
    let (folder, path) = plain("pixel = \"20 um\"");
    let content = fs::read(folder.path().join("pin.png")).unwrap();
    for length in [8, 20, 33, 50, content.len() / 2, content.len() - 1] {
        fs::write(folder.path().join("pin.png"), &content[..length]).unwrap();
        let found = load(&scene::load(&path, &[]).unwrap()).unwrap_err().to_string();
        assert!(found.contains("pin.png: cannot be read as PNG: "), "{length}: {found}");
    }
}

#[test]
fn the_micrograph_is_what_the_base_is_made_of() {
    let (_folder, scene) = grey("pixel = \"20 um\"");
    let (map, pixel) = micrograph(&scene).unwrap().unwrap();
    assert_eq!(pixel, 20e-6);
    assert_eq!((map.grey.width, map.grey.height), SIZE);
    for (x, line) in [(140, 100), (20, 100), (20, 10), (79, 30), (80, 30)] {
        let (at, is_fibre) = (line * SIZE.0 + x, fibre(x, line));
        assert_eq!(map.fibre.pixels[at], is_fibre, "{x}, {line}");
        let level = if is_fibre { 200.0 } else { 50.0 };
        assert!((255.0 * map.grey.pixels[at] - level).abs() < 1e-3, "{x}, {line}");
    }
    assert_eq!(load(&scene).unwrap().surfaces.pin_base, map.base);
}

/// A file of the corpus, as the picture of a scene with these keys; its name says PNG, its content what it is.
fn jpeg(name: &str, keys: &str) -> (tempfile::TempDir, PathBuf) {
    let (folder, path) = case(ColorType::Grayscale, BitDepth::Eight, |_, _| vec![0], keys);
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus/pictures");
    fs::copy(corpus.join(name), folder.path().join("pin.png")).unwrap();
    (folder, path)
}

#[test]
fn a_jpeg_shows_what_a_png_of_the_same_picture_does() {
    let (_folder, scene) = grey("pixel = \"20 um\"");
    let (expected, _) = micrograph(&scene).unwrap().unwrap();
    for (name, told) in [
        ("grey.jpg", "160 x 120 pixels, grey, 8 bits"),
        ("progressive.jpg", "160 x 120 pixels, grey, 8 bits"),
        ("colour.jpg", "160 x 120 pixels, colours, taken as their luma, 8 bits"),
    ] {
        let (_folder, path) = jpeg(name, "pixel = \"20 um\"");
        let scene = scene::load(&path, &[]).unwrap();
        let (map, _) = micrograph(&scene).unwrap().unwrap();
        assert_eq!((map.grey.width, map.grey.height), SIZE);
        // Blocks of 16 pixels end at its edges or in the middle of the bar: levels ring, what is fibre stays but for some pixels there.
        let pairs = map.fibre.pixels.iter().zip(&expected.fibre.pixels);
        let differ = pairs.filter(|(one, other)| one != other).count();
        assert!(differ <= SIZE.0 + SIZE.1, "{name}: {differ}");
        let report = load(&scene).unwrap().report;
        assert!(report.iter().any(|line| line.contains(told)), "{name}: {report:?}");
    }
    // Where they do not change, levels of a grey one are those of the PNG.
    let (_folder, path) = jpeg("grey.jpg", "pixel = \"20 um\"");
    let (map, _) = micrograph(&scene::load(&path, &[]).unwrap()).unwrap().unwrap();
    for (x, line) in [(20, 60), (140, 60), (140, 10), (5, 5)] {
        let off = 255.0 * (map.grey.pixels[line * SIZE.0 + x] - expected.grey.pixels[line * SIZE.0 + x]);
        assert!(off.abs() <= 2.0, "{x}, {line}: {off}");
    }
}

#[test]
fn a_jpeg_that_is_damaged_is_refused() {
    for name in ["grey.jpg", "progressive.jpg", "colour.jpg"] {
        let (folder, path) = jpeg(name, "pixel = \"20 um\"");
        let content = fs::read(folder.path().join("pin.png")).unwrap();
        let scene = scene::load(&path, &[]).unwrap();
        for length in 3..content.len() {
            fs::write(folder.path().join("pin.png"), &content[..length]).unwrap();
            let found = load(&scene).unwrap_err().to_string();
            assert!(found.contains("pin.png: cannot be read as JPEG: ") || length < 30, "{name}, {length}: {found}");
        }
        // Cameras write more behind the end.
        fs::write(folder.path().join("pin.png"), [&content[..], b"more"].concat()).unwrap();
        load(&scene).unwrap();
    }
}

#[test]
fn a_picture_that_is_smaller_than_the_pin_is_repeated_or_gives_its_statistics() {
    let statistics = "random fibres with the fraction and the correlation of the picture of 1.6 mm by 1.2 mm";
    let repeated = "the picture of 1.6 mm by 1.2 mm repeated 1.9";
    for (keys, told) in [("repeat = true", repeated), ("extend = \"statistics\"", statistics)] {
        let (_folder, scene) = grey(&format!("pixel = \"10 um\"\n{keys}"));
        let loaded = load(&scene).unwrap();
        assert!(loaded.report.iter().any(|line| line.contains(told)), "{:?}", loaded.report);
        let last = loaded.report.iter().rfind(|line| line.starts_with("pin.base: ")).unwrap();
        assert!(last.contains("fibre fraction 0.6"), "{last}");
    }
    // What the picture cannot tell is a warning.
    let (_folder, scene) = grey("pixel = \"10 um\"\nextend = \"statistics\"");
    let warnings: Vec<String> = load(&scene).unwrap().warnings().collect();
    assert!(warnings[0].starts_with("pin.base: along sliding, fibre is related over a quarter"), "{warnings:?}");
    let both = "pixel = \"20 um\"\nrepeat = true\nextend = \"statistics\"";
    let (_folder, path) = case(ColorType::Grayscale, BitDepth::Eight, |_, _| vec![0], both);
    let refused = scene::load(&path, &[]).unwrap_err().to_string();
    assert!(refused.contains("repeat and extend are given together"), "{refused}");
}

#[test]
fn the_distance_of_pixels_is_what_files_state() {
    let (_folder, path) = place("stated.png");
    let mut encoder = png::Encoder::new(fs::File::create(&path).unwrap(), 2, 1);
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: 500_000, yppu: 500_000, unit: png::Unit::Meter }));
    encoder.write_header().unwrap().write_image_data(&[0, 9]).unwrap();
    assert_eq!(stated_pixel(&path).unwrap(), Some(2e-6));
    // 5000 pixels in a centimetre, and twice as many along as across.
    for (across, expected) in [(5000, Some(2e-6)), (2500, None)] {
        let mut encoder = tiff::encoder::TiffEncoder::new(fs::File::create(&path).unwrap()).unwrap();
        let mut image = encoder.new_image::<tiff::encoder::colortype::Gray8>(2, 1).unwrap();
        image.resolution_unit(tiff::tags::ResolutionUnit::Centimeter);
        image.x_resolution(tiff::encoder::Rational { n: 5000, d: 1 });
        image.y_resolution(tiff::encoder::Rational { n: across, d: 1 });
        image.write_data(&[0, 9]).unwrap();
        assert_eq!(stated_pixel(&path).unwrap(), expected);
    }
    let (folder, _) = jpeg("grey.jpg", "");
    // 2540 pixels in an inch.
    let found = stated_pixel(&folder.path().join("pin.png")).unwrap().unwrap();
    assert!((found - 1e-5).abs() < 1e-12, "{found}");
    let (folder, _) = jpeg("progressive.jpg", "");
    assert_eq!(stated_pixel(&folder.path().join("pin.png")).unwrap(), None);
}
