//! Designs as other programs make them, and what a design promises, checked from its settings alone.
//!
//! The designs of other programs are in the folder `designs`, made by the scripts there; each says by which call.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use plateau_study::design::{Aliases, Alpha, Design, Factor, Fraction, Kind, Setting, design, design_with_centre};
use proptest::prelude::*;

/// The letters of factors.
const LETTERS: &str = "ABCDEFGHJKLMNOPQRSTUVWXYZ";

/// The rows of a file of numbers.
fn stored(name: &str) -> Vec<Vec<f64>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/designs").join(name).with_extension("csv");
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| line.split(',').map(|number| number.parse().unwrap()).collect()).collect()
}

fn made(kind: Kind, factors: &[Factor]) -> Design {
    design(&kind, factors).unwrap()
}

/// The points as numbers: coded settings, or levels.
fn rows(design: &Design) -> Vec<Vec<f64>> {
    let number = |setting: &Setting| match setting {
        Setting::Level(level) => *level as f64,
        Setting::Coded(at) => *at,
    };
    (0..design.points()).map(|point| design.point(point).iter().map(number).collect()).collect()
}

/// Rows in an order that does not depend on where they came from, to 10⁻¹².
fn sorted(rows: Vec<Vec<f64>>) -> Vec<Vec<i64>> {
    let mut rows: Vec<Vec<i64>> =
        rows.iter().map(|row| row.iter().map(|number| (number * 1e12).round() as i64).collect()).collect();
    rows.sort();
    rows
}

fn assert_same(name: &str, kind: Kind, factors: &[Factor]) {
    assert_eq!(sorted(rows(&made(kind, factors))), sorted(stored(name)), "{name}");
}

fn fraction(resolution: u32) -> Kind {
    Kind::FractionalFactorial(Fraction::Resolution(resolution))
}

fn generated(texts: &[&str]) -> Kind {
    Kind::FractionalFactorial(Fraction::Generators(texts.iter().map(ToString::to_string).collect()))
}

#[test]
fn full_and_fractional_factorials_have_the_points_of_pydoe() {
    let levels = [2, 3, 4].map(Factor::Levels);
    // Even in the same order.
    assert_eq!(rows(&made(Kind::FullFactorial, &levels)), stored("full-2-3-4"));
    let range = [Factor::Range; 15];
    assert_same("fraction-5-1", generated(&["E = ABCD"]), &range[..5]);
    assert_same("fraction-5-1-minus", generated(&["-ABCD"]), &range[..5]);
    assert_same("fraction-5-2", generated(&["D = AB", "E = AC"]), &range[..5]);
    // The generators that the smallest fractions have are those of these designs.
    assert_same("fraction-5-1", fraction(5), &range[..5]);
    assert_same("fraction-5-2", fraction(3), &range[..5]);
    assert_same("fraction-7-3", fraction(4), &range[..7]);
    assert_same("fraction-7-4", fraction(3), &range[..7]);
    assert_same("fraction-8-4", fraction(4), &[Factor::Levels(2); 8]);
    assert_same("fraction-15-11", fraction(3), &range);
}

#[test]
fn plackett_burman_designs_have_the_points_of_frf2() {
    for points in [12, 16, 20] {
        assert_same(&format!("burman-{points}"), Kind::PlackettBurman, &vec![Factor::Range; points - 1]);
    }
}

#[test]
fn central_composite_designs_have_the_points_of_pydoe() {
    for (name, alpha, centre, factors) in [
        ("composite-orthogonal-2", Alpha::Orthogonal, [4, 4], 2),
        ("composite-orthogonal-3", Alpha::Orthogonal, [4, 2], 3),
        ("composite-orthogonal-4", Alpha::Orthogonal, [0, 3], 4),
        ("composite-rotatable-2", Alpha::Rotatable, [0, 0], 2),
        ("composite-rotatable-4", Alpha::Rotatable, [1, 2], 4),
        ("composite-face-3", Alpha::Face, [2, 1], 3),
    ] {
        assert_same(name, Kind::CentralComposite { alpha, centre }, &vec![Factor::Range; factors]);
    }
}

#[test]
fn box_behnken_designs_have_the_points_of_rsm_and_up_to_five_factors_of_pydoe() {
    for factors in 3..=7 {
        let range = vec![Factor::Range; factors];
        assert_same(&format!("behnken-rsm-{factors}"), Kind::BoxBehnken { centre: 3 }, &range);
        if factors <= 5 {
            assert_same(&format!("behnken-{factors}"), Kind::BoxBehnken { centre: 3 }, &range);
        }
    }
}

