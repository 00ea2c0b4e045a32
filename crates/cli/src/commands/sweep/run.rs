//! `plateau sweep run` and `plateau sweep slurm`: make the runs of a study that are not there yet, here or by an array of jobs, or one of
//! them by itself; `plateau sweep scene`: its scene.

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use indicatif::ProgressBar;
use plateau_io::number;
use plateau_io::scene::Workers;
use plateau_io::study::Study;
use plateau_io::text::shown_on_one_line;
use plateau_run::sweep::{
    self, Estimate, Resolved, Sweep, SweepObserver, SweepOptions, SweepSummary, run_in_words, scene_of_run,
};
use plateau_run::{Job, Observer, RunOptions, signal_in_words};

use crate::arguments::{SlurmArguments, SweepRunArguments, SweepSceneArguments};
use crate::failure::{Failure, in_job, of_study};
use crate::output::{print, print_json, table};
use crate::terminal::{Interrupt, Messages, Terminal};
use crate::{commands, invocation, message, output, program, terminal};

/// Makes the runs, together with the other processes of the job if there are any.
pub fn run(arguments: &SweepRunArguments) -> Result<(), Failure> {
    in_job(|job| match arguments.run {
        Some(number) => run_alone(arguments, number as usize, job),
        None => run_study(arguments, job),
    })
}

/// Makes one run, as `plateau run` makes that of a scene.
fn run_alone(arguments: &SweepRunArguments, number: usize, job: &mut Job) -> Result<(), Failure> {
    let plan = arguments.study.load()?;
    let mut scene = scene_of_run(&plan, number)?;
    scene.workers = Workers::Count(arguments.cores.workers());
    let output = arguments.output.clone().unwrap_or_else(|| PathBuf::from(format!("run-{number:04}.h5")));
    output::check(&output, arguments.force, &plan.study().inputs())?;
    let options = RunOptions {
        output: Some(output),
        replace: arguments.force,
        program: program::this(),
        ..RunOptions::default()
    };
    let terminal = Terminal::listen_for_run(job.leads()).map_err(Failure::run)?;
    commands::run::make(commands::run::warned(scene), &options, arguments.json, job, terminal)
}

/// Prints the scene of one run.
pub fn scene(arguments: &SweepSceneArguments) -> Result<(), Failure> {
    let plan = sweep::load(&arguments.study, None).map_err(of_study)?;
    let number = arguments.run as usize;
    let scene = scene_of_run(&plan, number)?;
    let (run, study) = (run_in_words(&plan, number), arguments.study.display().to_string());
    print(&format!("# {} of {}\n\n{}", shown_on_one_line(&run), shown_on_one_line(&study), scene.resolved.trim_start()))
}

fn run_study(arguments: &SweepRunArguments, job: &mut Job) -> Result<(), Failure> {
    let plan = arguments.study.load()?;
    let options = SweepOptions {
        retry: arguments.retry,
        keep_files: arguments.keep_files,
        part: arguments.task,
        jobs: arguments.cores.runs_at_a_time(),
        workers: arguments.cores.workers(),
        most_failures: arguments.max_failures.map(|limit| limit as usize),
        program: program::this(),
    };
    let sweep = Sweep::prepare(&plan, options, job, &Messages)?;
    let interrupt = Interrupt::listen().map_err(Failure::run)?;
    // Else a signal that asks runs for a checkpoint would end all of them; these keep theirs by the clock.
    interrupt.listen_for_save().map_err(Failure::run)?;
    if job.ranks() > 1 && arguments.cores.jobs.is_some() && job.leads() {
        message::warning("each rank makes one run at a time: --jobs has no effect");
    }
    let progress = RunsProgress::new(interrupt, sweep.pending().len(), sweep.steps(), job.leads());
    let summary = sweep.run(job, &progress)?;
    if job.leads() {
        print_summary(&summary, arguments)?;
    }
    if let Some(signal) = summary.signal {
        let message = || {
            format!("stopped by {}; {} runs are left, the same command goes on", signal_in_words(signal), summary.left)
        };
        return Err(Failure::stopped(signal, job.leads().then(message)));
    }
    summary.check()
}

