//! Worker threads, their orders, and their end.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::thread::JoinHandle;

use crossbeam::channel::{Receiver, Sender, unbounded};

use crate::engine::comm::threads::Alarm;
use crate::engine::comm::{CommError, Exchange};
use crate::engine::worker::{EngineMemory, Worker};
use crate::model::clock::Operation;
use crate::model::error::SimulationError;
use crate::model::memory::{Course, Heights, Memory};
use crate::observe::{Map, Sample, Snapshot};

/// Order to all workers, which they follow together.
#[derive(Debug, Clone)]
enum Order {
    /// Take steps until so many are done, and watch the last or not.
    AdvanceTo(u64, bool),
    /// Change the acceleration.
    Accelerate(f64),
    /// Change load and speed.
    Operate(Operation),
    /// Take over a state.
    Restore(Arc<(Heights, Memory, EngineMemory)>),
    /// Tell what all workers know alike.
    Memory,
    /// Take a sample.
    Sample,
    /// Take maps.
    Snapshot(Vec<Map>),
}

/// Answer of the first worker, for all.
#[derive(Debug)]
enum Answer {
    Course(Course),
    Memory(Box<(Memory, EngineMemory)>),
    Sample(Box<Sample>),
    Snapshot(Snapshot),
}

/// Long-lived threads with a worker each.
#[derive(Debug)]
pub(crate) struct WorkerThreads {
    orders: Vec<Sender<Order>>,
    answers: Receiver<Result<Answer, SimulationError>>,
    threads: Vec<JoinHandle<()>>,
    alarms: Vec<Alarm>,
    course: Course,
    /// Reason that there are no more answers.
    failure: Option<SimulationError>,
}

impl WorkerThreads {
    /// Starts a thread for each worker; with `pin` each stays on a core of its own as far as there are enough.
    ///
    /// # Errors
    /// Error of the system when it gives no more threads.
    pub fn start(workers: Vec<(Worker, Alarm)>, pin: bool) -> std::io::Result<Self> {
        let cores = if pin { core_affinity::get_core_ids().unwrap_or_default() } else { Vec::new() };
        let (answer, answers) = unbounded();
        let (orders, threads) = (Vec::new(), Vec::new());
        let alarms = workers.iter().map(|(_, alarm)| alarm.clone()).collect();
        let mut started = Self { orders, answers, threads, alarms, course: Course::default(), failure: None };
        for (rank, (worker, alarm)) in workers.into_iter().enumerate() {
            let (order, orders) = unbounded();
            let answer = (rank == 0).then(|| answer.clone());
            let core = cores.get(rank % cores.len().max(1)).copied();
            let thread = std::thread::Builder::new().name(format!("worker {rank}")).spawn(move || {
                if let Some(core) = core {
                    core_affinity::set_for_current(core);
                }
                work(rank, worker, &alarm, &orders, answer.as_ref());
            })?;
            started.orders.push(order);
            started.threads.push(thread);
        }
        Ok(started)
    }

