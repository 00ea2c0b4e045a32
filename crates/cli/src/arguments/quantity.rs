//! Values of options that are quantities: a number and a unit, as in a scene.

use plateau_io::units::{self, Dimension};

/// A quantity of this dimension, SI.
pub(super) fn quantity(text: &str, dimension: Dimension) -> Result<f64, String> {
    units::parse(text.trim(), dimension).map_err(|error| error.to_string())
}

/// A time of the run, s.
pub(super) fn run_time(text: &str) -> Result<f64, String> {
    let time = quantity(text, Dimension::Time)?;
    if time >= 0.0 {
        Ok(time)
    } else {
        Err(format!("{text} is before the start of a run, expected a time such as \"100 s\""))
    }
}

/// A finite length, m.
pub(super) fn length(text: &str) -> Result<f64, String> {
    let length = quantity(text, Dimension::Length)?;
    if length.is_finite() { Ok(length) } else { Err("expected a finite length".to_owned()) }
}

/// The text, if it is a quantity of this dimension above 0.
pub(super) fn positive(text: &str, dimension: Dimension) -> Result<String, String> {
    let value = units::parse(text, dimension).map_err(|error| error.to_string())?;
    if value > 0.0 && value.is_finite() { Ok(text.to_owned()) } else { Err("expected more than 0".to_owned()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_time_of_a_run_and_no_length_is_refused() {
        assert_eq!(run_time("2 min"), Ok(120.0));
        assert!(run_time("-1 s").unwrap_err().contains("before the start of a run"));
        assert_eq!(length(" 2 mm "), Ok(2e-3));
        assert!(length("2 s").unwrap_err().contains("expected a length"));
        assert_eq!(positive("30 N", Dimension::Force).as_deref(), Ok("30 N"));
        assert!(positive("0 N", Dimension::Force).unwrap_err().contains("more than 0"));
    }
}