#[test]
fn sobol_s_points_are_those_of_scipy_bit_for_bit() {
    let design = made(Kind::Sobol { points: 70_001 }, &[Factor::Range; 101]);
    for row in stored("sobol") {
        let coded: Vec<Setting> = row[1..].iter().map(|at| Setting::Coded(2.0 * at / 2_f64.powi(30) - 1.0)).collect();
        assert_eq!(design.point(row[0] as usize), coded, "point {}", row[0]);
    }
}

#[test]
fn a_latin_hypercube_s_random_numbers_are_those_of_chacha() {
    // J. Strombergson, Test vectors for the stream cipher ChaCha (draft-strombergson-chacha-test-vectors-01), TC1,
    // 256-bit key of zeros, 12 rounds: the key stream begins 9bf49a6a0755f953 811fce125f2683d5. One stratum, so nothing
    // else.
    let design = made(Kind::LatinHypercube { points: 1, seed: 0 }, &[Factor::Range; 2]);
    let expected = [0x53f955, 0xd58326].map(|top| (f64::from(top) + 0.5) / f64::from(1 << 24));
    assert_eq!(rows(&design), [expected.map(|unit| 2.0 * unit - 1.0)]);
}

#[test]
fn the_smallest_fractions_are_those_of_the_catalogue() {
    let catalogue = stored("catalogue");
    for factors in 3..=25_usize {
        let mut best = 2;
        for row in catalogue.iter().filter(|row| row[0] as usize == factors) {
            let (points, resolution) = (row[1] as usize, row[2] as u32);
            if resolution <= best {
                continue;
            }
            best = resolution;
            let design = made(fraction(resolution), &vec![Factor::Range; factors]);
            let name = format!("{factors} factors, resolution {resolution}");
            assert_eq!(design.points(), points, "{name}");
            let aliases = design.aliases().unwrap();
            assert_eq!(aliases.resolution, resolution, "{name}");
            // The catalogue has misprints: 160, 8 for 1608 and 222, 4 for 2224 words of length 6 in 32 runs, and in
            // 4096 runs words of length 16 as of 13.
            let correct = match (factors, points) {
                (21 | 22, 32) => 5,
                (20..=24, 4096) => 12,
                _ => row.len() - 3,
            };
            let count = |length: usize| aliases.word_lengths.get(length).copied().unwrap_or(0) as f64;
            let lengths: Vec<f64> = (1..=correct).map(count).collect();
            assert_eq!(lengths, row[3..3 + correct], "{name}");
        }
    }
}

#[test]
fn every_resolution_of_up_to_15_factors_has_its_fraction() {
    for factors in 3..=15_usize {
        let mut before = 0;
        for resolution in 3..=factors as u32 {
            let design = made(fraction(resolution), &vec![Factor::Range; factors]);
            assert!(design.aliases().unwrap().resolution >= resolution);
            assert!((before..=1 << (factors - 1)).contains(&design.points()), "{factors} factors: {resolution}");
            before = design.points();
        }
    }
}

/// Aliases from the settings alone: a word is a product of columns that is the same at every point.
fn aliases_of_columns(design: &Design) -> Aliases {
    let rows = rows(design);
    let factors = design.factors();
    let product = |set: u32| -> Vec<i8> {
        let one = |row: &Vec<f64>| (0..factors).filter(|f| set >> f & 1 == 1).map(|f| row[f] as i8).product();
        rows.iter().map(one).collect()
    };
    let name = |set: u32| -> String { (0..factors).filter(|f| set >> f & 1 == 1).map(|f| &LETTERS[f..=f]).collect() };
    let mut words: Vec<(usize, String, i8)> = (1_u32..1 << factors)
        .map(|set| (set, product(set)))
        .filter(|(_, column)| column.iter().all(|sign| *sign == column[0]))
        .map(|(set, column)| (set.count_ones() as usize, name(set), column[0]))
        .collect();
    words.sort();
    let effects: Vec<u32> = (0..factors)
        .map(|one| 1 << one)
        .chain((0..factors).flat_map(|one| (one + 1..factors).map(move |other| 1 << one | 1 << other)))
        .collect();
    let mut chains: Vec<(Vec<i8>, Vec<String>)> = Vec::new();
    for effect in effects {
        let column = product(effect);
        let negative: Vec<i8> = column.iter().map(|sign| -sign).collect();
        match chains.iter_mut().find(|(first, _)| *first == column || *first == negative) {
            Some((first, chain)) if *first == column => chain.push(name(effect)),
            Some((_, chain)) => chain.push(format!("-{}", name(effect))),
            None => chains.push((column, vec![name(effect)])),
        }
    }
    Aliases {
        word_lengths: (0..=factors).map(|length| words.iter().filter(|word| word.0 == length).count()).collect(),
        resolution: words[0].0 as u32,
        defining_words: words
            .into_iter()
            .map(|(_, word, sign)| format!("{}{word}", if sign < 0 { "-" } else { "" }))
            .collect(),
        chains: chains.into_iter().map(|(_, chain)| chain).filter(|chain| chain.len() > 1).collect(),
    }
}

