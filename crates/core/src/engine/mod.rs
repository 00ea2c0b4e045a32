//! The steps of the model, fast: eight cells at a time, on any number of workers, with sums that do not depend on an order.
//!
//! From what is lowest to what is on top:
//!
//! | module | what it is |
//! |---|---|
//! | `lanes` | what the kernels ask of a processor |
//! | `exact`, `sums` | sums as integers, so that the order of cells does not show |
//! | `strips`, `sector` | heights as the kernels read them, and which cells of the pin are there; the ring in sectors and bands |
//! | [`parts`] | which parts of the model a scene needs |
//! | `coefficients`, `wear`, `debris` | the rules, one for each file |
//! | `contact`, `forecast` | the displacement, and where it is expected next |
//! | [`kernel`] | the loops over cells |
//! | `filling` | what is added up over cells to be reported |
//! | `execution` | how the steps are taken |
//! | [`comm`] | what workers tell each other: one, threads, or ranks of an MPI job |
//! | `worker`, `worker_threads` | the step that all workers take together and what is kept to go on later, and the threads that take it |

pub(crate) mod coefficients;
pub mod comm;
pub(crate) mod contact;
pub(crate) mod debris;
pub(crate) mod exact;
pub(crate) mod execution;
pub(crate) mod filling;
pub(crate) mod forecast;
pub mod kernel;
pub(crate) mod lanes;
pub mod parts;
pub(crate) mod sector;
pub(crate) mod strips;
pub(crate) mod sums;
pub(crate) mod wear;
pub(crate) mod worker;
pub(crate) mod worker_threads;
