//! Which dimension of a dataset is x and which is y, by their names, and how far its points are apart, by their coordinates.
//!
//! A dimension is named by its label or else by its scale (HDF5 Dimension Scale Specification); the scales are the coordinate
//! variables of netCDF.

use hdf5::types::{Reference, TypeDescriptor, VarLenArray};
use hdf5::{Dataset, ObjectReference1, ReferencedObject};

use super::error::Hdf5Error;
use super::packing::Packing;
use super::stated_unit;
use crate::hdf5_file::{refuse_hollow, text_attribute, texts_of};
use crate::number;
use crate::text::short;
use crate::units::{self, Dimension};

/// How far a coordinate may be from a regular grid, in pitches, besides what rounding to its type makes.
const TOLERANCE: f64 = 1e-3;
/// How NAME begins of a scale that netCDF makes for a dimension without coordinates.
const NO_COORDINATES: &str = "This is a netCDF dimension";

/// What the dimensions of a dataset with two of them say.
pub(super) struct Dimensions {
    /// y comes first, x second.
    pub(super) is_turned: bool,
    /// Distance of neighbouring points along x and y, m, if the coordinates of both are there.
    pub(super) pitch: Option<[f64; 2]>,
    /// Coordinates along x and y decrease.
    decreases: [bool; 2],
}

impl Dimensions {
    /// As labels, scales and coordinates have it; x first where they say nothing.
    ///
    /// # Errors
    /// [`Hdf5Error`] when coordinates are not equidistant, or in another unit than one of length.
    pub(super) fn of(dataset: &Dataset) -> Result<Self, Hdf5Error> {
        let (labels, scales) = (labels(dataset)?, scales(dataset)?);
        let name = |place: usize| {
            let label = labels.get(place).filter(|label| !label.is_empty()).cloned();
            let scale = || Some(scales.get(place)?.as_ref()?.name().rsplit('/').next()?.to_owned());
            label.or_else(scale).unwrap_or_default()
        };
        let names = [name(0), name(1)];
        let is = |place: usize, axis: &str| names[place].eq_ignore_ascii_case(axis);
        let is_turned = (is(0, "y") && !is(1, "y")) || (is(1, "x") && !is(0, "x"));
        let places = if is_turned { [1, 0] } else { [0, 1] };
        let (mut pitch, mut decreases) = ([None; 2], [false; 2]);
        for (axis, name) in ["x", "y"].into_iter().enumerate() {
            let place = places[axis];
            let scale = scales.get(place).and_then(Option::as_ref).filter(|_| is(place, name));
            let Some(step) = scale.map(|scale| step(dataset, place, scale)).transpose()?.flatten() else { continue };
            (pitch[axis], decreases[axis]) = (Some(step.abs()), step < 0.0);
        }
        Ok(Self { is_turned, pitch: pitch[0].zip(pitch[1]).map(|(x, y)| [x, y]), decreases })
    }

    /// The values of a dataset of this shape column by column, x and y growing, with the numbers of columns and rows.
    pub(super) fn lay_out<T: Copy>(&self, shape: (usize, usize), values: Vec<T>) -> ((usize, usize), Vec<T>) {
        let (columns, rows) = if self.is_turned { (shape.1, shape.0) } else { shape };
        if !self.is_turned && self.decreases == [false; 2] {
            return ((columns, rows), values);
        }
        let from =
            |axis: usize, place: usize, count: usize| if self.decreases[axis] { count - 1 - place } else { place };
        let places = (0..columns).flat_map(|x| (0..rows).map(move |y| (x, y)));
        let value = |(x, y): (usize, usize)| {
            let (x, y) = (from(0, x, columns), from(1, y, rows));
            values[if self.is_turned { y * columns + x } else { x * rows + y }]
        };
        ((columns, rows), places.map(value).collect())
    }

    /// How values are laid out, in words, where it is not (columns, rows).
    pub(super) fn note(&self) -> Option<String> {
        let turned = self.is_turned.then(|| "dimensions (y, x)".to_owned());
        let reversed = ["x", "y"].into_iter().zip(self.decreases).filter(|(_, decreases)| *decreases);
        let reversed: Vec<String> = reversed.map(|(axis, _)| format!("{axis} decreases in the file")).collect();
        let facts: Vec<String> = turned.into_iter().chain(reversed).collect();
        (!facts.is_empty()).then(|| facts.join(", "))
    }
}

