//! Talking to a run from outside: Ctrl-C, the signal that ends programs, and the one that asks for a checkpoint.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM, SIGUSR1};

/// Notes the signals that ask a run to stop.
#[derive(Debug)]
pub struct Interrupt {
    signal: Arc<AtomicUsize>,
    save: Arc<AtomicBool>,
}

impl Interrupt {
    /// From now on SIGINT and SIGTERM are noted instead of ending the program.
    ///
    /// # Errors
    /// When the system does not take the handlers.
    pub fn listen() -> io::Result<Self> {
        let signal = Arc::new(AtomicUsize::new(0));
        for number in [SIGINT, SIGTERM] {
            signal_hook::flag::register_usize(number, Arc::clone(&signal), number.unsigned_abs() as usize)?;
        }
        Ok(Self { signal, save: Arc::default() })
    }

    /// From now on SIGUSR1, with which batch systems announce the end, asks for a checkpoint.
    ///
    /// # Errors
    /// When the system does not take the handler.
    pub fn listen_for_save(&self) -> io::Result<()> {
        signal_hook::flag::register(SIGUSR1, Arc::clone(&self.save)).map(drop)
    }

    /// Whether a checkpoint was asked for since the last time.
    pub fn save(&self) -> bool {
        self.save.swap(false, Ordering::Relaxed)
    }

    /// The signal that came, if one did.
    pub fn signal(&self) -> Option<u8> {
        u8::try_from(self.signal.load(Ordering::Relaxed)).ok().filter(|signal| *signal != 0)
    }
}
