use super::*;

const COSTS: [Option<[f64; 2]>; 7] = [
    Some([10.0, 0.001]),
    Some([5.0, 0.01]),
    Some([6.0, 0.02]),
    Some([1.0, 0.05]),
    None,
    Some([5.0, 0.01]),
    Some([1.0, 0.06]),
];

#[test]
fn the_front_has_no_run_that_another_one_beats() {
    assert_eq!(front(&COSTS), [true, true, false, true, false, true, false]);
}

#[test]
fn the_quickest_that_is_exact_enough_is_advised() {
    assert_eq!(advise(0.1, &COSTS), Advice::Use(3));
    assert_eq!(advise(0.01, &COSTS), Advice::Use(1));
    assert_eq!(advise(1e-4, &COSTS), Advice::Missed(0));
    // The reference's own error is as large as what is permitted.
    assert_eq!(advise(-0.01, &COSTS), Advice::Missed(0));
    assert_eq!(advise(0.1, &[None]), Advice::NoChoice);
}

#[test]
fn the_own_error_grows_as_the_error_of_another_run_does() {
    let errors = |mean_square| [QuantityError { mean_square, largest: 0.0, end: 0.0 }; COUNT];
    let own = OwnError { opening: [2e-5; COUNT], end: 5.0, ..OwnError::NONE };
    // 0.01 % in the opening and 0.2 % in the end: 20 times as large, and so is the reference's.
    assert!((own.growing(&errors(1e-4), &errors(2e-3)).whole()[0] - 4e-4).abs() < 1e-18);
    for (opening, whole) in [(2e-3, 1e-3), (0.0, 1e-3), (0.0, 0.0), (1e-4, f64::NAN)] {
        assert_eq!(own.growing(&errors(opening), &errors(whole)), own, "{opening}, {whole}");
    }
    assert_eq!(OwnError::NONE.growing(&errors(1e-4), &errors(2e-3)).whole(), [0.0; COUNT]);
}
