//! The chain from picture to fibre map.

use plateau_core::model::mesh::{Mesh, Outline};
use plateau_core::model::state::Base;
use plateau_core::surface::micrograph::{
    Enlargement, FibreMap, Fibres, Micrograph, MicrographError, Picture, PinPlane, Threshold,
};
use plateau_core::surface::{Body, HeightSynthesis, Texture, fibre_fraction};

/// Square cells of 100 µm at the mean radius, pin of 3 mm by 2 mm.
fn mesh() -> Mesh {
    let mean_radius = 100e-6 * 1400.0 / std::f64::consts::TAU;
    Mesh::new(20, 1400, 30, mean_radius - 1e-3, mean_radius + 1e-3).unwrap()
}

fn settings() -> Micrograph {
    Micrograph {
        pixel: 20e-6,
        quarters: 0,
        smooth: None,
        threshold: Threshold::Otsu,
        fibres: Fibres::Bright,
        despeckle: None,
        enlargement: None,
    }
}

/// Bright to the right of x = 0, a bright bar along the top, dark elsewhere.
fn picture() -> Picture<f32> {
    let (width, height) = (160, 120);
    let bright = |x: usize, y: usize| x >= 80 || y < 30;
    let pixels = (0..width * height).map(|i| if bright(i % width, i / width) { 0.8 } else { 0.2 }).collect();
    Picture { width, height, pixels }
}

/// Base of the cell whose centre has this place in the plane.
fn at(map: &FibreMap, x: f64, y: f64) -> Base {
    map.base[PinPlane::new(&mesh()).cell(x, y).unwrap()]
}

#[test]
fn the_picture_lies_with_its_top_outward_and_its_right_in_sliding_direction() {
    let map = settings().fibre_map(picture(), &mesh()).unwrap();
    // The bar covers y > 30 · 20 µm.
    for (x, y, base) in [
        (0.5e-3, -0.5e-3, Base::Primary),
        (-0.5e-3, -0.5e-3, Base::Resin),
        (-0.5e-3, 0.8e-3, Base::Primary),
        (-0.5e-3, 0.4e-3, Base::Resin),
    ] {
        assert_eq!(at(&map, x, y), base, "{x} {y}");
    }
    // A quarter turn counterclockwise puts what was right on top.
    let turned = Micrograph { quarters: 1, pixel: 30e-6, ..settings() }.fibre_map(picture(), &mesh()).unwrap();
    assert_eq!((at(&turned, 0.5e-3, 0.5e-3), at(&turned, 0.5e-3, -0.5e-3)), (Base::Primary, Base::Resin));
    assert_eq!(turned.report[0], "turned counterclockwise by 90 deg");
    let dark = Micrograph { fibres: Fibres::Dark, ..settings() }.fibre_map(picture(), &mesh()).unwrap();
    assert!(dark.base.iter().zip(&map.base).all(|(a, b)| a != b));
}

#[test]
fn the_fractions_are_told() {
    let map = settings().fibre_map(picture(), &mesh()).unwrap();
    // Half of the picture, and a quarter of the other half.
    assert_eq!(map.report[1], "fibre fraction of the picture 0.6250");
    // On the pin the bar covers the outer 0.4 mm of 2 mm: 0.5 + 0.5 · 0.2, but for the curvature of the rows, at most
    // 1.5²/(2 · 22.3) mm = 50 µm of 2 mm, and for the larger share of the outer rows.
    let found: f64 = map.report[2].rsplit(' ').next().unwrap().parse().unwrap();
    assert!((found - 0.6).abs() < 0.0125, "{found}");
    assert!((fibre_fraction(&map.base, &mesh()) - found).abs() < 0.03);
}

