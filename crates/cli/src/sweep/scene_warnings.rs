//! What the scenes of a study can hardly mean, and which questions its runs do not answer: each kind of warning once, with how many
//! runs it concerns.

use std::fmt;

use plateau_io::plausibility;
use plateau_io::scene::{Scene, Warning};
use plateau_io::study::Study;
use plateau_io::study::response::NoAnswer;
use plateau_io::surface::Loaded;

use crate::message;

/// Kinds of warnings that are said.
const SHOWN: usize = 10;

/// A kind of warning: what it says but for its numbers, as it was said first, and of how many runs.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Kind {
    kind: String,
    first: String,
    runs: usize,
}

/// Kinds of warnings of several runs.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SceneWarnings {
    kinds: Vec<Kind>,
    /// Runs that were looked at.
    looked_at: usize,
}

/// A warning with what tells its kind.
pub type Found = (String, String);

/// What a scene says by itself. To look takes no time.
pub fn of_scene(scene: &Scene) -> Vec<Found> {
    scene.warnings.iter().cloned().chain(plausibility::of_scene(scene)).map(of_key).collect()
}

/// What its surfaces add.
pub fn of_surfaces(scene: &Scene, loaded: &Loaded) -> Vec<Found> {
    let own = plausibility::of_surfaces(scene, loaded).into_iter().map(of_key);
    let of_report = loaded.warnings().map(|line| (without_numbers(&line), line));
    own.chain(of_report).collect()
}

/// Questions that a finished run gives no answer to, with the reason; `unanswered` has their places. Of series that were not kept
/// others speak.
pub fn of_questions<'a>(study: &Study, unanswered: impl IntoIterator<Item = &'a (usize, NoAnswer)>) -> Vec<Found> {
    let told = |(place, reason): &(usize, NoAnswer)| {
        let name = &study.responses[*place].name;
        (
            format!("{name} {}", without_numbers(&reason.to_string())),
            format!("response \"{name}\" has no value: {reason}"),
        )
    };
    let is_told = |(_, reason): &&(usize, NoAnswer)| !matches!(reason, NoAnswer::Elsewhere | NoAnswer::NotKept);
    unanswered.into_iter().filter(is_told).map(told).collect()
}

fn of_key(warning: Warning) -> Found {
    (format!("{}: {}", warning.key, without_numbers(&warning.found)), warning.to_string())
}

/// A text without its numbers and their units, which differ from run to run.
fn without_numbers(text: &str) -> String {
    let mut before_is_number = false;
    let keeps = |word: &&str| {
        let is_number = word.contains(|each: char| each.is_ascii_digit());
        let is_unit = before_is_number && word.trim_end_matches([',', ';', ':', '.']).len() <= 3;
        before_is_number = is_number;
        !is_number && !is_unit
    };
    text.split_whitespace().filter(keeps).collect::<Vec<_>>().join(" ")
}

impl SceneWarnings {
    /// Takes in the warnings of one more run.
    pub fn add(&mut self, found: Vec<Found>) {
        self.looked_at += 1;
        let mut counted = Vec::new();
        for (kind, text) in found {
            if counted.contains(&kind) {
                continue;
            }
            match self.kinds.iter_mut().find(|known| known.kind == kind) {
                Some(known) => known.runs += 1,
                None => self.kinds.push(Kind { kind: kind.clone(), first: text, runs: 1 }),
            }
            counted.push(kind);
        }
    }

    /// Says each kind once; `what` are the runs that were looked at.
    pub fn say(&self, what: impl fmt::Display) {
        self.lines(what).iter().for_each(message::warning);
    }

    fn lines(&self, what: impl fmt::Display) -> Vec<String> {
        let of =
            |runs: usize| if self.looked_at == 1 { String::new() } else { format!("{runs} of {} ", self.looked_at) };
        let shown = self.kinds.iter().take(SHOWN);
        let mut lines: Vec<String> =
            shown.map(|Kind { first, runs, .. }| format!("{first} (so in {}{what})", of(*runs))).collect();
        if self.kinds.len() > SHOWN {
            lines.push(format!("{} more kinds of warnings of {what}", self.kinds.len() - SHOWN));
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str) -> Found {
        (without_numbers(text), text.to_owned())
    }

    #[test]
    fn a_kind_is_said_once_with_its_runs() {
        let mut warnings = SceneWarnings::default();
        warnings.add(vec![found("disc.prepare: the patch is only 8.7 times its correlation length of 1.2 mm")]);
        warnings.add(Vec::new());
        warnings.add(vec![found("disc.prepare: the patch is only 9.1 times its correlation length of 950 um")]);
        let lines = warnings.lines("runs");
        assert_eq!(
            lines,
            ["disc.prepare: the patch is only 8.7 times its correlation length of 1.2 mm (so in 2 of 3 runs)"]
        );
    }

    #[test]
    fn of_many_kinds_some_are_said() {
        let mut warnings = SceneWarnings::default();
        warnings.add((b'a'..b'p').map(|letter| found(&String::from(letter as char))).collect());
        let lines = warnings.lines("the run");
        assert_eq!((lines.len(), lines[10].as_str()), (11, "5 more kinds of warnings of the run"));
    }
}
