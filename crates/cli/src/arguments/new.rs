//! The command line of `plateau new`.

use std::path::PathBuf;

use clap::Args;
use plateau_io::units::{self, Dimension};

use super::ReadArguments;

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
    /// Rotational speed of the disc
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true, default_value = "850 rpm", value_parser = speed)]
    pub speed: String,
    /// Time to simulate
    #[arg(long, value_name = "TIME", allow_hyphen_values = true, default_value = "3000 s", value_parser = time)]
    pub duration: String,
    /// Replace the scene file if it exists
    #[arg(long)]
    pub force: bool,
}

fn length(text: &str) -> Result<String, String> {
    of(text, Dimension::Length)
}

fn force(text: &str) -> Result<String, String> {
    of(text, Dimension::Force)
}

fn speed(text: &str) -> Result<String, String> {
    of(text, Dimension::RotationalSpeed)
}

fn time(text: &str) -> Result<String, String> {
    of(text, Dimension::Time)
}

/// The text, if it is a quantity of this dimension above 0.
fn of(text: &str, dimension: Dimension) -> Result<String, String> {
    let value = units::parse(text, dimension).map_err(|error| error.to_string())?;
    if value > 0.0 && value.is_finite() { Ok(text.to_owned()) } else { Err("expected more than 0".to_owned()) }
}