#[test]
fn specks_go_and_a_smoothed_picture_has_fewer() {
    let mut speckled = picture();
    for (x, y, level) in [(20, 60, 0.9), (21, 60, 0.9), (100, 60, 0.1), (40, 80, 0.9)] {
        speckled.pixels[y * 160 + x] = level;
    }
    let clean = settings().fibre_map(picture(), &mesh()).unwrap();
    let kept = settings().fibre_map(speckled.clone(), &mesh()).unwrap();
    assert_ne!(kept.fibre, clean.fibre);
    // 3 pixels of 20 µm squared.
    let despeckled = Micrograph { despeckle: Some(1.2e-9), ..settings() }.fibre_map(speckled.clone(), &mesh()).unwrap();
    assert_eq!(despeckled.fibre, clean.fibre);
    assert_eq!(
        despeckled.report[2],
        "2 specks of fibre and 1 holes of fewer than 3 pixels removed, fibre fraction of the picture then 0.6250"
    );
    let some = Micrograph { despeckle: Some(0.8e-9), ..settings() }.fibre_map(speckled.clone(), &mesh()).unwrap();
    assert_ne!(some.fibre, clean.fibre, "two pixels are not fewer than two");
    let smoothed = Micrograph { smooth: Some(40e-6), ..settings() }.fibre_map(speckled, &mesh()).unwrap();
    assert_eq!(smoothed.base, clean.base);
}

#[test]
fn what_makes_no_sense_is_refused() {
    let error = |settings: Micrograph| settings.fibre_map(picture(), &mesh()).unwrap_err().to_string();
    assert_eq!(
        error(Micrograph { smooth: Some(1e-3), ..settings() }),
        "smooth = 1 mm is 50.0 pixels, expected at most a quarter of the picture's shorter side of 120 pixels"
    );
    assert_eq!(
        error(Micrograph { threshold: Threshold::Level(1.5), ..settings() }),
        "threshold is 1.5, expected a grey level from 0 to 1"
    );
    let small = error(Micrograph { pixel: 10e-6, ..settings() });
    assert!(small.starts_with("the picture is 1.6 mm by 1.2 mm, the pin 3."), "{small}");
    assert!(small.contains("repeat = true") && small.contains("extend = \"statistics\""), "{small}");
    assert!(small.contains("a larger picture") && !small.contains("pixel"), "{small}");
    // 3 by 2 cells.
    let extended = Micrograph { pixel: 2.1e-6, enlargement: Some(Enlargement::Statistics { seed: 1 }), ..settings() };
    assert!(
        error(extended)
            .starts_with("3 by 2 whole cells lie in the picture of 336 um by 252 um, expected at least 4 by 4")
    );
    for pixel in [0.0, f64::NAN, f64::INFINITY, -1.0] {
        assert!(error(Micrograph { pixel, ..settings() }).starts_with("pixel is "));
    }
    for area in [f64::NAN, -1.0] {
        assert!(error(Micrograph { despeckle: Some(area), ..settings() }).starts_with("despeckle is "));
    }
    let grey = Picture { width: 160, height: 120, pixels: vec![0.5; 160 * 120] };
    assert_eq!(settings().fibre_map(grey.clone(), &mesh()), Err(MicrographError::Uniform));
    let all = Micrograph { threshold: Threshold::Level(0.4), ..settings() }.fibre_map(grey, &mesh()).unwrap();
    assert!(all.base.iter().all(|base| *base == Base::Primary));
    for (width, height, level) in
        [(160, 119, 0.5), (usize::MAX, 2, 0.5), (0, 0, 0.5), (160, 120, f32::NAN), (160, 120, 1.1)]
    {
        let grey = Picture { width, height, pixels: vec![level; 160 * 120] };
        assert!(matches!(settings().fibre_map(grey, &mesh()), Err(MicrographError::Picture { .. })));
    }
}

/// Cells of 50 µm, a pin of 4 mm by 8 mm at 22 mm: the paper's.
fn paper() -> Mesh {
    Mesh::new(80, 2764, 161, 20e-3, 24e-3).unwrap()
}

