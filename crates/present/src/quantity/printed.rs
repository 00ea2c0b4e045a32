//! Units and numbers as a journal prints them: µm, °C, mm², mm³/(N m), 2·10⁻¹⁴.

use plateau_io::number::{raised, significant, with_minus};

/// Units with µ in front, as they are typed.
const MICRO: [&str; 7] = ["um", "us", "ug", "uN", "uPa", "uJ", "uW"];
/// Numbers of these sizes stand on axes without a power of ten.
const PLAIN: std::ops::Range<f64> = 0.01..1e5;
/// Ends of an axis of equal ratios that are farther apart have powers of ten at their ticks.
const WIDE: f64 = 1e3;

/// A unit as it is printed: `um` is µm, `mm^3/(N*m)` is mm³/(N m).
pub fn printed_unit(unit: &str) -> String {
    let mut text = String::new();
    let mut letters = unit.trim().chars().peekable();
    while let Some(letter) = letters.next() {
        if letter.is_alphabetic() {
            let mut word = letter.to_string();
            while let Some(next) = letters.next_if(|next| next.is_alphabetic()) {
                word.push(next);
            }
            text.push_str(&match word.as_str() {
                "degC" => "°C".to_owned(),
                word if MICRO.contains(&word) => format!("µ{}", &word[1..]),
                word => word.to_owned(),
            });
            let is_power = |next: &char| next.is_ascii_digit() || matches!(next, '^' | '-');
            let mut power = String::new();
            while let Some(next) = letters.next_if(is_power) {
                power.extend(Some(next).filter(|next| *next != '^'));
            }
            match power.parse() {
                Ok(power) => text.push_str(&raised(power)),
                Err(_) => text.push_str(&power),
            }
        } else {
            text.push(if matches!(letter, '*' | '·') { ' ' } else { letter });
        }
    }
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A number with at most so many significant digits; very large and very small ones as a digit times a power of ten.
pub fn printed_number(number: f64, digits: usize) -> String {
    let text = significant(number, digits);
    let trimmed = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text.to_owned(),
    };
    let power = |(digits, power): (&str, &str)| Some((trimmed(digits), power.parse::<i32>().ok()?));
    match text.split_once('e').and_then(power) {
        Some((digits, power)) if digits == "1" => format!("10{}", raised(power)),
        Some((digits, power)) => with_minus(&format!("{digits}\u{b7}10{}", raised(power))),
        None => with_minus(&trimmed(&text)),
    }
}

/// The power of ten that stands in front of the unit of an axis between two values, so that its numbers are short; 0 for
/// none.
pub fn power_of_axis(ends: [f64; 2], logarithmic: bool) -> i32 {
    let sizes = || ends.into_iter().map(f64::abs).filter(|size| *size > 0.0 && size.is_finite());
    let (least, largest) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
    let is_wide = largest >= WIDE * least;
    if largest == 0.0 || PLAIN.contains(&largest) || (logarithmic && is_wide) {
        return 0;
    }
    libm::log10(if is_wide { largest } else { least } * (1.0 + 1e-9)).floor() as i32
}

/// A unit with a power of ten in front of it; 0 is none.
pub fn with_power(power: i32, unit: &str) -> String {
    let power = if power == 0 { String::new() } else { format!("10{} ", raised(power)) };
    format!("{power}{unit}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_stand_as_a_journal_prints_them() {
        for (typed, printed) in [
            ("um", "µm"),
            ("degC", "°C"),
            ("mm2", "mm²"),
            ("mm^3/(N*m)", "mm³/(N m)"),
            ("mm^3/(N m)", "mm³/(N m)"),
            ("1/Pa", "1/Pa"),
            ("m^-1", "m⁻¹"),
            ("km/h", "km/h"),
            ("rpm", "rpm"),
            ("um^2", "µm²"),
            ("", ""),
        ] {
            assert_eq!(printed_unit(typed), printed);
        }
    }

    #[test]
    fn numbers_have_powers_of_ten() {
        assert_eq!(
            [2e-14, 4.472e-14, 1e-13, 7.5, -0.25, 12.0, 0.0].map(|number| printed_number(number, 3)),
            ["2·10⁻¹⁴", "4.47·10⁻¹⁴", "10⁻¹³", "7.5", "\u{2212}0.25", "12", "0"]
        );
    }

    #[test]
    fn axes_of_very_small_numbers_have_a_power_of_ten() {
        assert_eq!(power_of_axis([2e-14, 1e-13], true), -14);
        assert_eq!(power_of_axis([0.0, 3e-14], false), -14);
        assert_eq!(power_of_axis([1e-14, 1e-9], true), 0);
        assert_eq!(power_of_axis([3.0, 12.0], false), 0);
        assert_eq!(power_of_axis([0.0, 0.0], false), 0);
        assert_eq!(power_of_axis([2e6, 5e6], false), 6);
        assert_eq!(
            (with_power(-14, "1/Pa"), with_power(0, "N"), with_power(3, "")),
            ("10⁻¹⁴ 1/Pa".into(), "N".into(), "10³".into())
        );
    }
}
