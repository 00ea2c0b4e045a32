//! Runs and studies that write their files as those of the program do.

use std::path::PathBuf;

use plateau_core::simulation::Execution;
use plateau_run::sweep::{self, Sweep, SweepOptions};
use plateau_run::{Job, Observer as _, RunOptions, StartMode, execution};
use pyo3::prelude::*;

use crate::background::{Messages, in_background};
use crate::failure::Failure;
use crate::scene::Scene;
use crate::simulation::engine_of;
use crate::state::program;

/// Runs a scene, and gives the summary as JSON; nothing where the run was finished before. `mode` is `new`, `resume` or `extend`.
#[pyfunction]
pub fn run(
    py: Python<'_>,
    scene: &Scene,
    output: Option<PathBuf>,
    replace: bool,
    mode: &str,
    engine: &str,
    tell: &Bound<'_, PyAny>,
) -> PyResult<Option<String>> {
    let scene = scene.0.clone();
    let about = scene.path.to_string_lossy().into_owned();
    let work = |messages: &Messages| {
        let options = RunOptions {
            output,
            replace,
            mode: match mode {
                "resume" => StartMode::Resume,
                "extend" => StartMode::Extend,
                _ => StartMode::New,
            },
            execution: Execution { engine: engine_of(engine)?, ..Execution::default() },
            program: program(),
        };
        let mut job = Job::start().map_err(Failure::run)?;
        let done = plateau_run::run(scene, &options, &mut job, messages)?;
        job.finish();
        done.map(|summary| serde_json::to_string(&summary).map_err(Failure::run)).transpose()
    };
    in_background(py, tell, &[&about], work)
}

/// Makes the runs of a study that are not there yet.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "each is an argument in Python")]
pub fn make_runs(
    py: Python<'_>,
    study: PathBuf,
    directory: Option<PathBuf>,
    jobs: Option<usize>,
    workers: Option<usize>,
    most_failures: Option<usize>,
    retry: bool,
    keep_files: bool,
    tell: &Bound<'_, PyAny>,
) -> PyResult<()> {
    let about = study.to_string_lossy().into_owned();
    let work = |messages: &Messages| {
        let plan = sweep::load(&study, directory.as_deref()).map_err(Failure::input)?;
        let workers = workers.unwrap_or(1);
        let jobs = jobs.unwrap_or_else(|| (execution::cores() / workers).max(1));
        let options = SweepOptions { retry, keep_files, part: None, jobs, workers, most_failures, program: program() };
        let mut job = Job::start().map_err(Failure::run)?;
        let sweep = Sweep::prepare(&plan, options, &job, messages)?;
        messages.starts("", sweep.steps() as f64);
        let summary = sweep.run(&mut job, messages)?;
        job.finish();
        if let Some(signal) = summary.signal {
            let message = format!("{} runs are left, the same call goes on", summary.left);
            return Err(Failure::stopped(signal, Some(message)));
        }
        summary.check()
    };
    in_background(py, tell, &[&about], work)
}
