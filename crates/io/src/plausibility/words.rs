//! Numbers in warnings.

/// Four significant digits, without the zeros that would pretend more.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    // As it is rounded: 9.9996 is 10.
    let scientific = format!("{value:.3e}");
    let rounded: f64 = scientific.parse().unwrap_or(value);
    if (1e-3..1e6).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        let (digits, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
        let digits = digits.trim_end_matches('0').trim_end_matches('.');
        format!("{digits}e{exponent}")
    }
}

/// A pressure in the unit that suits it, Pa to GPa.
pub(super) fn pressure(value: f64) -> String {
    let units = [(1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa")];
    let (pascals, unit) = units.into_iter().find(|(pascals, _)| value >= *pascals).unwrap_or((1.0, "Pa"));
    format!("{} {unit}", number(value / pascals))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits_and_pressures_their_unit() {
        for (value, text) in [(0.0, "0"), (1.0, "1"), (2.94812, "2.948"), (123_456.0, "123500"), (5e-14, "5e-14")] {
            assert_eq!(number(value), text);
        }
        for (value, text) in [(0.5, "0.5 Pa"), (1e5, "100 kPa"), (1.4687e6, "1.469 MPa"), (1e11, "100 GPa")] {
            assert_eq!(pressure(value), text);
        }
        assert_eq!(pressure(2.5e16), "2.5e7 GPa");
    }
}
