//! Several runs, compared with the first.

use super::outcome::{Measure, UNKNOWN, readable};
use plateau_io::number;

/// A row for every number: its name, its value in the first run, and for each other run its value with the difference.
///
/// `runs` holds the same measures for every run.
pub fn rows(runs: &[Vec<Measure>]) -> Vec<Vec<String>> {
    let Some((first, others)) = runs.split_first() else { return Vec::new() };
    let row = |(index, reference): (usize, &Measure)| {
        let compared =
            others.iter().map(|run| run.get(index).map_or_else(|| UNKNOWN.into(), |run| compare(reference, run)));
        [reference.name.clone(), reference.text()].into_iter().chain(compared).collect()
    };
    first.iter().enumerate().map(row).collect()
}

/// The value of `other`, and how far it is from that of `reference`, absolutely and in percent of it.
fn compare(reference: &Measure, other: &Measure) -> String {
    let (Some(from), Some(to)) = (reference.value, other.value) else { return other.text() };
    let difference = other.unit.difference(to - from);
    if difference == 0.0 {
        return format!("{} (same)", other.text());
    }
    let percent = 100.0 * (to - from) / from.abs();
    // Percent of percent confuse; of a number that is 0, or that has its 0 anywhere, there are none.
    if other.unit.symbol == "%" {
        format!("{} ({} points)", other.text(), signed(&four_digits(difference)))
    } else if percent.is_finite() && other.unit.offset == 0.0 {
        format!("{} ({}, {} %)", other.text(), signed(&four_digits(difference)), signed(&percentage(percent)))
    } else {
        format!("{} ({})", other.text(), signed(&four_digits(difference)))
    }
}

fn four_digits(value: f64) -> String {
    readable(format!("{value:.3e}").parse().unwrap_or(value)).trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// With one decimal, or with one digit where that would say nothing.
fn percentage(percent: f64) -> String {
    let text = match percent.abs() {
        small if small < 0.05 => number::significant(percent, 1),
        large if large >= 1e5 => format!("{percent:.1e}"),
        _ => format!("{percent:.1}"),
    };
    number::with_minus(&text)
}

fn signed(number: &str) -> String {
    if number.starts_with('\u{2212}') { number.to_owned() } else { format!("+{number}") }
}

#[cfg(test)]
mod tests {
    use super::{Measure, rows};
    use crate::quantity::Unit;

    fn measure(unit: Unit, value: f64) -> Measure {
        Measure { name: "area".into(), unit, value: Some(value), error: None }
    }

    #[test]
    fn differences_are_relative_to_the_first() {
        let run = |value| vec![measure(Unit::MM2, value)];
        // By hand: 5 is 25 % more than 4, 3 is 25 % less,
        // and 4.0012 is 0.03 % more.
        let rows = rows(&[run(4e-6), run(5e-6), run(3e-6), run(4e-6), run(4.0012e-6)]);
        assert_eq!(
            rows,
            [[
                "area",
                "4.0000 mm²",
                "5.0000 mm² (+1, +25.0 %)",
                "3.0000 mm² (\u{2212}1, \u{2212}25.0 %)",
                "4.0000 mm² (same)",
                "4.0012 mm² (+0.0012, +0.03 %)"
            ]]
        );
    }

    #[test]
    fn no_percent_of_percent_or_of_nothing() {
        let shown = rows(&[vec![measure(Unit::PERCENT, 0.5)], vec![measure(Unit::PERCENT, 0.625)]]);
        assert_eq!(shown[0][2], "62.500 % (+12.5 points)");
        let shown = rows(&[vec![measure(Unit::NUMBER, 0.0)], vec![measure(Unit::NUMBER, 2.0)]]);
        assert_eq!(shown[0][2], "2.0000 (+2)");
        // 150 °C and 160 °C.
        let shown = rows(&[vec![measure(Unit::CELSIUS, 423.15)], vec![measure(Unit::CELSIUS, 433.15)]]);
        assert_eq!(shown[0][1..], ["150.00 °C", "160.00 °C (+10)"]);
    }
}
