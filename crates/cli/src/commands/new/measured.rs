//! The disc of a scene from a measured surface, or from a profile.

use std::fmt;
use std::path::Path;

use plateau_core::surface::describe::{Autocorrelation, Description, Grid, HeightParameters};
use plateau_core::surface::{Condition, Extension, Length, Level, Spikes, implausible, level};
use plateau_io::memory::refuse_beyond;
use plateau_io::surface::{self, FileError, Lay, Measured, TextError};

use super::{CELL, line};
use crate::arguments::{ReadArguments, as_options};
use crate::failure::Failure;
use crate::{message, number};

/// The tables of the disc: the file read as it is, levelled, without spikes, filled where points are missing, and extended by its
/// statistics; of the profile of a surface with grooves, tiled. Besides, what should be known of them.
pub fn disc(scene: &Path, disc: &Path, reading: &ReadArguments) -> Result<(String, Vec<String>), Failure> {
    let named = |reason: &dyn fmt::Display| Failure::input(format!("{}: {reason}", disc.display()));
    let measured = read(disc, reading).map_err(|reason| named(&reason))?;
    if measured.pitch.is_none() {
        return Err(named(&"it does not say how far its points are apart: give --pitch, such as --pitch \"5 um\""));
    }
    let too_small = smaller_than_cells(&measured);
    if let (Some(_), true, [warning, ..]) = (&too_small, measured.is_pitch_assumed, &measured.warnings[..]) {
        return Err(named(&format_args!("{warning}{}", as_options(warning))));
    }
    let mut lines = vec![line("file", path_from(scene, disc).map_err(|reason| named(&reason))?, "<-")];
    lines.extend(reading.keys().into_iter().map(|(key, value)| line(key, value, "<-")));
    let mut notes = Vec::new();
    lines.extend([String::new(), "[disc.prepare]".to_owned()]);
    let condition = condition(&measured);
    if measured.profile_lay.is_none() {
        let form = condition.map_or(Level::Plane, |condition| condition.form);
        let (rotate, remark) = match lay(&measured, form) {
            None => (
                "90 deg".to_owned(),
                "x of the file is along sliding: turn it where the lay would be across".to_owned(),
            ),
            Some(lay) => {
                notes.push(format!("{}: {}", disc.display(), lay.told()));
                (lay.rotate(), lay.remark())
            }
        };
        lines.push(format!("{:40}# {remark}", format!("# rotate = \"{rotate}\"")));
    }
    match &condition {
        Some(Condition { form: Level::Quadratic, rms_of_forms: [plane, quadratic], .. }) => {
            let bow = format!(
                "the surface is bowed: rms {} once a plane is taken out, {} once second order is",
                Length(*plane),
                Length(*quadratic)
            );
            lines.push(line("level", "quadratic", &format!("<- {bow}")));
            notes.push(format!("{}: {bow}: level = \"quadratic\" takes that out", disc.display()));
        }
        _ => lines.push(line("level", "plane", "form that is taken out: mean, plane, quadratic")),
    }
    let spikes = condition.and_then(|condition| condition.spikes);
    if let Some(spikes) = &spikes {
        lines.push(line("outliers", Spikes::LIMIT as i64, &format!("<- {}", told(spikes))));
        notes.push(format!("{}: {}: outliers = {} takes them out", disc.display(), told(spikes), Spikes::LIMIT));
    }
    if let Some((pixel, note)) = too_small {
        lines.extend(pixel);
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
        lines.push(format!(
            "{:40}# <- cuts peaks at this height above the mean, here one rms height",
            format!("# {cutoff}")
        ));
        notes.push(format!(
            "{}: no peaks are cut. With {cutoff}, one rms height as in the paper, the contact area is several times as large: \
             docs/values.md says when to give it",
            disc.display()
        ));
    }
    Ok((lines.join("\n"), notes))
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

/// What there is of spikes, in words.
fn told(spikes: &Spikes) -> String {
    let Spikes { count, points, kurtosis, rms } = *spikes;
    let (kurtosis, [before, after]) = (number::rounded(kurtosis, 3), rms.map(Length));
    format!("{count} of {points} points are spikes: kurtosis {kurtosis}, rms {before}, without them {after}")
}

/// Reads the file; a profile whose lay is not said is asked for it.
fn read(disc: &Path, reading: &ReadArguments) -> Result<Measured, String> {
    let found = match surface::read(disc, &reading.options()) {
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

/// The lay of a patch.
struct ClearLay {
    /// Str, or what it is less than.
    aspect_ratio: String,
    /// The form without which the heights are looked at.
    form: Level,
    /// Std, deg, from along sliding towards outward.
    direction: f64,
}

/// The lay of a patch, if it has a clear one and there is memory to look for it.
fn lay(measured: &Measured, form: Level) -> Option<ClearLay> {
    let Measured { columns, rows, pitch, ref heights, .. } = *measured;
    refuse_beyond(Description::memory_needed(columns, rows)).ok()?;
    let mut heights = heights.clone();
    level(&mut heights, rows, form, false);
    let mean = HeightParameters::of(&heights)?.mean;
    let found = Autocorrelation::of(&Grid { columns, rows, pitch, heights: &heights }, mean)?;
    let largest = found.largest_aspect_ratio();
    // As `plateau surface` has them.
    let is_bound = found.aspect_ratio.is_nan();
    let aspect_ratio = if is_bound { number::less_than(largest, 3) } else { number::significant(largest, 3) };
    let is_clear = largest < CLEAR_LAY && !found.direction.is_nan();
    is_clear.then(|| ClearLay { aspect_ratio, form, direction: found.direction.to_degrees() })
}

impl ClearLay {
    /// Which way it runs, in words.
    fn runs(&self) -> String {
        let Self { aspect_ratio, form, direction } = self;
        let way = match direction.abs() {
            ..=ALONG => "along sliding, x of the file",
            angle if angle >= 90.0 - ALONG => "across sliding, along y of the file",
            _ => "oblique to sliding, x of the file",
        };
        // `plateau surface` takes a plane out unless told otherwise.
        let beside = if *form == Level::Quadratic { ", with --level quadratic" } else { "" };
        // Added to 0, what is rounded to it has no sign.
        let tenths = (10.0 * direction).round() / 10.0 + 0.0;
        format!("{way} (Str {aspect_ratio}, Std {} deg{beside})", number::rounded(tenths, 3))
    }

    /// The angle that turns it along sliding; of one that runs along, across.
    fn rotate(&self) -> String {
        let is_oblique = (ALONG..90.0 - ALONG).contains(&self.direction.abs());
        let degrees = if is_oblique { -self.direction.round() } else { 90.0 };
        format!("{} deg", number::plain(degrees))
    }

    /// Where that turns it.
    fn to(&self) -> &'static str {
        if self.direction.abs() <= ALONG { "across sliding" } else { "along sliding" }
    }

    /// What stands beside the key in the scene.
    fn remark(&self) -> String {
        format!("<- the lay runs {}: this turns it {}", self.runs(), self.to())
    }

    /// What is said of it.
    fn told(&self) -> String {
        let (runs, rotate, to) = (self.runs(), self.rotate(), self.to());
        format!("its lay runs {runs}: rotate = \"{rotate}\" turns it {to}, where the disc has it so")
    }
}

/// The path of the surface as the scene has it: relative where it is in or below the scene's folder.
fn path_from(scene: &Path, disc: &Path) -> Result<String, String> {
    let folder = std::path::absolute(scene).ok().and_then(|scene| scene.parent().map(Path::to_owned));
    let path = std::path::absolute(disc).map_err(|reason| reason.to_string())?;
    let path = folder.and_then(|folder| path.strip_prefix(folder).ok().map(Path::to_owned)).unwrap_or(path);
    path.to_str().map(str::to_owned).ok_or_else(|| "its path is not UTF-8, as a scene is: rename it".to_owned())
}

/// Lines of the scene about a patch that is smaller than the fewest cells that are needed of it, and what that means; it is not read as
/// larger unless the user says so.
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
    let size = |x: f64, y: f64| match profile_lay {
        Some(_) => format!("{} long", Length(columns as f64 * x)),
        None => format!("{} by {}", Length(columns as f64 * x), Length(rows as f64 * y)),
    };
    let (is, read_as) = (size(x, y), size(CELL * 1e-6, CELL * 1e-6));
    let pixel = format!("pixel = \"{CELL} um\"");
    let most = Length(least / fewest as f64);
    let lines = vec![
        format!("{:40}# <- the patch is {is}, less than {cells}: it does not run before you", format!("# {pixel}")),
        format!("{:40}# take smaller cells (cell_size of at most {most}) or a larger patch, or read it as larger", ""),
    ];
    let note = format!(
        "it is {is}, less than {cells} of {CELL} um, and the scene does not run as it is: take a cell_size of at most {most}, or \
         measure a larger area. With {pixel} it would be read as {read_as}, with the heights as they are: a much smoother disc than \
         the measured one. If this is not its size, correct the pitch"
    );
    Some((lines, note))
}
