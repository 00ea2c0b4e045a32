//! How often the region and the intervals of 95 % of a fit have the true keys in them, in 400 experiments that never took place:
//! `cargo run --release --locked -p plateau-study --example fit_coverage`.

mod simulation;

fn main() -> Result<(), plateau_study::fit::FitError> {
    let trials = 400;
    let found = simulation::coverage(trials)?;
    let share = |count: usize, of: usize| {
        let share = count as f64 / of as f64;
        format!("{:.1} ± {:.1} %", 100.0 * share, 100.0 * (share * (1.0 - share) / of as f64).sqrt())
    };
    println!("regions of 95 % with the true keys in them: {}", share(found.regions, trials));
    println!("intervals of 95 % with the true key in them: {}", share(found.intervals, 2 * trials));
    println!("runs in the mean: {:.0}; settled before the budget: {}", found.mean_runs, share(found.settled, trials));
    Ok(())
}
