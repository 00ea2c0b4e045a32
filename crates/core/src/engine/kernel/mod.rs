//! The loops over cells.
//!
//! Each is written once, for eight cells at a time, and compiled for several instruction sets, of which the widest that
//! the processor has is chosen at start. What they sum up does not depend on the order of the cells.

mod deposit;
mod edge;
mod edges;
mod instructions;
mod moved;
mod ordinary;
mod pairs;
mod pass;
mod read;
mod reading;
mod rules;
mod strip;
mod worn;
mod worn_column;

pub(crate) use edge::Edge;
pub(crate) use edges::{EdgeOf, edge_of};
pub use instructions::InstructionSet;
pub(crate) use moved::Moved;
pub(crate) use pairs::PLATEAU;
pub(crate) use pass::{Pass, pass};
pub(crate) use read::{Read, Span, gaps_below, read};
pub(crate) use reading::{Bracket, NearPair, Reading, told_apart};
pub(crate) use rules::{Conditions, Rules};
