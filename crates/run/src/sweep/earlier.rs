//! Results of runs that were made before: the journal of a study, results that are those of none of its runs, and series that runs did
//! not keep.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::fs;
use std::path::PathBuf;

use plateau_io::generation::{self, GENERATIONS};
use plateau_io::study::Study;
use plateau_io::study::journal::{Entry, Journal, merge};
use plateau_io::study::record::{Identity, dataset_of};
use plateau_io::temporary::Temporary;
use plateau_io::{number, text};

use super::resolved::Resolved;
use crate::error::Failure;
use crate::execution;
use crate::sweep::warnings::SweepObserver;

/// Folder of the study's journal.
pub fn journal_folder(study: &Study) -> PathBuf {
    study.directory.join("journal")
}

/// Refuses a study whose results could not be kept, before a run is made. Makes the folder of the journal.
pub(super) fn refuse_unwritable(study: &Study) -> Result<(), Failure> {
    let folder = journal_folder(study);
    let probed = fs::create_dir_all(&folder).and_then(|()| Temporary::create(&folder.join("probe")));
    probed.map(drop).map_err(|error| {
        let (folder, study) = (folder.display(), study.path.display());
        let advice = format_args!("make it writable, or name another folder with `directory` in {study}");
        Failure::because(&error, format_args!("cannot write to {folder}: {error}; {advice}"))
    })
}

/// The journal of a study, after many small files of it were made few.
pub fn journal(study: &Study) -> Result<Journal, Failure> {
    let folder = journal_folder(study);
    let failed = |error| Failure::run(format!("{}: {error}", folder.display()));
    // A folder that must not be changed can still be read.
    let _ = merge(&folder, &execution::host());
    Journal::read(&folder).map_err(failed)
}

/// Says which results are left out because the study, its files or the numbers of the program are not what they were; gives the
/// reasons.
pub fn say_left_out(
    study: &Study,
    resolved: &Resolved,
    journal: &Journal,
    observer: &dyn SweepObserver,
) -> Vec<String> {
    let (reasons, folder) = (reasons(resolved, journal), journal_folder(study));
    reasons.iter().for_each(|reason| observer.note(&format_args!("{}: {reason}", folder.display())));
    reasons
}

/// Each reason with how many results it leaves out.
fn reasons(resolved: &Resolved, journal: &Journal) -> Vec<String> {
    let known: HashSet<&str> = resolved.runs.values().map(|run| run.identity.as_str()).collect();
    let scenes: HashMap<&str, &Identity> = resolved.runs.values().map(|run| (run.of.scene.as_str(), &run.of)).collect();
    let mut reasons: BTreeMap<String, usize> = BTreeMap::new();
    for (_, entry) in journal.entries().filter(|(identity, _)| !known.contains(identity)) {
        *reasons.entry(reason(entry, &scenes)).or_default() += 1;
    }
    let line = |(reason, count): (String, usize)| {
        let are = if count == 1 { "is" } else { "are" };
        format!("{} {are} left out: {reason}", number::count(count, "result"))
    };
    reasons.into_iter().map(line).collect()
}

/// Reason why a result is not that of a run of the study; `scenes` are those of its runs.
fn reason(entry: &Entry, scenes: &HashMap<&str, &Identity>) -> String {
    let Identity { generation, scene, files } = &entry.of;
    if *generation == 0 {
        return "made by a version of the program that did not count generations of its numbers, so that nobody can tell whether this one computes \
                the same; `plateau sweep run` makes them again"
            .to_owned();
    }
    if *generation != generation::current() {
        // Of a later one this program does not know why.
        let since = GENERATIONS.get(*generation as usize..).unwrap_or_default();
        let since = text::list(since.iter().map(|generation| generation.reason), "; ");
        let since = if since.is_empty() { "that of a later version".to_owned() } else { since };
        return format!(
            "of generation {generation} of the program's numbers, this is {}: {since}",
            generation::current()
        );
    }
    let Some(now) = scenes.get(scene.as_str()) else {
        return "of scenes that no run of the study has now: its levels or points, `set`, the base scene or what that extends were others, or \
                fit, optimize or --confirm added them"
            .to_owned();
    };
    let changed = now.files.iter().filter(|(key, digest)| files.get(*key) != Some(digest)).map(|(key, _)| key.as_str());
    format!("the file of {} had another content", text::list(changed, " and that of "))
}

/// Tells whether a run finished and kept what is needed.
pub fn is_whole(entry: &Entry, needed: &BTreeSet<String>) -> bool {
    entry.failure.is_none() && needed.is_subset(&entry.kept)
}

/// By what they lack, the numbers of the runs that finished and lack something.
fn unkept<'a>(resolved: &'a Resolved, journal: &'a Journal) -> BTreeMap<Vec<&'a str>, Vec<usize>> {
    let mut unkept: BTreeMap<_, Vec<usize>> = BTreeMap::new();
    for (number, run) in &resolved.runs {
        let Some(entry) = journal.get(&run.identity).filter(|entry| entry.failure.is_none()) else { continue };
        let lacks: Vec<&str> = run.needed.difference(&entry.kept).map(String::as_str).collect();
        if !lacks.is_empty() {
            unkept.entry(lacks).or_default().push(*number);
        }
    }
    unkept
}

/// Says which runs lack what, and how to make them again; or that they are made again now.
pub fn say_unkept(
    study: &Study,
    resolved: &Resolved,
    journal: &Journal,
    are_made_again: bool,
    observer: &dyn SweepObserver,
) {
    for (lacks, runs) in unkept(resolved, journal) {
        let lacks = text::list(lacks.into_iter().map(dataset_of), ", ");
        let (file, count) = (study.path.display(), number::count(runs.len(), "run"));
        let list = text::list(runs.iter().map(ToString::to_string), ", ");
        if are_made_again {
            observer.note(&format_args!("{file}: {count} that did not keep {lacks} are made again: {list}"));
        } else {
            let again = observer.retry_advice(study);
            observer.warning(&format_args!(
                "{file}: {lacks} was not kept by {count}, so that responses to it have no value there, or one of samples only: {list}; \
                 {again}"
            ));
        }
    }
}
