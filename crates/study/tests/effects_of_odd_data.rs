//! Analyses of data that studies had better not have, but have: few, missing, constant, exact, aliased, many.

use std::time::{Duration, Instant};

use plateau_study::design::Setting;
use plateau_study::effects::{
    Better, Effects, EffectsError, ErrorSource, Factor, FactorKind, Model, Nature, NoSquares, Observation, Options,
    analyse, no_squares,
};
use proptest::prelude::*;

fn categories(name: &str, count: usize) -> Factor {
    let labels = (0..count).map(|level| format!("{name}{level}")).collect();
    Factor { name: name.to_owned(), kind: FactorKind::Categorical(labels) }
}

fn range(name: &str) -> Factor {
    Factor { name: name.to_owned(), kind: FactorKind::Range { low: 10.0, high: 30.0 } }
}

/// All combinations of two levels, the first factor varying fastest.
fn corners(factors: usize) -> Vec<Vec<Setting>> {
    (0..1 << factors).map(|point| (0..factors).map(|factor| Setting::Level(point >> factor & 1)).collect()).collect()
}

fn observed(points: &[Vec<Setting>], response: impl Fn(usize, &[Setting]) -> f64) -> Vec<Observation> {
    let observation = |(index, settings): (usize, &Vec<Setting>)| Observation {
        settings: settings.clone(),
        replicate: 0,
        run: index,
        response: response(index, settings),
    };
    points.iter().enumerate().map(observation).collect()
}

fn sign(setting: Setting) -> f64 {
    match setting {
        Setting::Level(level) => 2.0 * level as f64 - 1.0,
        Setting::Coded(value) => value,
    }
}

fn of_model(model: Model) -> Options {
    Options { model, ..Options::default() }
}

fn named(names: &[&str]) -> Vec<Factor> {
    names.iter().map(|name| categories(name, 2)).collect()
}

#[test]
fn nothing_to_analyse() {
    let factors = named(&["a", "b"]);
    let fail = |responses: [f64; 4], options: Options| {
        analyse(&factors, &observed(&corners(2), |index, _| responses[index]), &options).unwrap_err()
    };
    let default = Options::default();
    assert_eq!(analyse(&factors, &[], &default), Err(EffectsError::Empty { missing: 0 }));
    assert_eq!(fail([f64::NAN; 4], default), EffectsError::Empty { missing: 4 });
    assert_eq!(fail([0.1; 4], default), EffectsError::Constant { value: 0.1, observations: 4 });
    let rounded = [0.3, 0.1 + 0.2, 0.3, 0.3];
    assert_eq!(fail(rounded, default), EffectsError::Constant { value: 0.3, observations: 4 });
    assert_eq!(fail([0.0; 4], default), EffectsError::Constant { value: 0.0, observations: 4 });
    let one = [1.5, f64::NAN, f64::NAN, f64::NAN];
    assert_eq!(fail(one, default), EffectsError::Constant { value: 1.5, observations: 1 });
    let infinite = EffectsError::Response { observation: 2, value: f64::INFINITY };
    assert_eq!(fail([1.0, 2.0, f64::INFINITY, 3.0], default), infinite);
    for confidence in [0.0, 1.0, f64::NAN] {
        let error = fail([1.0, 2.0, 3.0, 4.0], Options { confidence, ..default });
        assert!(matches!(error, EffectsError::Confidence(_)));
    }
}

