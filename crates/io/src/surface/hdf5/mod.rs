//! Heights and fibre maps in HDF5 files, netCDF-4 and run files among them: shape (columns, rows) unless the dimensions are named
//! x and y, heights in m.

mod netcdf;

use std::path::Path;

use hdf5::Dataset;
use hdf5::types::TypeDescriptor;
use ndarray::ArrayView2;
use netcdf::{Dimensions, Packing, is_metre, numbers, stated_unit, wrong};
use plateau_core::model::state::Base;
use plateau_core::observe::{Map, MapValues};
use plateau_core::surface::{Body, Patch};

use super::error::Hdf5Error;
use super::format::Format;
use super::measured::{MOST_POINTS, Measured, agreed_pitch, present};
use crate::hdf5_file::{self, in_words, text_attribute, write_text};
use crate::memory::refuse_beyond;
use crate::number;
use crate::run_file::{ReadError, RunFile, State, map_path};
use crate::text::short;

#[derive(Clone, Copy)]
enum Wanted {
    Heights,
    /// Fibre map of shape (columns, rows).
    Base((usize, usize)),
}

impl Wanted {
    fn fits(self, dataset: &Dataset) -> bool {
        let number = descriptor(dataset);
        let is_integer = matches!(number, Some(TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_)));
        let is_word = matches!(number, Some(TypeDescriptor::Enum(_) | TypeDescriptor::Boolean));
        match (self, dataset.shape()[..].as_ref()) {
            (Self::Heights, [_, _]) => {
                matches!(number, Some(TypeDescriptor::Float(_))) || (is_integer && Packing::is_packed(dataset))
            }
            (Self::Base(expected), &[first, second]) => {
                let is_turned = Dimensions::of(dataset).is_ok_and(|dimensions| dimensions.is_turned);
                expected == (if is_turned { (second, first) } else { (first, second) }) && (is_integer || is_word)
            }
            _ => false,
        }
    }

    fn describe(self) -> String {
        match self {
            Self::Heights => "floating-point numbers and 2 dimensions (columns, rows)".to_owned(),
            Self::Base((columns, rows)) => format!("integers and shape (pin_columns, rows) = ({columns}, {rows})"),
        }
    }
}

/// Reads heights, m: numbers with 2 dimensions (columns, rows), or named x and y in any order, NaN where there is none; or a map of
/// heights of a run file, the last one or that `at` a time in s. Without a name the file's only suitable dataset is taken. Its
/// attribute `units` may say that heights are in m, `pitch` or coordinates x and y the distance of the points, and the
/// attributes of netCDF how heights are packed.
pub(super) fn heights(path: &Path, dataset: Option<&str>, at: Option<f64>) -> Result<Measured, Hdf5Error> {
    if let Some(recorded) = recorded(path, dataset, at)? {
        return Ok(recorded);
    }
    let (dataset, dimensions, packing, pitch) = hdf5_file::guarded(0, || {
        let dataset = find(path, dataset, Wanted::Heights)?;
        refuse_other_units(&dataset)?;
        let (dimensions, packing) = (Dimensions::of(&dataset)?, Packing::of(&dataset)?);
        let stated = pitch(&dataset)?;
        let pitch = agreed_pitch(dimensions.pitch, stated).map_err(|_| {
            let found = format!("pitch = {:?}", stated.unwrap_or_default());
            wrong(&dataset, found, "the distance of points as its coordinates have it")
        })?;
        Ok::<_, Hdf5Error>((dataset, dimensions, packing, pitch))
    })?;
    let (name, shape) = (dataset.name(), bounded_shape(&dataset)?);
    hdf5_file::refuse_hollow(&dataset)?;
    let points = shape.0 * shape.1;
    // The heights, and what the library converts or inflates at a time, at most all of them; or the heights laid out anew.
    let needed = (2 * points * size_of::<f64>()) as u64;
    refuse_beyond(needed).map_err(|no_room| Hdf5Error::Memory { dataset: name.clone(), no_room })?;
    let mut heights = hdf5_file::guarded(points * size_of::<f64>(), || dataset.read_raw::<f64>())?;
    packing.unpack(&mut heights);
    let count = heights.iter().filter(|height| height.is_infinite()).count();
    if count > 0 {
        return Err(Hdf5Error::Infinite { dataset: name, count, points: heights.len() });
    }
    let ((columns, rows), heights) = dimensions.lay_out(shape, heights);
    let converted = converted(&dataset)?;
    let is_converted = converted.is_some();
    let notes = [Some(format!("dataset {name}")), converted, dimensions.note(), packing.note()];
    let notes = notes.into_iter().flatten().collect();
    // Those of an instrument have peaks positive.
    Ok(Measured { notes, instrument: is_converted, ..Measured::new(Format::Hdf5, [columns, rows], pitch, heights) })
}

