//! A run of Plateau as a library: scene, surfaces, simulation, samples, run file. It prints nothing: what there is to say goes
//! to an [`Observer`], and what went wrong is a [`RunError`], which tells a wrong input from a failed run.
//!
//! ```no_run
//! use plateau_run::{Job, RunOptions, run};
//!
//! let scene = plateau_io::scene::load("data/scenes/quick.toml".as_ref(), &[])?;
//! // `()` observes nothing.
//! let summary = run(scene, &RunOptions::default(), &mut Job::start()?, &())?;
//! if let Some(summary) = summary {
//!     println!("{} of the pin touches", summary.contact_ratio);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | content | module |
//! |---|---|
//! | a run from its scene to its file, and its results | [`run()`], [`RunSummary`] |
//! | options of a run, its observer, its failures | [`RunOptions`], [`Observer`], [`RunError`], [`Failure`] |
//! | simulation, scout and schedule of a scene, put together once for all who run one | [`Assembly`] |
//! | the time loop, and what takes its samples and maps | [`Assembly::run_to_end`], [`Sink`] |
//! | machine, number of workers, instruction set | [`execution`] |
//! | start or continuation, from which checkpoint, and writing those | `start`, `recorder` |
//! | accuracy of a scene's runs for their time | [`accuracy`] |
//! | the runs of a study | [`sweep`] |
//! | the processes that take the steps together | [`job`] |

pub mod accuracy;
mod assembly;
mod error;
pub mod execution;
pub mod job;
mod options;
mod recorder;
mod run;
mod start;
mod summary;
pub mod sweep;

pub use assembly::{Assembly, Sink, adapted};
pub use error::{Failure, InputError, Progress, RunError, RunFailure, Stopped, signal_in_words};
pub use job::Job;
pub use options::{Observer, Program, RunOptions, StartMode};
pub use recorder::{idle_warning, input_files, stiffness_warning};
pub use run::run;
pub use summary::{AccountsSummary, RunSummary};
