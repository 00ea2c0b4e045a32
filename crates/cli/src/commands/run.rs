//! `plateau run`: simulate a scene and write its run file.

use std::path::{Path, PathBuf};
use std::time::Instant;

use plateau_core::observe::{Sample, Snapshot};
use plateau_core::schedule::Schedule;
use plateau_core::simulation::{Simulation, SimulationError};
use plateau_core::state::Base;
use plateau_io::run_file::{End, Header, InputFile, RunFileError, RunWriter, WriterReport, report_file_size_limit};
use plateau_io::scene::recipe::{Scene, Workers};
use plateau_io::surface::{self, Loaded};
use serde::Serialize;

use super::load_scene;
use crate::arguments::RunArguments;
use crate::drive::{Outcome, Sink, drive};
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::message;
use crate::number;
use crate::progress::Progress;
use crate::stability;
use crate::table::{print, table};
use crate::{machine, version};

/// Runs a scene.
pub fn run(arguments: &RunArguments) -> Result<(), Failure> {
    // Where the system takes no handler, a run beyond the file size limit ends by a signal; no reason not to run.
    let _ = report_file_size_limit();
    let scene = load_scene(&arguments.scene)?;
    let path = arguments.output.clone().unwrap_or_else(|| scene.output.file.clone());
    match path.metadata() {
        Ok(there) if !there.is_file() => return Err(Failure::input(RunFileError::NotAFile { path })),
        _ if !arguments.force && path.symlink_metadata().is_ok() => {
            return Err(Failure::input(RunFileError::Exists { path }));
        }
        _ => {}
    }
    if let Workers::Count(2..) = scene.workers {
        message::warning("this version runs each scene on one worker; the result is the same");
    }
    stability::warn(&scene.parameters);
    let loaded = surface::load(&scene).map_err(Failure::input)?;
    refuse_to_replace_inputs(&path, &scene, &loaded)?;
    let schedule = Schedule::new(&scene.parameters, scene.output.sample_every, &scene.output.maps_at);
    let Loaded { surfaces, inputs, .. } = loaded;
    let pin_base = surfaces.pin_base.clone();
    let mut simulation = Simulation::new(scene.parameters.clone(), surfaces).map_err(Failure::input)?;
    let header = Header {
        expected_samples: schedule.samples(),
        instruction_set: simulation.instructions().name().into(),
        ..header(&scene, pin_base, &inputs)?
    };
    let interrupt = Interrupt::listen().map_err(Failure::run)?;
    let writer = RunWriter::create(&path, arguments.force, &header).map_err(create_failure)?;

    let start = Instant::now();
    let progress = Progress::new(scene.parameters.steps);
    let mut recorder = Recorder { writer, progress, interrupt, last: Sample::default() };
    let result = drive(&mut simulation, &schedule, &scene.output.maps, &mut recorder);
    recorder.progress.finish();
    let Recorder { writer, last, .. } = recorder;
    let outcome = match result {
        Ok(outcome) => outcome,
        Err(RunFailure::Stopped(signal)) => {
            let report = writer.finish(&End::Interrupted).map_err(Failure::run)?;
            let (steps, file, samples) = (simulation.steps_done(), path.display(), report.samples);
            let message = format!("stopped by signal {signal} after {steps} steps; {file} holds {samples} samples");
            return Err(Failure::Stopped { signal, message });
        }
        Err(failure) => {
            // The first error is the one to report; a writer that failed has nothing more to say.
            let _ = writer.finish(&End::Failed(failure.to_string()));
            return Err(Failure::run(failure));
        }
    };
    let report = writer.finish(&End::Finished).map_err(Failure::run)?;
    let summary = Summary::new(&scene, &path, &last, outcome, report, start.elapsed().as_secs_f64());
    if summary.load_residual > summary.load_tolerance {
        message::warning(format_args!(
            "the load balance reached {:.1e}, not {:.1e}: rounding of the heights allows no better",
            summary.load_residual, summary.load_tolerance
        ));
    }
    if arguments.scene.json { print(&summary.to_json()?) } else { print(&summary.to_text()) }
}

/// Refuses an output that is a file which the run reads: not even `--force` is meant like that.
fn refuse_to_replace_inputs(output: &Path, scene: &Scene, loaded: &Loaded) -> Result<(), Failure> {
    let Ok(existing) = output.canonicalize() else { return Ok(()) };
    let mut inputs = scene.files.iter().chain(loaded.inputs.iter().map(|(path, _)| path));
    if inputs.any(|input| input.canonicalize().is_ok_and(|input| input == existing)) {
        let output = output.display();
        return Err(Failure::input(format_args!(
            "the output file {output} is an input of this run and is not replaced; write elsewhere with -o FILE"
        )));
    }
    Ok(())
}

/// The part of the run file that scene and surfaces decide; not yet what depends on the simulation.
fn header(scene: &Scene, pin_base: Vec<Base>, surface_files: &[(PathBuf, String)]) -> Result<Header, Failure> {
    let mut inputs = InputFile::read_all(&scene.files)
        .map_err(|(path, error)| Failure::input(format_args!("{}: {error}", path.display())))?;
    inputs.extend(
        surface_files
            .iter()
            .map(|(path, sha256)| InputFile { path: path.to_string_lossy().into_owned(), sha256: sha256.clone() }),
    );
    Ok(Header {
        title: scene.title.clone(),
        mesh: scene.parameters.mesh.clone(),
        pin_base,
        maps: scene.output.maps.clone(),
        expected_samples: 0,
        scene: scene.resolved.clone(),
        program: version::program(),
        source_revision: version::REVISION.into(),
        host: machine::host(),
        workers: 1,
        instruction_set: String::new(),
        seeds: scene.seeds.clone(),
        inputs,
    })
}

