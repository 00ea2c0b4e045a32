//! Intervals of a Gaussian process have the true response in them 95 times of 100 with five points for each factor: a part of the
//! simulation in `examples/process_coverage`, which says what is simulated.

#[path = "../examples/process_coverage/simulation.rs"]
mod simulation;

#[test]
fn intervals_have_the_true_response_in_them_as_often_as_they_say() {
    for case in simulation::cases() {
        let [means, runs, certain] = case.coverage(30).unwrap();
        let name = case.name;
        // Places of one function are alike: thirty functions leave a standard error of 1 to 2 %.
        assert!((means - 0.95).abs() < 0.035 && (runs - 0.95).abs() < 0.035, "{name}: {means} {runs}");
        assert!(certain < means, "{name}: lengths that are taken for certain have {certain}, not less than {means}");
    }
}
