//! The command line of `plateau surface`.

use std::path::PathBuf;

use clap::Args;
use plateau_core::surface::Level;
use plateau_io::scene::schema::choices;
use plateau_io::surface::{Decimal, Lay};
use plateau_io::units::{self, Dimension};

/// Arguments of `plateau surface`.
#[derive(Debug, Args)]
pub struct SurfaceArguments {
    /// Surface files, told by their content
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
    /// Write the heights as they are, not levelled, in the format of the ending
    #[arg(long, value_name = "FILE")]
    pub to: Option<PathBuf>,
    /// Describe what a scene makes of its disc and pin surfaces, too, beside the patches that they are made of
    #[arg(long, value_name = "SCENE")]
    pub prepare: Option<PathBuf>,
    /// Draw the pin's fibre map that the scene makes, beside the micrograph that it comes from, in the same formats
    #[arg(long, value_name = "FILE", requires = "prepare")]
    pub preview: Option<PathBuf>,
    /// What the number 1 stands for in a file that does not say so, such as um
    #[arg(long, value_name = "UNIT", value_parser = unit)]
    pub unit: Option<f64>,
    /// Distance of the points of a file that does not say so, such as "0.5 um", or "0.5 um, 2 um" along x and y
    #[arg(long, value_name = "LENGTH", value_parser = pitch)]
    pub pitch: Option<Pitch>,
    /// Heights of black and white of an image, such as "0 um, 12 um"
    #[arg(long, value_name = "LENGTHS", value_parser = height_range)]
    pub height_range: Option<HeightRange>,
    /// Decimal mark of a text file whose content does not tell it: "." or ","
    #[arg(long, value_name = "MARK", value_parser = decimal)]
    pub decimal: Option<Decimal>,
    /// Lines of a text file before the table that are not read
    #[arg(long, value_name = "LINES")]
    pub skip: Option<u64>,
    /// Take the file as a profile, of a surface with grooves along or across sliding, or isotropic
    #[arg(long, value_name = "DIRECTION", value_parser = lay)]
    pub profile_lay: Option<Lay>,
    /// Dataset of an HDF5 file, or array of an .npz archive
    #[arg(long, value_name = "NAME")]
    pub dataset: Option<String>,
    /// Replace the files that --plot, --preview and --to name if they exist
    #[arg(long)]
    pub force: bool,
}

/// Distance of neighbouring points along x and y, m.
#[derive(Debug, Clone, Copy)]
pub struct Pitch(pub [f64; 2]);

/// Heights of black and white, m.
#[derive(Debug, Clone, Copy)]
pub struct HeightRange(pub [f64; 2]);

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

/// A value of `--unit`.
fn unit(text: &str) -> Result<f64, String> {
    length(&format!("1 {text}")).map_err(|_| "expected a unit of length: m, mm, um, nm".to_owned())
}

/// A value of `--pitch`.
fn pitch(text: &str) -> Result<Pitch, String> {
    let pitch = match text.split_once(',') {
        Some((x, y)) => [length(x)?, length(y)?],
        None => [length(text)?; 2],
    };
    if pitch.iter().all(|pitch| *pitch > 0.0) { Ok(Pitch(pitch)) } else { Err("expected more than 0".to_owned()) }
}

/// A value of `--height-range`.
fn height_range(text: &str) -> Result<HeightRange, String> {
    let (black, white) = text.split_once(',').ok_or("expected two lengths, such as \"0 um, 12 um\"")?;
    let range = [length(black)?, length(white)?];
    if range[0] == range[1] { Err("expected two different heights".to_owned()) } else { Ok(HeightRange(range)) }
}

/// A value of `--decimal`.
fn decimal(text: &str) -> Result<Decimal, &'static str> {
    let known = choices::DECIMAL.iter().find(|(word, _)| *word == text);
    known.map(|(_, decimal)| *decimal).ok_or("expected \".\" or \",\"")
}

/// A value of `--profile-lay`.
fn lay(text: &str) -> Result<Lay, &'static str> {
    let known = choices::LAY.iter().find(|(word, _)| *word == text);
    known.map(|(_, lay)| *lay).ok_or("expected along, across or isotropic")
}

fn length(text: &str) -> Result<f64, String> {
    let length = units::parse(text.trim(), Dimension::Length).map_err(|error| error.to_string())?;
    if length.is_finite() { Ok(length) } else { Err("expected a finite length".to_owned()) }
}
