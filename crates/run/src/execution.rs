//! Execution of a run: machine, cores, workers, instruction set. None of it shows in the results.

use std::time::{Duration, Instant};

use plateau_core::model::state::InitialSurfaces;
use plateau_core::simulation::{Engine, Execution, Simulation, SimulationError};
use plateau_io::scene::{Scene, Workers};

use crate::error::InputError;
use crate::options::Observer;

pub use plateau_io::process::{cores, host, processor};

/// Time for which each number of workers is tried.
const TRIAL: Duration = Duration::from_millis(25);

/// Steps before a trial's clock starts: threads start, caches fill, and the first displacement is searched from afar.
const WARM_UP_STEPS: u64 = 200;

/// Decides how a scene is carried out by `ranks` processes together, with engine, instructions and pinning as `asked`, and says
/// what is worth knowing about it. Where there are several, each of them is one worker.
pub fn decide(
    scene: &Scene,
    ranks: usize,
    asked: Execution,
    surfaces: &InitialSurfaces,
    observer: &dyn Observer,
) -> Result<Execution, SimulationError> {
    let workers = scene.workers;
    let engine = asked.engine.of(&scene.parameters);
    if engine == Engine::Plain {
        if ranks > 1 {
            return Err(SimulationError::PlainOnRanks { ranks });
        }
        if engine != asked.engine {
            observer.note(&"pooled debris: the plain model takes the steps, cell by cell, on one worker");
        }
        if workers != Workers::Count(1) {
            observer.warning(&"the plain model runs on one worker: numerics.workers and --workers have no effect");
        }
        return Ok(Execution { engine, workers: 1, pin: false, ..asked });
    }
    let execution = Execution { decomposition: scene.decomposition, ..asked };
    if ranks > 1 {
        return Ok(Execution { workers: ranks, ..execution });
    }
    let cores = cores();
    match workers {
        Workers::Auto => fastest(execution, cores, scene, surfaces, observer),
        Workers::Count(workers) => {
            if workers > cores {
                observer.warning(&format_args!(
                    "{workers} workers on {cores} cores wait for each other at every step; {cores} or fewer are faster"
                ));
            }
            Ok(Execution { workers, ..execution })
        }
    }
}

/// Checks that a scene asks for nothing that ranks cannot have: threads of their own, or to be pinned by this program.
///
/// # Errors
/// [`InputError::Refused`] otherwise.
pub(crate) fn check_ranks(scene: &Scene, ranks: usize, is_pinned: bool) -> Result<(), InputError> {
    let refused = match scene.workers {
        _ if ranks == 1 => return Ok(()),
        Workers::Count(workers) if workers > 1 => format!(
            "numerics.workers or --workers is {workers}, expected 1 on {ranks} ranks, which share the ring, one worker each: leave it \
             out, and start as many ranks as there are to be workers, as in mpirun -n {workers}"
        ),
        _ if is_pinned => format!(
            "--pin is for the threads of one process, and there are {ranks} ranks: leave it out, and let the launcher pin them, as in \
             mpirun --bind-to core"
        ),
        _ => return Ok(()),
    };
    Err(InputError::Refused(refused))
}

/// Tries 1, 2, 4, … workers, and as many as there are cores, on the first steps of the run.
fn fastest(
    execution: Execution,
    cores: usize,
    scene: &Scene,
    surfaces: &InitialSurfaces,
    observer: &dyn Observer,
) -> Result<Execution, SimulationError> {
    let mut candidates: Vec<usize> = (0..).map(|power| 1 << power).take_while(|workers| *workers < cores).collect();
    candidates.push(cores);
    let mut trials = Vec::new();
    for workers in candidates {
        let execution = Execution { workers, ..execution };
        let mut simulation = Simulation::with_execution(scene.parameters.clone(), surfaces.clone(), execution)?;
        trials.push((time_per_step(&mut simulation, scene.steps, TRIAL)?, workers));
    }
    let (_, workers) = trials.iter().copied().min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, 1));
    let times: Vec<String> =
        trials.iter().map(|(time, workers)| format!("{workers}: {:.1} µs a step", time * 1e6)).collect();
    observer.note(&format_args!("workers = \"auto\" runs on {workers} of {cores} cores ({})", times.join(", ")));
    Ok(Execution { workers, ..execution })
}

/// Wall time of a step, s: measured for about as long as `trial` on the first steps of a simulation, after some to warm up; step
/// `last` is the last, at the latest.
pub fn time_per_step(simulation: &mut Simulation, last: u64, trial: Duration) -> Result<f64, SimulationError> {
    let warm_up = Instant::now();
    while simulation.steps_done() < WARM_UP_STEPS.min(last / 2) && warm_up.elapsed() < trial {
        simulation.advance()?;
    }
    let (start, before, mut batch) = (Instant::now(), simulation.steps_done(), 1);
    while simulation.steps_done() < last && start.elapsed() < trial {
        simulation.pass_to(last.min(simulation.steps_done() + batch))?;
        batch *= 2;
    }
    Ok(start.elapsed().as_secs_f64() / (simulation.steps_done() - before) as f64)
}
