//! How often the 95 % intervals of a Gaussian process have the true response in them, where points are few.
//!
//! ```sh
//! cargo run --release --locked -p plateau-study --example process_coverage         # 200 functions of each kind
//! cargo run --release --locked -p plateau-study --example process_coverage 50
//! ```
//!
//! The result stands in docs/studies.md. The seed is fixed, so it is the same every time.

mod simulation;

use std::error::Error;

/// Functions of each kind, unless the command line says how many.
const FUNCTIONS: usize = 200;

fn main() -> Result<(), Box<dyn Error>> {
    let functions = std::env::args().nth(1).map_or(Ok(FUNCTIONS), |count| {
        count.parse().map_err(|error| format!("number of functions \"{count}\": {error}, expected such as {FUNCTIONS}"))
    })?;
    println!("| response | factors | points | seeds | of means | of runs | of means, lengths taken for certain |");
    println!("|---|---|---|---|---|---|---|");
    for case in simulation::cases() {
        let [means, runs, certain] = case.coverage(functions)?.map(|share| 100.0 * share);
        let (factors, points, seeds) = (case.factors, case.points, case.seeds);
        println!("| {} | {factors} | {points} | {seeds} | {means:.1} % | {runs:.1} % | {certain:.1} % |", case.name);
    }
    Ok(())
}
