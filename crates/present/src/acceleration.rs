//! What the time acceleration that a run chose was like, in words.

use plateau_core::acceleration::Chosen;
use plateau_io::number;

/// Range and last m, the estimated error, and whether that is within the tolerance.
pub fn acceleration(chosen: &Chosen) -> String {
    let Chosen { tolerance, smallest, largest, last, estimated_error, met } = chosen;
    let [smallest, largest, last] = [smallest, largest, last].map(|m| number::rounded(*m, 3));
    let range = if largest == smallest {
        format!("m = {largest}")
    } else {
        format!("m = {smallest} to {largest}, last {last}")
    };
    let met = if *met { "met" } else { "not met" };
    format!(
        "{range}; estimated error of the contact area {}, tolerance {} {met}",
        number::percent(*estimated_error),
        number::percent(*tolerance)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_tells_range_error_and_whether_the_tolerance_is_met() {
        let chosen = Chosen {
            smallest: 1.0,
            largest: 28.26,
            last: 2.0,
            estimated_error: 0.0117,
            met: false,
            ..Chosen::never(0.01)
        };
        assert_eq!(
            acceleration(&chosen),
            "m = 1 to 28.3, last 2; estimated error of the contact area 1.2 %, tolerance 1 % not met"
        );
        assert_eq!(
            acceleration(&Chosen::never(0.005)),
            "m = 1; estimated error of the contact area 0 %, tolerance 0.5 % met"
        );
    }
}
