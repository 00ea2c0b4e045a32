//! The progress bar: simulated time, steps per second, time left, present contact area.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use plateau_core::simulation::Simulation;

use crate::number;

/// Time between two looks at the bar.
const INTERVAL: Duration = Duration::from_millis(200);

/// A progress bar on standard error; silent where that is no terminal.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    looked: Instant,
}

impl Progress {
    /// A bar for this many steps, to be seen or not.
    pub fn new(steps: u64, visible: bool) -> Self {
        let bar = if visible { ProgressBar::new(steps) } else { ProgressBar::hidden() };
        if let Ok(style) = ProgressStyle::with_template("{prefix}{bar:28} {percent:>3} %  {msg}  {eta} left") {
            bar.set_style(style);
        }
        Self { bar, looked: Instant::now() }
    }

    /// A bar for this many steps with the name of what they are steps of.
    pub fn named(steps: u64, name: &str) -> Self {
        let progress = Self::new(steps, true);
        progress.bar.set_prefix(format!("{name}  "));
        progress
    }

    /// Shows how far the simulation is, if the last look was long enough ago.
    pub fn show(&mut self, simulation: &Simulation) {
        if self.bar.is_hidden() || self.looked.elapsed() < INTERVAL {
            return;
        }
        self.looked = Instant::now();
        let parameters = simulation.parameters();
        self.bar.set_message(format!(
            "{:.1} of {:.1} s  {} steps/s  contact {:.3} mm²",
            simulation.time(),
            parameters.time_at(parameters.steps),
            number::grouped(self.bar.per_sec() as u64),
            simulation.course().contact_area * 1e6
        ));
        self.bar.set_position(simulation.steps_done());
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
