//! How far a run is: simulated time, steps per second, time left, present contact area. On a terminal a bar, elsewhere a line
//! every minute.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use plateau_core::simulation::Simulation;

use crate::{message, number};

/// Parts of the bar.
const PARTS: u64 = 1_000_000;
/// Time between two looks at the bar.
const INTERVAL: Duration = Duration::from_millis(200);
/// Time between two lines where there is no terminal, as in the log of a batch system.
const INTERVAL_OF_LINES: Duration = Duration::from_secs(60);

/// Progress on standard error.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    visible: bool,
    /// Simulated time of the whole run, s.
    duration: f64,
    start: Instant,
    looked: Instant,
}

impl Progress {
    /// That of so much simulated time (s) with the name of what is simulated, if it has one; to be seen or not.
    pub fn new(duration: f64, name: &str, visible: bool) -> Self {
        let visible = visible && !message::is_quiet();
        let bar = if visible { ProgressBar::new(PARTS) } else { ProgressBar::hidden() };
        if let Ok(style) = ProgressStyle::with_template("{prefix}{bar:28} {percent:>3} %  {msg}  {eta} left") {
            bar.set_style(style);
        }
        if !name.is_empty() {
            bar.set_prefix(format!("{name}  "));
        }
        let now = Instant::now();
        Self { bar, visible, duration, start: now, looked: now }
    }

    /// Shows how far the simulation is, if the last look was long enough ago.
    pub fn show(&mut self, simulation: &Simulation) {
        let is_line = self.bar.is_hidden();
        if !self.visible || self.looked.elapsed() < if is_line { INTERVAL_OF_LINES } else { INTERVAL } {
            return;
        }
        self.looked = Instant::now();
        let part = simulation.time() / self.duration;
        let state = format!(
            "{:.1} of {:.1} s  {} steps/s  contact {:.3} mm²",
            simulation.time(),
            self.duration,
            number::grouped((simulation.steps_done() as f64 / self.start.elapsed().as_secs_f64()) as u64),
            simulation.course().contact_area * 1e6
        );
        if is_line {
            let left = self.start.elapsed().as_secs_f64() * (1.0 / part - 1.0);
            message::note(format_args!("{:.0} %, {state}, {} left", 100.0 * part, number::duration(left)));
        } else {
            self.bar.set_message(state);
            self.bar.set_position((part * PARTS as f64) as u64);
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