#[test]
fn a_cell_is_found_where_its_centre_lies() {
    let mesh = paper();
    let plane = PinPlane::new(&mesh);
    for column in [0, 1, 80, 159, 160] {
        for row in [0, 1, 40, 79] {
            let angle = (column as f64 + 0.5 - 80.5) * mesh.column_angle();
            let radius = mesh.radius()[row];
            let found = plane.cell(radius * angle.sin(), radius * angle.cos() - mesh.mean_radius());
            assert_eq!(found, Some(column * 80 + row));
        }
    }
    for (x, y) in [(0.0, 2.001e-3), (0.0, -2.001e-3), (4.1e-3, 0.0), (-4.1e-3, 0.0)] {
        assert_eq!(plane.cell(x, y), None);
    }
}

#[test]
fn a_picture_that_does_not_cover_the_pin_is_refused() {
    let mesh = paper();
    let (across, up) = PinPlane::new(&mesh).half_extent();
    // The outer corners lie at 24 mm · sin(80.5 · 2π/2764), the lowest points at 20 mm · cos.
    let angle = 80.5 * std::f64::consts::TAU / 2764.0;
    assert!((across - 24e-3 * angle.sin()).abs() < 1e-15 && (up - (22e-3 - 20e-3 * angle.cos())).abs() < 1e-15);
    let bright = Picture { width: 1000, height: 400, pixels: vec![1.0; 400_000] };
    let of = |pixel: f64| {
        Micrograph { pixel, threshold: Threshold::Level(0.5), ..settings() }.fibre_map(bright.clone(), &mesh)
    };
    let pixel = (2.0 * across / 1000.0).max(2.0 * up / 400.0);
    assert!(matches!(of(pixel * 0.999), Err(MicrographError::Small { .. })));
    assert!(of(pixel * 1.001).unwrap().base.iter().all(|base| *base == Base::Primary));
}

#[test]
fn a_round_pin_needs_a_picture_of_its_own_size() {
    // Arcs about the axis are not straight, so that the circle is a little bent: by R²/(2 r̄) = 91 µm of 2 mm at most.
    let mesh = paper().with_outline(Outline::Disc { radius: 2e-3 }).unwrap();
    let (across, up) = PinPlane::new(&mesh).half_extent();
    assert!((across - 2e-3).abs() < 91e-6 + 50e-6 && (up - 2e-3).abs() < 91e-6 + 50e-6, "{across} {up}");
}

#[test]
fn a_disc_in_the_picture_keeps_its_area_and_place() {
    // Area π R². Pixels of 10 µm misplace the edge by at most half a diagonal, with random sign; the fraction is told to 5e-5.
    let mesh = paper();
    let (centre, radius) = ((1.5e-3, -0.6e-3), 0.8e-3);
    let place = |at: usize, count: usize| (at as f64 + 0.5 - 0.5 * count as f64) * 10e-6;
    let level = |i: usize| {
        let (x, y) = (place(i % 1000, 1000), -place(i / 1000, 600));
        if f64::hypot(x - centre.0, y - centre.1) < radius { 1.0 } else { 0.0 }
    };
    let picture = Picture { width: 1000, height: 600, pixels: (0..600_000).map(level).collect() };
    let map = Micrograph { pixel: 10e-6, ..settings() }.fibre_map(picture, &mesh).unwrap();
    let found: f64 = map.report[2].rsplit(' ').next().unwrap().parse().unwrap();
    let expected = std::f64::consts::PI * radius * radius / mesh.pin_area();
    assert!((found - expected).abs() < 1e-4, "{found} {expected}");
    // Its centre of area, from the cells, by the mapping in the other direction.
    let (mut moment, mut area) = ((0.0, 0.0), 0.0);
    for cell in (0..map.base.len()).filter(|cell| map.base[*cell] == Base::Primary) {
        let angle = ((cell / 80) as f64 + 0.5 - 80.5) * mesh.column_angle();
        let (r, own) = (mesh.radius()[cell % 80], mesh.area()[cell % 80]);
        area += own;
        moment.0 += own * r * angle.sin();
        moment.1 += own * (r * angle.cos() - mesh.mean_radius());
    }
    assert!((moment.0 / area - centre.0).hypot(moment.1 / area - centre.1) < 5e-6, "{moment:?}");
}

