//! Ticks of an axis.

use std::ops::RangeInclusive;

use plateau_io::number;

/// Places of ticks in a range, and what they say: multiples of 1, 2 or 5 times a power of ten, at most `most` of them.
pub fn ticks(range: &RangeInclusive<f64>, most: usize) -> Vec<(f64, String)> {
    let (low, high) = (*range.start(), *range.end());
    let length = high - low;
    if !(length > 0.0 && length.is_finite()) || most == 0 {
        return Vec::new();
    }
    let power = (length / most as f64).log10().floor() as i32;
    let count = |step: f64| ((high / step + 1e-9).floor() - (low / step - 1e-9).ceil() + 1.0) as usize;
    let steps = [(1.0, power), (2.0, power), (5.0, power), (1.0, power + 1), (2.0, power + 1)];
    let mut steps = steps.into_iter().map(|(digit, power)| (digit * 10_f64.powi(power), power));
    // By the length alone: windows of one map, which are equally long, have the same steps wherever they begin.
    let count_at_most = |step: f64| (length / step + 1e-9).floor() as usize + 1;
    let found = steps.clone().find(|(step, _)| count_at_most(*step) <= most);
    let found = found.or_else(|| steps.clone().find(|(step, _)| count(*step) <= most));
    let Some((step, power)) = found else { return Vec::new() };
    // A single number is no scale: there are the first and the last of more instead.
    let finer = if most > 1 && count(step) < 2 { steps.rfind(|(step, _)| count(*step) > 1) } else { None };
    let (step, power) = finer.unwrap_or((step, power));
    let decimals = (-power).max(0) as usize;
    let first = (low / step - 1e-9).ceil();
    let tick = |index: usize| {
        // Adding 0 makes a negative zero a plain one.
        let value = (first + index as f64) * step + 0.0;
        (value, number::with_minus(&format!("{value:.decimals$}")))
    };
    let shown = if finer.is_some() { vec![0, count(step) - 1] } else { (0..count(step)).collect() };
    shown.into_iter().map(tick).collect()
}

/// Places of ticks in a positive range of an axis of equal ratios, and what they say: powers of ten, with 2 and 5 times
/// them where there are few, at most `most` of them.
pub fn logarithmic_ticks(range: &RangeInclusive<f64>, most: usize) -> Vec<(f64, String)> {
    let (low, high) = (*range.start(), *range.end());
    if !(low > 0.0 && high > low && high.is_finite()) || most == 0 {
        return Vec::new();
    }
    let powers = (low.log10() + 1e-9).floor() as i32..=(high.log10() + 1e-9).floor() as i32;
    let within = |value: f64| value >= low * (1.0 - 1e-9) && value <= high * (1.0 + 1e-9);
    let candidates = |digits: &[i32], every: i32| -> Vec<(f64, String)> {
        let powers = powers.clone().filter(|power| power.rem_euclid(every) == 0);
        let values = powers.flat_map(|power| digits.iter().map(move |digit| (*digit, power)));
        let ticks = values.map(|(digit, power)| (f64::from(digit) * 10_f64.powi(power), power_label(digit, power)));
        ticks.filter(|(value, _)| within(*value)).collect()
    };
    let fine = candidates(&[1, 2, 5], 1);
    if fine.len() <= most {
        // Less than a factor of two: as on a linear axis.
        return if fine.len() < 2 { ticks(range, most) } else { fine };
    }
    (1..).map(|every| candidates(&[1], every)).find(|ticks| ticks.len() <= most).unwrap_or_default()
}

/// Powers of ten that an axis may have for ticks between them to be told apart.
const MOST_POWERS: f64 = 8.0;

/// Places of 1 to 9 times the powers of ten in a positive range; none where they would be too close to each other.
pub fn minor_ticks(range: &RangeInclusive<f64>) -> Vec<f64> {
    let (low, high) = (*range.start(), *range.end());
    let are_apart = low > 0.0 && high > low && high.is_finite() && (high / low).log10() <= MOST_POWERS;
    if !are_apart {
        return Vec::new();
    }
    let powers = low.log10().floor() as i32..=high.log10().floor() as i32;
    let ticks = powers.flat_map(|power| (1..10).map(move |digit| f64::from(digit) * 10_f64.powi(power)));
    ticks.filter(|tick| range.contains(tick)).collect()
}

/// A digit times a power of ten.
fn power_label(digit: i32, power: i32) -> String {
    match power {
        0..=4 => format!("{}", i64::from(digit) * 10_i64.pow(power as u32)),
        -3..=-1 => format!("{:.*}", power.unsigned_abs() as usize, f64::from(digit) * 10_f64.powi(power)),
        _ => {
            let exponent = number::raised(power);
            if digit == 1 { format!("10{exponent}") } else { format!("{digit}\u{b7}10{exponent}") }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{logarithmic_ticks, minor_ticks, ticks};

    #[test]
    fn ticks_between_powers_of_ten_are_their_multiples() {
        let expected = [8.0, 9.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0, 100.0, 200.0];
        assert_eq!(minor_ticks(&(7.5..=250.0)), expected);
        assert_eq!(minor_ticks(&(1e-9..=1.0)).len() + minor_ticks(&(0.0..=1.0)).len(), 0);
    }

    #[test]
    fn ticks_of_equal_ratios_are_powers_of_ten() {
        for (range, most, expected) in [
            (1e-5..=30.0, 7, vec!["10\u{207b}\u{2075}", "10\u{207b}\u{2074}", "0.001", "0.01", "0.1", "1", "10"]),
            (0.8..=60.0, 9, vec!["1", "2", "5", "10", "20", "50"]),
            (0.5..=2e6, 4, vec!["1", "100", "10000", "10\u{2076}"]),
            (3.0..=4.0, 4, vec!["3.0", "3.5", "4.0"]),
            (0.0..=4.0, 4, vec![]),
        ] {
            let labels: Vec<String> = logarithmic_ticks(&range, most).into_iter().map(|(_, label)| label).collect();
            assert_eq!(labels, expected);
        }
    }

    #[test]
    fn ticks_are_round_numbers_within_the_range() {
        for (range, most, expected) in [
            (0.0..=1.0, 6, vec!["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]),
            (-0.35..=0.2, 4, vec!["\u{2212}0.2", "0.0", "0.2"]),
            (0.0..=129.6, 4, vec!["0", "50", "100"]),
            // Multiples of 5 have one number here, those of 2 five: there is room for the first and the last.
            (36.0..=44.0, 2, vec!["36", "44"]),
            (19.95..=24.05, 2, vec!["20", "24"]),
            (990.0..=1010.0, 5, vec!["990", "995", "1000", "1005", "1010"]),
            (3.0..=3.0, 5, vec![]),
            // Windows of 32.2 mm: steps of 2 mm would be 17 in the first, and 16 in the last.
            (0.0..=32.2, 16, vec!["0", "5", "10", "15", "20", "25", "30"]),
            (96.6..=128.8, 16, vec!["100", "105", "110", "115", "120", "125"]),
        ] {
            let labels: Vec<String> = ticks(&range, most).into_iter().map(|(_, label)| label).collect();
            assert_eq!(labels, expected);
        }
    }
}
