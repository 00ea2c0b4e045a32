//! What runs and surfaces look like: nothing here reads arguments or talks to a terminal.
//!
//! | what | where |
//! |---|---|
//! | figures as PNG, SVG and PDF | [`figure`] |
//! | HTML pages | [`report`] |
//! | a run that goes on, as lines and as a page of text | [`watch`] |
//! | tables as text and as CSV | [`table`], [`csv_table`] |
//! | what is shown: titles, units, signs, colour maps | [`quantity`], [`colour`] |
//! | numbers as people read them | [`plateau_io::number`] |
//! | many values as few, with their envelope | [`envelope`] |
//! | what runs are called | [`label`] |
//! | what the time acceleration that a run chose was like, in words | [`acceleration`] |
//! | whether a run is still running in, and of which time its contact area is, in words | [`running_in`] |

// The tables of files are for those who read the source: they name what is private, too.
#![allow(rustdoc::private_intra_doc_links)]

pub mod acceleration;
mod colour;
pub mod csv_table;
mod deflate;
mod envelope;
pub mod figure;
pub mod label;
mod quantity;
pub mod report;
pub mod running_in;
pub mod table;
pub mod watch;

pub use quantity::Unit;
