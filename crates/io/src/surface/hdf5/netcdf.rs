//! Conventions of netCDF for a dataset: which dimension is x and which is y, how far its points are apart, how its numbers are packed
//! (HDF5 Dimension Scale Specification; NetCDF Users Guide, attribute conventions; CF conventions, 2.5.1 and 8.1).

use hdf5::types::{FloatSize, Reference, TypeDescriptor, VarLenArray};
use hdf5::{Dataset, Location, ObjectReference1, ReferencedObject};

use crate::hdf5_file::{refuse_hollow, text_attribute, texts_of};
use crate::number;
use crate::surface::error::Hdf5Error;
use crate::text::short;
use crate::units::{self, Dimension};

/// The attribute of the factor, without which integers are no heights.
const SCALE_FACTOR: &str = "scale_factor";
/// The attribute that says whether integers are to be read without a sign, whatever their type is.
const UNSIGNED: &str = "_Unsigned";

/// Packing of numbers: a stored one means NaN where it is a mark or not valid, else itself times `scale_factor` plus `add_offset`.
pub(super) struct Packing {
    scale_factor: f64,
    add_offset: f64,
    /// Stored numbers that mark missing points.
    marks: Vec<f64>,
    /// The least and the largest stored number that is valid, if they are stated.
    valid: Option<[f64; 2]>,
    /// The least of the integers that are meant and how many there are, where netCDF says of their sign another thing than their type.
    range: Option<[f64; 2]>,
}

impl Packing {
    pub(super) fn is_packed(dataset: &Dataset) -> bool {
        dataset.attr(SCALE_FACTOR).is_ok()
    }

    /// Reads the packing from the attributes of a dataset.
    pub(super) fn of(dataset: &Dataset) -> Result<Self, Hdf5Error> {
        let one = |name: &str, absent: f64, fits: fn(f64) -> bool, expected: &'static str| {
            if dataset.attr(name).is_err() {
                return Ok(absent);
            }
            match numbers(dataset, name)?[..] {
                [number] if number.is_finite() && fits(number) => Ok(number),
                ref found => Err(wrong(dataset, format!("{name} = {found:?}"), expected)),
            }
        };
        let mut marks = Vec::new();
        for name in ["_FillValue", "missing_value"] {
            let found = numbers(dataset, name)?;
            if found.is_empty() && dataset.attr(name).is_ok() {
                return Err(wrong(dataset, name, "a number, or up to 64, in it"));
            }
            marks.extend(found);
        }
        let range = range(dataset)?;
        let mut valid = valid(dataset)?;
        for numbers in std::iter::once(&mut marks[..]).chain(valid.as_mut().map(|valid| &mut valid[..])) {
            as_stored(dataset, numbers)?;
            range.iter().for_each(|range| into_range(*range, numbers));
        }
        if let Some(valid @ [least, largest]) = valid
            && least > largest
        {
            let found = format!("valid_range, or valid_min and valid_max, of {valid:?}");
            return Err(wrong(dataset, found, "the least number first: correct or delete it"));
        }
        Ok(Self {
            range,
            valid,
            scale_factor: one(SCALE_FACTOR, 1.0, |factor| factor != 0.0, "one finite number that is not 0")?,
            add_offset: one("add_offset", 0.0, |_| true, "one finite number")?,
            marks,
        })
    }

    /// Turns stored numbers into those that they stand for, in place.
    pub(super) fn unpack(&self, stored: &mut [f64]) {
        let Self { scale_factor, add_offset, ref marks, valid, range } = *self;
        range.iter().for_each(|range| into_range(*range, stored));
        if marks.iter().any(|mark| !mark.is_nan()) {
            stored.iter_mut().filter(|number| marks.contains(number)).for_each(|number| *number = f64::NAN);
        }
        if let Some([least, largest]) = valid {
            let is_valid = |number: f64| least <= number && number <= largest;
            stored.iter_mut().filter(|number| !is_valid(**number)).for_each(|number| *number = f64::NAN);
        }
        if (scale_factor, add_offset) != (1.0, 0.0) {
            stored.iter_mut().for_each(|number| *number = *number * scale_factor + add_offset);
        }
    }

    /// Describes factor, offset and valid range of the stored numbers, if they are stated.
    pub(super) fn note(&self) -> Option<String> {
        let Self { scale_factor, add_offset, valid, .. } = *self;
        let packed = ((scale_factor, add_offset) != (1.0, 0.0)).then(|| {
            format!("heights are the stored numbers times scale_factor {scale_factor:e} plus add_offset {add_offset:e}")
        });
        let valid = valid.map(|[least, largest]| {
            let bounds = [("below", least), ("above", largest)].into_iter().filter(|(_, bound)| bound.is_finite());
            let bounds: Vec<String> = bounds.map(|(side, bound)| format!("{side} {}", number::plain(bound))).collect();
            format!("stored numbers {} are not valid and missing points", bounds.join(" or "))
        });
        let facts: Vec<String> = packed.into_iter().chain(valid).collect();
        (!facts.is_empty()).then(|| facts.join(", "))
    }
}

