//! The processes that run one scene together: this one alone, or with feature `mpi` the ranks that `mpirun` started.
//! Either way a [`Job`] looks the same.

#[cfg(feature = "mpi")]
mod ranks;
mod work_queue;

#[cfg(not(feature = "mpi"))]
pub use alone::Job;
#[cfg(feature = "mpi")]
pub use ranks::Job;
pub use work_queue::{Agreement, PieceEnd};

/// A process on its own.
#[cfg(not(feature = "mpi"))]
mod alone {
    use plateau_core::engine::comm::CommError;
    use plateau_core::model::parameters::Parameters;
    use plateau_core::model::state::InitialSurfaces;
    use plateau_core::simulation::{Execution, Simulation, SimulationError};

    use super::work_queue::{Agreement, PieceEnd, WorkQueue};
    use crate::error::{RunError, RunFailure};

    /// The processes that run a scene together; built without feature `mpi`, this one on its own.
    #[derive(Debug)]
    pub struct Job(());

    impl Job {
        /// Joins the other processes.
        pub fn start() -> Result<Self, RunFailure> {
            Ok(Self(()))
        }

        /// Tells whether this process writes the run file and talks to the user.
        pub fn leads(&self) -> bool {
            true
        }

        /// Number of processes.
        pub fn ranks(&self) -> usize {
            1
        }

        pub(crate) fn simulation(
            &self,
            parameters: Parameters,
            surfaces: InitialSurfaces,
            execution: Execution,
        ) -> Result<Simulation, SimulationError> {
            Simulation::with_execution(parameters, surfaces, execution)
        }

        /// Agrees with all processes: they stop and save if any was asked to.
        pub fn agree(&mut self, own: Agreement) -> Result<Agreement, CommError> {
            Ok(own)
        }

        pub(crate) fn compare(&mut self, _text: &str) -> Result<(), RunError> {
            Ok(())
        }

        /// Does all pieces of independent work on as many threads as there are `jobs`, until so many have failed.
        pub fn share(
            &mut self,
            pieces: &[usize],
            jobs: usize,
            most_failures: Option<usize>,
            work: &(dyn Fn(usize) -> PieceEnd + Sync),
        ) -> Result<(), RunFailure> {
            Ok(WorkQueue::new(pieces, most_failures).share(jobs, work)?)
        }

        /// The sums of two counts over all processes.
        pub fn sum(&mut self, one: usize, other: usize) -> Result<(usize, usize), CommError> {
            Ok((one, other))
        }

        /// Leaves the other processes in good order.
        pub fn finish(self) {}

        /// Ends all processes with this exit status after `report` said why; this one, if it is alone, ends itself as it likes.
        pub fn fail(self, _status: u8, _report: impl FnOnce()) {}
    }
}
