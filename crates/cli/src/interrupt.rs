//! Talking to a run from outside: Ctrl-C, the signals that end programs, and the one that asks for a checkpoint.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use std::{fs, io, thread};

use plateau_run::signal_in_words;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGUSR1, SIGXCPU};
use signal_hook::low_level::exit;

use crate::failure::Failure;

/// Time between two looks at signals while a run is prepared.
const LOOK: Duration = Duration::from_millis(50);

/// Notes the signals that ask a run to stop.
#[derive(Debug)]
pub struct Interrupt {
    signal: Arc<AtomicUsize>,
    save: Arc<AtomicBool>,
}

/// While this is there, a signal ends the program at once: nothing is written yet that could be kept.
#[derive(Debug)]
pub struct Preparation {
    goes_on: Arc<Mutex<bool>>,
}

impl Interrupt {
    /// From now on SIGINT, SIGTERM, SIGHUP (the terminal is gone) and SIGXCPU (the time limit of the system is reached) are noted
    /// instead of ending the program. What the caller ignores stays ignored, as SIGHUP behind `nohup`.
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

    /// Until what this gives is dropped, a noted signal ends the program, wherever it is: surfaces may take long to read and make.
    /// It says so if it `speaks`: of several processes one does. Where the system gives no thread to look, signals are noted only.
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
                    let stopped = Failure::Stopped { signal, message: speaks.then(message) };
                    stopped.say();
                    exit(stopped.status().into());
                }
                drop(goes_on);
                thread::sleep(LOOK);
            }
        };
        let _ = thread::Builder::new().name("signals".into()).spawn(look);
        Preparation { goes_on }
    }

    /// From now on SIGUSR1 ends no command: what keeps no state has none to save, and what does has none yet. Where the system takes no
    /// handler, all is as before.
    pub fn pass_over_saves() {
        let _ = signal_hook::flag::register(SIGUSR1, Arc::default());
    }

    /// From now on SIGUSR1, with which batch systems announce the end, asks for a checkpoint.
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