#[test]
fn settings_that_factors_do_not_have() {
    let fail = |factor: Factor, setting: Setting| {
        let observations = observed(&[vec![setting], vec![setting]], |index, _| index as f64);
        analyse(&[factor], &observations, &Options::default()).unwrap_err().to_string()
    };
    let pad = |count| categories("pad", count);
    assert_eq!(fail(pad(2), Setting::Level(2)), "factor `pad` has 2 levels, not level number 2, counted from 0");
    assert_eq!(fail(pad(3), Setting::Coded(1.0)), "factor `pad` has 3 levels, not the coded value 1");
    assert_eq!(fail(range("load"), Setting::Level(0)), "factor `load` has a range, not level number 0, counted from 0");
    assert_eq!(fail(range("load"), Setting::Coded(f64::NAN)), "factor `load` has a range, not the coded value NaN");
    assert_eq!(fail(pad(1), Setting::Level(0)), "factor `pad`: at least two levels are needed");
    let levels = Factor { name: "speed".into(), kind: FactorKind::Levels(vec![2.0, 2.0]) };
    assert_eq!(fail(levels, Setting::Level(0)), "factor `speed`: at least two different levels are needed");
    let empty = Factor { name: "speed".into(), kind: FactorKind::Levels(vec![]) };
    assert_eq!(fail(empty, Setting::Level(0)), "factor `speed`: at least two different levels are needed");
    let backwards = Factor { name: "load".into(), kind: FactorKind::Range { low: 2.0, high: 1.0 } };
    assert_eq!(fail(backwards, Setting::Coded(0.0)), "factor `load`: the range must begin below its end");
    let none = analyse(&[pad(2)], &observed(&[vec![]], |_, _| 1.0), &Options::default());
    assert_eq!(none, Err(EffectsError::Settings { found: 0, expected: 1 }));
}

#[test]
fn two_levels_may_be_given_as_their_codes() {
    let coded: Vec<Vec<Setting>> =
        corners(3).iter().map(|point| point.iter().map(|setting| Setting::Coded(sign(*setting))).collect()).collect();
    let factors = named(&["a", "b", "c"]);
    let effects = |points: &[Vec<Setting>]| {
        analyse(
            &factors,
            &observed(points, |index, _| [3.0, 1.0, 4.0, 1.5, 9.0, 2.0, 6.0, 5.0][index]),
            &Options::default(),
        )
    };
    assert_eq!(effects(&coded), effects(&corners(3)));
}

#[test]
fn numeric_levels_rise_whatever_their_order() {
    let speed = Factor { name: "speed".into(), kind: FactorKind::Levels(vec![4.0, 1.0]) };
    let points = [vec![Setting::Level(0)], vec![Setting::Level(1)]];
    let effects = analyse(&[speed], &observed(&points, |index, _| [10.0, 7.0][index]), &Options::default()).unwrap();
    // 10 at 4 and 7 at 1.
    assert!((effects.terms[0].estimate.unwrap().effect - 3.0).abs() < 1e-12);
}

#[test]
fn a_model_that_reproduces_all_responses_has_no_error_to_test_with() {
    let factors = named(&["a", "b", "c"]);
    let observations = observed(&corners(3), |_, point| 1e3 + 0.1 * sign(point[0]) - 0.7 * sign(point[1]));
    let effects = analyse(&factors, &observations, &Options::default()).unwrap();
    assert_eq!(effects.error, ErrorSource::Exact);
    assert_eq!((effects.r_squared, effects.residual.squares.sum), (1.0, 0.0));
    assert!(effects.terms.iter().all(|term| term.test.is_none()));
    assert!((effects.terms[1].estimate.unwrap().effect + 1.4).abs() < 1e-12);
    assert!(effects.lenth.is_none(), "more than half of the effects are rounding");
    finite(&effects);
}

#[test]
fn replicates_that_are_equal_give_no_pure_error_to_test_with() {
    // Seeds that change nothing.
    let factors = named(&["a", "b"]);
    let once = observed(&corners(2), |index, _| [1.0, 2.0, 4.0, 9.0][index]);
    let again = once.iter().map(|each| Observation { replicate: 1, run: 4 + each.run, ..each.clone() });
    let observations: Vec<Observation> = once.iter().cloned().chain(again).collect();
    let effects = analyse(&factors, &observations, &of_model(Model::MainEffects)).unwrap();
    let parts = effects.residual.parts.unwrap();
    assert_eq!((parts.pure_error.freedom, parts.pure_error.sum, parts.test), (3, 0.0, None));
    assert_eq!(parts.lack_of_fit.freedom, 1);
    assert_eq!(effects.blocks.as_ref().unwrap().freedom, 1);
    finite(&effects);
}