/// Note on the file from which the heights were converted, and on what converted it, if they were.
fn converted(dataset: &Dataset) -> hdf5::Result<Option<String>> {
    if dataset.attr("source_file").is_err() {
        return Ok(None);
    }
    let text = |name: &str| text_attribute(dataset, name).map(Option::unwrap_or_default);
    let (file, digest, by) = (text("source_file")?, text("source_sha256")?, text("converted_by")?);
    let digest: String = digest.chars().filter(char::is_ascii_hexdigit).take(64).collect();
    let [file, by] = [&file, &by].map(|text| short(text).escape_debug().to_string());
    Ok(Some(format!("converted from {file} (SHA-256 {digest}) by {by}")))
}

/// Refuses heights that say of themselves that they are not in m.
fn refuse_other_units(dataset: &Dataset) -> Result<(), Hdf5Error> {
    // Zygo says so in words of its own, as fringes or nanometres.
    if dataset.attr("Z Converter").is_ok() {
        return Err(Hdf5Error::Zygo { dataset: dataset.name() });
    }
    let Some(found) = stated_unit(dataset)? else { return Ok(()) };
    if is_metre(&found) {
        return Ok(());
    }
    let found = format!("units = \"{}\"", short(&found).escape_debug());
    Err(wrong(dataset, found, "\"m\""))
}

/// The attribute `pitch`, m: one length, or those along x and y.
fn pitch(dataset: &Dataset) -> Result<Option<[f64; 2]>, Hdf5Error> {
    if dataset.attr("pitch").is_err() {
        return Ok(None);
    }
    let lengths = numbers(dataset, "pitch")?;
    match lengths[..] {
        [x, y] if x > 0.0 && y > 0.0 && x.is_finite() && y.is_finite() => Ok(Some([x, y])),
        // One length is that along both.
        [both] if both > 0.0 && both.is_finite() => Ok(Some([both; 2])),
        _ => {
            let expected = "the distance of points along x and y in m, positive and finite";
            Err(wrong(dataset, format!("pitch = {lengths:?}"), expected))
        }
    }
}

/// Writes the heights of a patch as the dataset `/height` of a new file: float64, shape (columns, rows), m, NaN where a
/// point is missing, with the attributes `units` and `pitch` (m, along x and y).
pub fn write(path: &Path, patch: &Patch) -> Result<(), Hdf5Error> {
    let shape = (patch.columns, patch.rows);
    let heights = ArrayView2::from_shape(shape, &patch.heights).map_err(in_words)?;
    let file = hdf5::File::create(path)?;
    let dataset = file.new_dataset_builder().with_data(heights).create("height")?;
    for (name, text) in [("units", "m"), ("long_name", "height, columns along the sliding direction, rows outward")] {
        write_text(&dataset, name, text)?;
    }
    let pitch = [patch.column_pitch, patch.row_pitch];
    dataset.new_attr::<f64>().shape(2).create("pitch")?.write_raw(&pitch)?;
    // The library writes some values when the dataset is closed, and then nobody hears that it failed.
    file.flush()?;
    drop(dataset);
    file.close()?;
    Ok(())
}

/// Reads a fibre map: integers of shape (columns, rows), 0 = none and 1 = primary; what stands where `is_there` says that there
/// is no cell, does not matter. Gives the dataset's name too.
pub(super) fn base(
    path: &Path,
    dataset: Option<&str>,
    shape: (usize, usize),
    is_there: impl Fn(usize) -> bool,
) -> Result<(String, Vec<Base>), Hdf5Error> {
    let (dataset, dimensions) = hdf5_file::guarded(0, || {
        let dataset = find(path, dataset, Wanted::Base(shape))?;
        let dimensions = Dimensions::of(&dataset)?;
        Ok::<_, Hdf5Error>((dataset, dimensions))
    })?;
    hdf5_file::refuse_hollow(&dataset)?;
    let (name, stored) = (dataset.name(), bounded_shape(&dataset)?);
    let numbers = hdf5_file::guarded(shape.0 * shape.1 * size_of::<i64>(), || dataset.read_raw::<i64>())?;
    let (_, numbers) = dimensions.lay_out(stored, numbers);
    let base = numbers.into_iter().enumerate().map(|(cell, number)| match number {
        0 => Ok(Base::Resin),
        1 => Ok(Base::Primary),
        _ if !is_there(cell) => Ok(Base::Resin),
        found => Err(Hdf5Error::Base { dataset: name.clone(), found, column: cell / shape.1, row: cell % shape.1 }),
    });
    let base = base.collect::<Result<_, _>>()?;
    Ok((name, base))
}

