//! `plateau new`: write a commented scene to begin with, also for a measured disc and a micrograph of the pin.

mod fibres;
mod keys;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use plateau_core::surface::{Condition, Extension, HeightParameters, Length, Level, Spikes, implausible, level};
use plateau_io::scene::{self, Problem, SceneError};
use plateau_io::surface::{self, FileError, Lay, Measured, TextError};
use plateau_io::units::{self, Dimension};
use plateau_io::{number, plausibility, text};
use serde_json::Value;

use crate::arguments::{NewArguments, ReadArguments, as_options};
use crate::commands::surface::data::Data;
use crate::failure::Failure;
use crate::output::print;
use crate::{hand_over, invocation, message, output};
use keys::{line, path_from};

/// The scene with places for what is the user's.
const SCENE: &str = include_str!("new/scene.toml");

/// The cell size of that scene, um.
const CELL: f64 = 50.0;

/// The disc of who has not measured one.
const SYNTHETIC: &str = r#"synthetic = { seed = 1, rms_height = "3 um", correlation_length = "120 um" }     # <- or file = "surface.sdf"

[disc.prepare]
cutoff = "3 um"                         # peaks are cut at this height above the mean"#;

/// Place for what is made of a picture that is smaller than the pin, behind the keys of the base.
const BEYOND: &str = "{beyond}";

/// Makes a scene, looks whether it can be run, writes it, and says what to do next.
pub fn new(arguments: &NewArguments) -> Result<(), Failure> {
    let path = &arguments.scene;
    let inputs: Vec<_> = arguments.disc.iter().chain(&arguments.micrograph).cloned().collect();
    output::check(path, arguments.force, &inputs)?;
    let (draft, mut notes) = scene_text(arguments)?;
    let of_text = |text: &str| scene::of_text(path, text).map_err(|error| refusal(arguments, &error));
    let mut text = draft.replace(BEYOND, "");
    let mut scene = of_text(&text)?;
    if let Some(micrograph) = &arguments.micrograph {
        let mut found = surface::micrograph(&scene);
        let is_small = fibres::is_too_small(&found);
        if is_small {
            text = draft.replace(BEYOND, &format!("\n{}", fibres::beyond()));
            scene = of_text(&text)?;
            found = surface::micrograph(&scene);
        }
        if let Some((map, pixel)) = found.map_err(|error| Failure::input(format!("{error}\nnothing is written")))? {
            notes.extend(fibres::told(micrograph, &map, pixel, &scene, is_small));
        }
    }
    output::write(path, text.as_bytes(), arguments.force)?;
    scene.warnings.iter().chain(&plausibility::of_scene(&scene)).for_each(message::warning);
    let (program, name) = (invocation::program(), invocation::argument(&path.to_string_lossy()));
    let notes: String = notes.iter().map(|note| format!("note: {note}\n")).collect();
    print(&format!(
        "{notes}wrote {}: change what is yours, then\n  {program} check {name}\n  {program} surface --prepare {name}\n  \
         {program} run {name}\n",
        path.display()
    ))
}