#[test]
fn observations_of_one_run_count_once() {
    // Two points twice, of which one gave nothing: by hand, the means of four runs.
    let factors = named(&["a", "b"]);
    let once = observed(&corners(2), |index, _| [1.0, 2.0, 4.0, f64::NAN][index]);
    let observations: Vec<Observation> = [&once[..], &once[2..]].concat();
    let effects = analyse(&factors, &observations, &of_model(Model::MainEffects)).unwrap();
    assert_eq!((effects.observations, effects.missing, effects.repeated), (3, 1, 2));
    let alone = analyse(&factors, &once, &of_model(Model::MainEffects)).unwrap();
    assert_eq!((&effects.terms, &effects.fitted), (&alone.terms, &alone.fitted));
    assert_eq!(effects.error, ErrorSource::Saturated);
    assert!((effects.mean - 7.0 / 3.0).abs() < 1e-15);
    let empty = observed(&[corners(2)[0].clone(), corners(2)[0].clone()], |_, _| f64::NAN);
    let same: Vec<Observation> = empty.into_iter().map(|each| Observation { run: 9, ..each }).collect();
    assert_eq!(analyse(&factors, &same, &Options::default()), Err(EffectsError::Empty { missing: 1 }));
}

#[test]
fn designs_allow_squares_or_say_why_not() {
    let ranges = [range("load"), range("speed")];
    let points = |values: &[(f64, f64)]| -> Vec<Vec<Setting>> {
        values.iter().map(|(load, speed)| vec![Setting::Coded(*load), Setting::Coded(*speed)]).collect()
    };
    let of = |factors: &[Factor], points: &[Vec<Setting>]| {
        no_squares(factors, &observed(points, |index, _| index as f64), true)
    };
    // 1 + 2 + 1 + 2 coefficients, and three degrees of freedom.
    let nine: Vec<(f64, f64)> = (0..9).map(|index| (f64::from(index / 3) - 1.0, f64::from(index % 3) - 1.0)).collect();
    assert_eq!(of(&ranges, &points(&nine)), None);
    let few = of(&ranges, &points(&nine[1..])).unwrap();
    assert_eq!(few, NoSquares::FewRuns { runs: 8, coefficients: 6 });
    assert_eq!(few.to_string(), "8 runs are too few for 6 coefficients and an error");
    // Three points that are made with three seeds each are nine runs, but no more points than three.
    let repeated = [0, 4, 8].map(|index| nine[index]).repeat(3);
    let few = of(&ranges, &points(&repeated)).unwrap();
    assert_eq!(few.to_string(), "3 different points are too few for 6 coefficients");
    // Points on a diagonal.
    let diagonal: Vec<(f64, f64)> = nine.iter().map(|(load, speed)| (3.0 * load + speed, 3.0 * load + speed)).collect();
    let aliased = of(&ranges, &points(&diagonal)).unwrap();
    assert_eq!(aliased.to_string(), "the runs cannot tell speed, load², speed² from other terms");
    assert_eq!(of(&named(&["a", "b"]), &corners(2)), Some(NoSquares::TwoValues));
    // The square of a number that has two values is not needed.
    let mixed: Vec<(f64, f64)> =
        nine.iter().map(|(load, speed)| (*load, if *speed > 0.0 { 1.0 } else { -1.0 })).collect();
    assert_eq!(of(&ranges, &points(&mixed)), None);
    assert_eq!(of(&ranges, &[]), None, "that nothing can be analysed is another error");
}

#[test]
fn a_model_that_reproduces_everything_is_better_beyond_doubt() {
    let points: Vec<Vec<Setting>> = (0..7).map(|index| vec![Setting::Coded(f64::from(index) / 3.0 - 1.0)]).collect();
    let observations = observed(&points, |_, point| 2.0 - sign(point[0]).powi(2));
    let effects = analyse(&[range("load")], &observations, &Options::default()).unwrap();
    let misfit = effects.misfit().unwrap();
    assert_eq!((misfit.test.f, misfit.test.p), (f64::INFINITY, 0.0));
    assert_eq!(misfit.better, Some(Better { model: Model::Quadratic, r_squared: 1.0 }));
    // Nothing is to be told where there is no error.
    let exact = analyse(&[range("load")], &observations, &of_model(Model::Quadratic)).unwrap();
    assert_eq!((exact.error, exact.misfit()), (ErrorSource::Exact, None));
}

