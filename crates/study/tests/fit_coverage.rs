//! Regions and intervals of fits have the true keys in them as often as they say: a part of the simulation in
//! `examples/fit_coverage`, which says what is simulated.

#[path = "../examples/fit_coverage/simulation.rs"]
mod simulation;

#[test]
fn fits_find_the_truth_as_often_as_they_say() {
    let long = std::env::var_os("PLATEAU_LONG").is_some();
    let trials = if long { 400 } else { 40 };
    let found = simulation::coverage(trials).unwrap();
    let [regions, intervals] = [found.regions as f64 / trials as f64, found.intervals as f64 / (2 * trials) as f64];
    // Of 40 trials at 95 %, three standard errors of √(0.95 · 0.05/40) are 10 %; of 400 they are 3.3 %.
    let tolerance = if long { 0.05 } else { 0.10 };
    assert!((regions - 0.95).abs() <= tolerance && (intervals - 0.95).abs() <= tolerance, "{found:?}");
    // The fits end when they know enough, not when the budget does.
    assert!(found.settled * 2 > trials, "{found:?}");
}
