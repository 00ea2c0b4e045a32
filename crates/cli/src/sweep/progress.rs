//! How far a study is: runs that ended, steps of those that go on, time left.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use crate::message;

/// One bar for all runs, on standard error; silent where that is no terminal.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    runs: usize,
    ended: AtomicU64,
    failed: AtomicU64,
}

impl Progress {
    /// A bar for so many runs with so many steps together.
    pub fn new(runs: usize, steps: u64, visible: bool) -> Self {
        let bar = if visible && !message::is_quiet() { ProgressBar::new(steps) } else { ProgressBar::hidden() };
        if let Ok(style) = ProgressStyle::with_template("{bar:28} {percent:>3} %  {msg}  {eta} left") {
            bar.set_style(style);
        }
        if !bar.is_hidden() {
            bar.enable_steady_tick(Duration::from_secs(1));
        }
        let progress = Self { bar, runs, ended: AtomicU64::new(0), failed: AtomicU64::new(0) };
        progress.show();
        progress
    }

    /// Steps were taken.
    pub fn steps(&self, count: u64) {
        self.bar.inc(count);
    }

    /// A run ended.
    pub fn ended(&self, failed: bool) {
        self.failed.fetch_add(failed.into(), Ordering::Relaxed);
        self.ended.fetch_add(1, Ordering::Relaxed);
        self.show();
    }

    fn show(&self) {
        let (ended, failed) = (self.ended.load(Ordering::Relaxed), self.failed.load(Ordering::Relaxed));
        let failed = if failed > 0 { format!(", {failed} failed") } else { String::new() };
        self.bar.set_message(format!("{ended} of {} runs{failed}", self.runs));
    }

    /// Says something above the bar.
    pub fn say(&self, text: impl FnOnce()) {
        self.bar.suspend(text);
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
