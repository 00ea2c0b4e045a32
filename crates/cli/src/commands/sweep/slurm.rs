//! `plateau sweep slurm`: a batch script that makes the runs of a study as a job array.

use std::path::PathBuf;

use plateau_io::number;
use plateau_run::sweep::{self, Estimate, Resolved};

use crate::arguments::SlurmArguments;
use crate::failure::Failure;
use crate::table::{print, table};
use crate::terminal::Messages;
use crate::{invocation, output};

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
    let plan = sweep::load(&arguments.study).map_err(Failure::of_sweep)?;
    let stem = arguments.study.file_stem().map_or_else(|| "study".into(), |stem| stem.to_string_lossy().into_owned());
    let script = arguments.output.clone().unwrap_or_else(|| PathBuf::from(format!("{stem}.sbatch")));
    output::check(&script, arguments.force, &plan.study().inputs())?;
    let estimate = Estimate::of(&plan).map_err(Failure::of_sweep)?;
    if plan.runs() <= Resolved::MOST_AT_ONCE {
        let resolved = Resolved::of(&plan).map_err(Failure::of_sweep)?;
        resolved.refuse_unrecorded(plan.study(), &Messages).map_err(Failure::of_sweep)?;
    }
    let cores = arguments.cores as usize;
    let total = estimate.mean_time * plan.runs() as f64 / cores as f64;
    let wanted = arguments
        .tasks
        .map_or_else(|| ((total / TASK_TIME).ceil() as usize).clamp(1, MOST_TASKS), |tasks| tasks as usize);
    let tasks = wanted.min(plan.runs());
    let rounds = plan.runs().div_ceil(tasks).div_ceil(cores) as f64;
    let time = TIME_RESERVE * (estimate.mean_time * rounds).max(estimate.longest_time) + LEAST_TIME;
    let memory = MEMORY_RESERVE * estimate.memory as f64 * cores as f64 + PROGRAM_MEMORY;
    let program = std::env::current_exe().map_err(Failure::run)?;
    let study = arguments.study.canonicalize().map_err(Failure::input)?;
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
    let command = [
        &b"exec "[..],
        &invocation::quoted(program.as_os_str().as_encoded_bytes()),
        b" sweep run ",
        &invocation::quoted(study.as_os_str().as_encoded_bytes()),
    ]
    .concat();
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
