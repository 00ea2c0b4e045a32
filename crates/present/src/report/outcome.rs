//! How a run ended, in words and numbers.

use std::fs;

use plateau_core::model::outline::Outline;
use plateau_core::observe::window_mean::WindowMean;
use plateau_io::run_file::{ContactArea, RunFile, State};

use super::html::capital;
use super::series::Recorded;
use crate::acceleration::acceleration;
use crate::quantity::{SeriesLook, Unit};
use crate::running_in::{in_contact, running_in, running_in_time};
use plateau_io::number;

/// Shown where a run file does not say.
pub const UNKNOWN: &str = "–";

/// A number that says how a run ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// What it is.
    pub name: String,
    /// The unit in which it is read.
    pub unit: Unit,
    /// Its value, SI; none if the run file does not have it.
    pub value: Option<f64>,
    /// Standard error of the value, SI, where there is one.
    pub error: Option<f64>,
}

impl Measure {
    /// The number with its unit.
    pub fn text(&self) -> String {
        let text = |value: f64| match self.error {
            Some(error) => number::with_error(self.unit.value(value), Some(self.unit.difference(error))),
            None => readable(self.unit.value(value)),
        };
        self.value.map_or_else(|| UNKNOWN.into(), |value| self.unit.with_symbol(&text(value)))
    }
}

/// A number with five digits and a true minus.
pub fn readable(value: f64) -> String {
    // Adding 0 makes a negative zero a plain one.
    number::with_minus(&number::significant(value + 0.0, 5))
}

/// The numbers of a run, the same ones in the same order for every run: its series, and its mean contact area.
pub fn measures(series: &[Recorded], contact_area: Option<WindowMean>) -> Vec<Measure> {
    let find = |name: &str| series.iter().find(|series| series.name == name);
    let last = |name: &str| find(name).and_then(|series| series.last);
    let largest = |name: &str| find(name).and_then(|series| series.largest).map(f64::abs);
    let measure = |name: &str, unit, value| Measure { name: name.to_owned(), unit, value, error: None };
    let shown = |name: &'static str| {
        let SeriesLook { title, unit, .. } = SeriesLook::of(name);
        measure(&capital(title), unit, last(name))
    };
    let part = |name: &'static str, of: &str| Measure { name: format!("– {of}"), ..shown(name) };
    let worn = [
        ("worn_whole_pin", "of the whole pin"),
        ("lost_pin", "of the whole pin, less build-up deposited on it: as a balance shows it"),
        ("worn_pin", "of the pin's plateaus"),
        ("worn_resin", "of the resin"),
        ("worn_disc", "of the disc"),
    ];
    let all_worn = ["worn_pin", "worn_resin", "worn_disc"].map(last).into_iter().sum::<Option<f64>>();
    let mean = Measure {
        name: "Contact area, mean ± standard error".to_owned(),
        value: contact_area.map(|window| window.mean),
        error: contact_area.and_then(|window| window.standard_error),
        ..shown("contact_area")
    };
    let mut measures = vec![
        shown("sliding_distance"),
        mean,
        part("contact_area", "of the last step"),
        part("contact_ratio", "of the last step, as a part of the area of the pin"),
    ];
    measures.extend([
        part("mean_pressure", "of the last step, mean pressure"),
        part("max_pressure", "of the last step, largest pressure"),
        shown("filled_fraction"),
    ]);
    measures.extend(["disc_secondary", "pin_secondary", "pin_primary", "pin_none"].map(shown));
    measures.push(measure("Worn volume of the simulated pin and the disc", Unit::MM3, all_worn));
    measures.extend(worn.map(|(name, of)| part(name, of)));
    measures.extend(["emitted", "deposited_pin", "deposited_disc", "pool"].map(shown));
    let residuals = [("load_residual", "load"), ("balance_residual", "debris")];
    measures.extend(residuals.map(|(name, of)| {
        measure(&format!("Largest residual of the {of} balance in the samples"), Unit::NUMBER, largest(name))
    }));
    measures
}

