//! Heights that a run recorded: how rough disc and pin were before and after.

use std::path::Path;

use plateau_core::observe::Map;
use plateau_io::memory::refuse_beyond;
use plateau_io::run_file::{ReadError, RunFile, map_path};
use plateau_io::surface::Measured;
use plateau_io::surface::hdf5::{HEIGHTS, of_map};

use super::super::runs::{moment, nearest, warn_of_times, warn_of_unfinished};
use crate::arguments::SurfaceArguments;
use crate::failure::Failure;

/// The first of the maps of heights are described unless `--dataset` names one.
const USUAL: usize = 2;

/// Heights with the name that they are told by.
pub struct NamedHeights {
    /// The file; of a map of a run with its dataset and time.
    pub name: String,
    /// Of a map of a run the end of that name: dataset and time.
    pub map: String,
    /// The heights; those of a map with peaks positive.
    pub measured: Measured,
}

/// The heights of a run file at the times that are asked for, else at the first and the last time of its maps; none where the file is no run
/// file.
pub fn of(path: &Path, arguments: &SurfaceArguments) -> Result<Option<Vec<NamedHeights>>, Failure> {
    let run = match RunFile::open(path) {
        Ok(run) => run,
        Err(
            ReadError::NotHdf5 { .. }
            | ReadError::Foreign { .. }
            | ReadError::Elsewhere { .. }
            | ReadError::System { .. },
        ) if arguments.at.is_empty() => {
            return Ok(None);
        }
        Err(error @ (ReadError::NotHdf5 { .. } | ReadError::Foreign { .. })) => {
            return Err(Failure::input(format!("{error}; --at is a time of a run")));
        }
        Err(error) => return Err(Failure::input(error)),
    };
    let keys = arguments.reading.keys();
    if let Some((key, _)) = keys.iter().find(|(key, _)| *key != "dataset") {
        let option = key.replace('_', "-");
        return Err(Failure::of_file(path, format_args!("a run file says what its heights are: leave out --{option}")));
    }
    let dataset = arguments.reading.dataset.as_deref().map(|name| name.trim_start_matches('/'));
    let wanted: Vec<Map> = match dataset {
        None => HEIGHTS[..USUAL].to_vec(),
        Some(name) => HEIGHTS.into_iter().filter(|map| map_path(*map) == name).collect(),
    };
    if wanted.is_empty() {
        let known = HEIGHTS.map(map_path).join(", ");
        let found = dataset.unwrap_or_default();
        return Err(Failure::of_file(path, format_args!("--dataset \"{found}\": expected a map of heights: {known}")));
    }
    let maps: Vec<Map> = wanted.iter().copied().filter(|map| run.has_map(*map)).collect();
    let times = run.map_time().len();
    if maps.is_empty() || times == 0 {
        let names = wanted.iter().map(|map| map.name()).collect::<Vec<_>>().join(" or ");
        let what = if times == 0 && !maps.is_empty() { "no map yet".to_owned() } else { format!("no map {names}") };
        let advice = "output.maps of the scene says which are recorded, output.maps_at when";
        return Err(Failure::of_file(path, format_args!("this run file has {what}: {advice}")));
    }
    let moments = match arguments.at.as_slice() {
        [] if times == 1 => vec![0],
        [] => vec![0, times - 1],
        at => nearest(&run, at),
    };
    warn_of_unfinished(&run);
    warn_of_times(&run, &arguments.at);
    let mut found = Vec::new();
    for map in maps {
        for moment in &moments {
            found.extend(heights(&run, map, *moment)?);
        }
    }
    Ok(Some(found))
}

/// A map at one moment.
fn heights(run: &RunFile, map: Map, index: usize) -> Result<Option<NamedHeights>, Failure> {
    let (name, cells) = (map_path(map), if map.on_disc() { run.mesh().disc_cells() } else { run.mesh().pin_cells() });
    // As they are stored, as they are read, and as they are described.
    refuse_beyond(3 * size_of::<f64>() as u64 * cells as u64).map_err(|no_room| {
        let what = format_args!("to read {name} needs {no_room}; free memory, or allow this process more of it");
        Failure::of_file(run.path(), what)
    })?;
    let Some(mut measured) = of_map(run, map, index).map_err(Failure::input)? else { return Ok(None) };
    if let Some(body) = measured.body {
        body.turn(&mut measured.heights);
    }
    measured.notes.push(format!("recorded by a run at {}", moment(run, index)));
    let map = format!("{}, {}", name.replace('/', " "), moment(run, index));
    Ok(Some(NamedHeights { name: format!("{} {map}", run.path().display()), map, measured }))
}
