//! Why a load balance fails, and a simulation cannot start or go on.

use thiserror::Error;

/// Why no displacement carries the load.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ContactError {
    /// Heights or stiffness left the range of floating-point numbers.
    #[error(
        "the load balance has no finite solution (displacement {displacement:e} m carries {load:e} N of \
         {normal_force:e} N): heights, stiffness or load are out of the range of floating-point numbers"
    )]
    NotFinite {
        /// δ reached, m.
        displacement: f64,
        /// Σ k A u there, N.
        load: f64,
        /// F_N, N.
        normal_force: f64,
    },
    /// The overlap that carries the load is less than the rounding of the heights.
    #[error(
        "nothing carries the load of {normal_force:e} N: beside gaps of {displacement:e} m, the overlap that carries it is \
         smaller than the rounding of a number; check the unit and the scale of the heights"
    )]
    NotCarried {
        /// δ reached, m.
        displacement: f64,
        /// F_N, N.
        normal_force: f64,
    },
}

/// Why a simulation cannot start or go on.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SimulationError {
    /// The initial surfaces do not have the mesh's size.
    #[error("the initial surfaces do not fit the mesh: expected {disc} disc cells and {pin} pin cells")]
    Size {
        /// Cells of the disc mesh.
        disc: usize,
        /// Cells of the pin mesh.
        pin: usize,
    },
    /// An initial height is infinite or not a number.
    #[error("{count} of the {surface}'s initial heights are not finite")]
    Height {
        /// Disc or pin.
        surface: &'static str,
        /// How many.
        count: usize,
    },
    /// The load balance failed.
    #[error("step {step}: {source}")]
    Contact {
        /// The step, counted from 1.
        step: u64,
        /// What went wrong.
        source: ContactError,
    },
    /// Friction is too little for a braking torque.
    #[error(
        "step {step}: the coefficient of friction has come to {coefficient}, expected at least 0.01: no load that this model \
         holds for gives the braking torque; look at [friction] and its factor over temperature, or give a load"
    )]
    NoFriction {
        /// The step, counted from 1.
        step: u64,
        /// μ of the step before.
        coefficient: f64,
    },
    /// What the steps have come to is no number any more.
    #[error(
        "after step {step} {what} is {found}: no number holds what this scene asks for; look for a wrong unit among its moduli, \
         wear rates and lengths, or accelerate less"
    )]
    NotFinite {
        /// Steps done when that was seen.
        step: u64,
        /// What it is.
        what: String,
        /// Infinite, or not a number.
        found: f64,
    },
    /// Pressures are asked for that were not kept.
    #[error("the pressures of step {step} were not kept: take it with `advance_to`")]
    NotWatched {
        /// The last step.
        step: u64,
    },
    /// Load or speed that no step can have.
    #[error("the {what} is {found}, expected a finite number of more than 0")]
    Operation {
        /// Load or speed.
        what: &'static str,
        /// What was given.
        found: f64,
    },
    /// Load and speed are set where a cycle gives them.
    #[error("load and speed are those of the scene's cycle: leave out [operation.cycle] to set them between steps")]
    OfCycle,
    /// A height is set that no cell can have.
    #[error("{field} at (column {column}, row {row}) is {found}, expected {expected}")]
    Cell {
        /// Which field of heights.
        field: &'static str,
        /// Column of the cell.
        column: usize,
        /// Row of the cell.
        row: usize,
        /// The height, m.
        found: f64,
        /// What it should be.
        expected: String,
    },
    /// A checkpoint is of another mesh.
    #[error(transparent)]
    Checkpoint(#[from] WrongMesh),
    /// A checkpoint is of another scene, or of nothing.
    #[error("the checkpoint has other {what} than the scene asks for: it is of another scene, or damaged; begin again")]
    OtherState {
        /// What differs.
        what: &'static str,
    },
    /// A checkpoint is of the other engine.
    #[error(
        "the checkpoint is of the {found} engine, expected one of the {expected} engine; go on with --engine {found}"
    )]
    OtherEngine {
        /// That of the checkpoint.
        found: &'static str,
        /// That of the simulation.
        expected: &'static str,
    },
    /// The plain model is to run on the ranks of an MPI job.
    #[error(
        "the plain model runs in one process, there are {ranks} ranks: start one, or leave out --engine plain; pooled debris \
         (plateaus.debris = \"contact\" or \"track\") runs on the plain model alone"
    )]
    PlainOnRanks {
        /// How many there are.
        ranks: usize,
    },
    /// A worker failed.
    #[error("{message}")]
    Worker {
        /// Which, and what it said.
        message: String,
    },
    /// The system gives no more threads.
    #[error("cannot start {workers} worker threads: {message}; ask for fewer workers")]
    Threads {
        /// How many were asked for.
        workers: usize,
        /// What the system says.
        message: String,
    },
}

/// Why a simulation cannot go on from a checkpoint.
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
