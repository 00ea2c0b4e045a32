//! What a finished run tells its user.

use std::path::{Path, PathBuf};

use plateau_core::observe::Sample;
use plateau_core::observe::window_mean::WindowMean;
use plateau_core::simulation::Course;
use plateau_io::run_file::WriterReport;
use plateau_io::scene::Warning;
use plateau_io::scene::recipe::Scene;
use serde::Serialize;

use crate::failure::Failure;
use crate::machine;
use crate::message;
use crate::number;
use crate::table::{list, table};

/// What a finished run tells its user.
#[derive(Debug, Serialize)]
pub struct Summary {
    title: String,
    surfaces: Vec<String>,
    file: PathBuf,
    file_size: u64,
    steps: u64,
    time: f64,
    wall_time: f64,
    steps_per_second: f64,
    load_evaluations_per_step: f64,
    writer_wait: f64,
    peak_memory: Option<u64>,
    contact_area: f64,
    contact_area_mean: f64,
    contact_area_last_tenth: Option<WindowMean>,
    contact_ratio: f64,
    mean_pressure: f64,
    max_pressure: f64,
    filled_fraction: f64,
    disc_secondary: f64,
    pin_secondary: f64,
    worn: f64,
    emitted: f64,
    load_residual: f64,
    load_tolerance: f64,
    balance_residual: f64,
    /// What the scene can hardly mean.
    warnings: Vec<Warning>,
}

impl Summary {
    /// Puts together what was done for the surfaces and what the run file, the last sample, the drive and the writer tell.
    #[expect(clippy::too_many_arguments, reason = "each from somewhere else")]
    pub fn new(
        scene: &Scene,
        surfaces: Vec<String>,
        file: &Path,
        last: &Sample,
        contact_area_last_tenth: Option<WindowMean>,
        course: Course,
        report: WriterReport,
        wall_time: f64,
    ) -> Self {
        Self {
            title: scene.title.clone(),
            surfaces,
            file: file.to_owned(),
            file_size: report.bytes,
            steps: last.step,
            time: last.time,
            wall_time,
            steps_per_second: last.step as f64 / wall_time,
            load_evaluations_per_step: 1.0 + course.extra_readings as f64 / course.steps as f64,
            writer_wait: report.waited.as_secs_f64(),
            peak_memory: machine::peak_memory(),
            contact_area: last.contact_area,
            contact_area_mean: last.contact_area_mean,
            contact_area_last_tenth,
            contact_ratio: last.contact_ratio,
            mean_pressure: last.mean_pressure,
            max_pressure: last.max_pressure,
            filled_fraction: last.filled_fraction,
            disc_secondary: last.disc_secondary,
            pin_secondary: last.pin_secondary,
            worn: last.worn_pin + last.worn_resin + last.worn_disc,
            emitted: last.emitted,
            load_residual: course.largest_load_residual,
            load_tolerance: scene.load_tolerance,
            balance_residual: last.balance_residual,
            warnings: scene.warnings.clone(),
        }
    }

    /// Says on standard error what was not as exact as asked for.
    pub fn warn(&self) {
        if self.load_residual > self.load_tolerance {
            message::warning(format_args!(
                "the load balance reached {:.1e}, not {:.1e}: rounding of the heights allows no better",
                self.load_residual, self.load_tolerance
            ));
        }
    }

    /// One JSON document.
    ///
    /// # Errors
    /// When it cannot be written down.
    pub fn to_json(&self) -> Result<String, Failure> {
        serde_json::to_string_pretty(self).map(|text| text + "\n").map_err(Failure::run)
    }

    /// A table for people.
    pub fn to_text(&self) -> String {
        // Adding 0 makes a negative zero a plain one.
        let percent = |fraction: f64| format!("{:.2} %", (1e4 * fraction).round() / 1e2 + 0.0);
        let square_millimetres = |area: f64| format!("{:.4} mm²", area * 1e6);
        let cubic_millimetres = |volume: f64| format!("{} mm³", number::short(volume * 1e9));
        let megapascal = |pressure: f64| format!("{:.3} MPa", pressure * 1e-6);
        let of_last_step =
            format!("last step {}, {} of the pin", square_millimetres(self.contact_area), percent(self.contact_ratio));
        let contact_area = match &self.contact_area_last_tenth {
            Some(window) => format!("{}; {of_last_step}", contact_area(window)),
            None => of_last_step,
        };
        let mut rows = vec![
            ("simulated time", format!("{} s in {} steps", number::short(self.time), number::grouped(self.steps))),
            (
                "wall time",
                format!(
                    "{} ({} steps/s)",
                    number::duration(self.wall_time),
                    number::grouped(self.steps_per_second as u64)
                ),
            ),
            ("waited for the run file", number::duration(self.writer_wait)),
            ("contact area", contact_area),
            (
                "contact pressure",
                format!("mean {}, largest {}", megapascal(self.mean_pressure), megapascal(self.max_pressure)),
            ),
            ("disc filled", percent(self.filled_fraction)),
            (
                "with any build-up",
                format!("{} of the disc, {} of the pin", percent(self.disc_secondary), percent(self.pin_secondary)),
            ),
            (
                "worn volume",
                format!("{}, of which emitted {}", cubic_millimetres(self.worn), cubic_millimetres(self.emitted)),
            ),
            (
                "residuals",
                format!("load {:.1e} at most, debris balance {:.1e}", self.load_residual, self.balance_residual),
            ),
        ];
        if let Some(bytes) = self.peak_memory {
            rows.push(("peak memory", number::bytes(bytes)));
        }
        rows.push(("run file", format!("{} ({})", self.file.display(), number::bytes(self.file_size))));
        format!("{}\n{}", table(&self.title, &rows), list("Surfaces", &self.surfaces))
    }
}

/// A mean contact area with its standard error, and over what it is taken.
fn contact_area(window: &WindowMean) -> String {
    let mean = number::with_error(window.mean * 1e6, window.standard_error.map(|error| error * 1e6));
    let width = number::rounded(window.to - window.from, 4);
    let over = match window.revolutions {
        Some(revolutions) if !window.is_long() => {
            format!("mean of all {width} s, only {} simulated revolutions", number::rounded(revolutions, 2))
        }
        _ => format!("mean of the last {width} s"),
    };
    let error = if window.standard_error.is_some() { ", ± standard error" } else { ", too few samples for an error" };
    format!("{mean} mm² ({over}{error})")
}