/// The scene with the values of the command line in their places, and what of it should be known before it is run.
fn scene_text(arguments: &NewArguments) -> Result<(String, Vec<String>), Failure> {
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
    let mesh: Vec<_> = mesh.iter().chain(&mean_radius).map(|(key, value, remark)| line(key, *value, remark)).collect();
    let mut notes = Vec::new();
    let disc = match disc {
        Some(disc) => disc_lines(scene, disc, reading, arguments.force, &mut notes)?,
        None if reading.keys().is_empty() => SYNTHETIC.to_owned(),
        None => {
            let option = |(key, _): &(&str, _)| format!("--{}", key.replace('_', "-"));
            let named = reading.keys().iter().map(option).collect::<Vec<_>>().join(", ");
            let message = "says how the file of --disc is read, and none is given: give --disc FILE";
            return Err(Failure::input(format!("{named} {message}")));
        }
    };
    let (base, said) = fibres::lines(arguments)?;
    notes.extend(said);
    let speed_key = arguments.speed_key();
    let other_speed = other_speed(speed_key, speed, radius).unwrap_or_default();
    let operation = [
        line("normal_force", load.as_str(), "<- on the whole pin"),
        line(speed_key, speed.as_str(), &other_speed),
        line("duration", duration.as_str(), "<-"),
    ];
    let name = invocation::argument(&scene.to_string_lossy());
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
        ("{base}", base + BEYOND),
        ("{file}", line("file", run.as_str(), "in the folder in which the program is called")),
        ("{name}", name),
        ("{run}", invocation::argument(&run)),
    ];
    let text = places.iter().fold(SCENE.to_owned(), |text, (place, value)| text.replace(place, value));
    Ok((text, notes))
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

/// The tables of the disc: the file read as it is, levelled, without spikes, filled where points are missing, and extended by its
/// statistics; of the profile of a surface with grooves, tiled. What should be known of them is added to `notes`.
fn disc_lines(
    scene: &Path,
    disc: &Path,
    reading: &ReadArguments,
    force: bool,
    notes: &mut Vec<String>,
) -> Result<String, Failure> {
    let (disc, measured) = read_or_convert(scene, disc, reading, force, notes)?;
    let disc = disc.as_path();
    if measured.pitch.is_none() {
        let message = "it does not say how far its points are apart: give --pitch, such as --pitch \"5 um\"";
        return Err(Failure::of_file(disc, message));
    }
    let too_small = smaller_than_cells(&measured);
    if let (Some(_), true, [warning, ..]) = (&too_small, measured.is_pitch_assumed, &measured.warnings[..]) {
        return Err(Failure::of_file(disc, format_args!("{warning}{}", as_options(warning))));
    }
    let mut lines = vec![line("file", path_from(scene, disc).map_err(|reason| Failure::of_file(disc, reason))?, "<-")];
    lines.extend(reading.keys().into_iter().map(|(key, value)| line(key, value, "<-")));
    lines.extend([String::new(), "[disc.prepare]".to_owned()]);
    let condition = condition(&measured);
    if measured.profile_lay.is_none() {
        let form = condition.map_or(Level::Plane, |condition| condition.form);
        let lay = lay(&measured, form);
        notes.extend(lay.as_ref().map(|lay| format!("{}: {}", disc.display(), lay.told)));
        let any = "x of the file is along sliding: turn it where the lay would be across";
        let (rotate, remark) = lay.map_or(("90 deg".into(), any.into()), |lay| (lay.rotate, lay.remark));
        lines.push(format!("{:40}# {remark}", format!("# rotate = \"{rotate}\"")));
    }
    match &condition {
        Some(Condition { form: Level::Quadratic, rms_of_forms: [plane, quadratic], .. }) => {
            let [plane, quadratic] = [plane, quadratic].map(|rms| Length(*rms));
            let bow = format!(
                "the surface is bowed: rms {plane} once a plane is taken out, {quadratic} once second order is"
            );
            lines.push(line("level", "quadratic", &format!("<- {bow}")));
            notes.push(format!("{}: {bow}: level = \"quadratic\" takes that out", disc.display()));
        }
        _ => lines.push(line("level", "plane", "form that is taken out: mean, plane, quadratic")),
    }
    let spikes = condition.and_then(|condition| condition.spikes);
    if let Some(spikes) = &spikes {
        let told = spikes_in_words(spikes);
        lines.push(line("outliers", Spikes::LIMIT as i64, &format!("<- {told}")));
        notes.push(format!("{}: {told}: outliers = {} takes them out", disc.display(), Spikes::LIMIT));
    }
    if let Some((remark, note)) = too_small {
        lines.extend(remark);
        notes.push(format!("{}: {note}", disc.display()));
    }
    if spikes.is_some() || measured.heights.iter().any(|height| height.is_nan()) {
        lines.push(line("fill", "interpolate", "points that are missing get heights between those around them"));
    }
    match measured.profile_lay {
        Some(Lay::Along | Lay::Across) => {
            lines.push(line("repeat", true, "the profile again and again, mirrored, where it is too short"));
        }
        lay @ (Some(Lay::Isotropic) | None) => {
            let remark = match lay {
                Some(_) => "a whole ring with the statistics of the profile in every direction",
                None => "a whole ring like this patch; or repeat = true for tiles",
            };
            lines.push(line("extend", "statistics", remark));
            lines.push(line("extend_seed", 1, "another seed is another ring of the same kind"));
        }
    }
    let rms = condition.map(|condition| condition.rms_height());
    warn(disc, &measured, rms);
    if let Some(rms) = rms.filter(|rms| *rms > 0.0 && rms.is_finite()) {
        let cutoff = format!("cutoff = \"{}\"", rounded(rms));
        let remark = "<- cuts peaks at this height above the mean, here one rms height";
        lines.push(format!("{:40}# {remark}", format!("# {cutoff}")));
        notes.push(format!(
            "{}: no peaks are cut. With {cutoff}, one rms height as in the paper, the contact area is larger, up to several times: \
             docs/scenes.md says when to give it",
            disc.display()
        ));
    }
    Ok(lines.join("\n"))
}

