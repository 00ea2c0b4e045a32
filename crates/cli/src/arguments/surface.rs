//! The command line of `plateau surface`, and what a user says of a surface file that the file itself does not: the keys beside
//! `file` of a scene, as options.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use plateau_core::surface::Level;
use plateau_io::scene::schema::choices;
use plateau_io::surface::{Decimal, Lay, ReadOptions};
use toml::Value;

use crate::arguments::{HandedArguments, length, run_time};

/// What else to do with surfaces.
#[derive(Debug, Subcommand)]
pub enum SurfaceWord {
    /// Convert files of instruments to HDF5, which is read
    #[command(disable_help_flag = true)]
    Convert(HandedArguments),
}

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

/// The meaning of a word of a choice.
fn meaning<T: Copy>(choices: &[(&str, T)], text: &str, expected: &str) -> Result<T, String> {
    let known = choices.iter().find(|(word, _)| *word == text);
    known.map(|(_, meaning)| *meaning).ok_or_else(|| format!("expected {expected}"))
}

/// A value of `--level`.
fn level(text: &str) -> Result<Level, String> {
    meaning(&choices::LEVEL, text, "none, mean, plane or quadratic")
}

/// Options that tell how a surface file is read.
#[derive(Debug, Clone, Args)]
pub struct ReadArguments {
    /// What the number 1 stands for in a file that does not say so, such as um
    #[arg(long, value_name = "UNIT", allow_hyphen_values = true, value_parser = said(unit))]
    pub unit: Option<Said<f64>>,
    /// Distance of the points of a file that does not say so, such as "0.5 um", or "0.5 um, 2 um" along x and y
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = said(pitch))]
    pub pitch: Option<Said<[f64; 2]>>,
    /// Heights of black and white of an image, such as "0 um, 12 um"
    #[arg(long, value_name = "LENGTHS", allow_hyphen_values = true, value_parser = said(height_range))]
    pub height_range: Option<Said<[f64; 2]>>,
    /// Decimal mark of a text file whose content does not tell it: "." or ","
    #[arg(long, value_name = "MARK", value_parser = said(decimal))]
    pub decimal: Option<Said<Decimal>>,
    /// Lines of a text file before the table that are not read
    #[arg(long, value_name = "LINES", allow_hyphen_values = true)]
    pub skip: Option<u64>,
    /// Take the file as a profile, of a surface with grooves along or across sliding, or isotropic
    #[arg(long, value_name = "DIRECTION", value_parser = said(lay))]
    pub profile_lay: Option<Said<Lay>>,
    /// Dataset of an HDF5 file, array of an .npz archive, or number of a table in a text
    #[arg(long, value_name = "NAME")]
    pub dataset: Option<String>,
}

/// A value with the words in which it was given.
#[derive(Debug, Clone)]
pub struct Said<T> {
    words: String,
    value: T,
}

impl ReadArguments {
    /// What they say of a file.
    pub fn options(&self) -> ReadOptions {
        ReadOptions {
            dataset: self.dataset.clone(),
            at: None,
            unit: self.unit.as_ref().map(|said| said.value),
            pitch: self.pitch.as_ref().map(|said| said.value),
            height_range: self.height_range.as_ref().map(|said| said.value),
            decimal: self.decimal.as_ref().map(|said| said.value),
            skip: self.skip,
            profile_lay: self.profile_lay.as_ref().map(|said| said.value),
        }
    }

    /// The keys of a scene beside `file` that say the same.
    pub fn keys(&self) -> Vec<(&'static str, Value)> {
        let text = |words: &str| Value::from(words.trim());
        let lengths = |words: &str| match words.split_once(',') {
            Some((first, second)) => Value::from(vec![text(first), text(second)]),
            None => text(words),
        };
        let pairs = [
            ("dataset", self.dataset.as_deref().map(text)),
            ("unit", self.unit.as_ref().map(|said| text(&said.words))),
            ("pitch", self.pitch.as_ref().map(|said| lengths(&said.words))),
            ("height_range", self.height_range.as_ref().map(|said| lengths(&said.words))),
            ("decimal", self.decimal.as_ref().map(|said| text(&said.words))),
            ("skip", self.skip.and_then(|lines| i64::try_from(lines).ok()).map(Value::from)),
            ("profile_lay", self.profile_lay.as_ref().map(|said| text(&said.words))),
        ];
        pairs.into_iter().filter_map(|(key, value)| Some((key, value?))).collect()
    }
}

/// The options that stand for keys that a message about a file names as `key = ...`; empty where it names none.
pub fn as_options(message: &str) -> String {
    let keys = ["unit", "pitch", "height_range", "decimal", "skip", "profile_lay", "dataset"];
    let is_named = |key: &&str| {
        message.match_indices(*key).any(|(at, _)| {
            let alone = message[..at].chars().last().is_none_or(|before| !before.is_alphanumeric() && before != '_');
            alone && message[at + key.len()..].starts_with(" = ")
        })
    };
    let named: Vec<String> =
        keys.iter().filter(|key| is_named(key)).map(|key| format!("--{}", key.replace('_', "-"))).collect();
    if named.is_empty() { String::new() } else { format!(" (on the command line: {})", named.join(", ")) }
}

/// A parser that keeps the words.
fn said<T>(parse: fn(&str) -> Result<T, String>) -> impl Fn(&str) -> Result<Said<T>, String> + Clone {
    move |text| Ok(Said { words: text.to_owned(), value: parse(text)? })
}

/// A value of `--unit`.
fn unit(text: &str) -> Result<f64, String> {
    // A unit alone, or what the number 1 stands for, as in a scene.
    let unit = length(&format!("1 {text}")).or_else(|_| length(text));
    match unit {
        Err(_) => Err("expected a unit of length: m, mm, um, nm".to_owned()),
        Ok(unit) if unit > 0.0 => Ok(unit),
        Ok(_) => Err("expected more than 0".to_owned()),
    }
}

/// A value of `--pitch`.
fn pitch(text: &str) -> Result<[f64; 2], String> {
    let pitch = match text.split_once(',') {
        Some((x, y)) if x.trim().parse::<f64>().is_ok() && y.starts_with(|next: char| next.is_ascii_digit()) => {
            return Err(format!("a comma parts the pitch along x and along y; decimals have a point: \"{x}.{y}\""));
        }
        Some((x, y)) => [length(x)?, length(y)?],
        None => [length(text)?; 2],
    };
    if pitch.iter().all(|pitch| *pitch > 0.0) { Ok(pitch) } else { Err("expected more than 0".to_owned()) }
}

/// A value of `--height-range`.
fn height_range(text: &str) -> Result<[f64; 2], String> {
    let (black, white) = text.split_once(',').ok_or("expected two lengths, such as \"0 um, 12 um\"")?;
    let range = [length(black)?, length(white)?];
    if range[0] == range[1] { Err("expected two different heights".to_owned()) } else { Ok(range) }
}

/// A value of `--decimal`.
fn decimal(text: &str) -> Result<Decimal, String> {
    meaning(&choices::DECIMAL, text, "\".\" or \",\"")
}

/// A value of `--profile-lay`.
fn lay(text: &str) -> Result<Lay, String> {
    meaning(&choices::LAY, text, "along, across or isotropic")
}

#[cfg(test)]
#[path = "../../tests/unit/arguments/surface.rs"]
mod tests;
