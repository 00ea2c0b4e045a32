//! How often the 95 % intervals of `plateau sweep effects` have the true effect in them, for designs of each kind.
//!
//! ```sh
//! cargo run --release --locked -p plateau-study --example interval_coverage        # 4000 studies of each design
//! cargo run --release --locked -p plateau-study --example interval_coverage 500
//! ```
//!
//! The result stands in docs/studies.md. The seed is fixed, so it is the same every time.

mod simulation;

use std::error::Error;

/// Studies of each design, unless the command line says how many.
const STUDIES: usize = 4000;

fn main() -> Result<(), Box<dyn Error>> {
    let studies = std::env::args().nth(1).map_or(Ok(STUDIES), |count| {
        count.parse().map_err(|error| format!("number of studies \"{count}\": {error}, expected such as {STUDIES}"))
    })?;
    println!("| design | runs | different | 95 % intervals cover | with repeats as replicates |");
    println!("|---|---|---|---|---|");
    for case in simulation::cases() {
        let coverage = case.coverage(studies)?;
        let [share, error] = coverage.share.map(|share| 100.0 * share);
        println!(
            "| {} | {} | {} | {share:.1} ± {error:.1} % | {:.1} % |",
            case.name,
            coverage.runs,
            coverage.different,
            100.0 * coverage.if_repeated
        );
    }
    Ok(())
}
