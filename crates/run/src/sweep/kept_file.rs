//! Run files that a study keeps on request: where they are, how large, and the writer of one, which goes on with the state of its run.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use plateau_core::observe::Snapshot;
use plateau_io::claim::{Claim, ClaimError};
use plateau_io::number;
use plateau_io::run_file::{Earlier, End, Header, RunFile, RunFileError, RunWriter, State};
use plateau_io::study::Study;
use plateau_io::temporary::Temporary;

use super::resolved::{RUN_FILES, Resolved};
use super::under_way::{Ended, FileState, SavedState, UnderWay};
use crate::assembly::Assembly;
use crate::sweep::warnings::SweepObserver;

/// Tells whether there is a run file to whose end its run has come.
pub fn is_finished(path: &Path) -> bool {
    RunFile::open(path).is_ok_and(|file| file.state() == State::Finished)
}

/// The run files that are there and have the name of none of these runs.
fn strange(study: &Study, resolved: &Resolved) -> Vec<PathBuf> {
    let own: HashSet<&Path> = resolved.runs.values().map(|run| run.file.as_path()).collect();
    let there = fs::read_dir(study.directory.join(RUN_FILES)).into_iter().flatten().flatten();
    let is_run_file = |name: &str| name.starts_with("run-") && name.ends_with(".h5");
    let run_files = there.filter(|entry| entry.file_name().to_str().is_some_and(is_run_file)).map(|entry| entry.path());
    run_files.filter(|path| !own.contains(&**path)).collect()
}

/// The end of the name of a run file, which tells what it is of; before it stands the number of the run.
fn ending(path: &Path) -> Option<&str> {
    Some(path.file_name()?.to_str()?.rsplit_once('-')?.1)
}

/// Gives the files of runs that have another number than before, as where a factor has more levels, their new names.
pub fn renumber(study: &Study, resolved: &Resolved) {
    let strange = strange(study, resolved);
    let strange: HashMap<_, _> = strange.iter().filter_map(|path| Some((ending(path)?, path))).collect();
    for (number, run) in &resolved.runs {
        let before = ending(&run.file).and_then(|ending| strange.get(ending));
        let Some(before) = before.filter(|_| !resolved.is_repeat(*number) && !run.file.exists()) else { continue };
        if is_finished(before) {
            // One that keeps its name is made again.
            let _ = fs::rename(before, &run.file);
        }
    }
}

/// Says how many run files are of no run of the study.
pub fn say_strange(study: &Study, resolved: &Resolved, observer: &dyn SweepObserver) {
    let strange = strange(study, resolved).len();
    if strange > 0 {
        observer.note(&format_args!(
            "{}: {} of runs that the study no longer has, with other maps, or of another generation of the program; nothing needs them",
            study.directory.join(RUN_FILES).display(),
            number::count(strange, "run file")
        ));
    }
}

/// The run file of a run that is being made.
#[derive(Debug)]
pub struct KeptFile {
    /// Writer that takes samples.
    pub writer: RunWriter,
    snapshots: usize,
    /// Wall time before this process, s, and since when it counts.
    earlier: f64,
    start: Instant,
    /// Claim by which others see that the file is being written.
    _claim: Claim,
}

impl KeptFile {
    /// Goes on with the run file of a state, or begins it anew where there is no state or the file has not what it says; the state is
    /// none then.
    pub fn open(
        path: &Path,
        header: &Header,
        state: &mut Option<SavedState>,
        under_way: &mut UnderWay<'_>,
    ) -> Result<Self, Ended> {
        let folder = path.parent().unwrap_or(path);
        fs::create_dir_all(folder)
            .map_err(|error| Ended::Unkept(format!("cannot write to {}: {error}", folder.display())))?;
        let claim = claim(path).map_err(|error| Ended::Unkept(error.to_string()))?;
        Temporary::remove_abandoned(path);
        let start = Instant::now();
        if let Some((writer, file)) = state.as_mut().and_then(|state| resumed(path, header, state, under_way)) {
            return Ok(Self { writer, snapshots: file.snapshots, earlier: file.wall_time, start, _claim: claim });
        }
        *state = None;
        let writer = RunWriter::create(path, true, header)?;
        Ok(Self { writer, snapshots: 0, earlier: 0.0, start, _claim: claim })
    }

    /// Takes maps.
    pub fn snapshot(&mut self, snapshot: Snapshot) -> Result<(), RunFileError> {
        self.snapshots += 1;
        self.writer.snapshot(snapshot)
    }

    /// Returns the state of the file, as soon as what it has is on the disk.
    pub fn state(&mut self) -> Result<FileState, RunFileError> {
        let images = self.writer.sync().wait();
        // Without an answer it is not complete, and says why.
        let images = images.map_or_else(|| self.writer.check().map(|()| Vec::new()), Ok)?;
        let wall_time = self.earlier + self.start.elapsed().as_secs_f64();
        Ok(FileState { snapshots: self.snapshots, wall_time, images })
    }

    /// Closes it after its run has ended like this.
    pub fn close(self, result: &Result<(), Ended>, assembly: &Assembly) -> Result<(), Ended> {
        let end = match result {
            Ok(()) => End::Finished,
            Err(Ended::Stopped) => End::Interrupted,
            Err(Ended::Failed(error) | Ended::Unkept(error)) => End::Failed(error.clone()),
        };
        self.writer.finish(&end, assembly.events(), assembly.chosen_acceleration())?;
        Ok(())
    }
}

/// The claim of a run file. Who makes the run has the lock of its state: a lock of the file by another machine is one that was left.
fn claim(path: &Path) -> Result<Claim, ClaimError> {
    match (Claim::of(path), Claim::seen(path)) {
        (Err(ClaimError::Elsewhere(_)), Some(seen)) => Claim::of_silent(path, &seen),
        (claim, _) => claim,
    }
}

/// The writer that goes on with the file of a state, if that has what the state says, and what it has.
fn resumed(
    path: &Path,
    header: &Header,
    state: &mut SavedState,
    under_way: &mut UnderWay<'_>,
) -> Option<(RunWriter, FileState)> {
    let mut file = state.file.take()?;
    file.images.retain(|image| image.is_of(path));
    let earlier = Earlier {
        samples: state.columns.first().map_or(0, Vec::len),
        snapshots: file.snapshots,
        wall_time: Duration::try_from_secs_f64(file.wall_time).unwrap_or_default(),
    };
    // The file is made anew. A loss of power may leave either, so the state has to know both.
    let keep = |image| {
        let images = file.images.iter().cloned().chain([image]).collect();
        state.file = Some(FileState { images, ..file.clone() });
        under_way.keep(state);
    };
    let writer = RunWriter::resume(path, header, earlier, &file.images, keep).ok()?;
    Some((writer, file))
}
