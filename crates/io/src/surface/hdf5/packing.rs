//! How netCDF packs numbers: a mark for those that are missing, the range of those that are valid, a factor and an offset, and integers
//! that are meant to have a sign or none (NetCDF Users Guide, attribute conventions; CF conventions, 2.5.1 and 8.1).

use hdf5::types::{FloatSize, TypeDescriptor};
use hdf5::{Dataset, Location};

use super::error::Hdf5Error;
use crate::hdf5_file::text_attribute;
use crate::number;
use crate::text::short;

/// The attribute of the factor, without which integers are no heights.
const SCALE_FACTOR: &str = "scale_factor";
/// The attribute that says whether integers are to be read without a sign, whatever their type is.
const UNSIGNED: &str = "_Unsigned";

/// What a stored number stands for: NaN where it is a mark or not valid, else times `scale_factor` plus `add_offset`.
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
    /// Whether a factor is stated.
    pub(super) fn is_packed(dataset: &Dataset) -> bool {
        dataset.attr(SCALE_FACTOR).is_ok()
    }

    /// As the attributes of a dataset have it.
    pub(super) fn of(dataset: &Dataset) -> Result<Self, Hdf5Error> {
        let one = |name: &str, absent: f64, fits: fn(f64) -> bool, expected: &'static str| {
            if dataset.attr(name).is_err() {
                return Ok(absent);
            }
            match numbers(dataset, name)?[..] {
                [number] if number.is_finite() && fits(number) => Ok(number),
                ref found => {
                    let found = format!("{name} = {found:?}");
                    Err(Hdf5Error::Attribute { dataset: dataset.name(), found, expected })
                }
            }
        };
        let mut marks = Vec::new();
        for name in ["_FillValue", "missing_value"] {
            let found = numbers(dataset, name)?;
            if found.is_empty() && dataset.attr(name).is_ok() {
                return Err(Hdf5Error::Attribute {
                    dataset: dataset.name(),
                    found: name.to_owned(),
                    expected: "a number, or up to 64, in it",
                });
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
            let expected = "the least number first: correct or delete it";
            return Err(Hdf5Error::Attribute { dataset: dataset.name(), found, expected });
        }
        Ok(Self {
            range,
            valid,
            scale_factor: one(SCALE_FACTOR, 1.0, |factor| factor != 0.0, "one finite number that is not 0")?,
            add_offset: one("add_offset", 0.0, |_| true, "one finite number")?,
            marks,
        })
    }

    /// Makes what they stand for of stored numbers, in place.
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

    /// What is done to the stored numbers, in words.
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
        (text, _) => Err(Hdf5Error::Attribute {
            dataset: dataset.name(),
            found: format!("{UNSIGNED} = {:?}", short(text.unwrap_or_default())),
            expected: "\"true\" or \"false\"",
        }),
    }
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
        let error = |found: String, expected| Err(Hdf5Error::Attribute { dataset: dataset.name(), found, expected });
        if found.len() != count || found.iter().any(|number| number.is_nan()) {
            let found =
                if found.is_empty() { format!("{name}, which is no number") } else { format!("{name} = {found:?}") };
            return error(found, expected);
        }
        // Some programs mean heights by such numbers, others what is stored.
        if is_float(&attribute.dtype()?.to_descriptor()?) && !stores_floats {
            let expected =
                "integers, as the numbers that are stored, of which it says what is valid: correct or delete it";
            return error(format!("{name} = {found:?}"), expected);
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
