//! What `plateau watch` sees and shows.
//!
//! | what | where |
//! |---|---|
//! | what a run file says at one moment | [`look`] |
//! | how fast the run is, and whether it still goes on | [`pace`] |
//! | a curve made of characters | [`curve`] |
//! | a look in words and as a page of the terminal | [`page`] |

mod curve;
mod look;
mod pace;
pub mod page;

pub use look::Look;
pub use pace::Pace;
