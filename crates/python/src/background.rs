//! Work on a thread of its own. Meanwhile the thread that called looks at signals, which Python handles on no other, shows progress and
//! gives warnings.

use std::fmt::Display;
use std::mem;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use plateau_core::simulation::Simulation;
use plateau_io::run_file::close_abandoned;
use plateau_io::study::Study;
use plateau_run::Observer;
use plateau_run::sweep::SweepObserver;
use pyo3::prelude::*;

use crate::failure::{Failure, raise};

/// Time between two looks at signals.
const LOOK: Duration = Duration::from_millis(50);
/// Number of the signal of Ctrl-C.
const INTERRUPT: u8 = 2;

/// Messages of work on another thread, and to it; notes are for terminals alone.
#[derive(Debug, Default)]
pub struct Messages {
    is_asked_to_stop: AtomicBool,
    warnings: Mutex<Vec<String>>,
    /// Physical time that a run has come to and its end, s, as bits; of several runs steps.
    progress: [AtomicU64; 2],
    /// Runs that ended, and failed.
    ended: [AtomicUsize; 2],
}

impl Messages {
    /// Hands on warnings, to a function of Python that takes a word and a text, and progress as three numbers.
    fn deliver(&self, tell: &Bound<'_, PyAny>) -> PyResult<()> {
        for message in mem::take(&mut *self.warnings.lock().unwrap_or_else(PoisonError::into_inner)) {
            tell.call1(("warning", message))?;
        }
        let [done, end] = self.progress.each_ref().map(|part| f64::from_bits(part.load(Ordering::Relaxed)));
        if end > 0.0 {
            tell.call1(("progress", (done, end, self.ended.each_ref().map(|count| count.load(Ordering::Relaxed)))))?;
        }
        Ok(())
    }
}

impl Observer for Messages {
    fn warning(&self, message: &dyn Display) {
        self.warnings.lock().unwrap_or_else(PoisonError::into_inner).push(message.to_string());
    }

    fn starts(&self, _name: &str, end: f64) {
        self.progress[1].store(end.to_bits(), Ordering::Relaxed);
    }

    fn progress(&self, simulation: &Simulation) {
        self.progress[0].store(simulation.time().to_bits(), Ordering::Relaxed);
    }

    fn asked_to_stop(&self) -> Option<u8> {
        self.is_asked_to_stop.load(Ordering::Relaxed).then_some(INTERRUPT)
    }
}

impl SweepObserver for Messages {
    fn steps(&self, count: u64) {
        let add = |bits| Some((f64::from_bits(bits) + count as f64).to_bits());
        let _ = self.progress[0].fetch_update(Ordering::Relaxed, Ordering::Relaxed, add);
    }

    fn run_ended(&self, failed: bool) {
        self.ended[0].fetch_add(1, Ordering::Relaxed);
        self.ended[1].fetch_add(failed.into(), Ordering::Relaxed);
    }

    fn retry_advice(&self, study: &Study) -> String {
        let elsewhere = match study.is_elsewhere {
            true => format!(" --directory {}", study.directory.display()),
            false => String::new(),
        };
        format!("`plateau sweep run {}{elsewhere} --retry` makes them again", study.path.display())
    }
}

/// Puts a file in memory in the place of an open one.
fn put_aside(py: Python<'_>, number: i32) -> PyResult<()> {
    let os = py.import("os")?;
    let other = os.call_method1("memfd_create", ("plateau",))?;
    os.call_method1("dup2", (&other, number))?;
    os.call_method1("close", (other,)).map(drop)
}

/// Does `work` on a thread and gives what comes of it. An exception in this thread, such as that of Ctrl-C, asks the work to stop, and is
/// raised when it has.
///
/// Surfaces are made on threads that go with the work: those of a pool for the whole process would be missing after a fork.
pub fn in_background<T: Send>(
    py: Python<'_>,
    tell: &Bound<'_, PyAny>,
    about: &[&str],
    work: impl FnOnce(&Messages) -> Result<T, Failure> + Send,
) -> PyResult<T> {
    let (messages, caller) = (Messages::default(), thread::current());
    let mut raised = None;
    let done = thread::scope(|scope| {
        let job = || {
            let pool = rayon::ThreadPoolBuilder::new().build().map_err(Failure::run);
            let done = pool.and_then(|pool| pool.install(|| work(&messages)));
            caller.unpark();
            done
        };
        let thread = thread::Builder::new().name("plateau".into()).spawn_scoped(scope, job).map_err(Failure::run)?;
        while !thread.is_finished() {
            py.detach(|| thread::park_timeout(LOOK));
            if raised.is_none() {
                raised = py.check_signals().and_then(|()| messages.deliver(tell)).err();
                messages.is_asked_to_stop.store(raised.is_some(), Ordering::Relaxed);
            }
        }
        thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    });
    // The file of a run that failed is given up, and this process goes on.
    close_abandoned(|number| put_aside(py, number).is_ok());
    // What is said last is worth knowing also where it was stopped, but no exception takes the place of the first.
    let delivered = messages.deliver(tell);
    match (raised, done) {
        (Some(raised), _) => Err(raised),
        (None, done) => done.map_err(|failure| raise(py, about, failure)).and_then(|done| delivered.map(|()| done)),
    }
}
