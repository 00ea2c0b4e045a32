//! Heights of an HDF5 file, and those that a run recorded, as the surface of another run.

use std::path::Path;

use plateau_core::observe::{Map, MapValues};
use plateau_core::surface::Body;

use super::error::Hdf5Error;
use crate::memory::refuse_beyond;
use crate::run_file::{ReadError, RunFile, State, map_path};
use crate::{hdf5_file, number};

/// Heights of an HDF5 file, column by column.
pub(in crate::surface) struct Heights {
    pub(in crate::surface) columns: usize,
    pub(in crate::surface) rows: usize,
    /// Distance of neighbouring points along x and y, m, if the dataset states it.
    pub(in crate::surface) pitch: Option<[f64; 2]>,
    pub(in crate::surface) heights: Vec<f64>,
    /// They are those of an instrument, peaks positive, and were converted from its file.
    pub(in crate::surface) is_converted: bool,
    /// The body of which a run recorded them.
    pub(in crate::surface) body: Option<Body>,
    /// What they are, one fact a line.
    pub(in crate::surface) notes: Vec<String>,
    /// What is to be warned of.
    pub(in crate::surface) warnings: Vec<String>,
}

/// Maps that are heights.
const HEIGHTS: [Map; 4] = [Map::DiscHeight, Map::DiscSubstrate, Map::PinHeight, Map::PinSubstrate];
/// Part of a time by which a map may be from it: that of a step is recorded when it ends.
const SAME_TIME: f64 = 0.01;

/// The heights of a map of a run file, with the model's signs: the last, or that `at` a time in s. None where the file is no run
/// file, or the dataset is none of its maps of heights.
pub(super) fn heights(path: &Path, dataset: Option<&str>, at: Option<f64>) -> Result<Option<Heights>, Hdf5Error> {
    let not_recorded = |found: &str| match at {
        Some(_) => Err(Hdf5Error::NotRecorded { found: found.to_owned() }),
        None => Ok(None),
    };
    let name = dataset.map(|name| name.trim_start_matches('/'));
    let map = HEIGHTS.into_iter().find(|map| Some(map_path(*map)) == name);
    let run = match RunFile::open(path) {
        Ok(run) => run,
        // What cannot be opened at all is told as of any file.
        Err(error @ (ReadError::Newer { .. } | ReadError::Damaged { .. }))
            if map.is_some() && hdf5_file::guarded(0, || hdf5_file::open(path)).is_ok() =>
        {
            return Err(error.into());
        }
        Err(_) => return not_recorded("this file"),
    };
    let map = match (map, dataset) {
        (Some(map), _) => map,
        (None, None) => return Err(Hdf5Error::WhichMap),
        (None, Some(dataset)) => return not_recorded(dataset),
    };
    let times = run.map_time();
    let is_near = |time: &f64, wanted: f64| (time - wanted).abs() <= SAME_TIME * wanted;
    let index = match at {
        None => times.len().checked_sub(1),
        Some(at) => {
            let near = (0..times.len()).filter(|index| is_near(&times[*index], at));
            near.min_by(|one, other| (times[*one] - at).abs().total_cmp(&(times[*other] - at).abs()))
        }
    };
    let body = if map.on_disc() { Body::Disc } else { Body::Pin };
    let (columns, rows) = (body.columns(run.mesh()), run.mesh().rows());
    // As they are stored, and as they are read.
    let needed = 2 * (columns * rows * size_of::<f64>()) as u64;
    let too_large = |no_room| Hdf5Error::Memory { dataset: format!("/{}", map_path(map)), no_room };
    refuse_beyond(needed).map_err(too_large)?;
    let found = index.map(|index| Ok::<_, Hdf5Error>((times[index], run.map(map, index)?))).transpose()?;
    let Some((time, Some(MapValues::Float(mut heights)))) = found else {
        let at = at.filter(|_| run.has_map(map)).map(|at| (at, times.to_vec()));
        return Err(Hdf5Error::NoMap { map: map_path(map), at });
    };
    if body == Body::Pin {
        run.mesh().absent_cells().for_each(|cell| heights[cell] = f64::NAN);
    }
    let mut warnings = Vec::new();
    if run.state() != State::Finished {
        warnings.push(format!("its run is not finished, its state is {}", run.state().name()));
    }
    Ok(Some(Heights {
        columns,
        rows,
        pitch: Some([run.mesh().column_width(), run.mesh().row_height()]),
        heights,
        is_converted: false,
        body: Some(body),
        notes: vec![format!("dataset /{}", map_path(map)), format!("recorded by a run at {} s", number::plain(time))],
        warnings,
    }))
}
