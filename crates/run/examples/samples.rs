//! Runs a scene and prints time and contact area of every sample, with an observer of its own.
//! `cargo run --release -p plateau-run --example samples -- data/scenes/quick.toml quick.h5`.

use std::error::Error;
use std::fmt::Display;
use std::path::PathBuf;

use plateau_core::observe::Sample;
use plateau_io::scene;
use plateau_run::{Job, Observer, RunOptions, run};

/// Prints what a run says, and its samples.
struct Printer;

impl Observer for Printer {
    fn warning(&self, message: &dyn Display) {
        eprintln!("warning: {message}");
    }

    fn sample(&self, sample: &Sample) {
        println!("{:8.3} s  {:6.3} mm2", sample.time, sample.contact_area_mean * 1e6);
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let path = arguments.next().unwrap_or_else(|| "data/scenes/quick.toml".into());
    // Without a second argument the scene names the run file.
    let options = RunOptions { output: arguments.next(), replace: true, ..RunOptions::default() };
    let mut job = Job::start()?;
    if let Some(summary) = run(scene::load(&path, &[])?, &options, &mut job, &Printer)? {
        println!("{} has {} steps, made in {:.1} s", summary.file.display(), summary.steps, summary.wall_time);
    }
    job.finish();
    Ok(())
}
