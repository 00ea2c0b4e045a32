//! The command line of `plateau surface`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use plateau_core::surface::Level;

use super::reading::ReadArguments;
use super::{HandedArguments, run_time};

/// What else to do with surfaces.
#[derive(Debug, Subcommand)]
pub enum SurfaceWord {
    /// Convert files of instruments to HDF5, which is read
    #[command(disable_help_flag = true)]
    Convert(HandedArguments),
}

/// Arguments of `plateau surface`.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true, disable_help_subcommand = true)]
pub struct SurfaceArguments {
    #[command(subcommand)]
    pub word: Option<SurfaceWord>,
    /// Surface files, told by their content; of a run file the heights of disc and pin, or the map that --dataset names
    #[arg(value_name = "FILE", required_unless_present = "prepare")]
    pub files: Vec<PathBuf>,
    /// Print one JSON document instead of a table: an object for one surface, an array for several; heights in um
    #[arg(long)]
    pub json: bool,
    /// Form that is taken out first: none, mean, plane or quadratic; plane for files, none for what a scene prepared,
    /// unless given
    #[arg(long, value_name = "FORM", value_parser = level)]
    pub level: Option<Level>,
    /// Draw map, histogram and Abbott-Firestone curve of each surface, in the format of the ending: .png, .svg or .pdf
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Draw the surfaces in perspective, instead of maps and charts
    #[arg(long, requires = "plot")]
    pub relief: bool,
    /// Write the heights as they are, not levelled, in the format of the ending
    #[arg(long, value_name = "FILE")]
    pub to: Option<PathBuf>,
    /// Time of the maps of a run file, the nearest that was recorded ("100 s"); may be repeated. Unless given, the first and the last map
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, value_parser = run_time)]
    pub at: Vec<f64>,
    /// Describe what a scene makes of its disc and pin surfaces, too, beside the patches that they are made of
    #[arg(long, value_name = "SCENE")]
    pub prepare: Option<PathBuf>,
    /// Draw the pin's fibre map that the scene makes, beside the micrograph that it comes from, in the same formats
    #[arg(long, value_name = "FILE", requires = "prepare")]
    pub preview: Option<PathBuf>,
    /// Write the data of the figures into this folder, which is there, and print nothing: for the Python package
    #[arg(long, value_name = "DIR", hide = true, conflicts_with_all = ["plot", "preview", "json"])]
    pub figure_data: Option<PathBuf>,
    #[command(flatten)]
    pub reading: ReadArguments,
    /// Replace the files that --plot, --preview and --to name if they exist
    #[arg(long)]
    pub force: bool,
}

/// A value of `--level`.
fn level(text: &str) -> Result<Level, &'static str> {
    match text {
        "none" => Ok(Level::None),
        "mean" => Ok(Level::Mean),
        "plane" => Ok(Level::Plane),
        "quadratic" => Ok(Level::Quadratic),
        _ => Err("expected none, mean, plane or quadratic"),
    }
}
