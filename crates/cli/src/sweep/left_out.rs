//! Results in the journal of a study that are those of none of its runs, and why.

use std::collections::{BTreeMap, HashMap, HashSet};

use plateau_io::brief;
use plateau_io::generation::{self, GENERATIONS};
use plateau_io::study::Study;
use plateau_io::study::identity::Identity;
use plateau_io::study::journal::{Entry, Journal};

use super::journal_folder;
use super::resolved::Resolved;
use crate::{message, number};

/// Says which results are left out because the study, its files or the numbers of the program are not what they were; gives the
/// reasons.
pub fn say(study: &Study, resolved: &Resolved, journal: &Journal) -> Vec<String> {
    let (reasons, folder) = (reasons(resolved, journal), journal_folder(study));
    reasons.iter().for_each(|reason| message::note(format_args!("{}: {reason}", folder.display())));
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

/// Why a result is not that of a run of the study; `scenes` are those of its runs.
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
        let since = brief::list(since.iter().map(|generation| generation.reason), "; ");
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
    format!("the file of {} had another content", brief::list(changed, " and that of "))
}
