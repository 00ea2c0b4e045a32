//! Making and looking up the runs of a study.
//!
//! | what | where |
//! |---|---|
//! | the scenes of runs, resolved | [`resolved`] |
//! | what runs of before did not keep | [`unkept`] |
//! | why results are left out | [`left_out`] |
//! | what these scenes can hardly mean | [`scene_warnings`] |
//! | how long runs are | [`run_length`] |
//! | what `mean = "last tenth"` is a mean over | [`short_tenth`] |
//! | what they will cost | [`estimate`] |
//! | one run, from its scene to its record | [`make`] |
//! | its surfaces, given up when a signal comes | [`surfaces`] |
//! | who looks on, and how it may end before its end | [`watcher`] |
//! | all of them, several at a time | [`plateau_run::Job::share`] |
//! | what those that are made at a time share | [`floor`] |
//! | those that are under way: one process makes each, and keeps what lets it go on | [`under_way`] |
//! | how far they are | [`progress`] |

pub mod estimate;
pub mod floor;
pub mod left_out;
pub mod make;
pub mod progress;
pub mod resolved;
pub mod run_length;
pub mod scene_warnings;
pub mod short_tenth;
pub mod surfaces;
pub mod under_way;
pub mod unkept;
pub mod watcher;

use std::fs;
use std::path::{Path, PathBuf};

use plateau_io::regular;
use plateau_io::study::Study;
use plateau_io::study::journal::Journal;
use plateau_io::study::plan::Plan;
use plateau_io::temporary::Temporary;

use crate::failure::Failure;
use crate::machine;

/// Reads a study and makes its design.
///
/// # Errors
/// [`Failure::Input`] with everything that is wrong.
pub fn plan(path: &Path) -> Result<Plan, Failure> {
    Study::load(path).and_then(Plan::new).map_err(Failure::of_study)
}

/// Refuses a study that has no scene to run.
///
/// # Errors
/// [`Failure::Input`].
fn refuse_without_scene(plan: &Plan) -> Result<(), Failure> {
    let path = plan.study().path.display();
    match &plan.study().base {
        Some(base) => regular::open(base).map(drop).map_err(|error| {
            let problem = format!("{}: cannot read the scene: {error}", base.display());
            Failure::because(&error, format_args!("{}: base: {problem}", plan.study().base_place))
        }),
        None => Err(Failure::input(format!(
            "{path}: no base scene, so there is nothing to run; `plateau sweep import` takes in its responses"
        ))),
    }
}

/// Folder of the study's journal.
pub fn journal_folder(study: &Study) -> PathBuf {
    study.directory.join("journal")
}

/// Refuses a study whose results could not be kept, before a run is made. Makes the folder of the journal.
///
/// # Errors
/// [`Failure::Input`].
pub fn refuse_unwritable(study: &Study) -> Result<(), Failure> {
    let folder = journal_folder(study);
    let probed = fs::create_dir_all(&folder).and_then(|()| Temporary::create(&folder.join("probe")));
    probed.map(drop).map_err(|error| {
        let (folder, study) = (folder.display(), study.path.display());
        let advice = format_args!("make it writable, or name another folder with `directory` in {study}");
        Failure::because(&error, format_args!("cannot write to {folder}: {error}; {advice}"))
    })
}

/// The journal of a study, after many small files of it were made few.
///
/// # Errors
/// [`Failure::Run`].
pub fn journal(study: &Study) -> Result<Journal, Failure> {
    let folder = journal_folder(study);
    let failed = |error| Failure::run(format_args!("{}: {error}", folder.display()));
    // A folder that must not be changed can still be read.
    let _ = plateau_io::study::journal::merge(&folder, &machine::host());
    Journal::read(&folder).map_err(failed)
}