#[test]
fn fewer_observations_than_terms() {
    // Plackett, R. L. & Burman, J. P. (1946): The design of optimum multifactorial experiments. Biometrika 33: the
    // generating row of twelve points.
    let row = [1, 1, 0, 1, 1, 1, 0, 0, 0, 1, 0];
    let mut points: Vec<Vec<Setting>> =
        (0..11).map(|shift| (0..11).map(|factor| Setting::Level(row[(factor + 11 - shift) % 11])).collect()).collect();
    points.push(vec![Setting::Level(0); 11]);
    let names: Vec<String> = (1..=11).map(|factor| format!("f{factor}")).collect();
    let factors = named(&names.iter().map(String::as_str).collect::<Vec<_>>());
    let observations = observed(&points, |index, point| 5.0 + 2.0 * sign(point[3]) + 0.1 * (index * index % 7) as f64);
    let effects = analyse(&factors, &observations, &Options::default()).unwrap();
    assert_eq!(effects.error, ErrorSource::Saturated);
    let (single, pairs) = effects.terms.split_at(11);
    assert!(single.iter().all(|term| term.freedom == 1 && term.estimate.is_some()));
    assert!(pairs.iter().all(|term| term.freedom == 0 && term.estimate.is_none() && term.test.is_none()));
    // In this design a pair is partly aliased with every single factor but its own two.
    assert!(pairs.iter().all(|term| term.aliased_with.len() == 9));
    assert_eq!(pairs[0].aliased_with, ["f3", "f4", "f5", "f6", "f7", "f8", "f9", "f10", "f11"]);
    assert!(effects.lenth.is_some());
    assert_eq!(effects.half_normal().len(), 11);
    assert_eq!(effects.half_normal()[10].term, 3);
    finite(&effects);
}

#[test]
fn a_factor_that_never_varied_is_part_of_the_mean() {
    let factors = [categories("pad", 3), range("load")];
    let points = [-1.0, 0.0, 0.5, 1.0].map(|load| vec![Setting::Level(1), Setting::Coded(load)]);
    let observations = observed(&points, |index, _| [1.0, 2.0, 2.2, 3.1][index]);
    let effects = analyse(&factors, &observations, &Options::default()).unwrap();
    let aliases: Vec<_> = effects.terms.iter().map(|term| (term.freedom, term.aliased_with.join(", "))).collect();
    let expected = [(0, "mean"), (1, "pad × load"), (0, "load")];
    assert_eq!(aliases, expected.map(|(freedom, text)| (freedom, text.to_owned())));
    let unseen = effects.predict(&[Setting::Level(0), Setting::Coded(0.0)]);
    assert_eq!(unseen.unwrap_err().to_string(), "factor `pad` has no observation at this level");
    finite(&effects);
}

#[test]
fn squares_of_two_levels_are_part_of_the_mean() {
    let factors = [range("load"), range("speed")];
    let points: Vec<_> =
        corners(2).iter().map(|point| point.iter().map(|s| Setting::Coded(sign(*s))).collect()).collect();
    let observations = observed(&points, |index, _| [1.0, 2.0, 4.0, 9.0][index]);
    let effects = analyse(&factors, &observations, &of_model(Model::Quadratic)).unwrap();
    assert_eq!(effects.terms[3].label, "load²");
    assert_eq!((effects.terms[3].freedom, &effects.terms[3].aliased_with[..]), (0, &["mean".to_owned()][..]));
    // What is left is the saddle of the product, (1 + 9 − 2 − 4)/4 · load · speed: eigenvalues ±½.
    let surface = effects.surface(&points[0]).unwrap();
    assert_eq!(surface.nature, Nature::Saddle);
    assert!((surface.eigenvalues[1] - 0.5).abs() < 1e-12);
    finite(&effects);
    let main = analyse(&factors, &observations, &of_model(Model::MainEffects)).unwrap();
    assert_eq!(main.surface(&points[0]), Err(EffectsError::NoSurface));
}

