//! `plateau new`: write a commented scene to begin with.

use std::path::Path;

use plateau_core::surface::{Extension, Length};
use plateau_io::scene;
use plateau_io::surface::{self, Measured, ReadOptions};

use crate::arguments::NewArguments;
use crate::failure::Failure;
use crate::message;
use crate::output;
use crate::table::print;

/// The scene with places for what is the user's.
const SCENE: &str = include_str!("scene.toml");

/// The cell size of that scene, um.
const CELL: f64 = 50.0;

/// The disc of who has not measured one.
const SYNTHETIC: &str = r#"synthetic = { seed = 1, rms_height = "3 um", correlation_length = "120 um" }     # <- or file = "surface.x3p"

[disc.prepare]
cutoff = "3 um"                         # peaks are cut at this height above the mean"#;

/// Writes a scene, looks whether it can be run, and says what to do next.
pub fn new(arguments: &NewArguments) -> Result<(), Failure> {
    let path = &arguments.scene;
    let inputs: Vec<_> = arguments.disc.iter().cloned().collect();
    output::check(path, arguments.force, &inputs)?;
    output::write(path, text(arguments)?.as_bytes(), arguments.force)?;
    let name = path.display();
    let unfit = |error| Failure::input(format_args!("{name} is written, but it needs a change:\n{error}"));
    let scene = scene::load(path, &[]).map_err(unfit)?;
    scene.warnings.iter().for_each(message::warning);
    print(&format!(
        "wrote {name}: change what is yours, then\n  plateau check {name}\n  plateau surface --prepare {name}\n  plateau run {name}\n"
    ))
}

/// The scene with the values of the command line in their places.
fn text(arguments: &NewArguments) -> Result<String, Failure> {
    let NewArguments { scene, disc, pin_width, pin_length, diameter, radius, load, speed, duration, .. } = arguments;
    let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
    let mesh = match diameter {
        Some(diameter) => vec![("shape", "disc", "a round pin"), ("pin_width", diameter.as_str(), "<- its diameter")],
        None => vec![
            ("pin_width", pin_width.as_str(), "<- along the radius"),
            ("pin_length", pin_length.as_str(), "<- along sliding"),
        ],
    };
    let radius = [("mean_radius", radius.as_str(), "<- where the middle of the pin slides")];
    let mesh: Vec<String> = mesh.iter().chain(&radius).map(|(key, value, remark)| line(key, value, remark)).collect();
    let disc = disc.as_ref().map_or_else(|| Ok(SYNTHETIC.to_owned()), |disc| measured(scene, disc))?;
    let operation = [
        line("normal_force", load, "<- on the whole pin"),
        line("rotational_speed", speed, "<- or sliding_speed = \"2 m/s\", at the mean radius"),
        line("duration", duration, "<-"),
    ];
    let name = scene.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let run = format!("{stem}.h5");
    let places = [
        (
            "{cell_size}",
            line("cell_size", &format!("{CELL} um"), "local debris goes one cell far: keep it to compare runs"),
        ),
        ("{title}", line("title", &stem, "<-")),
        ("{mesh}", mesh.join("\n")),
        ("{operation}", operation.join("\n")),
        ("{disc}", disc),
        ("{file}", line("file", &run, "in the folder in which the program is called")),
        ("{name}", name),
        ("{run}", run),
    ];
    Ok(places.iter().fold(SCENE.to_owned(), |text, (place, value)| text.replace(place, value)))
}

/// A key with a text and a remark, as the others stand in the scene.
fn line(key: &str, value: &str, remark: &str) -> String {
    let pair = format!("{key} = {}", toml::Value::from(value));
    format!("{pair:<39} # {remark}")
}

/// The disc of a measured surface: read as it is, levelled, filled where points are missing, and extended by its statistics.
fn measured(scene: &Path, disc: &Path) -> Result<String, Failure> {
    let named = |reason: &dyn std::fmt::Display| Failure::input(format_args!("{}: {reason}", disc.display()));
    let Measured { heights, pitch, columns, rows, .. } =
        surface::read(disc, &ReadOptions::default()).map_err(|reason| named(&reason))?;
    let folder = std::path::absolute(scene).ok().and_then(|scene| scene.parent().map(Path::to_owned));
    let path = std::path::absolute(disc).map_err(|reason| named(&reason))?;
    let path = folder.and_then(|folder| path.strip_prefix(folder).ok().map(Path::to_owned)).unwrap_or(path);
    let path = path.to_str().ok_or_else(|| named(&"its path is not UTF-8, as a scene is: rename it"))?;
    let cell = format!("{CELL} um");
    let mut lines = vec![line("file", path, "<-")];
    if pitch.is_none() {
        lines.push(line("pitch", "1 um", "<- the file does not say how far its points are apart"));
    }
    lines.extend([String::new(), "[disc.prepare]".to_owned()]);
    lines.push(line("level", "plane", "form that is taken out: mean, plane, quadratic"));
    let least = pitch.map_or(f64::INFINITY, |[x, y]| (columns as f64 * x).min(rows as f64 * y));
    let fewest = Extension::FEWEST_CELLS;
    if least < fewest as f64 * CELL * 1e-6 {
        let remark = format!("<- the patch is {} wide, less than {fewest} cells: read it as larger,", Length(least));
        lines.push(line("pixel", &cell, &remark));
        lines.push(format!("{:40}# or leave this out and take smaller cells", ""));
    }
    if heights.iter().any(|height| height.is_nan()) {
        lines.push(line("fill", "interpolate", "points are missing"));
    }
    lines.push(line("extend", "statistics", "a whole ring like this patch; or repeat = true for tiles"));
    lines.push(format!("{:40}# another seed is another ring of the same kind", "extend_seed = 1"));
    lines.push(format!("{:40}# peaks are cut at this height above the mean, as in the paper", "# cutoff = \"3 um\""));
    Ok(lines.join("\n"))
}