#[test]
fn aliases_of_the_smallest_fractions_are_those_of_their_columns() {
    for factors in 3..=9 {
        for resolution in 3..=factors as u32 {
            let design = made(fraction(resolution), &vec![Factor::Range; factors]);
            assert_eq!(design.aliases(), Some(&aliases_of_columns(&design)), "{factors} factors: {resolution}");
        }
    }
}

proptest! {
    #[test]
    fn aliases_of_any_generators_are_those_of_their_columns(
        base in 2_usize..5,
        choice in prop::collection::btree_map(0_usize..16, any::<bool>(), 1..5),
    ) {
        // All products of two or more base factors, of which some are chosen.
        let products: Vec<u32> = (1_u32..1 << base).filter(|set| set.count_ones() > 1).collect();
        let texts: Vec<String> = choice
            .iter()
            .filter_map(|(index, negative)| Some((products.get(*index)?, negative)))
            .map(|(set, negative)| {
                let word: String = (0..base).filter(|f| set >> f & 1 == 1).map(|f| &LETTERS[f..=f]).collect();
                format!("{}{word}", if *negative { "-" } else { "" })
            })
            .collect();
        prop_assume!(!texts.is_empty());
        let factors = vec![Factor::Range; base + texts.len()];
        let design = made(Kind::FractionalFactorial(Fraction::Generators(texts)), &factors);
        prop_assert_eq!(design.points(), 1 << base);
        prop_assert_eq!(design.aliases(), Some(&aliases_of_columns(&design)));
    }
}

/// The terms of a quadratic model at a point: 1, x, x², xy.
fn quadratic(point: &[f64]) -> Vec<f64> {
    let pairs = (0..point.len()).flat_map(|one| (one + 1..point.len()).map(move |other| (one, other)));
    let squares = point.iter().map(|x| x * x);
    let products: Vec<f64> = pairs.map(|(one, other)| point[one] * point[other]).collect();
    [1.0].into_iter().chain(point.iter().copied()).chain(squares).chain(products).collect()
}

/// Inverse of the information matrix of the quadratic model, by Gauss and Jordan; panics where it is singular.
fn covariance(design: &Design) -> Vec<Vec<f64>> {
    let terms: Vec<Vec<f64>> = rows(design).iter().map(|row| quadratic(row)).collect();
    let size = terms[0].len();
    let mut matrix: Vec<Vec<f64>> = (0..size)
        .map(|i| {
            let information = (0..size).map(|j| terms.iter().map(|row| row[i] * row[j]).sum());
            information.chain((0..size).map(|j| f64::from(u8::from(i == j)))).collect()
        })
        .collect();
    for column in 0..size {
        let pivot = (column..size).max_by(|a, b| matrix[*a][column].abs().total_cmp(&matrix[*b][column].abs()));
        matrix.swap(column, pivot.unwrap());
        let scale = matrix[column][column];
        assert!(scale.abs() > 1e-6, "the quadratic model cannot be estimated");
        matrix[column].iter_mut().for_each(|value| *value /= scale);
        let row = matrix[column].clone();
        for (index, other) in matrix.iter_mut().enumerate().filter(|(index, _)| *index != column) {
            let factor = other[column];
            assert!(index < size);
            other.iter_mut().zip(&row).for_each(|(value, pivot)| *value -= factor * pivot);
        }
    }
    matrix.into_iter().map(|row| row[size..].to_vec()).collect()
}

#[test]
fn response_surface_designs_can_estimate_every_quadratic_effect() {
    for factors in [3, 4, 5, 6, 7, 9, 10, 11, 12, 16] {
        covariance(&made(Kind::BoxBehnken { centre: 1 }, &vec![Factor::Range; factors]));
    }
    for alpha in [Alpha::Rotatable, Alpha::Orthogonal, Alpha::Face] {
        for factors in 1..=9 {
            let kind = Kind::CentralComposite { alpha, centre: [2, 2] };
            covariance(&made(kind, &vec![Factor::Levels(2); factors]));
        }
    }
}

