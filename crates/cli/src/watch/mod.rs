//! A run that `plateau watch` follows.
//!
//! | content | module |
//! |---|---|
//! | a run file at one moment, and the pace of its run | [`look`] |
//! | a look in words and as a page of the terminal | [`page`] |

mod look;
pub mod page;

pub use look::{Look, Pace};
