//! Seeds with which every point of a study is run.

use std::collections::HashSet;

use super::Replicates;
use super::document;
use super::place::Place;
use crate::brief::MOST_PROBLEMS;
use crate::scene::{Problem, schema};
use crate::text::short;

/// What `[replicates]` says; of a study without a scene, numbers of measurements without keys.
pub(super) fn of(
    given: &document::Replicates,
    has_scene: bool,
    place: &Place<'_>,
    problems: &mut Vec<Problem>,
) -> Replicates {
    let keys = given.keys.as_ref().map_or(&[][..], |keys| keys.get_ref());
    for key in keys {
        if !is_seed(key.get_ref()) {
            let message = format!(
                "\"{}\" is not a seed; expected keys such as disc.surface.synthetic.seed, or disc.prepare.extend_seed of a \
                     measured patch",
                short(key.get_ref())
            );
            problems.push(place.problem(key, "replicates.keys", message));
        }
    }
    let seeds: Vec<i64> = given.seeds.get_ref().iter().map(|seed| *seed.get_ref()).collect();
    if seeds.is_empty() || has_scene && keys.is_empty() {
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
    Replicates { keys: keys.iter().map(|key| key.get_ref().clone()).collect(), seeds }
}

/// Whether a key of a scene is a seed of random heights or bases.
fn is_seed(key: &str) -> bool {
    (key.ends_with(".seed") || key.ends_with(".extend_seed")) && schema::find(key).is_some()
}

#[cfg(test)]
mod tests {
    use super::is_seed;

    #[test]
    fn seeds_of_synthetic_and_of_extended_surfaces_are_seeds() {
        assert!(
            ["disc.surface.synthetic.seed", "disc.prepare.extend_seed", "pin.prepare.extend_seed"]
                .iter()
                .all(|key| is_seed(key))
        );
        assert!(!["mesh.rows", "disc.seed", "disc.prepare.extend"].iter().any(|key| is_seed(key)));
    }
}
