//! Ticks of an axis.

use std::ops::RangeInclusive;

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
    let Some((step, power)) = steps.find(|(step, _)| count(*step) <= most) else { return Vec::new() };
    let decimals = (-power).max(0) as usize;
    let first = (low / step - 1e-9).ceil();
    let tick = |index: usize| {
        // Adding 0 makes a negative zero a plain one.
        let value = (first + index as f64) * step + 0.0;
        (value, format!("{value:.decimals$}").replace('-', "\u{2212}"))
    };
    (0..count(step)).map(tick).collect()
}

#[cfg(test)]
mod tests {
    use super::ticks;

    #[test]
    fn ticks_are_round_numbers_within_the_range() {
        for (range, most, expected) in [
            (0.0..=1.0, 6, vec!["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]),
            (-0.35..=0.2, 4, vec!["\u{2212}0.2", "0.0", "0.2"]),
            (0.0..=129.6, 4, vec!["0", "50", "100"]),
            (990.0..=1010.0, 5, vec!["990", "995", "1000", "1005", "1010"]),
            (3.0..=3.0, 5, vec![]),
        ] {
            let labels: Vec<String> = ticks(&range, most).into_iter().map(|(_, label)| label).collect();
            assert_eq!(labels, expected);
        }
    }
}