/// Prints what came of the runs.
fn print_summary(summary: &SweepSummary, arguments: &SweepRunArguments) -> Result<(), Failure> {
    if arguments.json {
        return print_json(summary);
    }
    let task = arguments.task.map(|task| format!("task {} of {}", task.number, task.count));
    let mut rows = vec![("runs of the study", summary.runs.to_string())];
    rows.extend(task.map(|task| ("made here", task)));
    rows.extend((summary.repeats > 0).then(|| ("repeats of others", summary.repeats.to_string())));
    rows.push(("finished before", summary.finished_before.to_string()));
    rows.push((
        "finished now",
        format!("{}, {} at a time, in {}", summary.finished, summary.jobs, number::duration(summary.wall_time)),
    ));
    let (elsewhere, now, before) =
        (summary.finished_elsewhere, summary.failed + summary.failed_elsewhere, summary.failed_before);
    rows.extend((elsewhere > 0).then(|| ("by other processes", format!("{elsewhere} meanwhile"))));
    rows.extend((now + before > 0).then(|| ("failed", format!("{now} now, {before} before"))));
    rows.extend((summary.left > 0).then(|| ("left", summary.left.to_string())));
    rows.push(("results", summary.results.clone()));
    print(&table(&summary.study, &rows))
}

/// Messages, a bar and signals while runs are made.
struct RunsProgress {
    interrupt: Interrupt,
    /// One bar for all runs, on standard error; silent where that is no terminal.
    bar: ProgressBar,
    runs: usize,
    ended: AtomicU64,
    failed: AtomicU64,
}

impl RunsProgress {
    /// For so many runs with so many steps together.
    fn new(interrupt: Interrupt, runs: usize, steps: u64, visible: bool) -> Self {
        let bar = terminal::bar(steps, visible);
        if !bar.is_hidden() {
            bar.enable_steady_tick(Duration::from_secs(1));
        }
        let progress = Self { interrupt, bar, runs, ended: AtomicU64::new(0), failed: AtomicU64::new(0) };
        progress.show();
        progress
    }

    fn show(&self) {
        let (ended, failed) = (self.ended.load(Ordering::Relaxed), self.failed.load(Ordering::Relaxed));
        let failed = if failed > 0 { format!(", {failed} failed") } else { String::new() };
        self.bar.set_message(format!("{ended} of {} runs{failed}", self.runs));
    }
}

impl Observer for RunsProgress {
    fn warning(&self, text: &dyn Display) {
        self.bar.suspend(|| message::warning(text));
    }

    fn note(&self, text: &dyn Display) {
        self.bar.suspend(|| message::note(text));
    }

    fn ends(&self) {
        self.bar.finish_and_clear();
    }

    fn asked_to_stop(&self) -> Option<u8> {
        self.interrupt.signal()
    }
}

impl SweepObserver for RunsProgress {
    fn steps(&self, count: u64) {
        self.bar.inc(count);
    }

    fn run_ended(&self, failed: bool) {
        self.failed.fetch_add(failed.into(), Ordering::Relaxed);
        self.ended.fetch_add(1, Ordering::Relaxed);
        self.show();
    }

    fn retry_advice(&self, study: &Study) -> String {
        Messages.retry_advice(study)
    }
}

/// Time that a task is to take, s.
const TASK_TIME: f64 = 3600.0;
/// Factor of the estimated time that is asked for: other nodes may be slower, and share their memory's bandwidth.
const TIME_RESERVE: f64 = 2.0;
/// Besides, s.
const LEAST_TIME: f64 = 600.0;
/// Factor of the estimated memory that is asked for.
const MEMORY_RESERVE: f64 = 1.25;
/// The program itself and its libraries, bytes.
const PROGRAM_MEMORY: f64 = 64e6;
/// Tasks of an array that Slurm takes unless told otherwise.
const MOST_TASKS: usize = 1000;

