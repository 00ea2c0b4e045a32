//! Intervals of 95 % have the true effect in them 95 times of 100: a part of the simulation in
//! `examples/interval_coverage`, which says what is simulated.

#[path = "../examples/interval_coverage/simulation.rs"]
mod simulation;

#[test]
fn intervals_have_the_true_effect_in_them_as_often_as_they_say() {
    for case in simulation::cases() {
        let coverage = case.coverage(400).unwrap();
        let [share, error] = coverage.share;
        assert!((share - 0.95).abs() < 0.02 && error < 0.01, "{}: {coverage:?}", case.name);
        // Where points are repeated, the simulation notices if they are taken for replicates.
        let is_repeated = coverage.different < coverage.runs;
        assert_eq!(coverage.if_repeated < 0.93, is_repeated, "{}: {coverage:?}", case.name);
    }
}
