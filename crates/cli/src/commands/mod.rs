//! Commands, one file or folder for each.

pub mod accuracy;
pub mod check;
pub mod new;
pub mod reference;
pub mod repair;
pub mod run;
pub mod runs;
pub mod surface;
pub mod sweep;
pub mod verify;
pub mod watch;
