//! Heights that a run recorded: how rough disc and pin were before and after.

use std::path::Path;

use plateau_core::observe::{Map, MapValues};
use plateau_core::surface::Body;
use plateau_io::run_file::{RunFile, map_path};
use plateau_io::surface::{Format, Measured};
use plateau_present::figure::run::{moment, nearest};

use super::super::runs::warn_of_unfinished;
use super::named;
use crate::arguments::SurfaceArguments;
use crate::failure::Failure;

/// Maps that are heights; those of them that are described unless `--dataset` names one come first.
const HEIGHTS: [Map; 4] = [Map::DiscHeight, Map::PinHeight, Map::DiscSubstrate, Map::PinSubstrate];
const USUAL: usize = 2;

/// Heights with the name that they are told by.
pub struct RecordedHeights {
    /// The file; of a map of a run with its dataset and time.
    pub name: String,
    /// The body of a map of a run.
    pub body: Option<Body>,
    /// The heights; those of a map with peaks positive.
    pub measured: Measured,
}

/// The heights of a run file at the times that are asked for, else at the first and the last time of its maps; none where the file is no run
/// file.
///
/// # Errors
/// [`Failure::Input`] when an option has no use for a run file, or it has no such map.
pub fn of(path: &Path, arguments: &SurfaceArguments) -> Result<Option<Vec<RecordedHeights>>, Failure> {
    let Ok(run) = RunFile::open(path) else {
        return match arguments.at.is_empty() {
            true => Ok(None),
            false => Err(named(path, "--at is a time of a run, and this is not a run file: leave it out")),
        };
    };
    let dataset = arguments.reading.dataset.as_deref().map(|name| name.trim_start_matches('/'));
    let keys = arguments.reading.keys();
    if let Some((key, _)) = keys.iter().find(|(key, _)| *key != "dataset") {
        let option = key.replace('_', "-");
        return Err(named(path, format_args!("a run file says what its heights are: leave out --{option}")));
    }
    let maps: Vec<Map> = match dataset {
        None => HEIGHTS[..USUAL].iter().copied().filter(|map| run.has_map(*map)).collect(),
        Some(name) => HEIGHTS.into_iter().filter(|map| map_path(*map) == name && run.has_map(*map)).collect(),
    };
    let moments = match arguments.at.as_slice() {
        [] => [0, run.map_time().len().saturating_sub(1)].into_iter().take(run.map_time().len().min(2)).collect(),
        times => nearest(&run, times),
    };
    if maps.is_empty() || moments.is_empty() {
        let there: Vec<&str> = HEIGHTS.into_iter().filter(|map| run.has_map(*map)).map(map_path).collect();
        let wanted = dataset.unwrap_or("disc/height or pin/height");
        let found = match (moments.is_empty(), there.is_empty()) {
            (true, _) => "it has no maps yet".to_owned(),
            (_, true) => "it has no maps of heights: name disc_height in output.maps of the scene".to_owned(),
            _ => format!("it has {}", there.join(", ")),
        };
        return Err(named(path, format_args!("this run file has no {wanted}; {found}")));
    }
    warn_of_unfinished(&run);
    let mut found = Vec::new();
    for map in maps {
        for moment in &moments {
            found.extend(heights(&run, map, *moment)?);
        }
    }
    Ok(Some(found))
}

/// A map at one moment.
fn heights(run: &RunFile, map: Map, index: usize) -> Result<Option<RecordedHeights>, Failure> {
    let Some(MapValues::Float(mut heights)) = run.map(map, index).map_err(Failure::input)? else { return Ok(None) };
    let mesh = run.mesh();
    let body = if map.on_disc() { Body::Disc } else { Body::Pin };
    if body == Body::Pin {
        // The pin's z grows away from the disc.
        heights.iter_mut().for_each(|height| *height = -*height);
        mesh.absent_cells().for_each(|cell| heights[cell] = f64::NAN);
    }
    let measured = Measured {
        format: Format::Hdf5,
        columns: body.columns(mesh),
        rows: mesh.rows(),
        pitch: Some([mesh.column_width(), mesh.row_height()]),
        is_pitch_assumed: false,
        heights,
        instrument: true,
        profile_lay: None,
        notes: vec![format!("recorded by a run at {}", moment(run, index))],
        warnings: Vec::new(),
    };
    let name = format!("{} {}, {}", run.path().display(), map_path(map).replace('/', " "), moment(run, index));
    Ok(Some(RecordedHeights { name, body: Some(body), measured }))
}