/// What becomes of a small picture, line by line, whose pixels are so large that it covers the pin.
fn of(lines: &[&[f32]], settings: Micrograph) -> FibreMap {
    let picture = Picture { width: lines[0].len(), height: lines.len(), pixels: lines.concat() };
    Micrograph { pixel: 5e-3, ..settings }.fibre_map(picture, &mesh()).unwrap()
}

#[test]
fn pictures_turn_counterclockwise() {
    // numpy.rot90([[1, 2, 3], [4, 5, 6]], k)
    for (quarters, width, pixels) in
        [(0, 3, [1, 2, 3, 4, 5, 6]), (1, 2, [3, 6, 2, 5, 1, 4]), (2, 3, [6, 5, 4, 3, 2, 1]), (3, 2, [4, 1, 5, 2, 6, 3])]
    {
        let turned = of(&[&[0.1, 0.2, 0.3], &[0.4, 0.5, 0.6]], Micrograph { quarters, ..settings() }).grey;
        assert_eq!((turned.width, turned.height), (width, 6 / width));
        assert_eq!(turned.pixels.iter().map(|level| (10.0 * level).round() as i32).collect::<Vec<_>>(), pixels);
    }
}

/// scipy 1.17.1 ndimage.gaussian_filter(numpy.arange(35).reshape(5, 7)**2 % 23 / 23, 0.7), its default mode and truncation.
#[rustfmt::skip]
const SMOOTHED: [f64; 35] = [
    0.073148582, 0.181265912, 0.269377731, 0.395367450, 0.452719518, 0.311529775, 0.434446720,
    0.278102007, 0.468881641, 0.419447312, 0.375849305, 0.334997778, 0.335587463, 0.386024269,
    0.415054783, 0.473637984, 0.322733567, 0.315806256, 0.286760820, 0.435340065, 0.461648986,
    0.243624394, 0.243245326, 0.167365873, 0.245309963, 0.293045656, 0.418496175, 0.513319831,
    0.184064740, 0.310054829, 0.284856205, 0.474033799, 0.458460099, 0.378857142, 0.357538044,
];

#[test]
fn smoothing_agrees_with_scipy() {
    // Levels of a picture are float32, twice rounded: 2⁻²⁴ each.
    let levels: Vec<f32> = (0..35).map(|i| ((i * i % 23) as f64 / 23.0) as f32).collect();
    let lines: Vec<&[f32]> = levels.chunks(7).collect();
    for (pixel, expected) in SMOOTHED.iter().enumerate() {
        let is_above = |level: f64| {
            let threshold = Threshold::Level(level);
            of(&lines, Micrograph { smooth: Some(0.7 * 5e-3), threshold, ..settings() }).fibre.pixels[pixel]
        };
        assert!(is_above(expected - 2e-7) && !is_above(expected + 2e-7), "{pixel}");
    }
}

/// Grey levels of 8 bits with their counts, and the level that is found.
const OTSU: &[(&[(u8, usize)], u8)] = &[
    (&[(50, 10), (200, 30)], 50),
    (&[(0, 1), (255, 1000)], 0),
    (&[(10, 5), (20, 9), (30, 4), (180, 3), (200, 12), (230, 2)], 30),
    (&[(0, 100), (1, 90), (2, 50), (3, 5), (4, 1)], 0),
    (
        &[
            (0, 1),
            (25, 2),
            (50, 5),
            (75, 10),
            (100, 17),
            (125, 26),
            (150, 8),
            (175, 21),
            (200, 7),
            (225, 24),
            (250, 14),
        ],
        150,
    ),
    (&[(100, 50), (120, 40), (140, 45), (160, 3)], 120),
];

