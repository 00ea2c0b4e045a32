//! The model as it is read: state (section 2) and one step (section 4), on plain arrays, cell by cell, in the order of the text.
//!
//! Nothing here is fast, and nothing is done twice for speed: [`step`] is what the engine is held
//! against, step by step. `plateau run --engine plain` drives it in place of the engine.
//!
//! | model | rule | function |
//! |---|---|---|
//! | 1, 2 | which cells face each other, and their statuses | [`step::pairs`] |
//! | 4.1 | the displacement that carries the load | [`step::balance`] |
//! | 4.2 | wear, build-up first | [`step::wear`] |
//! | 4.2a | strength of build-up | [`step::break_away`] |
//! | 4L | local debris: what wears ahead fills the gap behind it | [`step::deposit_locally`] |
//! | 4L | the same over a transport length | [`step::deposit_over`] |
//! | 4P | loss of support | [`step::destroy`] |
//! | 4P | pooled debris fills open cells | [`step::form`] |
//! | 4P | what is in a pool | [`step::pool`] |
//! | 4.6 | all of these, once | [`step::advance`] |
//! | 9 | load and speed that change | [`cycle`] |
//! | 10 | friction | [`friction::Friction::coefficient`] |
//! | 11 | heat | [`heat`] |
//! | 12 | emission | [`emission::Emission::mass`] |

pub mod accounts;
pub mod brake;
pub mod clock;
pub mod cycle;
pub mod emission;
pub mod error;
pub mod first_contact;
pub mod friction;
pub mod heat;
pub mod material;
pub mod memory;
pub mod mesh;
pub mod parameters;
pub mod state;
pub mod step;
pub(crate) mod sums;
pub mod thermal;
pub mod totals;

pub use self::state::State;
pub use self::step::{REACH, Step};
pub use self::totals::Volumes;
