//! The loops over cells.
//!
//! Each works on one column at a time, row by row, without branches, so that the compiler makes vector code of it; and
//! what is summed is summed row by row in the order of the columns, so that the sums are the same on every machine.
//! Each is compiled for several instruction sets, of which the widest that the processor has is chosen at start.

mod columns;
mod instructions;
mod load;
mod update;

pub use columns::{DiscColumn, DiscView, PinColumn, PinView};
pub use instructions::InstructionSet;
pub use load::{add_load, face_column};
pub use update::{Outlook, Update, update};