#[test]
fn ridges_have_no_stationary_point() {
    let point = |index: usize| [index / 3, index % 3].map(|level| Setting::Coded(level as f64 - 1.0)).to_vec();
    let points: Vec<_> = (0..9).map(point).collect();
    let factors = [range("load"), range("speed")];
    let observations = observed(&points, |_, point| 3.0 - sign(point[0]).powi(2) + 2.0 * sign(point[1]));
    let effects = analyse(&factors, &observations, &of_model(Model::Quadratic)).unwrap();
    let surface = effects.surface(&points[0]).unwrap();
    assert_eq!((surface.nature, surface.stationary), (Nature::Ridge, None));
    // Half a range is 10, the middle 20: 3 − ((load − 20)/10)² + 2·(speed − 20)/10.
    let natural = surface.natural.value(&[25.0, 30.0]);
    assert!((natural - (3.0 - 0.25 + 2.0)).abs() < 1e-12, "{natural}");
}

#[test]
fn no_factor_at_all_leaves_the_mean() {
    let effects =
        analyse(&[], &observed(&[vec![], vec![], vec![]], |index, _| index as f64), &Options::default()).unwrap();
    assert!((effects.constant.value - 1.0).abs() < 1e-12);
    assert_eq!((effects.residual.squares.freedom, effects.error), (2, ErrorSource::Replicates));
    finite(&effects);
}

#[test]
fn very_small_and_very_large_responses() {
    let factors = named(&["a", "b"]);
    for unit in [1e-140, 1e-18, 1e140] {
        let observations = observed(&corners(2), |index, _| unit * [1.0, 2.0, 4.0, 9.0][index]);
        let effects = analyse(&factors, &observations, &of_model(Model::MainEffects)).unwrap();
        // By hand: effects 3 and 5, and 2 of the product, which is the error: squares of 9, 25 and 4.
        assert!((effects.terms[0].test.unwrap().f - 9.0 / 4.0).abs() < 1e-9);
        assert!((effects.terms[1].test.unwrap().f - 25.0 / 4.0).abs() < 1e-9);
        finite(&effects);
    }
}

#[test]
fn ten_thousand_observations_of_eight_factors_take_less_than_a_second() {
    let count = 10_000;
    let strata =
        |stride: usize| (0..count).map(move |index| (2 * (index * stride % count) + 1) as f64 / count as f64 - 1.0);
    let columns: Vec<Vec<f64>> =
        [1, 3, 7, 1237, 4391, 7919, 2399, 9431].map(|stride| strata(stride).collect()).to_vec();
    let points: Vec<Vec<Setting>> =
        (0..count).map(|index| columns.iter().map(|column| Setting::Coded(column[index])).collect()).collect();
    let ranges: Vec<Factor> = "abcdefgh".chars().map(|name| range(&name.to_string())).collect();
    let start = Instant::now();
    let effects =
        analyse(&ranges, &observed(&points, |index, point| sign(point[0]) + (index % 17) as f64), &Options::default());
    assert_eq!(effects.unwrap().terms.len(), 36);
    assert!(start.elapsed() < Duration::from_secs(1), "ranges took {:?}", start.elapsed());

    let levels: Vec<Factor> = "abcdefgh".chars().map(|name| categories(&name.to_string(), 3)).collect();
    let point = |index: usize| (0..8).map(|factor| Setting::Level(index / 3_usize.pow(factor) % 3)).collect();
    let points: Vec<Vec<Setting>> = (0..count).map(point).collect();
    let start = Instant::now();
    let response = |index: usize, point: &[Setting]| sign(point[0]) + (index * index % 17) as f64;
    let effects = analyse(&levels, &observed(&points, response), &Options::default()).unwrap();
    assert_eq!(effects.terms.iter().map(|term| term.freedom).sum::<usize>(), 8 * 2 + 28 * 4);
    assert!(start.elapsed() < Duration::from_secs(3), "levels took {:?}", start.elapsed());
}

