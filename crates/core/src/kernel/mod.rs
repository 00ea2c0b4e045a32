//! The loops over cells: one body each, written for a fixed number of lanes, so that the compiler makes vector code of
//! it and every sum is taken in the same order on every machine.

mod cells;
mod lanes;
mod load;
mod update;

pub use cells::{DiscColumn, DiscView, PinColumn, PinView};
pub use lanes::{LANES, Lanes, Mask};
pub use load::{Load, count_touching, face_column, load_of_column};
pub use update::{Outlook, Update, update};
