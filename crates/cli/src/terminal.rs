//! A run on the terminal: messages and a progress bar on standard error, and signals.

use std::fmt::Display;
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use plateau_core::simulation::Simulation;
use plateau_io::number;
use plateau_run::Observer;
use plateau_run::sweep::SweepObserver;

use crate::interrupt::{Interrupt, Preparation};
use crate::{invocation, message};

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

/// Shows messages and nothing else; signals end the program as ever.
#[derive(Debug)]
pub struct Messages;

impl Observer for Messages {
    fn warning(&mut self, message: &dyn Display) {
        message::warning(message);
    }

    fn note(&mut self, message: &dyn Display) {
        message::note(message);
    }

    fn detail(&mut self, message: &dyn Display) {
        if message::is_verbose() {
            message::note(message);
        }
    }
}

impl SweepObserver for Messages {
    fn warning(&self, message: &dyn Display) {
        message::warning(message);
    }

    fn note(&self, message: &dyn Display) {
        message::note(message);
    }

    fn retry_advice(&self, study: &Path) -> String {
        let again =
            format!("{} sweep run {} --retry", invocation::program(), invocation::argument(&study.to_string_lossy()));
        format!("`{again}` makes them again")
    }
}

/// Shows a run, and stops or saves it when a signal asks for that.
#[derive(Debug)]
pub struct Terminal {
    interrupt: Interrupt,
    /// Nothing is written yet.
    preparation: Option<Preparation>,
    /// Tells whether there is a progress bar.
    visible: bool,
    progress: Option<Progress>,
}

impl Terminal {
    /// From now on signals are noted; another process of the job shows the progress unless this one does.
    pub fn listen(visible: bool) -> io::Result<Self> {
        Ok(Self { interrupt: Interrupt::listen()?, preparation: None, visible, progress: None })
    }

    /// The same, and SIGUSR1 asks for a checkpoint.
    pub fn listen_for_save(visible: bool) -> io::Result<Self> {
        let terminal = Self::listen(visible)?;
        terminal.interrupt.listen_for_save()?;
        Ok(terminal)
    }

    /// Until the run is prepared, a signal ends the program at once.
    pub fn end_while_preparing(&mut self) {
        self.preparation = Some(self.interrupt.end_at_once(self.visible));
    }
}

impl Observer for Terminal {
    fn warning(&mut self, message: &dyn Display) {
        Messages.warning(message);
    }

    fn note(&mut self, message: &dyn Display) {
        Messages.note(message);
    }

    fn detail(&mut self, message: &dyn Display) {
        Messages.detail(message);
    }

    fn prepared(&mut self) {
        self.preparation = None;
    }

    fn starts(&mut self, name: &str, duration: f64) {
        self.progress = Some(Progress::new(duration, name, self.visible));
    }

    fn progress(&mut self, simulation: &Simulation) {
        self.progress.iter_mut().for_each(|progress| progress.show(simulation));
    }

    fn ends(&mut self) {
        self.progress.take().iter().for_each(Progress::finish);
    }

    fn asked_to_stop(&mut self) -> Option<u8> {
        self.interrupt.signal()
    }

    fn asked_to_save(&mut self) -> bool {
        self.interrupt.save()
    }
}
