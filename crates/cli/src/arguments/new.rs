//! The command line of `plateau new`.

use std::path::PathBuf;

use clap::Args;
use plateau_io::units::{self, Dimension};

use super::positive;
use super::reading::ReadArguments;

/// Arguments of `plateau new`. Values have a unit, as in a scene.
#[derive(Debug, Args)]
pub struct NewArguments {
    /// Scene file to write
    pub scene: PathBuf,
    /// Measured surface of the disc, told by its content; of a profile say --profile-lay
    #[arg(long, value_name = "FILE")]
    pub disc: Option<PathBuf>,
    #[command(flatten)]
    pub reading: ReadArguments,
    /// Width of the pin, along the radius
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, default_value = "4 mm", value_parser = length)]
    pub pin_width: String,
    /// Length of the pin, along sliding
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, default_value = "8 mm", value_parser = length)]
    pub pin_length: String,
    /// A round pin of this diameter
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, conflicts_with_all = ["pin_width", "pin_length"],
          value_parser = length)]
    pub diameter: Option<String>,
    /// Radius at which the middle of the pin slides
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, default_value = "22 mm", value_parser = length)]
    pub radius: String,
    /// Force on the pin
    #[arg(long, value_name = "FORCE", allow_hyphen_values = true, default_value = "47 N", value_parser = force)]
    pub load: String,
    /// Rotational speed of the disc, or the sliding speed ("3 m/s") at --radius
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true, default_value = "850 rpm", value_parser = speed)]
    pub speed: String,
    /// Time to simulate
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, default_value = "3000 s", value_parser = time)]
    pub duration: String,
    /// Replace the scene file if it exists
    #[arg(long)]
    pub force: bool,
}

impl NewArguments {
    /// The key of the scene that the speed is given by.
    pub fn speed_key(&self) -> &'static str {
        if is_sliding_speed(&self.speed) { "sliding_speed" } else { "rotational_speed" }
    }
}

fn length(text: &str) -> Result<String, String> {
    positive(text, Dimension::Length)
}

fn force(text: &str) -> Result<String, String> {
    positive(text, Dimension::Force)
}

fn speed(text: &str) -> Result<String, String> {
    let dimension = if is_sliding_speed(text) { Dimension::Speed } else { Dimension::RotationalSpeed };
    positive(text, dimension).map_err(|error| match dimension {
        Dimension::Speed => error,
        _ => format!("{error}, or a sliding speed such as \"3 m/s\""),
    })
}

/// Whether a speed is a length over a time.
fn is_sliding_speed(text: &str) -> bool {
    units::parse(text, Dimension::Speed).is_ok()
}

fn time(text: &str) -> Result<String, String> {
    positive(text, Dimension::Time)
}

#[cfg(test)]
#[path = "../../tests/unit/arguments/new.rs"]
mod tests;