/// Says what of the file can hardly be meant.
fn warn(disc: &Path, measured: &Measured, rms: Option<f64>) {
    let stand_in = implausible::stand_in(&measured.heights);
    let units = || implausible::odd_units(&measured.heights, measured.rows, measured.pitch, rms.unwrap_or_default());
    // Numbers that stand for no height make odd heights of any unit.
    let found = stand_in.map_or_else(|| units().collect(), |found| vec![found]);
    for warning in measured.warnings.iter().cloned().chain(found) {
        message::warning(format_args!("{}: {warning}", disc.display()));
    }
}

/// A length of two digits, as a scene has it.
fn rounded(length: f64) -> String {
    if length < 1e-6 {
        format!("{} nm", number::rounded(length * 1e9, 2))
    } else {
        format!("{} um", number::rounded(length * 1e6, 2))
    }
}

/// Form, spikes and rms height of a patch; of a profile neither bow nor spikes are looked for.
fn condition(measured: &Measured) -> Option<Condition> {
    let Measured { rows, ref heights, .. } = *measured;
    if measured.profile_lay.is_none() {
        return Condition::of(heights, rows);
    }
    let mut heights = heights.clone();
    level(&mut heights, rows, Level::Plane, false);
    let rms = HeightParameters::of(&heights)?.root_mean_square_height;
    Some(Condition { form: Level::Plane, rms_of_forms: [rms; 2], spikes: None })
}

fn spikes_in_words(spikes: &Spikes) -> String {
    let Spikes { count, points, kurtosis, rms } = *spikes;
    let (kurtosis, [before, after]) = (number::rounded(kurtosis, 3), rms.map(Length));
    format!("{count} of {points} points are spikes: kurtosis {kurtosis}, rms {before}, without them {after}")
}

/// Reads the file, or what the Python package converts it to, which is noted; and which that is.
fn read_or_convert(
    scene: &Path,
    disc: &Path,
    reading: &ReadArguments,
    force: bool,
    notes: &mut Vec<String>,
) -> Result<(PathBuf, Measured), Failure> {
    let (mut path, mut found) = (disc.to_owned(), surface::read(disc, &reading.options()));
    let may_be_converted = found.as_ref().is_err_and(FileError::may_be_converted);
    if may_be_converted && hand_over::answering(WORD).is_some() {
        path = converted(scene, disc, force)?;
        notes.push(format!("{}: converted to {}, which the scene names", disc.display(), path.display()));
        found = surface::read(&path, &reading.options());
    }
    let measured = measured(found).map_err(|reason| Failure::of_file(&path, reason))?;
    Ok((path, measured))
}

