//! Where the samples and maps of a run go, and what may end it.

use plateau_core::acceleration::scout::Scout;
use plateau_core::engine::comm::CommError;
use plateau_core::observe::{Sample, Snapshot};
use plateau_core::simulation::{Simulation, SimulationError};
use plateau_io::plausibility::Recorded;
use plateau_io::run_file::{RunFileError, RunWriter};

use crate::drive::Sink;
use crate::interrupt::Interrupt;
use crate::job::{Agreement, Job};
use crate::keeper::Keeper;
use crate::progress::Progress;

/// Why a run that had started did not end.
#[derive(Debug)]
pub(super) enum RunFailure {
    Simulation(SimulationError),
    RunFile(RunFileError),
    Comm(CommError),
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
            Self::Comm(error) => error.fmt(f),
            Self::Stopped(signal) => write!(f, "stopped by signal {signal}"),
        }
    }
}

/// Hands what a simulation reports to the writer and shows how far it is.
pub(super) struct Recorder<'job> {
    /// None in a process that does not lead.
    pub(super) writer: Option<RunWriter>,
    pub(super) progress: Progress,
    pub(super) interrupt: Interrupt,
    pub(super) job: &'job mut Job,
    pub(super) keeper: Keeper,
    /// What all processes settled last.
    pub(super) agreement: Agreement,
    /// What the samples so far say of the scene.
    pub(super) recorded: Recorded,
}

impl Sink for Recorder<'_> {
    type Error = RunFailure;

    fn sample(&mut self, sample: Sample) -> Result<(), RunFailure> {
        self.recorded.add(&sample);
        self.keeper.sampled(sample.clone());
        self.writer.as_mut().map_or(Ok(()), |writer| writer.sample(sample)).map_err(RunFailure::RunFile)
    }

    fn snapshot(&mut self, snapshot: Snapshot) -> Result<(), RunFailure> {
        self.keeper.mapped();
        self.writer.as_mut().map_or(Ok(()), |writer| writer.snapshot(snapshot)).map_err(RunFailure::RunFile)
    }

    fn look(&mut self, simulation: &Simulation, steps: u64) -> Result<u64, RunFailure> {
        self.progress.show(simulation);
        // Samples may be rare: the run is not to go on for hours beside a file that is lost.
        self.writer.as_mut().map_or(Ok(()), RunWriter::check).map_err(RunFailure::RunFile)?;
        let save = self.interrupt.save() || (self.writer.is_some() && self.keeper.is_due());
        let own = Agreement { signal: self.interrupt.signal(), save: save || self.agreement.save, steps };
        self.agreement = self.job.agree(own).map_err(RunFailure::Comm)?;
        Ok(self.agreement.steps)
    }

    fn rest(&mut self, simulation: &mut Simulation, scout: Option<&mut Scout>) -> Result<(), RunFailure> {
        let Agreement { signal, save, .. } = self.agreement;
        if save || signal.is_some() {
            self.agreement.save = false;
            self.keeper.keep(simulation, scout, false, self.writer.as_ref().map(RunWriter::sync))?;
        }
        let Some(signal) = signal else { return Ok(()) };
        self.keeper.wait();
        Err(RunFailure::Stopped(signal))
    }
}
