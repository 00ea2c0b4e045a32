//! One self-contained HTML page about one run or several: `plateau report`.
//!
//! The page is made of a template and of parts that are written here; scripts on the page draw its charts and maps from
//! one JSON document in it, so it needs no network and nothing beside it.
//!
//! | what | where |
//! |---|---|
//! | the template with its parts filled in | [`mod@page`], [`section`], [`template`] |
//! | text as HTML, tables | [`html`] |
//! | units in which people read a quantity | [`mod@unit`] |
//! | a series with its last and largest value, thinned | [`recorded`], [`thin`] |
//! | how the runs ended, and the comparison with the first | [`outcome`], [`comparison`] |
//! | scenes, and in which keys they differ | [`scene`] |
//! | where the run files come from | [`provenance`] |
//! | the JSON document of the page | [`document`] |
//! | maps for the page, no larger than allowed | [`maps`], [`reduction`], [`coarsen`] |
//! | numbers as few bytes, bytes as text | [`quantise`], [`pack`] |
//! | figures made by the program | [`picture`] |

mod coarsen;
mod comparison;
mod document;
mod html;
mod maps;
mod outcome;
mod pack;
mod page;
mod picture;
mod provenance;
mod quantise;
mod recorded;
mod reduction;
mod scene;
mod section;
mod template;
mod thin;
mod unit;

pub use page::page;
pub use picture::Pictures;
