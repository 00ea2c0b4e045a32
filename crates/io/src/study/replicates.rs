//! Seeds with which every point of a study is run.

use std::collections::HashSet;

use super::Replicates;
use super::document;
use super::place::{MOST_PROBLEMS, Place};
use crate::scene::{Problem, schema};

/// What `[replicates]` says.
pub(super) fn of(given: &document::Replicates, place: &Place<'_>, problems: &mut Vec<Problem>) -> Replicates {
    for key in given.keys.get_ref() {
        if !(key.get_ref().ends_with(".seed") && schema::find(key.get_ref()).is_some()) {
            let message =
                format!("\"{}\" is no seed; expected keys such as disc.surface.synthetic.seed", key.get_ref());
            problems.push(place.problem(key, "replicates.keys", message));
        }
    }
    let seeds: Vec<i64> = given.seeds.get_ref().iter().map(|seed| *seed.get_ref()).collect();
    if seeds.is_empty() || given.keys.get_ref().is_empty() {
        problems.push(place.problem(&given.seeds, "replicates", "expected at least one key and one seed"));
    }
    let mut known = HashSet::new();
    for seed in given.seeds.get_ref() {
        let message = match known.insert(*seed.get_ref()) {
            _ if problems.len() >= MOST_PROBLEMS => break,
            false => "is there twice: equal seeds give equal runs",
            true if *seed.get_ref() < 0 => "is negative, expected a seed of at least 0",
            true => continue,
        };
        problems.push(place.problem(seed, "replicates.seeds", format!("{} {message}", seed.get_ref())));
    }
    Replicates { keys: given.keys.get_ref().iter().map(|key| key.get_ref().clone()).collect(), seeds }
}
