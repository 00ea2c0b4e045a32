//! Figures, drawn by the program itself with a font of its own: they look alike on every machine.
//!
//! | what | where |
//! |---|---|
//! | a page and what is put on it: lines, areas, bitmaps, text | [`canvas`] |
//! | the pixels that a line covers | [`brush`] |
//! | the font | [`font`] |
//! | a box with axes round it | [`axes`] |
//! | where ticks are and what they say | [`ticks`] |
//! | a map of heights, reduced to what a picture shows | [`raster`] |
//! | a bitmap of few colours | [`picture`] |
//! | the colour bar of a map | [`colour_bar`] |
//! | curves with no more places than there is to see | [`simplify`] |
//! | colour, width and dashes of lines | [`stroke`] |
//! | a page as plain data | [`page`], drawn as PNG, SVG or PDF by [`mod@format`] |
//! | what is too high for a page of a journal on several of them | [`pages`] |
//! | charts beside and below each other | [`chart`] |
//! | map, histogram and Abbott-Firestone curve of surfaces | [`surface_description`], [`surface_map`], [`surface_charts`] |
//! | the fibre map of a pin beside its micrograph | [`fibre_map`] |
//! | labels beside points | [`labels`] |
//! | the figures of runs | [`run`] |
//! | error against run time | [`accuracy`] |

pub mod accuracy;
mod axes;
mod brush;
mod canvas;
mod chart;
mod colour_bar;
pub mod fibre_map;
mod font;
mod format;
mod histogram;
mod labels;
mod page;
mod pages;
mod picture;
mod raster;
pub mod run;
mod simplify;
mod stroke;
mod surface_charts;
pub mod surface_description;
mod surface_map;
mod ticks;

pub use crate::colour::ColourMap;
pub use canvas::FigureError;
pub use format::{Figure, Format};