/// Returns what was read; for a profile without a lay, an error that asks for it.
fn measured(found: Result<Measured, FileError>) -> Result<Measured, String> {
    let found = match found {
        Ok(Measured { profile_lay: None, columns, rows, .. }) if columns == 1 || rows == 1 => {
            format!("{columns} x {rows} points")
        }
        Ok(measured) => return Ok(measured),
        Err(FileError::Text(TextError::IsProfile { columns, lines })) => format!("{lines} lines of {columns} numbers"),
        Err(reason) => return Err(format!("{reason}{}", as_options(&reason.to_string()))),
    };
    Err(format!(
        "{found} are a profile, which does not say how the surface goes on beside it: give --profile-lay along for grooves along \
         sliding, --profile-lay across for grooves across sliding, or --profile-lay isotropic for a surface without a direction; \
         and --unit and --pitch, if the file does not state them"
    ))
}

/// Str below which a lay is told.
const CLEAR_LAY: f64 = 0.3;
/// A lay that runs along or across sliding but for this angle is said to, deg.
const ALONG: f64 = 5.0;

/// A lay that can be told, and how it is turned.
struct ClearLay {
    /// Angle that turns it along sliding; of one that runs along, across.
    rotate: String,
    /// Remark beside the key in the scene.
    remark: String,
    /// Statement about it.
    told: String,
}

impl ClearLay {
    /// Describes a lay with this Str, or what it is less than, and this Std (deg, from along sliding towards outward), of heights without
    /// that form.
    fn new(aspect_ratio: &str, direction: f64, form: Level) -> Self {
        let (way, to, degrees) = match direction.abs() {
            ..=ALONG => ("along sliding, x of the file", "across sliding", 90.0),
            angle if angle >= 90.0 - ALONG => ("across sliding, along y of the file", "along sliding", 90.0),
            _ => ("oblique to sliding, x of the file", "along sliding", -direction.round()),
        };
        // `plateau surface` takes a plane out unless told otherwise.
        let beside = if form == Level::Quadratic { ", with --level quadratic" } else { "" };
        // Added to 0, what is rounded to it has no sign.
        let tenths = (10.0 * direction).round() / 10.0 + 0.0;
        let runs = format!("{way} (Str {aspect_ratio}, Std {} deg{beside})", number::rounded(tenths, 3));
        let rotate = format!("{} deg", number::plain(degrees));
        Self {
            remark: format!("<- the lay runs {runs}: this turns it {to}"),
            told: format!("its lay runs {runs}: rotate = \"{rotate}\" turns it {to}, where the disc has it so"),
            rotate,
        }
    }
}

/// The lay of a patch, if the Python package is here and tells a clear one.
fn lay(measured: &Measured, form: Level) -> Option<ClearLay> {
    hand_over::answering(WORD)?;
    let mut levelled = Measured { body: None, ..measured.clone() };
    level(&mut levelled.heights, levelled.rows, form, false);
    let folder = hand_over::temporary_folder().ok()?;
    let mut data = Data::new(folder.path());
    data.add_levelled("", "", &levelled, form).ok()?;
    let told: Value = serde_json::from_str(&hand_over::described(data.finish().ok()?, true).ok()?).ok()?;
    // As `plateau surface` has them.
    let (ratio, aspect_ratio) = match (told["Str"].as_f64(), told["Str_below"].as_f64()) {
        (Some(ratio), _) => (ratio, number::significant(ratio, 3)),
        (None, bound) => (bound?, number::less_than(bound?, 3)),
    };
    let direction = told["Std"].as_f64()?;
    (ratio < CLEAR_LAY).then(|| ClearLay::new(&aspect_ratio, direction, form))
}

