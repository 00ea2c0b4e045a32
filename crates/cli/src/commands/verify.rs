//! `plateau verify`: whether run files still hold what was written.

use std::path::Path;

use plateau_io::number;
use plateau_io::run_file::{self, Damage, ReadError, State, Verification};
use serde::Serialize;

use crate::arguments::VerifyArguments;
use crate::failure::Failure;
use crate::message;
use crate::output::{print, print_json, table};

/// Looks at all files before it fails because of one.
pub fn verify(arguments: &VerifyArguments) -> Result<(), Failure> {
    let mut findings = Vec::new();
    let mut foreign = 0;
    for path in &arguments.runs {
        match run_file::verify(path) {
            Ok(verification) => findings.push(Finding::of(path, verification)),
            // All that can be said of it.
            Err(error @ ReadError::Damaged { .. }) => findings.push(Finding::unreadable(path, &error)),
            // Nothing of the file's: the next one would fare no better.
            Err(error @ ReadError::Handles { .. }) => return Err(Failure::run(error)),
            Err(error) => {
                message::error(&error);
                foreign += 1;
            }
        }
    }
    if arguments.json {
        print_json(&findings)?;
    } else {
        print(&findings.iter().map(Finding::to_text).collect::<Vec<_>>().join("\n"))?;
    }
    let bad = findings.iter().filter(|finding| finding.verdict != Verdict::Intact).count();
    let files = number::count(arguments.runs.len(), "file");
    match (foreign, bad) {
        (0, 0) => Ok(()),
        (0, bad) => Err(Failure::run(format_args!("not intact: {bad} of {files}"))),
        (foreign, _) => Err(Failure::input(format!("cannot be verified: {foreign} of {files}"))),
    }
}

/// State of a file in a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
enum Verdict {
    /// All of it is what was written.
    Intact,
    /// All of it can be read, but it has no digests yet.
    NotClosed,
    /// All of it can be read, but the program that wrote it knew no digests.
    NoDigests,
    /// Some of it is not what was written.
    Damaged,
}

/// Report on a file.
#[derive(Debug, Serialize)]
struct Finding {
    file: String,
    verdict: Verdict,
    state: Option<&'static str>,
    samples: Option<usize>,
    moments: Option<usize>,
    digests: usize,
    /// Tells whether there are digests of the numbers among the attributes, and of what tells of machine and time.
    covers_numbers: bool,
    damage: Vec<Damage>,
}

impl Finding {
    fn of(path: &Path, verification: Verification) -> Self {
        let Verification { state, samples, moments, intact: digests, digested, covers_numbers, damage } = verification;
        let verdict = match (damage.len(), digested, state) {
            (0, true, _) => Verdict::Intact,
            (0, false, State::Running) => Verdict::NotClosed,
            (0, false, _) => Verdict::NoDigests,
            _ => Verdict::Damaged,
        };
        let (file, state) = (path.display().to_string(), Some(state.name()));
        Self { file, verdict, state, samples: Some(samples), moments: Some(moments), digests, covers_numbers, damage }
    }

    fn unreadable(path: &Path, error: &ReadError) -> Self {
        let damage = vec![Damage { place: "file".into(), problem: error.to_string() }];
        let (file, verdict, covers_numbers) = (path.display().to_string(), Verdict::Damaged, false);
        Self { file, verdict, state: None, samples: None, moments: None, digests: 0, covers_numbers, damage }
    }

    fn to_text(&self) -> String {
        let verdict = match self.verdict {
            Verdict::Intact => "intact".to_owned(),
            Verdict::NotClosed => {
                format!("not closed: the run goes on, or it was killed (then: plateau repair {})", self.file)
            }
            Verdict::NoDigests => {
                "all of it can be read, but it has no digests: an earlier program wrote it".to_owned()
            }
            Verdict::Damaged => format!("damaged in {}", number::count(self.damage.len(), "place")),
        };
        let mut rows = vec![("verdict", verdict)];
        if let (Some(state), Some(samples), Some(moments)) = (self.state, self.samples, self.moments) {
            rows.push(("state", state.to_owned()));
            rows.push(("holds", format!("samples: {}, moments with maps: {moments}", number::grouped(samples as u64))));
            rows.push(("digests that hold", self.digests.to_string()));
        }
        if self.verdict == Verdict::Intact && !self.covers_numbers {
            let what = "numbers among the attributes, host and times: an earlier program wrote it";
            rows.push(("without a digest", what.to_owned()));
        }
        rows.extend(self.damage.iter().map(|damage| ("damaged", format!("{}: {}", damage.place, damage.problem))));
        table(&self.file, &rows)
    }
}