/// All numbers of an analysis are numbers, and probabilities and shares are such.
fn finite(effects: &Effects) {
    let mut numbers = vec![effects.constant.value, effects.total.sum, effects.residual.squares.sum, effects.r_squared];
    numbers.extend(effects.adjusted_r_squared);
    numbers.extend(effects.predicted_r_squared);
    numbers.extend(effects.constant.standard_error);
    numbers.extend(effects.constant.interval.into_iter().flatten());
    numbers.extend(effects.fitted.iter().flat_map(|each| [each.fitted, each.residual]));
    for term in effects.rows() {
        numbers.extend([term.sum_of_squares, term.share]);
        assert!(term.sum_of_squares >= 0.0 && term.share <= 1.0 + 1e-9, "{term:?}");
        numbers.extend(term.estimate.iter().flat_map(|estimate| [estimate.effect, estimate.coefficient]));
        let uncertainty = term.estimate.and_then(|estimate| estimate.uncertainty);
        numbers.extend(uncertainty.iter().flat_map(|each| [each.standard_error, each.t, each.interval[0]]));
        for p in [uncertainty.map(|each| each.p), term.test.map(|test| test.p)].into_iter().flatten() {
            assert!((0.0..=1.0).contains(&p), "{term:?}");
        }
        numbers.extend(term.test.map(|test| test.f));
        assert_eq!(term.test.is_some(), term.freedom > 0 && effects.residual_standard_deviation.is_some());
    }
    for factor in 0..3 {
        numbers.extend(effects.level_means(factor).iter().map(|cell| cell.mean));
        numbers.extend(effects.cell_means(0, factor).iter().filter_map(|cell| Some(cell.interval?[0])));
    }
    assert!(numbers.iter().all(|number| number.is_finite()), "{effects:?}");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    /// Whatever runs were made: few, repeated, in blocks, failed.
    #[test]
    fn any_data_give_numbers_or_an_error(
        rows in prop::collection::vec((0..3_usize, 0..2_usize, -2..3_i32, 0..3_usize, 0..12_i32), 0..40),
        model in prop::sample::select(vec![Model::MainEffects, Model::Interactions, Model::Full, Model::Quadratic]),
        blocks: bool,
        offset in prop::sample::select(vec![0.0, 1e6]),
    ) {
        let speed = Factor { name: "speed".into(), kind: FactorKind::Levels(vec![1.0, 5.0]) };
        let factors = [categories("pad", 3), speed, range("load")];
        type Row = (usize, usize, i32, usize, i32);
        let observation = |(run, &(pad, speed, load, replicate, response)): (usize, &Row)| Observation {
            settings: vec![Setting::Level(pad), Setting::Level(speed), Setting::Coded(f64::from(load) / 2.0)],
            replicate,
            run,
            response: if response == 0 { f64::NAN } else { offset + 0.1 * f64::from(response) },
        };
        let observations: Vec<Observation> = rows.iter().enumerate().map(observation).collect();
        let options = Options { model, blocks, ..Options::default() };
        match analyse(&factors, &observations, &options) {
            Ok(effects) => {
                finite(&effects);
                let rows: usize = effects.rows().map(|term| term.freedom).sum();
                prop_assert_eq!(rows + effects.residual.squares.freedom, effects.total.freedom);
                if let Some(parts) = effects.residual.parts {
                    let freedom = parts.lack_of_fit.freedom + parts.pure_error.freedom;
                    prop_assert_eq!(freedom, effects.residual.squares.freedom);
                    let sum = parts.lack_of_fit.sum + parts.pure_error.sum;
                    prop_assert!((sum - effects.residual.squares.sum).abs() <= 1e-9 * effects.total.sum);
                }
                if let Some(misfit) = effects.misfit() {
                    prop_assert!(misfit.test.p < 0.05 && misfit.test.f > 0.0, "{:?}", misfit);
                }
                let _ = no_squares(&factors, &observations, blocks);
                if let Ok(surface) = effects.surface(&observations[0].settings) {
                    prop_assert!(surface.coded.constant.is_finite() && surface.natural.constant.is_finite());
                }
            }
            Err(EffectsError::Empty { .. } | EffectsError::Constant { .. }) => {}
            Err(error) => prop_assert!(false, "{}", error),
        }
    }
}
