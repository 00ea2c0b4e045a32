//! What can go wrong.

use std::io;
use std::path::{Path, PathBuf};

use plateau_core::simulation::SimulationError;
use plateau_io::scene::SceneError;
use plateau_io::surface::SurfaceError;
use thiserror::Error;

/// Why there is no result.
#[derive(Debug, Error)]
pub enum BenchError {
    /// The scene is no scene.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Its surfaces cannot be had.
    #[error(transparent)]
    Surface(Box<SurfaceError>),
    /// The simulation failed.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// A file cannot be read or written.
    #[error("{path}: {source}")]
    File {
        /// Which.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A file is not a result of this program.
    #[error("{path}: expected results as `plateau-bench --json` writes them: {source}")]
    NoResults {
        /// Which.
        path: PathBuf,
        /// What is wrong with it.
        source: serde_json::Error,
    },
    /// Two files hold results of the same benchmark.
    #[error("{path}: results of {benchmark} were already given, expected one file for each benchmark")]
    Twice {
        /// The second file.
        path: PathBuf,
        /// Of what it holds results.
        benchmark: &'static str,
    },
    /// A document has no place for the tables of a benchmark.
    #[error("{path}: found no lines {begin:?} and {end:?} in this order, expected the place of a table between them")]
    NoPlace {
        /// The document.
        path: PathBuf,
        /// Before the tables.
        begin: String,
        /// After the tables.
        end: String,
    },
    /// The peer does not run as it should.
    #[error("the step in Python: {problem}")]
    Peer {
        /// What it said.
        problem: String,
    },
    /// The peer computes something else.
    #[error(
        "the step in Python is another: value {index} of {quantity} is {theirs:e} and ours {ours:e}, which differ by \
         more than {tolerance:e} of the largest value; their times cannot be compared"
    )]
    Disagreement {
        /// Of what: a series over the steps, or a field over the cells.
        quantity: &'static str,
        /// Which step or cell, counted from 0.
        index: usize,
        /// The peer's.
        theirs: f64,
        /// Ours.
        ours: f64,
        /// Largest accepted difference over the largest value.
        tolerance: f64,
    },
    /// The program is not there.
    #[error(
        "{}: found no program, expected `plateau`: build it with `cargo build --release -p plateau`, or name it with \
         --program or PLATEAU_PROGRAM", .0.display()
    )]
    NoProgram(PathBuf),
    /// A run of the program fails.
    #[error("{program} run {scene} (with {sets}): {problem}")]
    Run {
        /// The program.
        program: PathBuf,
        /// The scene file.
        scene: PathBuf,
        /// Changes of it.
        sets: String,
        /// What it said.
        problem: String,
    },
    /// The scene asks for what the peer does not compute.
    #[error(
        "the step in Python has explicit wear of the pin on a disc that does not wear, build-ups as what they lie on, and \
         local debris, or one debris pool with formation and destruction; the scene asks for {0}"
    )]
    NotForPeers(&'static str),
}

impl From<SurfaceError> for BenchError {
    fn from(error: SurfaceError) -> Self {
        Self::Surface(Box::new(error))
    }
}

impl BenchError {
    /// A file cannot be read or written.
    pub fn file(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::File { path: path.to_owned(), source }
    }
}
