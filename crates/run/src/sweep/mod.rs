//! Runs of a study, as a library: [`load`] reads it, [`Sweep::prepare`] decides which of its runs are to be made, [`Sweep::run`] makes
//! them and keeps their results in its journal.
//!
//! ```no_run
//! use plateau_run::Job;
//! use plateau_run::sweep::{self, Sweep, SweepOptions};
//!
//! let plan = sweep::load("study.toml".as_ref(), None)?;
//! let mut job = Job::start()?;
//! // `()` observes nothing.
//! let summary = Sweep::prepare(&plan, SweepOptions::default(), &job, &())?.run(&mut job, &())?;
//! println!("{} runs finished, {} failed", summary.finished, summary.failed);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | file | content |
//! |---|---|
//! | `warnings.rs` | who follows the runs; warnings of several runs, each kind once |
//! | `resolved.rs` | scenes of the runs, built before any run is made, their length and cost |
//! | `earlier.rs` | the journal: results of before, those that are left out, series that were not kept |
//! | `under_way.rs` | runs that are under way: one process makes each, and keeps the state from which it continues |
//! | `shared_surfaces.rs` | surfaces that several runs have in common |
//! | `make.rs` | one run, from its scene to its record |
//! | `kept_file.rs` | the run file of a run, where the study keeps those |
//! | `runner.rs` | which runs are to be made, and several at a time |

mod earlier;
mod kept_file;
mod make;
mod resolved;
mod runner;
mod shared_surfaces;
mod under_way;
mod warnings;

pub use crate::options::{Part, SweepOptions};
pub use earlier::{journal, say_left_out, say_unkept};
pub use resolved::{Estimate, Resolved, ResolvedRun, RunLength, note_short_tenths, run_in_words, scene_of_run};
pub use runner::{Sweep, SweepSummary, load};
pub use warnings::{SceneWarnings, SweepObserver, of_questions};