/// The least of the integers that `_Unsigned` means and how many there are; none where it says what the type says.
fn range(dataset: &Dataset) -> Result<Option<[f64; 2]>, Hdf5Error> {
    if dataset.attr(UNSIGNED).is_err() {
        return Ok(None);
    }
    let descriptor = dataset.dtype()?.to_descriptor()?;
    let count = libm::ldexp(1.0, 8 * descriptor.size() as i32);
    let text = text_attribute(dataset, UNSIGNED)?.map(|text| text.to_ascii_lowercase());
    match (text.as_deref(), descriptor) {
        (Some("true"), TypeDescriptor::Integer(_)) => Ok(Some([0.0, count])),
        (Some("false"), TypeDescriptor::Unsigned(_)) => Ok(Some([-0.5 * count, count])),
        (Some("true" | "false"), _) => Ok(None),
        (text, _) => {
            let found = format!("{UNSIGNED} = {:?}", short(text.unwrap_or_default()));
            Err(wrong(dataset, found, "\"true\" or \"false\""))
        }
    }
}

/// The error of an attribute that says another thing than is expected.
pub(super) fn wrong(dataset: &Dataset, found: impl Into<String>, expected: &'static str) -> Hdf5Error {
    Hdf5Error::Attribute { dataset: dataset.name(), found: found.into(), expected }
}

/// Makes integers of a range those of the same bits that are in it; what no bits of the type mean stays.
fn into_range([least, count]: [f64; 2], integers: &mut [f64]) {
    let has_bits = |integer: &&mut f64| (-0.5 * count..count).contains(*integer);
    integers.iter_mut().filter(has_bits).for_each(|integer| *integer = least + (*integer - least).rem_euclid(count));
}

/// Rounds what attributes say of stored numbers to the type of these, as their writer did with the numbers.
fn as_stored(dataset: &Dataset, numbers: &mut [f64]) -> hdf5::Result<()> {
    if let TypeDescriptor::Float(FloatSize::U4) = dataset.dtype()?.to_descriptor()? {
        numbers.iter_mut().for_each(|number| *number = f64::from(*number as f32));
    }
    Ok(())
}

