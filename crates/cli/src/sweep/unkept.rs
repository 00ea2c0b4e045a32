//! Series that a response asks for and that runs of before did not keep: `series` in the study had left them out, or the response is new.

use std::collections::{BTreeMap, BTreeSet};

use plateau_io::brief;
use plateau_io::study::Study;
use plateau_io::study::journal::{Entry, Journal};
use plateau_io::study::record::EVENT;

use super::resolved::Resolved;
use crate::{called, message, number};

/// Whether a run finished and kept what is needed.
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
pub fn say(study: &Study, resolved: &Resolved, journal: &Journal, are_made_again: bool) {
    for (lacks, runs) in unkept(resolved, journal) {
        let dataset =
            |series: &&str| if series.starts_with(EVENT) { format!("/{series}") } else { format!("/series/{series}") };
        let lacks = brief::list(lacks.iter().map(dataset), ", ");
        let (file, count) = (study.path.display(), number::count(runs.len(), "run"));
        let list = brief::list(runs.iter().map(ToString::to_string), ", ");
        if are_made_again {
            message::note(format_args!("{file}: {count} that did not keep {lacks} are made again: {list}"));
        } else {
            let again =
                format!("{} sweep run {} --retry", called::program(), called::argument(&study.path.to_string_lossy()));
            message::warning(format_args!(
                "{file}: {lacks} was not kept by {count}, so that responses to it have no value there, or one of samples only: {list}; \
                 `{again}` makes them again"
            ));
        }
    }
}
