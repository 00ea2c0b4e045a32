//! The progress bar: simulated time, steps per second, time left, present contact area.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use plateau_core::simulation::Simulation;

use crate::number;

/// Parts of the bar.
const PARTS: u64 = 1_000_000;
/// Time between two looks at the bar.
const INTERVAL: Duration = Duration::from_millis(200);

/// A progress bar on standard error; silent where that is no terminal.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    /// Simulated time of the whole run, s.
    duration: f64,
    start: Instant,
    looked: Instant,
}

impl Progress {
    /// A bar for so much simulated time (s) with the name of what is simulated, if it has one; to be seen or not.
    pub fn new(duration: f64, name: &str, visible: bool) -> Self {
        let bar = if visible { ProgressBar::new(PARTS) } else { ProgressBar::hidden() };
        if let Ok(style) = ProgressStyle::with_template("{prefix}{bar:28} {percent:>3} %  {msg}  {eta} left") {
            bar.set_style(style);
        }
        if !name.is_empty() {
            bar.set_prefix(format!("{name}  "));
        }
        let now = Instant::now();
        Self { bar, duration, start: now, looked: now }
    }

    /// Shows how far the simulation is, if the last look was long enough ago.
    pub fn show(&mut self, simulation: &Simulation) {
        if self.bar.is_hidden() || self.looked.elapsed() < INTERVAL {
            return;
        }
        self.looked = Instant::now();
        self.bar.set_message(format!(
            "{:.1} of {:.1} s  {} steps/s  contact {:.3} mm²",
            simulation.time(),
            self.duration,
            number::grouped((simulation.steps_done() as f64 / self.start.elapsed().as_secs_f64()) as u64),
            simulation.course().contact_area * 1e6
        ));
        self.bar.set_position((simulation.time() / self.duration * PARTS as f64) as u64);
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
