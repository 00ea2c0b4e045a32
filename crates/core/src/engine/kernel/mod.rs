//! The loops over cells.
//!
//! Each is written once, for eight cells at a time, and compiled for several instruction sets, of which the widest that
//! the processor has is chosen at start. What they sum up does not depend on the order of the cells.

mod ahead;
mod cells;
mod deposit;
mod edge;
mod instructions;
mod local;
mod local_plain;
mod moved;
mod pairs;
mod plain;
mod read;
mod reading;
mod rules;
mod sweep;
mod worn;

pub use ahead::{WearColumn, wear_column};
pub use cells::Sweep;
pub use edge::Edge;
pub use instructions::InstructionSet;

pub use moved::{Moved, SeldomEvent};
pub use read::{Read, Span, read};
pub use reading::{Bracket, NearPair, Reading, told_apart};
pub use rules::{Conditions, Rules};
pub use sweep::sweep;
