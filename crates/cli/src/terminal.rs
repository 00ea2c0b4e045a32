//! A run as the terminal shows it and talks to it: messages and a progress bar on standard error, signals.

use std::fmt::Display;
use std::io;

use plateau_core::simulation::Simulation;
use plateau_run::Observer;

use crate::interrupt::{Interrupt, Preparation};
use crate::message;
use crate::progress::Progress;

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

/// Shows a run, and stops or saves it when a signal asks for that.
#[derive(Debug)]
pub struct Terminal {
    interrupt: Interrupt,
    /// Nothing is written yet.
    preparation: Option<Preparation>,
    /// Whether there is a progress bar.
    visible: bool,
    progress: Option<Progress>,
}

impl Terminal {
    /// From now on signals are noted; another process of the job shows the progress unless this one does.
    ///
    /// # Errors
    /// When the system does not take the handlers.
    pub fn listen(visible: bool) -> io::Result<Self> {
        Ok(Self { interrupt: Interrupt::listen()?, preparation: None, visible, progress: None })
    }

    /// The same, and SIGUSR1 asks for a checkpoint.
    ///
    /// # Errors
    /// When the system does not take the handlers.
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
