//! Levels of a factor on an axis: what they are called, and where they stand.

use crate::quantity::printed_unit;
use crate::study::reading::split;
use plateau_io::number::{self, raised};

/// Levels that are numbers stand at their values where the least distance of two is at least this part of the mean one.
const NEAREST: f64 = 0.3;

/// Where levels that are numbers stand: at their values; at their logarithms where names would stand too near to each other there; at
/// equal distances where they would there, too.
pub fn places_of(values: &[f64]) -> Vec<f64> {
    let logarithms: Vec<f64> = values.iter().map(|value| value.ln()).collect();
    let last = values.len().saturating_sub(1) as f64;
    let spread = |values: &[f64]| -> Vec<f64> {
        let (low, high) = values
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
        values.iter().map(|value| last * (value - low) / (high - low)).collect()
    };
    let fits = |places: &Vec<f64>| places.iter().all(|place| place.is_finite()) && least_distance(places) >= NEAREST;
    let below = |value: &f64| values.iter().filter(|other| other.total_cmp(value).is_lt()).count() as f64;
    let found = [values, &logarithms[..]].into_iter().map(spread).find(fits);
    found.unwrap_or_else(|| values.iter().map(below).collect())
}

/// The least distance of two different places.
pub fn least_distance(places: &[f64]) -> f64 {
    let mut sorted = places.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.windows(2).map(|pair| pair[1] - pair[0]).filter(|distance| *distance > 0.0).fold(f64::INFINITY, f64::min)
}

/// Names of levels on an axis, and their unit: one that all numbers have stands in the label of the axis.
pub fn named(labels: &[String]) -> (Vec<String>, String) {
    let parts: Vec<(Option<f64>, &str)> = labels.iter().map(|label| split(label)).collect();
    let unit = parts.first().map_or("", |(_, unit)| *unit);
    if !parts.iter().all(|(number, other)| number.is_some() && *other == unit) {
        let printed = |label: &String| match split(label) {
            (Some(_), unit) if !unit.is_empty() => {
                let number = label.split_whitespace().next().unwrap_or_default();
                format!("{} {}", plain(number), printed_unit(unit))
            }
            _ => label.clone(),
        };
        return (labels.iter().map(printed).collect(), String::new());
    }
    (labels.iter().map(|label| plain(label.split_whitespace().next().unwrap_or_default())).collect(), unit.to_owned())
}

/// A number as it is printed: `2.5e-14` becomes 2.5·10⁻¹⁴.
fn plain(number: &str) -> String {
    let power = |(digits, power): (&str, &str)| Some((digits.to_owned(), power.parse::<i32>().ok()?));
    match number.split_once(['e', 'E']).and_then(power) {
        Some((digits, power)) if digits == "1" => format!("10{}", raised(power)),
        Some((digits, power)) => number::with_minus(&format!("{digits}\u{b7}10{}", raised(power))),
        None => number::with_minus(number),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_that_would_stand_too_near_to_each_other_stand_otherwise() {
        let close =
            |one: Vec<f64>, other: &[f64]| one.iter().zip(other).all(|(one, other)| (one - other).abs() < 1e-12);
        assert!(close(places_of(&[1.0, 10.0, 100.0]), &[0.0, 1.0, 2.0]));
        // Their logarithms are 0, 1 and 5: less than 0.3 times the mean distance, 2.5, would be 0.75.
        assert!(close(places_of(&[1.0, 10.0, 1e5]), &[0.0, 0.4, 2.0]));
        assert!(close(places_of(&[0.0, 1.0, 1e5]), &[0.0, 1.0, 2.0]));
        assert!(close(places_of(&[7.0, 3.0]), &[1.0, 0.0]));
    }

    #[test]
    fn words_and_mixed_units_stand_as_they_are() {
        let words = ["contact".to_owned(), "track".to_owned()];
        assert_eq!(named(&words), (words.to_vec(), String::new()));
        let mixed = ["50 um".to_owned(), "1 mm".to_owned()];
        assert_eq!(named(&mixed), (vec!["50 µm".to_owned(), "1 mm".to_owned()], String::new()));
        assert_eq!(named(&["0.2".to_owned(), "-0.4".to_owned()]).0, ["0.2", "\u{2212}0.4"]);
        assert_eq!(
            ["2.5e-14", "1e6", "-3E2"].map(plain),
            ["2.5\u{b7}10\u{207b}\u{b9}\u{2074}", "10\u{2076}", "\u{2212}3\u{b7}10\u{b2}"]
        );
    }
}
