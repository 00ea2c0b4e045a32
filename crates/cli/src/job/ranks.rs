//! The ranks of an MPI job: all run the same scene, the first one writes the run file and talks to the user.

use plateau_core::comm::mpi::{Mpi, Session};
use plateau_core::comm::{CommError, Communicator as _};
use plateau_core::parameters::Parameters;
use plateau_core::simulation::{Execution, Simulation, SimulationError};
use plateau_core::state::InitialSurfaces;

use crate::failure::Failure;
use crate::message;

/// This process as one of the ranks.
#[derive(Debug)]
pub struct Job {
    session: Session,
    /// For what the ranks settle between steps.
    meeting: Mpi,
}

impl Job {
    /// Joins the other ranks. From here on only the first rank gives warnings.
    pub fn start() -> Result<Self, Failure> {
        let session = Session::start().map_err(Failure::run)?;
        let meeting = session.communicator();
        if meeting.rank() != 0 {
            message::no_warnings();
        }
        Ok(Self { session, meeting })
    }

    /// Whether this rank writes the run file and talks to the user.
    pub fn leads(&self) -> bool {
        self.meeting.rank() == 0
    }

    /// How many ranks there are.
    pub fn ranks(&self) -> usize {
        self.meeting.size()
    }

    /// The simulation that the ranks carry out together; a single rank may have threads instead.
    pub fn simulation(
        &self,
        parameters: Parameters,
        surfaces: InitialSurfaces,
        execution: Execution,
    ) -> Result<Simulation, SimulationError> {
        if self.ranks() == 1 {
            return Simulation::with_execution(parameters, surfaces, execution);
        }
        Simulation::on_ranks(parameters, surfaces, execution.instructions, self.session.communicator())
    }

    /// Whether any rank was asked to stop, and by which signal; and how many steps to take before the next agreement.
    /// Clocks differ, so the number is that of the first rank, and all ranks get the same answer.
    pub fn agree(&mut self, signal: Option<u8>, steps: u64) -> Result<(Option<u8>, u64), CommError> {
        let (mut largest, mut first) = (0, steps);
        self.meeting.all_gather(&[signal.unwrap_or(0).into(), steps], &mut |rank, words| {
            largest = largest.max(words[0]);
            if rank == 0 {
                first = words[1];
            }
        })?;
        Ok((u8::try_from(largest).ok().filter(|signal| *signal != 0), first))
    }

    /// Makes sure that all ranks are about to do the same, which `text` describes.
    pub fn compare(&mut self, text: &str) -> Result<(), Failure> {
        let mut first = Vec::new();
        let mut other = None;
        let words: Vec<_> = text.bytes().map(u64::from).collect();
        self.meeting
            .all_gather(&words, &mut |rank, words| {
                if rank == 0 {
                    first = words.to_vec();
                } else if words != first {
                    other = other.or(Some(rank));
                }
            })
            .map_err(Failure::run)?;
        other.map_or(Ok(()), |rank| {
            Err(Failure::input(format_args!(
                "rank {rank} was given another scene, other surfaces or another build of this program than rank 0: \
                 give all ranks the same, where the machines share no files by copying them"
            )))
        })
    }

    /// Leaves the other ranks in good order; if this rank failed, all end with its exit status.
    pub fn end(self, result: Result<(), Failure>) -> Result<(), Failure> {
        match result {
            Err(failure @ (Failure::Input(_) | Failure::Run(_))) => {
                self.session.fail(failure.status(), || failure.say())
            }
            // All ranks were stopped together.
            Ok(()) | Err(Failure::Stopped { .. }) => {
                self.session.finish();
                result
            }
        }
    }
}