/// What there is to tell of a run besides its numbers: name and text.
pub fn facts(run: &RunFile, contact_area: &ContactArea) -> Vec<(&'static str, String)> {
    let attribute = |name: &str| run.attribute(name).unwrap_or_else(|| UNKNOWN.into());
    let mesh = run.mesh();
    let size = fs::metadata(run.path()).map_or_else(|_| UNKNOWN.into(), |file| number::bytes(file.len()));
    vec![
        ("Run file", format!("{} ({size})", run.path().display())),
        ("State", state(run)),
        ("Simulated time", simulated(run)),
        ("Samples and times of maps", format!("{} and {}", run.time().len(), run.map_time().len())),
        (
            "Mesh",
            format!(
                "{} rows, {} columns of the disc, {} of the pin{}",
                mesh.rows(),
                mesh.disc_columns(),
                mesh.pin_columns(),
                match mesh.outline() {
                    Outline::Rectangle => String::new(),
                    Outline::Disc { radius } =>
                        format!(" within a circle of {} mm in diameter", number::significant(2e3 * radius, 6)),
                }
            ),
        ),
        ("Wall time", run.number("wall_time").map_or_else(|| UNKNOWN.into(), number::duration)),
        (
            "Workers",
            format!(
                "{}, {}",
                run.number("workers").map_or_else(|| UNKNOWN.into(), |workers| workers.to_string()),
                attribute("instruction_set")
            ),
        ),
        ("Program", attribute("program")),
        ("Running in", running_in(&contact_area.drift)),
        ("Running-in time", running_in_time(&contact_area.running_in)),
        ("Time acceleration", time_acceleration(run)),
        ("Mean contact area is taken over", contact_area.last_tenth.as_ref().map_or_else(|| UNKNOWN.into(), over)),
    ]
}

/// From when to when a mean is taken.
fn over(window: &WindowMean) -> String {
    let short = if window.is_long() { "" } else { ", all of it: fewer than ten simulated revolutions" };
    let error = if window.standard_error.is_some() { "" } else { "; too few samples for a standard error" };
    let contact = in_contact(window);
    format!("{} to {} s{contact}{short}{error}", number::rounded(window.from, 6), number::rounded(window.to, 6))
}

/// The m of the scene, or what the run chose.
fn time_acceleration(run: &RunFile) -> String {
    match (run.chosen_acceleration(), run.given_acceleration()) {
        (Some(chosen), _) => acceleration(&chosen),
        (None, Some(given)) => format!("m = {}", number::short(given)),
        (None, None) => UNKNOWN.into(),
    }
}

/// The state in words that say what it means.
fn state(run: &RunFile) -> String {
    match run.state() {
        State::Finished => "finished".into(),
        State::Running => "running, or killed: there was no end yet when this page was made".into(),
        State::Interrupted => "interrupted by its user".into(),
        State::Failed => match run.attribute("error") {
            Some(reason) => format!("failed: {reason}"),
            None => "failed".into(),
        },
    }
}

fn simulated(run: &RunFile) -> String {
    let time = run.time().last().or(run.map_time().last()).copied().unwrap_or(0.0);
    let duration = run.scene().get("operation").and_then(|operation| operation.get("duration"));
    match duration.and_then(toml::Value::as_str) {
        Some(duration) if run.state() != State::Finished => format!("{} s of {duration}", readable(time)),
        _ => format!("{} s", readable(time)),
    }
}

#[cfg(test)]
mod tests {
    use super::{Measure, Unit, measures};

    #[test]
    fn numbers_carry_their_units() {
        let measure = |value| Measure { name: "area".into(), unit: Unit::MM2, value, error: None };
        assert_eq!(measure(Some(4.690_52e-6)).text(), "4.6905 mm²");
        assert_eq!(measure(Some(-0.0)).text(), "0 mm²");
        assert_eq!(measure(None).text(), "–");
        assert_eq!(Measure { error: Some(3.2e-8), ..measure(Some(4.690_52e-6)) }.text(), "4.691 ± 0.032 mm²");
    }

    #[test]
    fn what_is_not_recorded_has_no_value() {
        assert!(measures(&[], None).iter().all(|measure| measure.value.is_none()));
    }
}
