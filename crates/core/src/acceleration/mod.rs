//! Time acceleration that a run chooses as it goes, and where it may not (model 4.6).

mod choice;
pub mod scout;

pub use choice::{Adaptive, Choice, Chosen, RATIO};
