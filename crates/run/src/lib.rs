//! A run of Plateau as a library: scene, surfaces, simulation, samples, run file. It prints nothing: what there is to say goes
//! to an [`Observer`], and what went wrong is a [`RunError`], which tells a wrong input from a failed run.
//!
//! ```no_run
//! use plateau_run::{Job, RunOptions, run};
//!
//! let scene = plateau_io::scene::load("data/scenes/quick.toml".as_ref(), &[])?;
//! // `()` observes nothing.
//! let summary = run(scene, &RunOptions::default(), &mut Job::start()?, &mut ())?;
//! if let Some(summary) = summary {
//!     println!("{} of the pin touches", summary.contact_ratio);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | what | where |
//! |---|---|
//! | a run from its scene to its file, and what came of it | [`run()`], [`RunSummary`] |
//! | what is asked of it, who follows it, how it fails | [`RunOptions`], [`Observer`], [`RunError`] |
//! | simulation, scout and schedule of a scene, put together once for all who run one | [`Assembly`] |
//! | the time loop, and what takes its samples and maps | [`Assembly::run_to_end`], [`Sink`] |
//! | how many workers, which instruction set | [`execution`] |
//! | start or continuation, from which checkpoint, and writing those | `start`, `resume`, `checkpointer` |
//! | what was done before the first checkpoint, kept when a run begins anew | `kept` |
//! | how exact a scene's runs are for their time | [`accuracy`] |
//! | the processes that take the steps together | [`job`] |
//! | what the system tells of this machine | [`machine`] |

pub mod accuracy;
mod assembly;
mod checkpointer;
mod error;
pub mod execution;
mod header;
pub mod job;
mod kept;
pub mod machine;
mod observer;
mod options;
mod recorder;
mod resume;
mod run;
mod start;
mod summary;
mod time_loop;
mod warnings;

pub use assembly::Assembly;
pub use error::{InputError, Progress, RunError, RunFailure, Stopped, signal_in_words};
pub use header::input_files;
pub use job::Job;
pub use observer::Observer;
pub use options::{ExecutionOptions, Program, RunOptions, StartMode};
pub use run::run;
pub use summary::{PartsSummary, RunSummary};
pub use time_loop::Sink;
pub use warnings::{idle_warning, stiffness_warning};
