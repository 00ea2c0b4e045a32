//! A run on the terminal: messages and a progress bar on standard error, and signals.

use std::cell::RefCell;
use std::fmt::Display;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use std::{fs, io, thread};

use indicatif::{ProgressBar, ProgressStyle};
use plateau_core::simulation::Simulation;
use plateau_io::number;
use plateau_io::study::Study;
use plateau_run::sweep::SweepObserver;
use plateau_run::{Observer, signal_in_words};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGUSR1, SIGXCPU};
use signal_hook::low_level::exit;

use crate::failure::{Failure, say};
use crate::{invocation, message};

/// Parts of the bar.
const PARTS: u64 = 1_000_000;
/// Time between two looks at the bar.
const INTERVAL: Duration = Duration::from_millis(200);
/// Time between two lines where there is no terminal, as in the log of a batch system.
const INTERVAL_OF_LINES: Duration = Duration::from_secs(60);

/// Progress on standard error.
#[derive(Debug)]
struct Progress {
    bar: ProgressBar,
    visible: bool,
    /// Simulated time of the whole run, s.
    duration: f64,
    start: Instant,
    looked: Instant,
}

/// A bar of that length on standard error, which may be silent: `-q` keeps it back.
pub fn bar(length: u64, visible: bool) -> ProgressBar {
    let bar = if visible && !message::is_quiet() { ProgressBar::new(length) } else { ProgressBar::hidden() };
    if let Ok(style) = ProgressStyle::with_template("{prefix}{bar:28} {percent:>3} %  {msg}  {eta} left") {
        bar.set_style(style);
    }
    bar
}

impl Progress {
    /// Progress over so much simulated time (s), with the name of what is simulated, if it has one; to be seen or not.
    fn new(duration: f64, name: &str, visible: bool) -> Self {
        let visible = visible && !message::is_quiet();
        let bar = bar(PARTS, visible);
        if !name.is_empty() {
            bar.set_prefix(format!("{name}  "));
        }
        let now = Instant::now();
        Self { bar, visible, duration, start: now, looked: now }
    }

    /// Shows how far the simulation is, if the last look was long enough ago.
    fn show(&mut self, simulation: &Simulation) {
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
}

/// Shows messages and nothing else; signals end the program as ever.
#[derive(Debug)]
pub struct Messages;

impl Observer for Messages {
    fn warning(&self, message: &dyn Display) {
        message::warning(message);
    }

    fn note(&self, message: &dyn Display) {
        message::note(message);
    }

    fn detail(&self, message: &dyn Display) {
        if message::is_verbose() {
            message::note(message);
        }
    }
}

impl SweepObserver for Messages {
    fn retry_advice(&self, study: &Study) -> String {
        let argument = |path: &Path| invocation::argument(&path.to_string_lossy());
        let elsewhere = match study.is_elsewhere {
            true => format!(" --directory {}", argument(&study.directory)),
            false => String::new(),
        };
        format!("`{} sweep run {}{elsewhere} --retry` makes them again", invocation::program(), argument(&study.path))
    }
}

/// Shows a run, and stops or saves it when a signal asks for that.
#[derive(Debug)]
pub struct Terminal {
    interrupt: Interrupt,
    /// Guard that is there until something is written.
    preparation: RefCell<Option<Preparation>>,
    /// Tells whether there is a progress bar.
    visible: bool,
    progress: RefCell<Option<Progress>>,
}

impl Terminal {
    /// Notes signals from now on; another process of the job shows the progress unless this one does.
    pub fn listen(visible: bool) -> io::Result<Self> {
        Ok(Self {
            interrupt: Interrupt::listen()?,
            preparation: RefCell::default(),
            visible,
            progress: RefCell::default(),
        })
    }

    /// Listens as [`listen`](Self::listen) does, also for SIGUSR1 as a wish for a checkpoint. Until the run is prepared, which takes long
    /// enough for a large scene, a signal ends the program at once, and each process of a job by itself: nothing is written yet.
    pub fn listen_for_run(visible: bool) -> io::Result<Self> {
        let terminal = Self::listen(visible)?;
        terminal.interrupt.listen_for_save()?;
        *terminal.preparation.borrow_mut() = Some(terminal.interrupt.end_at_once(visible));
        Ok(terminal)
    }
}

impl Observer for Terminal {
    fn warning(&self, message: &dyn Display) {
        Messages.warning(message);
    }

    fn note(&self, message: &dyn Display) {
        Messages.note(message);
    }