/// The labels of the dimensions; none where there are none.
fn labels(dataset: &Dataset) -> Result<Vec<String>, Hdf5Error> {
    let Ok(attribute) = dataset.attr("DIMENSION_LABELS") else { return Ok(Vec::new()) };
    let count = attribute.space()?.size();
    let labels = if count == dataset.ndim() { texts_of(&attribute)? } else { Vec::new() };
    if labels.len() == dataset.ndim() {
        return Ok(labels);
    }
    // Without them x and y might be taken for one another.
    Err(Hdf5Error::Attribute {
        dataset: dataset.name(),
        found: format!("DIMENSION_LABELS of {count} values of type {}", attribute.dtype()?.to_descriptor()?),
        expected: "one text for each dimension: correct it, or delete it where the dimensions are (columns, rows)",
    })
}

/// The first scale of each dimension; none where there is none.
fn scales(dataset: &Dataset) -> hdf5::Result<Vec<Option<Dataset>>> {
    let Ok(attribute) = dataset.attr("DIMENSION_LIST") else { return Ok(Vec::new()) };
    let references = TypeDescriptor::VarLenArray(Box::new(TypeDescriptor::Reference(Reference::Object)));
    if attribute.space()?.size() != dataset.ndim() || attribute.dtype()?.to_descriptor()? != references {
        return Ok(Vec::new());
    }
    let lists = attribute.read_raw::<VarLenArray<ObjectReference1>>()?;
    let scale = |list: &VarLenArray<ObjectReference1>| {
        let Some(first) = list.first() else { return Ok(None) };
        Ok(match dataset.dereference(first)? {
            ReferencedObject::Dataset(scale) => Some(scale),
            _ => None,
        })
    };
    lists.iter().map(scale).collect()
}

/// From one coordinate of a dimension to the next, m; none where there are no coordinates, or one point only.
fn step(dataset: &Dataset, place: usize, scale: &Dataset) -> Result<Option<f64>, Hdf5Error> {
    let count = dataset.shape()[place];
    let descriptor = scale.dtype()?.to_descriptor()?;
    let is_number =
        matches!(descriptor, TypeDescriptor::Float(_) | TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_));
    let is_empty = text_attribute(scale, "NAME")?.is_some_and(|name| name.starts_with(NO_COORDINATES));
    if scale.shape() != [count] || count < 2 || !is_number || is_empty {
        return Ok(None);
    }
    refuse_hollow(scale)?;
    let name = scale.name();
    let unit = match stated_unit(scale)? {
        None => 1.0,
        Some(unit) if is_metre(&unit) => 1.0,
        Some(unit) => units::parse(&format!("1 {unit}"), Dimension::Length).map_err(|_| Hdf5Error::Attribute {
            dataset: name.clone(),
            found: format!("units = \"{}\"", short(&unit).escape_debug()),
            expected: "a unit of length, for it has the coordinates of heights",
        })?,
    };
    let refuse = |problem: String| {
        let (dataset, dimension) = (dataset.name(), short(&name).into_owned());
        Err(Hdf5Error::Coordinates { dataset, dimension, problem })
    };
    let mut coordinates = scale.read_raw::<f64>()?;
    Packing::of(scale)?.unpack(&mut coordinates);
    let (first, last) = (coordinates[0], coordinates[count - 1]);
    let step = (last - first) / (count - 1) as f64;
    if !(step.is_finite() && step != 0.0) {
        return refuse(format!("run from {} to {}", number::plain(first), number::plain(last)));
    }
    let precision = if descriptor.size() < 8 { f64::from(f32::EPSILON) } else { f64::EPSILON };
    let rounding = precision * first.abs().max(last.abs());
    for (index, found) in coordinates.iter().enumerate() {
        let expected = first + index as f64 * step;
        let off = (found - expected).abs();
        if off.is_nan() || off > TOLERANCE * step.abs() + rounding {
            let [found, expected] = [*found, expected].map(number::plain);
            return refuse(format!("are not equidistant: number {index} is {found}, expected {expected}"));
        }
    }
    Ok(Some(step * unit))
}

/// Whether a text is a name of the metre.
pub(super) fn is_metre(unit: &str) -> bool {
    ["m", "metre", "metres", "meter", "meters"].contains(&unit)
}