/// Whose fault it is that a run file cannot be made.
fn create_failure(error: RunFileError) -> Failure {
    match error {
        RunFileError::SetUp { .. } | RunFileError::Write { .. } => Failure::run(error),
        _ => Failure::input(error),
    }
}

/// Why a run that had started did not end.
#[derive(Debug)]
enum RunFailure {
    Simulation(SimulationError),
    RunFile(RunFileError),
    /// This signal asked the run to stop.
    Stopped(u8),
}

impl From<SimulationError> for RunFailure {
    fn from(error: SimulationError) -> Self {
        Self::Simulation(error)
    }
}

impl std::fmt::Display for RunFailure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Simulation(error) => error.fmt(f),
            Self::RunFile(error) => error.fmt(f),
            Self::Stopped(signal) => write!(f, "stopped by signal {signal}"),
        }
    }
}

/// Hands what a simulation reports to the writer and shows how far it is.
struct Recorder {
    writer: RunWriter,
    progress: Progress,
    interrupt: Interrupt,
    last: Sample,
}

impl Sink for Recorder {
    type Error = RunFailure;

    fn sample(&mut self, sample: Sample) -> Result<(), RunFailure> {
        self.last = sample;
        self.writer.sample(sample).map_err(RunFailure::RunFile)
    }

    fn snapshot(&mut self, snapshot: Snapshot) -> Result<(), RunFailure> {
        self.writer.snapshot(snapshot).map_err(RunFailure::RunFile)
    }

    fn look(&mut self, simulation: &Simulation) -> Result<(), RunFailure> {
        self.progress.show(simulation);
        self.interrupt.signal().map_or(Ok(()), |signal| Err(RunFailure::Stopped(signal)))
    }
}

/// What a finished run tells its user.
#[derive(Debug, Serialize)]
struct Summary {
    title: String,
    file: PathBuf,
    file_size: u64,
    steps: u64,
    time: f64,
    wall_time: f64,
    steps_per_second: f64,
    load_evaluations_per_step: f64,
    writer_wait: f64,
    peak_memory: Option<u64>,
    contact_area: f64,
    contact_area_mean: f64,
    contact_ratio: f64,
    mean_pressure: f64,
    max_pressure: f64,
    filled_fraction: f64,
    disc_secondary: f64,
    pin_secondary: f64,
    worn: f64,
    emitted: f64,
    load_residual: f64,
    load_tolerance: f64,
    balance_residual: f64,
}

impl Summary {
    fn new(scene: &Scene, file: &Path, last: &Sample, outcome: Outcome, report: WriterReport, wall_time: f64) -> Self {
        Self {
            title: scene.title.clone(),
            file: file.to_owned(),
            file_size: report.bytes,
            steps: last.step,
            time: last.time,
            wall_time,
            steps_per_second: last.step as f64 / wall_time,
            load_evaluations_per_step: outcome.evaluations,
            writer_wait: report.waited.as_secs_f64(),
            peak_memory: machine::peak_memory(),
            contact_area: last.contact_area,
            contact_area_mean: last.contact_area_mean,
            contact_ratio: last.contact_ratio,
            mean_pressure: last.mean_pressure,
            max_pressure: last.max_pressure,
            filled_fraction: last.filled_fraction,
            disc_secondary: last.disc_secondary,
            pin_secondary: last.pin_secondary,
            worn: last.worn_pin + last.worn_resin + last.worn_disc,
            emitted: last.emitted,
            load_residual: outcome.load_residual,
            load_tolerance: scene.parameters.load_tolerance,
            balance_residual: last.balance_residual,
        }
    }

    fn to_json(&self) -> Result<String, Failure> {
        serde_json::to_string_pretty(self).map(|text| text + "\n").map_err(Failure::run)
    }

    fn to_text(&self) -> String {
        // Adding 0 makes a negative zero a plain one.
        let percent = |fraction: f64| format!("{:.2} %", (1e4 * fraction).round() / 1e2 + 0.0);
        let square_millimetres = |area: f64| format!("{:.4} mm²", area * 1e6);
        let cubic_millimetres = |volume: f64| format!("{} mm³", number::short(volume * 1e9));
        let megapascal = |pressure: f64| format!("{:.3} MPa", pressure * 1e-6);
        let mut rows = vec![
            ("simulated time", format!("{} s in {} steps", number::short(self.time), number::grouped(self.steps))),
            (
                "wall time",
                format!(
                    "{} ({} steps/s)",
                    number::duration(self.wall_time),
                    number::grouped(self.steps_per_second as u64)
                ),
            ),
            ("waited for the run file", number::duration(self.writer_wait)),
            (
                "contact area",
                format!(
                    "{}, {} of the pin; mean of the last revolution {}",
                    square_millimetres(self.contact_area),
                    percent(self.contact_ratio),
                    square_millimetres(self.contact_area_mean)
                ),
            ),
            (
                "contact pressure",
                format!("mean {}, largest {}", megapascal(self.mean_pressure), megapascal(self.max_pressure)),
            ),
            ("disc filled", percent(self.filled_fraction)),
            (
                "with any build-up",
                format!("{} of the disc, {} of the pin", percent(self.disc_secondary), percent(self.pin_secondary)),
            ),
            (
                "worn volume",
                format!("{}, of which emitted {}", cubic_millimetres(self.worn), cubic_millimetres(self.emitted)),
            ),
            (
                "residuals",
                format!("load {:.1e} at most, debris balance {:.1e}", self.load_residual, self.balance_residual),
            ),
        ];
        if let Some(bytes) = self.peak_memory {
            rows.push(("peak memory", number::bytes(bytes)));
        }
        rows.push(("run file", format!("{} ({})", self.file.display(), number::bytes(self.file_size))));
        table(&self.title, &rows)
    }
}
