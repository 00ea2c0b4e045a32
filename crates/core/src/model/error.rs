//! Errors of a load balance that fails, and of a simulation that cannot start or go on.

use thiserror::Error;

/// Error of a load that no displacement carries.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum ContactError {
    #[error(
        "the load balance has no finite solution (displacement {displacement:e} m carries {load:e} N of \
         {normal_force:e} N): heights, stiffness or load are out of the range of floating-point numbers"
    )]
    NotFinite { displacement: f64, load: f64, normal_force: f64 },
    #[error(
        "nothing carries the load of {normal_force:e} N: beside gaps of {displacement:e} m, the overlap that carries it is \
         smaller than the rounding of a number; check the unit and the scale of the heights"
    )]
    NotCarried { displacement: f64, normal_force: f64 },
}

/// Error of a simulation that cannot start or go on.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum SimulationError {
    #[error("the initial surfaces do not fit the mesh: expected {disc} disc cells and {pin} pin cells")]
    Size { disc: usize, pin: usize },
    #[error("{count} of the {surface}'s initial heights are not finite")]
    Height { surface: &'static str, count: usize },
    #[error("step {step}: {source}")]
    Contact {
        /// The step, counted from 1.
        step: u64,
        source: ContactError,
    },
    #[error(
        "step {step}: the coefficient of friction has come to {coefficient}, expected at least 0.01: no load that this model \
         holds for gives the braking torque; look at [friction] and its factor over temperature, or give a load"
    )]
    NoFriction {
        /// The step, counted from 1.
        step: u64,
        coefficient: f64,
    },
    #[error(
        "after step {step} {what} is {found}: no number holds what this scene asks for; look for a wrong unit among its moduli, \
         wear rates and lengths, or accelerate less"
    )]
    NotFinite { step: u64, what: String, found: f64 },
    #[error("the pressures of step {step} were not kept: take it with `advance_to`")]
    NotWatched { step: u64 },
    #[error("the {what} is {found}, expected a finite number of more than 0")]
    Operation { what: &'static str, found: f64 },
    #[error(
        "at a rotational speed of {found:e} rad/s a step takes {step_time:e} s, which is lost in a time of {time} s or endless: expected \
         one nearer to {now} rad/s, that of the last step"
    )]
    TimeLost { found: f64, step_time: f64, time: f64, now: f64 },
    #[error("load and speed are those of the scene's cycle: leave out [operation.cycle] to set them between steps")]
    OfCycle,
    #[error("{field} at (column {column}, row {row}) is {found}, expected {expected}")]
    Cell { field: &'static str, column: usize, row: usize, found: f64, expected: String },
    /// A checkpoint is of another mesh.
    #[error(transparent)]
    Checkpoint(#[from] WrongMesh),
    #[error("the checkpoint has other {what} than the scene asks for: it is of another scene, or damaged; begin again")]
    OtherState { what: &'static str },
    #[error(
        "the checkpoint is of the {found} engine, expected one of the {expected} engine; go on with --engine {found}"
    )]
    OtherEngine { found: &'static str, expected: &'static str },
    #[error(
        "the plain model runs in one process, there are {ranks} ranks: start one, or leave out --engine plain; pooled debris \
         (plateaus.debris = \"contact\" or \"track\") runs on the plain model alone"
    )]
    PlainOnRanks { ranks: usize },
    /// A worker failed.
    #[error("{message}")]
    Worker {
        /// Number of the worker, and its message.
        message: String,
    },
    #[error("cannot start {workers} worker threads: {message}; ask for fewer workers")]
    Threads { workers: usize, message: String },
}

/// Error of a checkpoint that is of another mesh.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the checkpoint is of another mesh: {found} {body} cells, expected {expected}")]
pub struct WrongMesh {
    /// Disc or pin.
    pub body: &'static str,
    /// Cells of the checkpoint.
    pub found: usize,
    /// Cells of the simulation.
    pub expected: usize,
}