/// The least and the largest stored number that is valid; none where nothing says so.
fn valid(dataset: &Dataset) -> Result<Option<[f64; 2]>, Hdf5Error> {
    let is_float = |descriptor: &TypeDescriptor| matches!(descriptor, TypeDescriptor::Float(_));
    let stores_floats = is_float(&dataset.dtype()?.to_descriptor()?);
    let stated = |name: &str, expected: &'static str, count: usize| {
        let Ok(attribute) = dataset.attr(name) else { return Ok(None) };
        let found = numbers(dataset, name)?;
        if found.len() != count || found.iter().any(|number| number.is_nan()) {
            let found =
                if found.is_empty() { format!("{name}, which is no number") } else { format!("{name} = {found:?}") };
            return Err(wrong(dataset, found, expected));
        }
        // Some programs mean heights by such numbers, others what is stored.
        if is_float(&attribute.dtype()?.to_descriptor()?) && !stores_floats {
            let expected =
                "integers, as the numbers that are stored, of which it says what is valid: correct or delete it";
            return Err(wrong(dataset, format!("{name} = {found:?}"), expected));
        }
        Ok(Some(found))
    };
    let range = stated("valid_range", "the least and the largest number that is valid: correct or delete it", 2)?;
    let one = "one number: correct or delete it";
    let (least, largest) = (stated("valid_min", one, 1)?, stated("valid_max", one, 1)?);
    if range.is_none() && least.is_none() && largest.is_none() {
        return Ok(None);
    }
    // Where all of them are there, against the conventions, each of them holds.
    let [mut valid_least, mut valid_largest] =
        range.map_or([f64::NEG_INFINITY, f64::INFINITY], |range| [range[0], range[1]]);
    least.iter().for_each(|least| valid_least = valid_least.max(least[0]));
    largest.iter().for_each(|largest| valid_largest = valid_largest.min(largest[0]));
    Ok(Some([valid_least, valid_largest]))
}

/// The numbers of an attribute; none where it is not there or holds something else.
pub(super) fn numbers(location: &Location, name: &str) -> hdf5::Result<Vec<f64>> {
    let Ok(attribute) = location.attr(name) else { return Ok(Vec::new()) };
    match attribute.dtype()?.to_descriptor()? {
        TypeDescriptor::Float(_) | TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_)
            if (1..=MOST_NUMBERS).contains(&attribute.space()?.size()) =>
        {
            attribute.read_raw::<f64>()
        }
        _ => Ok(Vec::new()),
    }
}

/// Numbers of an attribute that is read.
const MOST_NUMBERS: usize = 64;

/// Largest distance of a coordinate from a regular grid, in pitches, besides what rounding to its type makes.
const TOLERANCE: f64 = 1e-3;
/// Beginning of the NAME of a scale that netCDF makes for a dimension without coordinates.
const NO_COORDINATES: &str = "This is a netCDF dimension";

/// Order, pitch and direction of the dimensions of a dataset with two of them.
pub(super) struct Dimensions {
    /// True if y comes first, x second.
    pub(super) is_turned: bool,
    /// Distance of neighbouring points along x and y, m, if the coordinates of both are there.
    pub(super) pitch: Option<[f64; 2]>,
    /// True where coordinates along x and y decrease.
    decreases: [bool; 2],
}

impl Dimensions {
    /// Reads them from labels, scales and coordinates; x comes first where these say nothing.
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

    /// Describes the layout of the values, where it is not (columns, rows) with growing x and y.
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
    let found = format!("DIMENSION_LABELS of {count} values of type {}", attribute.dtype()?.to_descriptor()?);
    let expected = "one text for each dimension: correct it, or delete it where the dimensions are (columns, rows)";
    Err(wrong(dataset, found, expected))
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

/// Step from one coordinate of a dimension to the next, m; none where there are no coordinates, or one point only.
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
        Some(unit) => units::parse(&format!("1 {unit}"), Dimension::Length).map_err(|_| {
            let found = format!("units = \"{}\"", short(&unit).escape_debug());
            wrong(scale, found, "a unit of length, for it has the coordinates of heights")
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

pub(super) fn stated_unit(dataset: &Dataset) -> Result<Option<String>, Hdf5Error> {
    let unit = text_attribute(dataset, "units")?;
    if unit.is_none() && dataset.attr("units").is_ok() {
        let found = match &numbers(dataset, "units")?[..] {
            [] => "units, which is not one text".to_owned(),
            numbers => format!("units = {numbers:?}"),
        };
        let expected = "the name of a unit as one text: correct it, or delete it where the numbers are in m";
        return Err(wrong(dataset, found, expected));
    }
    Ok(unit)
}

pub(super) fn is_metre(unit: &str) -> bool {
    ["m", "metre", "metres", "meter", "meters"].contains(&unit)
}
