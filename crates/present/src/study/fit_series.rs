//! What is to be known of a series that keys were fitted to, in words.

use plateau_io::number;
use plateau_study::fit::{FitResult, FittedSeries};

/// Points below which their successive deviations tell nothing.
const FEW: usize = 8;
/// Deviation for want of seeds, over that of the measurement, that is said.
const MANY_SEEDS: f64 = 0.5;

/// What is to be known before the intervals are trusted: deviations that are alike, scatter between seeds.
pub fn notes(result: &FitResult, names: &[&str]) -> Vec<String> {
    let mut notes = Vec::new();
    for (series, name) in result.series.iter().zip(names) {
        notes.extend(alike(series, name));
        if series.scatter.is_some_and(|scatter| scatter > 1.0) {
            notes.push(format!(
                "Runs with other seeds scatter in {name} by more than the uncertainties of the measurement. Specimens may do the \
                 same: unless the measurement is a mean of many specimens, add that scatter to the uncertainties."
            ));
        }
        if series.seeds_deviation > MANY_SEEDS {
            notes.push(format!(
                "The mean of {name} over the seeds is known no better than to half the uncertainty of the measurement: more \
                 seeds in [replicates] make the intervals shorter."
            ));
        }
    }
    notes
}

/// That neighbours deviate alike, so that there are fewer independent points than was assumed.
fn alike(series: &FittedSeries, name: &str) -> Option<String> {
    let times = series.measured.times();
    let points = times.len();
    // Of independent deviations the correlation has the standard error 1/√n.
    if points < FEW || series.successive < 2.0 / (points as f64).sqrt() {
        return None;
    }
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    let advice = if series.measured.correlation_time() > 0.0 {
        "a longer correlation_time".to_owned()
    } else {
        // exp(−step/τ) is the correlation.
        let time = -steps[steps.len() / 2] / libm::log(series.successive.min(0.99));
        format!("correlation_time = \"{} s\"", number::rounded(time, 2))
    };
    Some(format!(
        "Successive points of {name} deviate alike (correlation {}): they tell less than so many independent points, and the \
         intervals are too short. If the errors of the measurement are like that, give {advice} in its [[response]]; if not, the \
         runs cannot follow the series.",
        number::rounded(series.successive, 2)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use plateau_study::fit::MeasuredSeries;

    fn series(successive: f64, correlation_time: f64) -> FittedSeries {
        let times: Vec<f64> = (0..25).map(|at| 2.0 * f64::from(at)).collect();
        let measured = MeasuredSeries::new(times, vec![1.0; 25], vec![1.0; 25], correlation_time).unwrap();
        let forecast = vec![1.0; 25];
        FittedSeries {
            measured,
            deviations: forecast.clone(),
            forecast,
            components: 1,
            apart: 1.0,
            successive,
            seeds_deviation: 0.0,
            scatter: None,
        }
    }

    #[test]
    fn deviations_that_are_alike_are_told_with_their_time() {
        assert_eq!(alike(&series(0.3, 0.0), "area"), None, "0.3 is within twice 1/√25");
        // exp(−2 s/τ) = 0.6: τ = 3.9 s.
        let said = alike(&series(0.6, 0.0), "area").unwrap();
        assert!(said.contains("(correlation 0.6)") && said.contains("give correlation_time = \"3.9 s\""), "{said}");
        assert!(alike(&series(0.6, 1.0), "area").unwrap().contains("give a longer correlation_time"));
    }
}
