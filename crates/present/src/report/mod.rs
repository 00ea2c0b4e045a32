//! Self-contained HTML pages: about one run or several (`plateau report`).
//!
//! A page is made of a template and of parts that are written here; scripts on the page draw what is to be played with
//! from one JSON document in it, so it needs no network and nothing beside it.
//!
//! | what | where |
//! |---|---|
//! | what all pages have in common: the template with its parts filled in | [`layout`] |
//! | the page about runs | [`mod@page`] |
//! | text as HTML, tables | [`html`] |
//! | a series with its last and largest value, thinned | [`series`] |
//! | how the runs ended, and the comparison with the first | [`outcome`], [`comparison`] |
//! | the same of friction, heat and emission, of runs that have them | [`dissipation`] |
//! | the events of a cycle | [`events`] |
//! | where the run files come from, in which keys their scenes differ | [`provenance`] |
//! | the JSON document of the page | [`document`] |
//! | maps for the page, no larger than allowed | [`maps`], [`reduction`] |
//! | numbers as few bytes, bytes as text | [`pack`] |
//! | figures made by the program | [`picture`] |

mod comparison;
mod dissipation;
mod document;
mod events;
mod html;
mod layout;
mod maps;
mod outcome;
mod pack;
mod page;
mod picture;
mod provenance;
mod reduction;
mod series;

pub use page::page;
pub use picture::{Picture, Pictures};
