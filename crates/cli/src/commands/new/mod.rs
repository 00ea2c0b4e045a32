//! `plateau new`: write a commented scene to begin with.

mod measured;
mod refusal;

use plateau_io::units::{self, Dimension};
use plateau_io::{plausibility, scene};

use crate::arguments::NewArguments;
use crate::called;
use crate::failure::Failure;
use crate::output;
use crate::table::print;
use crate::{message, number};

/// The scene with places for what is the user's.
const SCENE: &str = include_str!("scene.toml");

/// The cell size of that scene, um.
const CELL: f64 = 50.0;

/// The disc of who has not measured one.
const SYNTHETIC: &str = r#"synthetic = { seed = 1, rms_height = "3 um", correlation_length = "120 um" }     # <- or file = "surface.x3p"

[disc.prepare]
cutoff = "3 um"                         # peaks are cut at this height above the mean"#;

/// Makes a scene, looks whether it can be run, writes it, and says what to do next.
pub fn new(arguments: &NewArguments) -> Result<(), Failure> {
    let path = &arguments.scene;
    let inputs: Vec<_> = arguments.disc.iter().cloned().collect();
    output::check(path, arguments.force, &inputs)?;
    let Written { text, notes } = text(arguments)?;
    let scene = scene::of_text(path, &text).map_err(|error| refusal::of(arguments, &error))?;
    output::write(path, text.as_bytes(), arguments.force)?;
    scene.warnings.iter().chain(&plausibility::of_scene(&scene)).for_each(message::warning);
    let (program, name) = (called::program(), called::argument(&path.to_string_lossy()));
    let notes: String = notes.iter().map(|note| format!("note: {note}\n")).collect();
    print(&format!(
        "{notes}wrote {}: change what is yours, then\n  {program} check {name}\n  {program} surface --prepare {name}\n  \
         {program} run {name}\n",
        path.display()
    ))
}

/// A scene, and what of it should be known before it is run.
struct Written {
    text: String,
    notes: Vec<String>,
}

/// The scene with the values of the command line in their places.
fn text(arguments: &NewArguments) -> Result<Written, Failure> {
    let NewArguments { scene, disc, pin_width, pin_length, diameter, radius, load, speed, duration, reading, .. } =
        arguments;
    let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
    let mesh = match diameter {
        Some(diameter) => vec![("shape", "disc", "a round pin"), ("pin_width", diameter.as_str(), "<- its diameter")],
        None => vec![
            ("pin_width", pin_width.as_str(), "<- along the radius"),
            ("pin_length", pin_length.as_str(), "<- along sliding"),
        ],
    };
    let mean_radius = [("mean_radius", radius.as_str(), "<- where the middle of the pin slides")];
    let mesh: Vec<String> =
        mesh.iter().chain(&mean_radius).map(|(key, value, remark)| line(key, *value, remark)).collect();
    let mut notes = Vec::new();
    let disc = match disc {
        Some(disc) => {
            let (lines, said) = measured::disc(scene, disc, reading)?;
            notes = said;
            lines
        }
        None if reading.keys().is_empty() => SYNTHETIC.to_owned(),
        None => {
            let named: Vec<String> =
                reading.keys().iter().map(|(key, _)| format!("--{}", key.replace('_', "-"))).collect();
            let message = "says how the file of --disc is read, and none is given: give --disc FILE";
            return Err(Failure::input(format!("{} {message}", named.join(", "))));
        }
    };
    let speed_key = arguments.speed_key();
    let other_speed = other_speed(speed_key, speed, radius).unwrap_or_default();
    let operation = [
        line("normal_force", load.as_str(), "<- on the whole pin"),
        line(speed_key, speed.as_str(), &other_speed),
        line("duration", duration.as_str(), "<-"),
    ];
    let name = called::argument(&scene.to_string_lossy());
    let run = format!("{stem}.h5");
    let places = [
        (
            "{cell_size}",
            line("cell_size", format!("{CELL} um"), "local debris goes one cell far: keep it to compare runs"),
        ),
        ("{title}", line("title", stem.as_ref(), "<-")),
        ("{mesh}", mesh.join("\n")),
        ("{operation}", operation.join("\n")),
        ("{disc}", disc),
        ("{file}", line("file", run.as_str(), "in the folder in which the program is called")),
        ("{name}", name),
        ("{run}", called::argument(&run)),
    ];
    let text = places.iter().fold(SCENE.to_owned(), |text, (place, value)| text.replace(place, value));
    Ok(Written { text, notes })
}

/// The remark beside the speed: the same by the other key.
fn other_speed(key: &str, speed: &str, radius: &str) -> Option<String> {
    let radius = units::parse(radius, Dimension::Length).ok()?;
    Some(if key == "sliding_speed" {
        let rotation = units::parse(speed, Dimension::Speed).ok()? / radius * 60.0 / std::f64::consts::TAU;
        format!("<- at the mean radius, or rotational_speed = \"{} rpm\"", number::rounded(rotation, 4))
    } else {
        let sliding = units::parse(speed, Dimension::RotationalSpeed).ok()? * radius;
        format!("<- or sliding_speed = \"{} m/s\" at the mean radius", number::rounded(sliding, 4))
    })
}

/// A key with a value and a remark, as the others stand in the scene.
fn line(key: &str, value: impl Into<toml::Value>, remark: &str) -> String {
    let pair = format!("{key} = {}", value.into());
    format!("{pair:<39} # {remark}")
}
