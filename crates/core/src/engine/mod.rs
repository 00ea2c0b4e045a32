//! The steps of the model, fast: eight cells at a time, on any number of workers, with sums that do not depend on an order.
//!
//! From what is lowest to what is on top:
//!
//! | module | what it is |
//! |---|---|
//! | [`lanes`] | what the kernels ask of a processor |
//! | [`exact`], [`sums`], [`sum`] | sums as integers, so that the order of cells does not show; sums over time that do not drift |
//! | [`strips`], [`sector`] | heights as the kernels read them; the ring in sectors and bands |
//! | [`parts`] | which parts of the model a scene needs |
//! | [`pair`], [`wear`], [`plateau`], [`debris`] | the rules, one for each file |
//! | [`contact`], [`forecast`] | the displacement, and where it is expected next |
//! | [`kernel`] | the loops over cells |
//! | [`history`], [`filling`] | what is added up over steps and cells to be reported |
//! | [`comm`] | what workers tell each other: one, threads, or ranks of an MPI job |
//! | `worker`, `crew` | the step that all workers take together, and the threads that take it |

pub mod comm;
pub mod contact;
pub(crate) mod crew;
pub mod debris;
pub mod exact;
pub mod filling;
pub mod forecast;
pub mod history;
pub mod kernel;
pub mod lanes;
pub mod pair;
pub mod parts;
pub mod plateau;
pub mod sector;
pub mod strips;
pub mod sum;
pub mod sums;
pub mod wear;
pub(crate) mod worker;