/// Writes the script.
pub fn slurm(arguments: &SlurmArguments) -> Result<(), Failure> {
    let plan = arguments.study.load()?;
    let stem = arguments.study.study.file_stem().map_or("study".into(), |stem| stem.to_string_lossy());
    let script = arguments.output.clone().unwrap_or_else(|| PathBuf::from(format!("{stem}.sbatch")));
    output::check(&script, arguments.force, &plan.study().inputs())?;
    let estimate = Estimate::of(&plan)?;
    if plan.runs() <= Resolved::MOST_AT_ONCE {
        Resolved::of(&plan)?.refuse_unrecorded(plan.study(), &Messages)?;
    }
    let cores = arguments.cores as usize;
    let total = estimate.mean_time * plan.runs() as f64 / cores as f64;
    let usual = ((total / TASK_TIME).ceil() as usize).clamp(1, MOST_TASKS);
    let tasks = arguments.tasks.map_or(usual, |tasks| tasks as usize).min(plan.runs());
    let rounds = plan.runs().div_ceil(tasks).div_ceil(cores) as f64;
    let time = TIME_RESERVE * (estimate.mean_time * rounds).max(estimate.longest_time) + LEAST_TIME;
    let memory = MEMORY_RESERVE * estimate.memory as f64 * cores as f64 + PROGRAM_MEMORY;
    let program = std::env::current_exe().map_err(Failure::run)?;
    let study = arguments.study.study.canonicalize().map_err(Failure::input)?;
    let directory =
        arguments.study.directory.as_deref().map(std::path::absolute).transpose().map_err(Failure::input)?;
    let minutes = (time / 60.0).ceil() as u64;
    let megabytes = (memory / (1 << 20) as f64).ceil() as u64;
    let head = format!(
        "#!/bin/sh\n\
         # Makes the runs of a study of {runs} runs that are not there yet. Submit it again for what is left.\n\
         #SBATCH --job-name={name}\n\
         #SBATCH --array=1-{tasks}\n\
         #SBATCH --ntasks=1\n\
         #SBATCH --cpus-per-task={cores}\n\
         #SBATCH --mem={megabytes}M\n\
         #SBATCH --time={hours:02}:{rest:02}:00\n\
         #SBATCH --signal=B:TERM@60\n\
         #SBATCH --output={name}-%A_%a.out\n",
        runs = plan.runs(),
        name = stem.replace(|c: char| !(c.is_ascii_alphanumeric() || "-_.".contains(c)), "-"),
        hours = minutes / 60,
        rest = minutes % 60,
    );
    // Paths need not be UTF-8.
    let quoted = |path: &Path| invocation::quoted(path.as_os_str().as_encoded_bytes());
    let mut command = [&b"exec "[..], &quoted(&program), b" sweep run ", &quoted(&study)].concat();
    if let Some(directory) = &directory {
        command.extend([&b" --directory "[..], &quoted(directory)].concat());
    }
    if arguments.keep_files {
        command.extend(b" --keep-files");
    }
    let rest = format!(" --task \"$SLURM_ARRAY_TASK_ID/{tasks}\" --jobs {cores}\n");
    output::write(&script, &[head.as_bytes(), &command, rest.as_bytes()].concat(), arguments.force)?;
    print(&table(
        &plan.study().title,
        &[
            ("script", script.display().to_string()),
            ("tasks", format!("{tasks} for {}, {} at a time in each", number::count(plan.runs(), "run"), cores)),
            ("asked for", format!("{} min and {megabytes} MiB for each task", minutes)),
            ("next", format!("sbatch {}", script.display())),
        ],
    ))
}
