//! What worker threads do when one of them panics.

use std::sync::Arc;
use std::sync::mpsc::channel;
use std::time::Duration;

use super::*;
use crate::engine::comm::Communicator;
use crate::engine::comm::threads::Threads;
use crate::engine::execution::{Decomposition, Execution};
use crate::engine::kernel::InstructionSet;
use crate::engine::sector::Partition;
use crate::engine::strips::PinStrips;
use crate::model::mesh::Mesh;
use crate::model::parameters::{Parameters, PlateauRules};
use crate::model::state::{Base, InitialSurfaces};

const WORKERS: usize = 3;

/// No threads take nearly as long to take their steps or to end; those that do hang.
const PATIENCE: Duration = Duration::from_secs(60);

/// When a worker panics: around one of its calls to the others, counted from 0.
#[derive(Debug, Clone, Copy)]
struct Fault {
    call: u64,
    /// Before the others get its message, or when they have it and may go on without waiting for it.
    before: bool,
}

/// Threads, one of which has a fault.
#[derive(Debug)]
struct Faulty {
    threads: Threads,
    fault: Option<Fault>,
    calls: u64,
    /// Shared by all that have not ended.
    _alive: Arc<()>,
}

impl Faulty {
    fn call(&mut self, call: impl FnOnce(&mut Threads) -> Result<(), CommError>) -> Result<(), CommError> {
        let fault = self.fault.filter(|fault| fault.call == self.calls);
        self.calls += 1;
        let panics = |before| assert!(fault.is_none_or(|fault| fault.before != before), "out of paper");
        panics(true);
        let result = call(&mut self.threads);
        panics(false);
        result
    }
}

impl Communicator for Faulty {
    fn rank(&self) -> usize {
        self.threads.rank()
    }

    fn size(&self) -> usize {
        self.threads.size()
    }

    fn send_halo(&mut self, boundary: usize, to: usize, words: &[u64]) -> Result<(), CommError> {
        self.call(|threads| threads.send_halo(boundary, to, words))
    }

    fn receive_halo(&mut self, boundary: usize, from: usize, words: &mut [u64]) -> Result<(), CommError> {
        self.call(|threads| threads.receive_halo(boundary, from, words))
    }

    fn all_gather(&mut self, words: &[u64], each: &mut dyn FnMut(usize, &[u64])) -> Result<(), CommError> {
        self.call(|threads| threads.all_gather(words, each))
    }
}

/// Threads whose worker `rank` has this fault, and what its workers share until they end.
fn start(rank: usize, fault: Option<Fault>) -> (WorkerThreads, Arc<()>) {
    let mesh = Mesh::new(3, 40, 11, 20e-3, 20.15e-3).unwrap();
    let parameters = Parameters { mesh, normal_force: 1.0, plateaus: PlateauRules::pool(0.5), ..Parameters::paper() };
    let (mesh, parameters) = (parameters.mesh.clone(), Arc::new(parameters));
    let surfaces = InitialSurfaces {
        disc_height: (0..mesh.disc_cells()).map(|cell| (cell * 7 % 11) as f64 * 1e-7).collect(),
        pin_height: (0..mesh.pin_cells()).map(|cell| (cell * 5 % 13) as f64 * 1e-7).collect(),
        pin_base: vec![Base::Primary; mesh.pin_cells()],
    };
    let partition = Arc::new(Partition::new(&mesh, WORKERS, Decomposition::Auto, 2));
    let alive = Arc::new(());
    let worker = |threads: Threads| {
        let alarm = threads.alarm();
        let fault = fault.filter(|_| threads.rank() == rank);
        let faulty = Faulty { threads, fault, calls: 0, _alive: alive.clone() };
        let execution = Execution { instructions: InstructionSet::PORTABLE, ..Execution::default() };
        (Worker::new(parameters.clone(), &surfaces, partition.clone(), execution, 0, Box::new(faulty)), alarm)
    };
    let threads = Threads::connect(WORKERS, partition.messages(), PinStrips::crossing_words(mesh.rows()));
    let workers = threads.into_iter().map(worker).collect();
    (WorkerThreads::start(workers, false).unwrap(), alive)
}

/// Does something that must not hang.
fn within_patience<T: Send + 'static>(what: &str, work: impl FnOnce() -> T + Send + 'static) -> T {
    let (done, result) = channel();
    std::thread::spawn(move || done.send(work()));
    result.recv_timeout(PATIENCE).unwrap_or_else(|error| panic!("{what}: {error}"))
}

#[test]
fn threads_without_a_fault_take_their_steps_and_end() {
    let alive = within_patience("the threads", || {
        let (mut threads, alive) = start(0, None);
        threads.advance_to(40, true).unwrap();
        assert_eq!((threads.course().steps, threads.sample().unwrap().step), (40, 40));
        drop(threads);
        Arc::strong_count(&alive)
    });
    assert_eq!(alive, 1, "a thread goes on");
}

#[test]
fn a_panic_in_one_worker_ends_all_with_its_name() {
    for rank in 0..WORKERS {
        // The first gatherings of step 1, handed columns and gatherings of the steps after it, samples and maps.
        for call in (0..12).chain([25, 50, 75, 100]) {
            for before in [true, false] {
                let what = format!("worker {rank} panics at call {call}, {}", if before { "before" } else { "after" });
                let (failures, alive) = within_patience(&what, move || {
                    let (mut threads, alive) = start(rank, Some(Fault { call, before }));
                    // Where it panics after its last message of an order, the others notice with the next order.
                    let mut orders = (1..200).map(|step| {
                        threads.advance_to(step, true)?;
                        threads.sample()?;
                        threads.snapshot(&Map::ALL).map(drop)
                    });
                    let first = orders.find_map(Result::err);
                    let failures = [
                        first,
                        threads.advance_to(1000, true).err(),
                        threads.sample().err(),
                        threads.snapshot(&Map::ALL).err(),
                    ];
                    drop(threads);
                    (failures, Arc::strong_count(&alive))
                });
                let message = "out of paper".into();
                let failure = SimulationError::from(CommError::Worker { worker: rank, message });
                assert_eq!(failures, [(); 4].map(|()| Some(failure.clone())), "{what}");
                assert_eq!(alive, 1, "{what}: a thread goes on");
            }
        }
    }
}
