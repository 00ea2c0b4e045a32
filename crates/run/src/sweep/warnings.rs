//! Warnings of several runs: values of their scenes that can hardly be meant, and questions that they do not answer, each kind said
//! once, with how many runs it concerns; and who follows the runs of a study.

use std::fmt;

use plateau_io::plausibility;
use plateau_io::scene::{Scene, Warning};
use plateau_io::study::Study;
use plateau_io::study::response::NoAnswer;
use plateau_io::surface::Loaded;

use crate::options::Observer;

/// Follows the runs of a study and may stop them; called from several threads at a time. `()` observes nothing. After a signal a run
/// leaves its state, from which the next sweep continues it.
pub trait SweepObserver: Observer + Sync {
    /// Told that so many steps of all runs together were taken since the last time.
    fn steps(&self, _count: u64) {}

    /// Told that a run ended.
    fn run_ended(&self, _failed: bool) {}

    /// Advice, in messages, on how runs of a study are made again.
    fn retry_advice(&self, _study: &Study) -> String {
        "`retry` makes them again".to_owned()
    }
}

impl SweepObserver for () {}

/// Kinds of warnings that are said.
const SHOWN: usize = 10;

/// A kind of warning: what it says but for its numbers, as it was said first, and of how many runs.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Kind {
    kind: String,
    first: String,
    /// Least and largest of each of its numbers; none where texts differ in more than numbers.
    ranges: Option<Vec<[String; 2]>>,
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

/// Warnings of a scene by itself. To look takes no time.
pub fn of_scene(scene: &Scene) -> Vec<Found> {
    scene.warnings.iter().cloned().chain(plausibility::of_scene(scene)).map(of_key).collect()
}

/// Warnings that its surfaces add.
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

/// A word as what is before its number, the number, and what is behind it; none where it has none.
fn around_number(word: &str) -> Option<[&str; 3]> {
    let is_digit = |each: char| each.is_ascii_digit();
    let (start, end) = (word.find(is_digit)?, word.rfind(is_digit)? + 1);
    let start = if word[..start].ends_with(['-', '+']) { start - 1 } else { start };
    let number = &word[start..end];
    number.parse::<f64>().ok().map(|_| [&word[..start], number, &word[end..]])
}

fn numbers_of(text: &str) -> impl Iterator<Item = String> + '_ {
    text.split(' ').filter_map(around_number).map(|[_, number, _]| number.to_owned())
}

/// A text with its numbers replaced.
fn with_numbers<'a>(text: &str, mut numbers: impl Iterator<Item = String> + 'a) -> String {
    let replaced = |word: &str| match around_number(word) {
        Some([before, _, behind]) => format!("{before}{}{behind}", numbers.next().unwrap_or_default()),
        None => word.to_owned(),
    };
    text.split(' ').map(replaced).collect::<Vec<_>>().join(" ")
}

impl Kind {
    /// Widens the ranges by the numbers of another text.
    fn take_in(&mut self, text: &str) {
        let bare = |text: &str| with_numbers(text, std::iter::repeat("#".to_owned()));
        if bare(text) != bare(&self.first) {
            self.ranges = None;
        }
        let value = |number: &str| number.parse::<f64>().unwrap_or(f64::NAN);
        for ([least, largest], number) in self.ranges.iter_mut().flatten().zip(numbers_of(text)) {
            if value(&number) < value(least) {
                *least = number;
            } else if value(&number) > value(largest) {
                *largest = number;
            }
        }
    }

    /// Text of all its runs.
    fn text(&self) -> String {
        let range = |[least, largest]: &[String; 2]| {
            if least == largest { least.clone() } else { format!("{least} … {largest}") }
        };
        match &self.ranges {
            Some(ranges) => with_numbers(&self.first, ranges.iter().map(range)),
            None => format!("{}; this is the first of them, others differ in numbers", self.first),
        }
    }
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
                Some(known) => {
                    known.runs += 1;
                    known.take_in(&text);
                }
                None => {
                    let ranges = Some(numbers_of(&text).map(|number| [number.clone(), number]).collect());
                    self.kinds.push(Kind { kind: kind.clone(), first: text, ranges, runs: 1 });
                }
            }
            counted.push(kind);
        }
    }

    /// Says each kind once; `what` are the runs that were looked at.
    pub fn say(&self, what: impl fmt::Display, observer: &dyn SweepObserver) {
        self.lines(what).iter().for_each(|line| observer.warning(line));
    }

    fn lines(&self, what: impl fmt::Display) -> Vec<String> {
        let of = |runs: usize| {
            if self.looked_at == 1 { String::new() } else { format!(" (so in {runs} of {} {what})", self.looked_at) }
        };
        let shown = self.kinds.iter().take(SHOWN);
        let mut lines: Vec<String> = shown.map(|kind| format!("{}{}", kind.text(), of(kind.runs))).collect();
        if self.kinds.len() > SHOWN {
            lines.push(format!("{} more kinds of warnings of {what}", self.kinds.len() - SHOWN));
        }
        lines
    }
}

#[cfg(test)]
#[path = "../../tests/unit/sweep/warnings.rs"]
mod tests;
