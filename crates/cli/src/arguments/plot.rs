//! Which figures `plateau plot` draws, and how they look.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use plateau_io::units::Dimension;
use plateau_present::figure::run::NAMES;
use plateau_present::figure::{ColourMap, Format};

use super::quantity::{quantity, run_time};

/// Arguments of `plateau plot`.
#[derive(Debug, Args)]
pub struct PlotArguments {
    /// Run files, also of runs that go on or were stopped; at most 8
    #[arg(value_name = "RUN", required = true)]
    pub runs: Vec<PathBuf>,
    /// Folder for the figures, made if it is not there; named like the run file, or "figures" for several, unless given
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Format of the figures
    #[arg(long, value_enum, default_value = "png")]
    pub format: FigureFormat,
    /// Draw this figure only; may be repeated
    #[arg(long = "figure", value_name = "NAME", value_parser = NAMES)]
    pub figures: Vec<String>,
    /// Time of the maps to show, the nearest that was recorded ("100 s"); may be repeated. Unless given, the first and the last map
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = run_time)]
    pub at: Vec<f64>,
    /// Width of the figures in millimetres ("120 mm"), with letters of the same size; unless given, 88 mm or 180 mm. Those of 180 mm are made at least 120 mm wide
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = width)]
    pub width: Option<f64>,
    /// Colours of maps
    #[arg(long, value_enum, default_value = "viridis")]
    pub cmap: Colours,
    /// Show the whole ring from above instead of unrolled
    #[arg(long)]
    pub polar: bool,
    /// Replace figures that exist
    #[arg(long)]
    pub force: bool,
}

/// Format of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FigureFormat {
    /// Pixels
    Png,
    /// Lines and letters, for web pages and for drawing programs
    Svg,
    /// Lines and letters, for papers
    Pdf,
}

impl From<FigureFormat> for Format {
    fn from(format: FigureFormat) -> Self {
        match format {
            FigureFormat::Png => Self::Png,
            FigureFormat::Svg => Self::Svg,
            FigureFormat::Pdf => Self::Pdf,
        }
    }
}

/// Colours of maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Colours {
    /// From violet through green to yellow
    Viridis,
    /// From blue through grey to yellow
    Cividis,
    /// From black through red to pale yellow
    Inferno,
    /// From black through purple to pale yellow
    Magma,
    /// From blue through red to yellow
    Plasma,
    /// From black to white
    Greys,
}

impl From<Colours> for ColourMap {
    fn from(colours: Colours) -> Self {
        match colours {
            Colours::Viridis => Self::Viridis,
            Colours::Cividis => Self::Cividis,
            Colours::Inferno => Self::Inferno,
            Colours::Magma => Self::Magma,
            Colours::Plasma => Self::Plasma,
            Colours::Greys => Self::Greys,
        }
    }
}

/// Widths that figures can have, mm: less has no room for a map and its colour bar.
const WIDTHS: std::ops::RangeInclusive<f64> = 60.0..=1000.0;

/// A width, mm.
fn width(text: &str) -> Result<f64, String> {
    if text.trim().parse::<f64>().is_ok() {
        return Err(format!("{text} has no unit, expected a width such as \"88 mm\""));
    }
    let width = 1e3 * quantity(text, Dimension::Length)?;
    let (least, most) = (WIDTHS.start(), WIDTHS.end());
    if WIDTHS.contains(&width) { Ok(width) } else { Err(format!("{text} is not a width from {least} mm to {most} mm")) }
}