    fn detail(&self, message: &dyn Display) {
        Messages.detail(message);
    }

    fn prepared(&self) {
        drop(self.preparation.take());
    }

    fn starts(&self, name: &str, duration: f64) {
        *self.progress.borrow_mut() = Some(Progress::new(duration, name, self.visible));
    }

    fn progress(&self, simulation: &Simulation) {
        self.progress.borrow_mut().iter_mut().for_each(|progress| progress.show(simulation));
    }

    fn ends(&self) {
        self.progress.take().iter().for_each(|progress| progress.bar.finish_and_clear());
    }

    fn asked_to_stop(&self) -> Option<u8> {
        self.interrupt.signal()
    }

    fn asked_to_save(&self) -> bool {
        self.interrupt.save()
    }
}

/// Time between two looks at signals while a run is prepared.
const LOOK: Duration = Duration::from_millis(50);

/// Notes the signals that ask a run to stop.
#[derive(Debug)]
pub struct Interrupt {
    signal: Arc<AtomicUsize>,
    save: Arc<AtomicBool>,
}

/// Guard: while it lives, a signal ends the program at once; nothing is written yet that could be kept.
#[derive(Debug)]
pub struct Preparation {
    goes_on: Arc<Mutex<bool>>,
}

impl Interrupt {
    /// Notes SIGINT, SIGTERM, SIGHUP (the terminal is gone) and SIGXCPU (the time limit of the system is reached) from now on,
    /// so that they do not end the program. What the caller ignores stays ignored, as SIGHUP behind `nohup`.
    pub fn listen() -> io::Result<Self> {
        let signal = Arc::new(AtomicUsize::new(0));
        let ignored = ignored_signals();
        for number in [SIGINT, SIGTERM, SIGHUP, SIGXCPU] {
            if number != SIGHUP || ignored >> (SIGHUP - 1) & 1 == 0 {
                signal_hook::flag::register_usize(number, Arc::clone(&signal), number.unsigned_abs() as usize)?;
            }
        }
        Ok(Self { signal, save: Arc::default() })
    }

    /// Lets a noted signal end the program, wherever it is, until the guard is dropped: surfaces may take long to read and make.
    /// The program says so if it `speaks`: of several processes one does. Where the system gives no thread to look, signals are noted only.
    pub fn end_at_once(&self, speaks: bool) -> Preparation {
        let goes_on = Arc::new(Mutex::new(true));
        let (signal, preparation) = (Arc::clone(&self.signal), Arc::clone(&goes_on));
        let look = move || {
            loop {
                // Held while the program ends, so that nothing is written meanwhile.
                let goes_on = preparation.lock().unwrap_or_else(PoisonError::into_inner);
                if !*goes_on {
                    return;
                }
                if let Some(signal) = noted(&signal) {
                    let message = || format!("stopped by {} before the first step", signal_in_words(signal));
                    let stopped = Failure::stopped(signal, speaks.then(message));
                    say(&stopped);
                    exit(stopped.status.into());
                }
                drop(goes_on);
                thread::sleep(LOOK);
            }
        };
        let _ = thread::Builder::new().name("signals".into()).spawn(look);
        Preparation { goes_on }
    }

    /// Keeps SIGUSR1 from ending a command: what keeps no state has none to save, and what does has none yet. Where the system takes no
    /// handler, all is as before.
    pub fn pass_over_saves() {
        let _ = signal_hook::flag::register(SIGUSR1, Arc::default());
    }

    /// Notes SIGUSR1, with which batch systems announce the end, as a wish for a checkpoint from now on.
    pub fn listen_for_save(&self) -> io::Result<()> {
        signal_hook::flag::register(SIGUSR1, Arc::clone(&self.save)).map(drop)
    }

    /// Tells whether a checkpoint was asked for since the last time.
    pub fn save(&self) -> bool {
        self.save.swap(false, Ordering::Relaxed)
    }

    /// The signal that came, if one did.
    pub fn signal(&self) -> Option<u8> {
        noted(&self.signal)
    }
}

impl Drop for Preparation {
    fn drop(&mut self) {
        *self.goes_on.lock().unwrap_or_else(PoisonError::into_inner) = false;
    }
}

fn noted(signal: &AtomicUsize) -> Option<u8> {
    u8::try_from(signal.load(Ordering::Relaxed)).ok().filter(|signal| *signal != 0)
}

/// The signals that this process ignores, one bit each from 1 on (proc(5), SigIgn); none where the system does not tell.
fn ignored_signals() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}
