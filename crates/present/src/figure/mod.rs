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
//! | lines of equal value | [`contour`] |
//! | the rim of places | [`hull`] |
//! | the figures of runs | [`run`] |
//! | the figures of studies | [`effects`], [`optimum`] |
//! | error against run time | [`accuracy`] |
//! | what a fit to an experiment tells of the keys; of a whole series | [`fit`], [`fit_series`] |
//! | parts of a response's variation | [`sensitivity`] |

pub mod accuracy;
mod axes;
mod brush;
mod canvas;
mod chart;
mod colour_bar;
mod contour;
pub mod effects;
pub mod fibre_map;
pub mod fit;
pub mod fit_series;
mod font;
mod format;
mod histogram;
mod hull;
mod labels;
pub mod optimum;
mod page;
mod pages;
mod picture;
mod raster;
pub mod run;
pub mod sensitivity;
mod simplify;
mod stroke;
mod surface_charts;
pub mod surface_description;
mod surface_map;
mod ticks;

pub use crate::colour::ColourMap;
pub use canvas::FigureError;
pub use format::{Figure, Format};
