//! `plateau watch`: follow a run file that is being written.

use std::path::Path;
use std::time::{Duration, Instant, SystemTime};
use std::{fs, io, thread};

use plateau_io::number;
use plateau_io::run_file::{ReadError, State};

use crate::arguments::WatchArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::message;
use crate::screen::Screen;
use crate::watch::{Look, Pace};

/// Time between two looks, at least.
const INTERVAL: Duration = Duration::from_secs(1);
/// A look takes at most this part of the time.
const PART: u32 = 5;
/// Time between two questions whether a signal has come.
const NAP: Duration = Duration::from_millis(50);
/// Time for which a file may look damaged: its writer closes it, or replaces it.
const MENDING: Duration = Duration::from_secs(3);
/// Time for which a file is waited for unless a timeout is given.
const ARRIVAL: Duration = Duration::from_secs(10);

/// Shows a run until it ends.
pub fn watch(arguments: &WatchArguments) -> Result<(), Failure> {
    let interrupt = Interrupt::listen().map_err(Failure::run)?;
    let mut watcher = Watcher::new(arguments);
    let mut screen = Screen::new();
    if !arguments.once && !arguments.run.exists() {
        message::note(format_args!("waiting for {}", arguments.run.display()));
    }
    loop {
        let start = Instant::now();
        if let Some(look) = watcher.look()? {
            let warning = watcher.warning(&look);
            match screen.show(&look, &watcher.pace, warning.as_deref()) {
                // Nobody is left to be shown anything.
                Err(error) if error.kind() == io::ErrorKind::BrokenPipe => return Ok(()),
                shown => shown.map_err(Failure::run)?,
            }
            if arguments.once {
                return Ok(());
            }
            if look.state != State::Running {
                return ended(&look);
            }
            watcher.last = Some(look);
        }
        watcher.check_timeout()?;
        let next = Instant::now() + INTERVAL.max(start.elapsed() * PART);
        while Instant::now() < next {
            if let Some(signal) = interrupt.signal() {
                return Err(Failure::Stopped { signal, message: None });
            }
            thread::sleep(NAP);
        }
    }
}

/// Meaning of the end of a run for the exit status.
fn ended(look: &Look) -> Result<(), Failure> {
    match look.state {
        State::Failed => {
            let reason = look.error.as_deref().unwrap_or("its file does not say why");
            Err(Failure::run(format_args!("the run failed: {reason}")))
        }
        State::Interrupted => {
            Err(Failure::run(format_args!("the run was stopped at {} s", number::short(look.time()))))
        }
        State::Finished | State::Running => Ok(()),
    }
}

/// Looks at a run file again and again.
struct Watcher<'a> {
    path: &'a Path,
    once: bool,
    timeout: Option<Duration>,
    pace: Pace,
    last: Option<Look>,
    /// Size and time of the file that was looked at last, and how often it was.
    stamp: (Option<(u64, SystemTime)>, u32),
    /// Since when the file cannot be read.
    unreadable: Option<Instant>,
}

impl<'a> Watcher<'a> {
    fn new(arguments: &'a WatchArguments) -> Self {
        Self {
            path: &arguments.run,
            once: arguments.once,
            timeout: arguments.timeout.map(Duration::from_secs),
            pace: Pace::new(Instant::now()),
            last: None,
            stamp: (None, 0),
            unreadable: None,
        }
    }

    /// Content of the file now; nothing while it is not there, or is just being closed.
    fn look(&mut self) -> Result<Option<Look>, Failure> {
        let stamp = fs::metadata(self.path).and_then(|file| Ok((file.len(), file.modified()?))).ok();
        // Twice, for a file system may give two changes shortly after one another the same time.
        let seen = if stamp == self.stamp.0 { self.stamp.1 } else { 0 };
        if let (Some(last), Some((_, written)), 2..) = (&self.last, stamp, seen) {
            return Ok(Some(Look { age: written.elapsed().unwrap_or_default(), ..last.clone() }));
        }
        self.stamp = (stamp, seen + 1);
        match Look::at(self.path) {
            Ok(look) => {
                self.unreadable = None;
                self.pace.note(&look, Instant::now());
                Ok(Some(look))
            }
            Err(error) => self.unreadable(error),
        }
    }

    /// Tells whether a file that cannot be read is worth waiting for.
    fn unreadable(&mut self, error: ReadError) -> Result<Option<Look>, Failure> {
        let since = *self.unreadable.get_or_insert_with(Instant::now);
        let absent = !self.path.exists();
        let patience = match error {
            ReadError::System { .. } if absent && self.once => Duration::ZERO,
            ReadError::System { .. } if absent => self.timeout.unwrap_or(ARRIVAL),
            ReadError::Damaged { .. } => MENDING,
            _ => Duration::ZERO,
        };
        if since.elapsed() < patience {
            return Ok(None);
        }
        let waited = if absent && !self.once {
            format!("; none came within {}", number::duration(patience.as_secs_f64()))
        } else {
            String::new()
        };
        Err(Failure::because(&error, format_args!("{error}{waited}")))
    }

    /// That the run may have been killed, if so it seems.
    fn warning(&self, look: &Look) -> Option<String> {
        let silence = self.pace.silence(look, Instant::now()).filter(|_| look.state == State::Running)?;
        let silence = number::duration(silence.as_secs_f64().floor());
        Some(format!("no new sample for {silence}; the run may have been killed"))
    }

    fn check_timeout(&self) -> Result<(), Failure> {
        let Some(timeout) = self.timeout else { return Ok(()) };
        if self.last.is_none() || self.pace.idle(Instant::now()) < timeout {
            return Ok(());
        }
        let (path, timeout) = (self.path.display(), number::duration(timeout.as_secs_f64()));
        Err(Failure::run(format_args!("{path} has no new sample for {timeout}; the run may have been killed")))
    }
}