/// Variances of prediction in some directions at this distance from the centre, relative to that of the response.
fn variances(design: &Design, distance: f64) -> Vec<f64> {
    let covariance = covariance(design);
    let directions = (0..20).map(|number| {
        let direction: Vec<f64> =
            (0..design.factors()).map(|f| f64::from(number * (3 * f as u32 + 2) + 1).sin()).collect();
        let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
        direction.iter().map(|x| x / length * distance).collect::<Vec<f64>>()
    });
    directions
        .map(|point| {
            let terms = quadratic(&point);
            let product = |row: &Vec<f64>| row.iter().zip(&terms).map(|(a, b)| a * b).sum::<f64>();
            covariance.iter().map(product).zip(&terms).map(|(a, b)| a * b).sum()
        })
        .collect()
}

#[test]
fn rotatable_designs_predict_equally_well_at_equal_distance_and_others_do_not() {
    // The definition: Box and Hunter (1957), doi:10.1214/aoms/1177707047. Of Box-Behnken designs those of 4 and 7
    // factors are rotatable: Box and Behnken (1960), table 4.
    let spread = |kind: Kind, factors: usize, distance: f64| {
        let variances = variances(&made(kind, &vec![Factor::Range; factors]), distance);
        let (least, most) = variances.iter().fold((f64::MAX, 0_f64), |(a, b), v| (a.min(*v), b.max(*v)));
        most / least - 1.0
    };
    let composite = |alpha| Kind::CentralComposite { alpha, centre: [1, 2] };
    for factors in 2..=8 {
        for distance in [0.5, 1.0, 1.7] {
            assert!(spread(composite(Alpha::Rotatable), factors, distance) < 1e-9, "{factors} factors");
        }
        assert!(spread(composite(Alpha::Face), factors, 1.0) > 1e-3);
    }
    assert!(spread(Kind::BoxBehnken { centre: 3 }, 4, 1.0) < 1e-9);
    assert!(spread(Kind::BoxBehnken { centre: 6 }, 7, 1.0) < 1e-9);
    assert!(spread(Kind::BoxBehnken { centre: 3 }, 3, 1.0) > 1e-3);
}

#[test]
fn one_factor_has_designs_or_is_told_why_not() {
    let factor = [Factor::Range];
    for (kind, points) in [
        (Kind::FullFactorial, 2),
        (fraction(3), 2),
        (Kind::PlackettBurman, 4),
        (Kind::CentralComposite { alpha: Alpha::Rotatable, centre: [0, 1] }, 5),
        (Kind::LatinHypercube { points: 3, seed: 1 }, 3),
        (Kind::Sobol { points: 4 }, 4),
    ] {
        assert_eq!(made(kind, &factor).points(), points);
    }
    let error = design(&Kind::BoxBehnken { centre: 1 }, &factor).unwrap_err();
    assert!(error.0.contains("no Box-Behnken design of 1 factor,"), "{error}");
    assert!(design(&Kind::Sobol { points: 1 }, &[]).is_err());
}

#[test]
fn large_designs_are_quick_and_small_in_memory() {
    // 100 000 points in 0.5 s and 50 MB, as studies need; 5 settings of 16 bytes a point are 8 MB.
    let start = Instant::now();
    let design = made(Kind::FullFactorial, &[Factor::Levels(10); 5]);
    assert!(start.elapsed() < Duration::from_millis(500), "{:?}", start.elapsed());
    assert_eq!(design.points(), 100_000);
    assert!(size_of::<Setting>() <= 16);
}

#[test]
fn centre_points_follow_a_factorial_and_leave_its_aliases() {
    // By hand: the corners in standard order, then the centre twice.
    let factors = [Factor::Range, Factor::Levels(2), Factor::Range];
    let kind = Kind::FractionalFactorial(Fraction::Generators(vec!["C = AB".into()]));
    let (plain, with) = (made(kind.clone(), &factors), design_with_centre(&kind, 2, &factors).unwrap());
    let expected = [[-1, -1, 1], [1, -1, -1], [-1, 1, -1], [1, 1, 1], [0, 0, 0], [0, 0, 0]];
    assert_eq!(rows(&with), expected.map(|row| row.map(f64::from).to_vec()));
    assert_eq!((with.aliases(), rows(&plain)), (plain.aliases(), rows(&with)[..4].to_vec()));
    let three = design_with_centre(&Kind::FullFactorial, 1, &[Factor::Range, Factor::Levels(3)]).unwrap_err();
    assert!(three.0.contains("centre points needs ranges or two levels"), "{three}");
}