/// The dataset of that name, or the only suitable one.
fn find(path: &Path, dataset: Option<&str>, wanted: Wanted) -> Result<Dataset, Hdf5Error> {
    let (file, mut all) = hdf5_file::open_with_datasets(path)?;
    all.sort_by_key(|dataset| dataset.name());
    let Some(name) = dataset else {
        let mut suitable: Vec<&Dataset> = all.iter().filter(|dataset| wanted.fits(dataset)).collect();
        return match (suitable.pop(), suitable.len()) {
            (Some(only), 0) => Ok(only.clone()),
            (last, others) => Err(Hdf5Error::Ambiguous {
                found: others + usize::from(last.is_some()),
                wanted: wanted.describe(),
                present: list(&all),
            }),
        };
    };
    let Ok(dataset) = file.dataset(name) else {
        return Err(Hdf5Error::Missing { dataset: name.to_owned(), present: list(&all) });
    };
    if wanted.fits(&dataset) {
        Ok(dataset)
    } else {
        Err(Hdf5Error::Unsuitable { dataset: dataset.name(), found: describe(&dataset), wanted: wanted.describe() })
    }
}

fn list(datasets: &[Dataset]) -> String {
    let name = |dataset: &Dataset| format!("{} ({})", short(&dataset.name()), describe(dataset));
    present(datasets, name, "it has no datasets")
}

fn describe(dataset: &Dataset) -> String {
    let number = descriptor(dataset).map_or_else(|| "an unknown type".to_owned(), |number| number.to_string());
    let shape: Vec<String> = dataset.shape().iter().map(ToString::to_string).collect();
    format!("{number}, shape ({})", shape.join(", "))
}

fn descriptor(dataset: &Dataset) -> Option<TypeDescriptor> {
    dataset.dtype().and_then(|dtype| dtype.to_descriptor()).ok()
}

fn bounded_shape(dataset: &Dataset) -> Result<(usize, usize), Hdf5Error> {
    let shape = dataset.shape();
    let (columns, rows) = (shape.first().copied().unwrap_or(0), shape.get(1).copied().unwrap_or(0));
    match columns.checked_mul(rows) {
        Some(points) if points <= MOST_POINTS => Ok((columns, rows)),
        _ => Err(Hdf5Error::TooLarge { dataset: dataset.name(), shape: (columns, rows) }),
    }
}

/// Maps of a run file that are heights.
pub const HEIGHTS: [Map; 4] = [Map::DiscHeight, Map::PinHeight, Map::DiscSubstrate, Map::PinSubstrate];
/// Part of a time by which a map may be from it: that of a step is recorded when it ends.
const SAME_TIME: f64 = 0.01;

/// The heights of a map of a run file, with the model's signs: the last, or that `at` a time in s. None where the file is no run
/// file, or the dataset is none of its maps of heights.
fn recorded(path: &Path, dataset: Option<&str>, at: Option<f64>) -> Result<Option<Measured>, Hdf5Error> {
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
    let cells = if map.on_disc() { run.mesh().disc_cells() } else { run.mesh().pin_cells() };
    // As they are stored, and as they are read.
    let needed = 2 * (cells * size_of::<f64>()) as u64;
    let too_large = |no_room| Hdf5Error::Memory { dataset: format!("/{}", map_path(map)), no_room };
    refuse_beyond(needed).map_err(too_large)?;
    let found = index.map(|index| Ok::<_, Hdf5Error>((times[index], of_map(&run, map, index)?))).transpose()?;
    let Some((time, Some(measured))) = found else {
        let at = at.filter(|_| run.has_map(map)).map(|at| (at, times.to_vec()));
        return Err(Hdf5Error::NoMap { map: map_path(map), at });
    };
    let mut warnings = Vec::new();
    if run.state() != State::Finished {
        warnings.push(format!("its run is not finished, its state is {}", run.state().name()));
    }
    let notes = vec![format!("dataset /{}", map_path(map)), format!("recorded by a run at {} s", number::plain(time))];
    Ok(Some(Measured { notes, warnings, ..measured }))
}

/// The heights of a map of a run file at one moment, with the model's signs; none where it has no such map.
pub fn of_map(run: &RunFile, map: Map, index: usize) -> Result<Option<Measured>, ReadError> {
    let (mesh, body) = (run.mesh(), if map.on_disc() { Body::Disc } else { Body::Pin });
    let Some(MapValues::Float(mut heights)) = run.map(map, index)? else { return Ok(None) };
    if body == Body::Pin {
        mesh.absent_cells().for_each(|cell| heights[cell] = f64::NAN);
    }
    let pitch = Some([mesh.column_width(), mesh.row_height()]);
    let plain = Measured::new(Format::Hdf5, [body.columns(mesh), mesh.rows()], pitch, heights);
    Ok(Some(Measured { body: Some(body), instrument: false, ..plain }))
}
