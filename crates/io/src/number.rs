//! Numbers as people read them.

/// An integer with thin groups of three digits.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

/// A number with about four significant digits, for people.
pub fn short(number: f64) -> String {
    let magnitude = number.abs();
    let text = if number == 0.0 {
        "0".into()
    } else if !(1e-3..1e6).contains(&magnitude) {
        format!("{number:.3e}")
    } else {
        let decimals = (3 - magnitude.log10().floor() as i32).max(0) as usize;
        format!("{number:.decimals$}")
    };
    with_minus(&text)
}

/// A number with so many significant digits; very large and very small ones with an exponent.
pub fn significant(number: f64, digits: usize) -> String {
    if number == 0.0 || !number.is_finite() {
        return format!("{number}");
    }
    // As it is rounded: 9.9996 has another exponent with four digits.
    let scientific = format!("{number:.*e}", digits.saturating_sub(1));
    let exponent = scientific.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok()).unwrap_or(0);
    if (-5..7).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        format!("{number:.decimals$}")
    } else {
        scientific
    }
}

/// A number and its standard error with two digits of that, `4.426 ± 0.012`; with five digits where there is none.
pub fn with_error(number: f64, error: Option<f64>) -> String {
    let Some(error) = error else { return significant(number, 5) };
    // As it is rounded: 0.0996 is 0.10.
    let magnitude = if error > 0.0 { to_digits(error, 2).log10().floor() } else { -3.0 };
    let decimals = (1.0 - magnitude).clamp(0.0, 9.0) as usize;
    format!("{number:.decimals$} ± {error:.decimals$}")
}

/// The number to so many significant digits.
pub fn to_digits(number: f64, digits: usize) -> f64 {
    format!("{number:.*e}", digits.saturating_sub(1)).parse().unwrap_or(number)
}

/// The largest number with so many significant digits that is not above a positive one but for rounding: a limit that people may
/// write down.
pub fn not_above(number: f64, digits: usize) -> f64 {
    let nearest = to_digits(number, digits);
    if nearest <= number * (1.0 + 1e-12) {
        return nearest;
    }
    // All digits that a double has, without those beyond.
    let text = format!("{number:.17e}");
    let cut = text.split_once('e').and_then(|(mantissa, power)| Some(format!("{}e{power}", mantissa.get(..=digits)?)));
    cut.and_then(|text| text.parse().ok()).unwrap_or(number)
}

/// Upper bound of a positive number, in words: with so many significant digits, rounded up.
pub fn less_than(bound: f64, digits: usize) -> String {
    let nearest = significant(bound, digits).parse().unwrap_or(bound);
    let last = 10_f64.powi(bound.log10().floor() as i32 + 1 - digits as i32);
    format!("< {}", significant(if nearest < bound { nearest + last } else { nearest }, digits))
}

/// A number with at most so many significant digits, for people: no zeros at the end, and a sign that is as wide as a plus.
pub fn rounded(number: f64, digits: usize) -> String {
    let text = significant(number, digits);
    let (mantissa, exponent) =
        text.split_once('e').map_or((text.as_str(), None), |(mantissa, power)| (mantissa, Some(power)));
    let mantissa = if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
    with_minus(&exponent.map_or_else(|| mantissa.to_owned(), |power| format!("{mantissa}e{power}")))
}

/// A number with all its digits, with an exponent where there would be a row of zeros.
pub fn plain(number: f64) -> String {
    let readable = number == 0.0 || !number.is_finite() || (1e-6..1e16).contains(&number.abs());
    if readable { format!("{number}") } else { format!("{number:e}") }
}

/// Counts things in words, `1 worker` or `2 workers`.
pub fn count(number: usize, one: &str) -> String {
    if number == 1 { format!("1 {one}") } else { format!("{number} {one}s") }
}

/// A number with the sign that is as wide as a plus.
fn with_minus(number: &str) -> String {
    number.replace('-', "\u{2212}")
}

/// Formats a duration (s) for people.
pub fn duration(seconds: f64) -> String {
    if seconds < 1.0 {
        format!("{:.0} ms", seconds * 1e3)
    } else if seconds < 100.0 {
        format!("{seconds:.1} s")
    } else if seconds < 7200.0 {
        format!("{} min {:02.0} s", (seconds / 60.0).floor(), (seconds % 60.0).floor())
    } else {
        format!("{:.1} h", seconds / 3600.0)
    }
}

/// A number of bytes.
pub fn bytes(count: u64) -> String {
    match count {
        0..1_000_000 => format!("{:.1} kB", count as f64 / 1e3),
        1_000_000..1_000_000_000 => format!("{:.1} MB", count as f64 / 1e6),
        _ => format!("{:.2} GB", count as f64 / 1e9),
    }
}

/// A fraction in per cent, with two digits that count.
pub fn percent(fraction: f64) -> String {
    if fraction.is_nan() {
        return "–".to_owned();
    }
    format!("{} %", rounded(100.0 * fraction, 2))
}

#[cfg(test)]
#[path = "../tests/unit/number.rs"]
mod tests;