#[test]
fn the_threshold_agrees_with_scikit_image() {
    // skimage 0.26.0 filters.threshold_otsu on 8-bit pictures of these counts; between two levels the one above the darker.
    for (counts, expected) in OTSU {
        let levels = counts.iter().flat_map(|(level, count)| vec![f32::from(*level) / 255.0; *count]);
        let map = of(&[&levels.collect::<Vec<_>>()], settings());
        let threshold = (f64::from(*expected) * 257.0 + 0.5) / 65535.0;
        assert_eq!(map.report[0], format!("fibre is what is brighter than the grey level {threshold:.4} (Otsu)"));
    }
}

/// What is left of fibre drawn as "#" where regions of fewer than so many pixels are removed, with what is said of it.
fn despeckled(lines: &[&str], smallest: f64) -> (Vec<String>, String) {
    let level = |pixel: char| if pixel == '#' { 1.0 } else { 0.0 };
    let levels: Vec<Vec<f32>> = lines.iter().map(|line| line.chars().map(level).collect()).collect();
    let levels: Vec<&[f32]> = levels.iter().map(Vec::as_slice).collect();
    let map = of(&levels, Micrograph { despeckle: Some(smallest * 25e-6), ..settings() });
    let drawn = |line: &[bool]| line.iter().map(|fibre| if *fibre { '#' } else { '.' }).collect();
    (map.fibre.pixels.chunks(map.fibre.width).map(drawn).collect(), map.report[2].clone())
}

#[test]
fn specks_and_holes_of_few_pixels_are_removed() {
    // Regions of 1, 2, 2 and 5 pixels that touch each other at corners only.
    let before = ["#....##", ".##....", "...#...", "..###..", "...#..."];
    for (smallest, specks, after) in [
        (1.0, 0, before),
        (2.0, 1, [".....##", ".##....", "...#...", "..###..", "...#..."]),
        (3.0, 3, [".......", ".......", "...#...", "..###..", "...#..."]),
        (6.0, 4, [".......", ".......", ".......", ".......", "......."]),
    ] {
        let (found, said) = despeckled(&before, smallest);
        assert_eq!(found, after, "{smallest}");
        assert!(said.starts_with(&format!("{specks} specks of fibre and ")), "{said}");
    }
    assert_eq!(despeckled(&["#####", "#.#.#", "###.#", "#####"], 2.0).0, ["#####", "###.#", "###.#", "#####"]);
}

#[test]
fn a_repeated_picture_is_the_one_that_is_mirrored_at_its_edges() {
    // Three by three pictures, those beside the middle mirrored, cover what one of half their size does not.
    let (small, [width, height]) = (picture(), [160, 120]);
    let mirrored = |at: usize, count: usize| if at / count == 1 { at % count } else { count - 1 - at % count };
    let places = (0..3 * height).flat_map(|y| (0..3 * width).map(move |x| (x, y)));
    let pixels = places.map(|(x, y)| small.pixels[mirrored(y, height) * width + mirrored(x, width)]).collect();
    let large = Picture { width: 3 * width, height: 3 * height, pixels };
    let expected = Micrograph { pixel: 11e-6, ..settings() }.fibre_map(large, &mesh()).unwrap();
    let repeating = Micrograph { pixel: 11e-6, enlargement: Some(Enlargement::Tiles), ..settings() };
    let found = repeating.fibre_map(small, &mesh()).unwrap();
    assert_eq!(found.base, expected.base);
    let told = "the picture of 1.76 mm by 1.32 mm repeated 1.7";
    assert!(found.report.iter().any(|line| line.starts_with(told)), "{:?}", found.report);
    // Where the picture covers the pin nothing is repeated.
    let covered = |enlargement| Micrograph { enlargement, ..settings() }.fibre_map(picture(), &mesh()).unwrap();
    assert_eq!(covered(Some(Enlargement::Tiles)), covered(None));
}

