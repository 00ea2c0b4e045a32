//! Figures, drawn by the program itself with a font of its own: they look alike on every machine.
//!
//! | what | where |
//! |---|---|
//! | a page and what is put on it: lines, areas, bitmaps, text | [`canvas`] |
//! | colours and the colour map | [`colour`] |
//! | a box with axes round it | [`axes`] |
//! | where ticks are and what they say | [`ticks`] |
//! | a map of heights, reduced to what a picture shows | [`raster`] |
//! | its colour bar | [`colour_bar`] |
//! | map, histogram and Abbott-Firestone curve of surfaces | [`surface`] |

mod axes;
mod canvas;
mod colour;
mod colour_bar;
mod histogram;
mod raster;
mod surface;
mod ticks;
mod unit;

pub use colour::viridis;
pub use surface::{Drawn, SurfaceFigure, surfaces};