    /// Has all workers follow an order; once they could not, the reason is all there is to be had.
    fn ask(&mut self, order: &Order) -> Result<Answer, SimulationError> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone());
        }
        for worker in &self.orders {
            // Who does not listen any more has failed, which the first worker will notice.
            let _ = worker.send(order.clone());
        }
        let gone = || CommError::Worker { worker: 0, message: "it ended before its time".into() };
        let answer = self.answers.recv().unwrap_or_else(|_| Err(gone().into()));
        self.failure = answer.as_ref().err().cloned();
        answer
    }

    /// Takes steps until `step` of them are done; the last may be watched.
    pub fn advance_to(&mut self, step: u64, watched: bool) -> Result<(), SimulationError> {
        self.go(&Order::AdvanceTo(step, watched))
    }

    /// Changes the acceleration of the coming steps.
    pub fn accelerate(&mut self, acceleration: f64) -> Result<(), SimulationError> {
        self.go(&Order::Accelerate(acceleration))
    }

    /// Changes load and speed of the coming steps.
    pub fn operate(&mut self, operation: &Operation) -> Result<(), SimulationError> {
        self.go(&Order::Operate(*operation))
    }

    fn go(&mut self, order: &Order) -> Result<(), SimulationError> {
        match self.ask(order)? {
            Answer::Course(course) => self.course = course,
            answer => unreachable!("{answer:?} to an order to go on"),
        }
        Ok(())
    }

    /// Takes over a state.
    pub fn restore(
        &mut self,
        heights: &Heights,
        memory: &Memory,
        engine: &EngineMemory,
    ) -> Result<(), SimulationError> {
        self.go(&Order::Restore(Arc::new((heights.clone(), memory.clone(), engine.clone()))))
    }

    /// Returns the state that all workers know alike.
    pub fn memory(&mut self) -> Result<(Memory, EngineMemory), SimulationError> {
        match self.ask(&Order::Memory)? {
            Answer::Memory(memory) => Ok(*memory),
            answer => unreachable!("{answer:?} to an order for the memory"),
        }
    }

    /// The reported quantities after the last step.
    pub fn sample(&mut self) -> Result<Sample, SimulationError> {
        match self.ask(&Order::Sample)? {
            Answer::Sample(sample) => Ok(*sample),
            answer => unreachable!("{answer:?} to an order for a sample"),
        }
    }

    /// The maps asked for, as they are now.
    pub fn snapshot(&mut self, maps: &[Map]) -> Result<Snapshot, SimulationError> {
        match self.ask(&Order::Snapshot(maps.to_vec()))? {
            Answer::Snapshot(snapshot) => Ok(snapshot),
            answer => unreachable!("{answer:?} to an order for maps"),
        }
    }

    /// Returns the summary of the steps so far.
    pub fn course(&self) -> Course {
        self.course
    }

    /// Returns the time and bytes of each worker's exchange so far.
    pub fn exchanges(&self) -> Vec<Exchange> {
        self.alarms.iter().map(Alarm::exchange).collect()
    }
}

impl Drop for WorkerThreads {
    fn drop(&mut self) {
        // A worker without orders ends.
        self.orders.clear();
        for thread in self.threads.drain(..) {
            // A panic was reported when it happened.
            let _ = thread.join();
        }
    }
}

/// Follows orders until there are no more, or one cannot be followed.
fn work(
    rank: usize,
    mut worker: Worker,
    alarm: &Alarm,
    orders: &Receiver<Order>,
    answers: Option<&Sender<Result<Answer, SimulationError>>>,
) {
    while let Ok(order) = orders.recv() {
        let result = catch_unwind(AssertUnwindSafe(|| follow(&mut worker, &order))).unwrap_or_else(|panic| {
            let message = panic_message(panic.as_ref());
            alarm.raise(message.clone());
            Err(CommError::Worker { worker: rank, message }.into())
        });
        let failed = result.is_err();
        if let Some(answers) = answers {
            // Nobody waits for an answer any more when the simulation is dropped.
            let _ = answers.send(result);
        }
        if failed {
            return;
        }
    }
}

fn follow(worker: &mut Worker, order: &Order) -> Result<Answer, SimulationError> {
    match order {
        Order::AdvanceTo(step, watched) => worker.advance_to(*step, *watched).map(|()| Answer::Course(worker.course())),
        Order::Accelerate(acceleration) => worker.accelerate(*acceleration).map(|()| Answer::Course(worker.course())),
        Order::Operate(operation) => worker.operate(operation).map(|()| Answer::Course(worker.course())),
        Order::Restore(state) => {
            let (heights, memory, engine) = &**state;
            worker.restore(heights, memory, engine).map(|()| Answer::Course(worker.course()))
        }
        Order::Memory => Ok(Answer::Memory(Box::new(worker.memory()))),
        Order::Sample => worker.sample().map(|sample| Answer::Sample(Box::new(sample))),
        Order::Snapshot(maps) => worker.snapshot(maps).map(Answer::Snapshot),
    }
}

fn panic_message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "it panicked".into())
}

#[cfg(test)]
#[path = "../../tests/unit/engine/worker_threads.rs"]
mod tests;