/// Cells of 100 µm, a pin of 16 mm by 10 mm, far from the middle of the ring.
fn large_mesh() -> Mesh {
    let mean_radius = 100e-6 * 14_000.0 / std::f64::consts::TAU;
    Mesh::new(100, 14_000, 160, mean_radius - 5e-3, mean_radius + 5e-3).unwrap()
}

/// Random fibres of a picture whose pixels are 25 µm wide, on the large pin.
fn extended(picture: &Picture<f32>, seed: u64) -> FibreMap {
    let enlargement = Some(Enlargement::Statistics { seed });
    Micrograph { pixel: 25e-6, threshold: Threshold::Level(0.5), enlargement, ..settings() }
        .fibre_map(picture.clone(), &large_mesh())
        .unwrap()
}

/// The autocorrelation of what is fibre at a distance, in points of a grid with so many columns and rows: the mean over all
/// pairs.
fn correlation([columns, rows]: [usize; 2], lag: [isize; 2], is_fibre: impl Fn(usize, usize) -> bool) -> f64 {
    let value = |x: usize, y: usize| f64::from(u8::from(is_fibre(x, y)));
    let places = || (0..columns).flat_map(|x| (0..rows).map(move |y| (x, y)));
    let fraction = places().map(|(x, y)| value(x, y)).sum::<f64>() / (columns * rows) as f64;
    let (mut sum, mut pairs) = (0.0, 0.0);
    for (x, y) in places() {
        let (Some(u), Some(v)) = (x.checked_add_signed(lag[0]), y.checked_add_signed(lag[1])) else { continue };
        if u < columns && v < rows {
            sum += (value(x, y) - fraction) * (value(u, v) - fraction);
            pairs += 1.0;
        }
    }
    sum / pairs / (fraction * (1.0 - fraction))
}

/// That of the fibres of a picture on the large pin, the mean over some seeds, at a distance in cells along and outward.
fn of_pins(pins: &[FibreMap], lag: [isize; 2]) -> f64 {
    let of = |pin: &FibreMap| correlation([160, 100], lag, |x, y| pin.base[x * 100 + y] == Base::Primary);
    pins.iter().map(of).sum::<f64>() / pins.len() as f64
}

/// Half of a Gaussian field of autocorrelation exp(−(h/ℓ)²) has the autocorrelation (2/π) arcsin of that.
#[test]
fn random_fibres_have_the_correlation_of_a_cut_field_which_is_known() {
    let (columns, rows, pixel, length) = (440, 320, 25e-6, 250e-6);
    let radius = pixel * columns as f64 / std::f64::consts::TAU;
    let half = 0.5 * pixel * rows as f64;
    let ring = Mesh::new(rows, columns, 1, 4.0 * radius - half, 4.0 * radius + half).unwrap();
    // The ring of four times the radius has columns four times as wide.
    let synthesis = HeightSynthesis {
        seed: 7,
        rms_height: 1e-6,
        texture: Texture::Correlation { along: 4.0 * length, across: length },
        skewness: 0.0,
        kurtosis: 3.0,
        patch: None,
    };
    let field = synthesis.field(Body::Disc, &ring).unwrap();
    let pixels = (0..rows * columns).map(|i| if field[i % columns * rows + i / columns] > 0.0 { 1.0 } else { 0.0 });
    let picture = Picture { width: columns, height: rows, pixels: pixels.collect() };
    let pins: Vec<FibreMap> = (0..6).map(|seed| extended(&picture, seed)).collect();
    for lag in [[1, 0], [0, 1], [2, 0], [0, 2], [2, 2], [3, 0], [0, 4], [6, 0], [8, 8]] {
        let distance = 100e-6 * f64::hypot(lag[0] as f64, lag[1] as f64);
        let expected = 2.0 / std::f64::consts::PI * (-(distance / length).powi(2)).exp().asin();
        let found = of_pins(&pins, lag);
        // The picture is 44 by 32 correlation lengths: its own autocorrelation scatters by about 1/√(44 · 32).
        assert!((found - expected).abs() < 2.0 / f64::sqrt(44.0 * 32.0), "{lag:?}: {found}, expected {expected}");
    }
}

