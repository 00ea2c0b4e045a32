//! The ranks of an MPI job: all run the same scene, the first one writes the run file and talks to the user.

use std::thread;
use std::time::Duration;

use plateau_core::engine::comm::mpi::{Mpi, Session};
use plateau_core::engine::comm::{CommError, Communicator as _};
use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::InitialSurfaces;
use plateau_core::simulation::{Execution, Simulation, SimulationError};

use super::share::Hand;
use super::{Agreement, Went};
use crate::failure::Failure;
use crate::message;

/// Between two looks for ranks that want work.
const PAUSE: Duration = Duration::from_millis(1);

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

    /// What all ranks do alike: they stop and save if any was asked to, and take as many steps as the first, for clocks
    /// differ.
    pub fn agree(&mut self, own: Agreement) -> Result<Agreement, CommError> {
        let (mut largest, mut save, mut first) = (0, false, own.steps);
        let words = [own.signal.unwrap_or(0).into(), own.steps, own.save.into()];
        self.meeting.all_gather(&words, &mut |rank, words| {
            largest = largest.max(words[0]);
            save |= words[2] == 1;
            if rank == 0 {
                first = words[1];
            }
        })?;
        let signal = u8::try_from(largest).ok().filter(|signal| *signal != 0);
        Ok(Agreement { signal, save, steps: first })
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

    /// Does all pieces of independent work, each on one rank, until so many have failed. A single rank has as many threads
    /// as there are `jobs`, several have one each; rank 0 hands the pieces out while a thread of its own works. Only its
    /// `pieces` count: another rank may see what is to be done a moment later, when some of it is done.
    pub fn share(
        &mut self,
        pieces: &[usize],
        jobs: usize,
        most_failures: Option<usize>,
        work: &(dyn Fn(usize) -> Went + Sync),
    ) -> Result<(), Failure> {
        if self.ranks() == 1 {
            return Hand::new(pieces, most_failures).share(jobs, work).map_err(Failure::run);
        }
        let queue = self.session.work_queue();
        if !self.leads() {
            let mut went = Went::Well;
            while let Some(piece) = queue.ask(went as u64) {
                went = work(piece);
                if went == Went::Stopped {
                    break;
                }
            }
            if went == Went::Stopped {
                queue.ask(went as u64);
            }
            return Ok(());
        }
        let hand = Hand::new(pieces, most_failures);
        thread::scope(|scope| {
            let own = scope.spawn(|| hand.work(work));
            let mut others = self.ranks() - 1;
            while others > 0 || !own.is_finished() {
                let Some((rank, word)) = queue.request() else {
                    thread::sleep(PAUSE);
                    continue;
                };
                let went = [Went::Well, Went::Wrong, Went::Stopped].into_iter().find(|went| *went as u64 == word);
                hand.note(went.unwrap_or(Went::Well));
                // Who stopped wants no more.
                let piece = if went == Some(Went::Stopped) { None } else { hand.next() };
                others -= usize::from(piece.is_none());
                queue.answer(rank, piece);
            }
        });
        Ok(())
    }

    /// The sums of two counts over all ranks.
    pub fn sum(&mut self, one: usize, other: usize) -> Result<(usize, usize), Failure> {
        let mut sums = (0, 0);
        self.meeting
            .all_gather(&[one as u64, other as u64], &mut |_, words| {
                sums = (sums.0 + words[0] as usize, sums.1 + words[1] as usize);
            })
            .map_err(Failure::run)?;
        Ok(sums)
    }

    /// Leaves the other ranks in good order; if this rank failed, all end with its exit status. Says why they were stopped while
    /// all are still there: the launcher ends the others as soon as one is gone with a status other than 0.
    pub fn end(self, result: Result<(), Failure>) -> Result<(), Failure> {
        match result {
            Ok(()) => {
                self.session.finish();
                Ok(())
            }
            // All ranks were stopped together.
            Err(failure @ Failure::Stopped { signal, .. }) => {
                failure.say();
                self.session.finish();
                Err(Failure::Stopped { signal, message: None })
            }
            Err(failure) => self.session.fail(failure.status(), || failure.say()),
        }
    }
}