/// Lines of the scene about a patch that is smaller than the fewest cells that are needed of it, and what that means.
fn smaller_than_cells(measured: &Measured) -> Option<(Vec<String>, String)> {
    let Measured { columns, rows, pitch, profile_lay, .. } = *measured;
    let [x, y] = pitch?;
    let (least, fewest) = match profile_lay {
        Some(Lay::Along | Lay::Across) => (columns as f64 * x, 1),
        Some(Lay::Isotropic) => (columns as f64 * x, Extension::FEWEST_CELLS),
        None => ((columns as f64 * x).min(rows as f64 * y), Extension::FEWEST_CELLS),
    };
    if least >= fewest as f64 * CELL * 1e-6 {
        return None;
    }
    let cells = if fewest == 1 { "a cell".to_owned() } else { format!("{fewest} cells") };
    let is = match profile_lay {
        Some(_) => format!("{} long", Length(columns as f64 * x)),
        None => format!("{} by {}", Length(columns as f64 * x), Length(rows as f64 * y)),
    };
    let most = Length(least / fewest as f64);
    let lines = vec![
        format!("{:40}# <- the patch is {is}, less than {cells}: it does not run before you", ""),
        format!("{:40}# take smaller cells (cell_size of at most {most}) or a larger patch", ""),
    ];
    let note = format!(
        "it is {is}, less than {cells} of {CELL} um, and the scene does not run as it is: take a cell_size of at most {most}, or \
         measure a larger area. If this is not its size, correct the pitch in the file"
    );
    Some((lines, note))
}

/// Reason why the scene that the arguments ask for cannot be run; nothing is written.
fn refusal(arguments: &NewArguments, error: &SceneError) -> Failure {
    let told = text::problems(error.problems().iter().map(|problem| with_options(arguments, problem)));
    Failure::input(format!("{told}\nnothing is written"))
}

/// A problem with the option that it comes from, or with its key where it comes from none.
fn with_options(arguments: &NewArguments, Problem { key, message, .. }: &Problem) -> String {
    let key = key.as_deref().unwrap_or_default();
    let name = key.rsplit('.').next().unwrap_or_default();
    let options = options(arguments);
    let message = options.iter().fold(message.clone(), |message, (name, option, _)| message.replace(name, option));
    match options.iter().find(|(known, ..)| *known == name) {
        Some((_, option, value)) => format!("{option} \"{value}\": {message}"),
        None => format!("{key}: {message}"),
    }
}

/// Keys of the scene, each with the option that it comes from and its value.
fn options(arguments: &NewArguments) -> [(&'static str, &'static str, &str); 6] {
    let NewArguments { pin_width, pin_length, diameter, radius, load, speed, duration, .. } = arguments;
    let width = match diameter {
        Some(diameter) => ("pin_width", "--diameter", diameter.as_str()),
        None => ("pin_width", "--pin-width", pin_width.as_str()),
    };
    [
        width,
        ("pin_length", "--pin-length", pin_length),
        ("mean_radius", "--radius", radius),
        ("normal_force", "--load", load),
        (arguments.speed_key(), "--speed", speed),
        ("duration", "--duration", duration),
    ]
}

/// The word of the package that converts.
const WORD: &str = "surface";

/// Converts a file beside the scene: the file that is written.
fn converted(scene: &Path, disc: &Path, force: bool) -> Result<PathBuf, Failure> {
    let name = Path::new(disc.file_name().unwrap_or_default()).with_extension("h5");
    let output = scene.with_file_name(name);
    let to = [OsStr::new("convert"), OsStr::new("--output"), output.as_os_str()];
    let from = [OsStr::new("--"), disc.as_os_str()];
    let arguments = to.into_iter().chain(force.then_some(OsStr::new("--force"))).chain(from);
    hand_over::succeeded(hand_over::asked(WORD, arguments)?, "it was not converted").map(|_| output)
}