/// Fibres of 800 by 150 µm that all point 30° outward from the sliding direction.
fn oblique() -> Picture<f32> {
    let (width, height) = (400, 320);
    let mut state = 12_345_u64;
    let mut random = || {
        state = state * 16_807 % 2_147_483_647;
        state as f64 / 2_147_483_647.0
    };
    let mut pixels = vec![0.2; width * height];
    for _ in 0..240 {
        let (x, y) = (500.0 * random() - 50.0, 420.0 * random() - 50.0);
        for (place, pixel) in pixels.iter_mut().enumerate() {
            // Lines run downward.
            let (u, v) = ((place % width) as f64 - x, y - (place / width) as f64);
            let (along, across) = (0.866 * u + 0.5 * v, 0.866 * v - 0.5 * u);
            if along.abs() < 16.0 && across.abs() < 3.0 {
                *pixel = 0.8;
            }
        }
    }
    Picture { width, height, pixels }
}

#[test]
fn random_fibres_keep_fraction_and_correlation_of_the_picture() {
    let picture = oblique();
    let is_fibre = |x: usize, y: usize| picture.pixels[(319 - y) * 400 + x] > 0.5;
    let fraction = picture.pixels.iter().filter(|level| **level > 0.5).count() as f64 / (400.0 * 320.0);
    let pins: Vec<FibreMap> = (0..6).map(|seed| extended(&picture, seed)).collect();
    let largest = large_mesh().pin_areas().fold(0.0, f64::max) / large_mesh().pin_area();
    for pin in &pins {
        assert!((fibre_fraction(&pin.base, &large_mesh()) - fraction).abs() <= 0.5 * largest);
    }
    assert!(pins[0].base != pins[1].base && extended(&picture, 1).base == pins[1].base);
    for lag in [[1, 0], [0, 1], [1, 1], [1, -1], [2, 1], [3, 2], [4, 2], [2, -1], [4, -2], [6, 0], [0, 4], [8, 4]] {
        // A cell is four pixels.
        let expected = correlation([400, 320], lag.map(|cells| 4 * cells), is_fibre);
        let found = of_pins(&pins, lag);
        // Fibres of a cell and a half with sharp edges are correlated as no cut field is: at a lag of a cell along and none across by
        // 0.57, of which 0.03 are lost; the same in NumPy.
        assert!((found - expected).abs() < 0.06, "{lag:?}: {found}, expected {expected}");
    }
}

#[test]
fn random_fibres_have_the_fraction_within_a_round_outline_and_few_fibres_are_warned_of() {
    let mean_radius = 100e-6 * 1400.0 / std::f64::consts::TAU;
    let round = Mesh::new(20, 1400, 20, mean_radius - 1e-3, mean_radius + 1e-3).unwrap();
    let round = round.with_outline(Outline::Disc { radius: 1e-3 }).unwrap();
    let enlargement = Some(Enlargement::Statistics { seed: 3 });
    let map = Micrograph { pixel: 5e-6, enlargement, ..settings() }.fibre_map(picture(), &round).unwrap();
    assert!((fibre_fraction(&map.base, &round) - 0.625).abs() < 0.003);
    let warned = map.report.iter().filter(|line| line.starts_with("warning: ")).count();
    assert_eq!(warned, 2, "{:?}", map.report);
    // Of fibre alone there is nothing random.
    let all = Micrograph { threshold: Threshold::Level(0.1), ..settings() };
    let all = Micrograph { enlargement, ..all }.fibre_map(picture(), &round).unwrap();
    assert!(all.base.iter().all(|base| *base == Base::Primary));
}
