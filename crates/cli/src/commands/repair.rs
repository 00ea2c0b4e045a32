//! `plateau repair`: make the file of a run that was killed readable by every program.

use std::fs;
use std::path::Path;
use std::time::Duration;

use plateau_io::claim::Claim;
use plateau_io::number;
use plateau_io::process::{Writer, writer_of};
use plateau_io::run_file::{self, LeftOut, Repair, RepairError, RunFile, checkpoint};
use plateau_io::units::{self, Dimension};
use plateau_run::{execution, signal_in_words};

use crate::arguments::RepairArguments;
use crate::failure::{Failure, say};
use crate::message;
use crate::output::print;
use crate::terminal::Interrupt;

/// A run that goes on touches its file or a checkpoint at least that often, unless its scene wants rarer checkpoints.
const SILENCE: Duration = Duration::from_secs(150);

/// Repairs all files that can be before it fails because of one.
pub fn repair(arguments: &RepairArguments) -> Result<(), Failure> {
    // A file that is begun is repaired to its end, and left without a lock.
    let interrupt = Interrupt::listen().map_err(Failure::run)?;
    let mut last = None;
    for path in &arguments.runs {
        match repair_one(path, arguments.force) {
            Ok(line) => print(&line)?,
            Err(failure) => {
                if let Some(earlier) = last.replace(failure) {
                    say(&earlier);
                }
            }
        }
        if let Some(signal) = interrupt.signal() {
            let message = format!("stopped by {} after {}", signal_in_words(signal), path.display());
            return Err(Failure::stopped(signal, Some(message)));
        }
    }
    last.map_or(Ok(()), Err)
}

/// Outcome for a file, on one line.
fn repair_one(path: &Path, force: bool) -> Result<String, Failure> {
    let file = path.display();
    match run_file::is_healthy(path) {
        Ok(true) => {}
        Ok(false) => refuse_if_written(path, force)?,
        // There may be a checkpoint of before it was damaged.
        Err(_) if run_file::last_writer(path).is_some() => refuse_if_written(path, force)?,
        Err(error) => return Err(Failure::input(error)),
    }
    match run_file::repair(path) {
        Ok(Repair::Healthy) => Ok(format!("{file} is healthy: nothing was done\n")),
        Ok(Repair::Repaired { copy, samples, moments, left_out }) => {
            if let Some(what) = told(left_out) {
                message::note(format_args!("{file}: {what}"));
            }
            let (samples, moments) = (number::count(samples, "sample"), number::count(moments, "moment"));
            Ok(format!("{file} is repaired: {samples}, {moments} with maps; what was there is {}\n", copy.display()))
        }
        Err(RepairError::Claimed(error)) if !error.lacks_space() => Err(Failure::input(error)),
        Err(error @ (RepairError::Read(_) | RepairError::Unknown { .. })) => Err(Failure::input(error)),
        Err(error) => Err(Failure::run(error)),
    }
}

/// Part that may be missing in a file, in words.
fn told(left_out: LeftOut) -> Option<&'static str> {
    match left_out {
        LeftOut::Nothing => None,
        LeftOut::Unreadable => Some("it cannot be read as it is; what came after its last checkpoint is left out"),
        LeftOut::NotOnDisk => Some(
            "the machine was started anew since it was written; what came after its last checkpoint may not have reached the \
             disk, and is left out",
        ),
        LeftOut::Doubtful => Some(
            "the machine was started anew since it was written, and there is no checkpoint: its last samples may not have \
             reached the disk, and be wrong",
        ),
    }
}

/// Time for which a run that continues may touch nothing.
fn silence(scene: &toml::Table) -> Duration {
    let every = scene.get("output").and_then(|output| output.get("checkpoint_every")?.as_str());
    let every = every.and_then(|every| units::parse(every, Dimension::Time).ok()).unwrap_or(0.0);
    SILENCE.max(Duration::try_from_secs_f64(2.5 * every).unwrap_or(Duration::MAX))
}

/// The machine on which a file was written last, and the scene of its run.
fn origin(path: &Path) -> Result<(String, toml::Table), Failure> {
    match (RunFile::open(path), run_file::last_writer(path)) {
        (Ok(run), _) => Ok((run.attribute("host").unwrap_or_default(), run.scene().clone())),
        (Err(_), Some((writer, scene))) => Ok((writer.machine.host, scene.parse().unwrap_or_default())),
        (Err(error), None) => Err(Failure::input(error)),
    }
}

/// Refuses a file whose run goes on, or may.
fn refuse_if_written(path: &Path, force: bool) -> Result<(), Failure> {
    let is_known = Claim::check(path).map_err(Failure::input)?;
    let file = path.display();
    match writer_of(path) {
        Writer::Process(process) => {
            return Err(Failure::input(format!("{file} is being written by process {process}; stop it first")));
        }
        // The lock of a run that was killed says that this run has ended.
        Writer::Hidden if !is_known && !force => {
            let advice = "who may still be writing it: this system does not tell; if not, give --force";
            return Err(Failure::input(format!("{file} belongs to another user, {advice}")));
        }
        Writer::Nobody | Writer::Hidden => {}
    }
    let (host, scene) = origin(path)?;
    if force || host == execution::host() {
        return Ok(());
    }
    let [last, _] = checkpoint::paths(path);
    // Another machine's clock may go ahead.
    let ages = [path, &last].map(|path| Some(fs::metadata(path).ok()?.modified().ok()?.elapsed().unwrap_or_default()));
    let Some(age) = ages.into_iter().flatten().min().filter(|age| *age < silence(&scene)) else {
        message::note(format_args!("{file} was last written on the machine {host}"));
        return Ok(());
    };
    Err(Failure::input(format!(
        "{file} was written {} ago on the machine {host}, where its run may still go on; if not, give --force",
        number::duration(age.as_secs_f64().floor())
    )))
}
