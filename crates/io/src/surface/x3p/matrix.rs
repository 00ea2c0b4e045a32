//! Axes and size of the matrix of points.

use std::str::FromStr;

use super::document::Document;
use super::error::X3pError;

/// Type of a stored number, little endian.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Number {
    Int16,
    Int32,
    Float32,
    Float64,
}

impl Number {
    fn from_letter(letter: &str) -> Option<Self> {
        Some(match letter {
            "I" => Self::Int16,
            "L" => Self::Int32,
            "F" => Self::Float32,
            "D" => Self::Float64,
            _ => return None,
        })
    }

    /// Bytes of one number.
    pub(super) fn size(self) -> usize {
        match self {
            Self::Int16 => 2,
            Self::Int32 | Self::Float32 => 4,
            Self::Float64 => 8,
        }
    }

    /// The first number of `bytes`, and the bytes after it; NaN where there are too few.
    pub(super) fn split(self, bytes: &[u8]) -> (f64, &[u8]) {
        match self {
            Self::Int16 => split(bytes, |raw| i16::from_le_bytes(raw).into()),
            Self::Int32 => split(bytes, |raw| i32::from_le_bytes(raw).into()),
            Self::Float32 => split(bytes, |raw| f32::from_le_bytes(raw).into()),
            Self::Float64 => split(bytes, f64::from_le_bytes),
        }
    }

    /// Whether a number of a text is one of this type.
    pub(super) fn holds(self, number: f64) -> bool {
        let whole = number.fract() == 0.0 || number.is_nan();
        match self {
            Self::Int16 => whole && number == f64::from(number as i16) || number.is_nan(),
            Self::Int32 => whole && number == f64::from(number as i32) || number.is_nan(),
            Self::Float32 | Self::Float64 => true,
        }
    }

    /// What is expected of such a number, in words.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Int16 => "an int16 number",
            Self::Int32 => "an int32 number",
            Self::Float32 | Self::Float64 => "a number",
        }
    }
}

fn split<const SIZE: usize>(bytes: &[u8], decode: impl Fn([u8; SIZE]) -> f64) -> (f64, &[u8]) {
    bytes.split_first_chunk().map_or((f64::NAN, &[]), |(raw, rest)| (decode(*raw), rest))
}

/// One axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Axis {
    /// Type of the coordinates that each point has along it; none where they are counted.
    pub(super) stored: Option<Number>,
    /// What the number 1 stands for, m: the pitch, where points are counted.
    pub(super) increment: f64,
    /// The coordinate of the number 0, m.
    pub(super) offset: f64,
}

/// Names of the elements of an axis.
struct Names {
    axis_type: &'static str,
    data_type: &'static str,
    increment: &'static str,
    offset: &'static str,
}

macro_rules! names {
    ($axis:literal) => {
        Names {
            axis_type: concat!("Record1/Axes/", $axis, "/AxisType"),
            data_type: concat!("Record1/Axes/", $axis, "/DataType"),
            increment: concat!("Record1/Axes/", $axis, "/Increment"),
            offset: concat!("Record1/Axes/", $axis, "/Offset"),
        }
    };
}

impl Axis {
    fn new(document: &Document, names: &Names) -> Result<Self, X3pError> {
        let increment = document.get(names.increment).map(|text| number(names.increment, text, "a number"));
        let offset = document.get(names.offset).map(|text| number(names.offset, text, "a number"));
        let (increment, offset) = (increment.transpose()?, offset.transpose()?.unwrap_or(0.0));
        let finite = |element: &str, number: f64, fits: bool, expected| match fits && number.is_finite() {
            true => Ok(number),
            false => Err(X3pError::Element { element: element.to_owned(), found: number.to_string(), expected }),
        };
        let offset = finite(names.offset, offset, true, "a finite number")?;
        match document.require(names.axis_type)? {
            "I" => {
                let pitch = increment.ok_or(X3pError::NoElement { element: names.increment })?;
                let pitch = finite(names.increment, pitch, pitch > 0.0, "a positive, finite number of m")?;
                Ok(Self { stored: None, increment: pitch, offset })
            }
            "A" => {
                let letter = document.require(names.data_type)?;
                let stored = Number::from_letter(letter).ok_or_else(|| X3pError::Element {
                    element: names.data_type.to_owned(),
                    found: letter.chars().take(20).collect(),
                    expected: "I (int16), L (int32), F (float32) or D (float64)",
                })?;
                let scale = increment.unwrap_or(1.0);
                let scale = finite(names.increment, scale, scale > 0.0, "a positive, finite number of m")?;
                Ok(Self { stored: Some(stored), increment: scale, offset })
            }
            other => Err(X3pError::Element {
                element: names.axis_type.to_owned(),
                found: other.chars().take(20).collect(),
                expected: "I (incremental) or A (absolute)",
            }),
        }
    }

    /// The coordinate that a stored number stands for, m.
    pub(super) fn coordinate(&self, number: f64) -> f64 {
        number * self.increment + self.offset
    }
}

/// One layer of points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Matrix {
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) x: Axis,
    pub(super) y: Axis,
    /// Absolute always.
    pub(super) z: Axis,
}

impl Matrix {
    /// Size and axes as `main.xml` has them.
    ///
    /// # Errors
    /// [`X3pError`] when they are missing or are those of something else than one layer of heights.
    pub(super) fn new(document: &Document) -> Result<Self, X3pError> {
        let feature = "Record1/FeatureType";
        match document.require(feature)? {
            "SUR" => {}
            other => {
                return Err(X3pError::Element {
                    element: feature.to_owned(),
                    found: other.chars().take(20).collect(),
                    expected: "SUR, a surface (profiles and point clouds are not read)",
                });
            }
        }
        let x = Axis::new(document, &names!("CX"))?;
        let y = Axis::new(document, &names!("CY"))?;
        let z = Axis::new(document, &names!("CZ"))?;
        if z.stored.is_none() {
            return Err(X3pError::Element {
                element: names!("CZ").axis_type.to_owned(),
                found: "I".to_owned(),
                expected: "A (absolute): heights are stored",
            });
        }
        let at_least_1 = "a whole number, at least 1";
        let size = |element| match number(element, document.require(element)?, at_least_1)? {
            0 => Err(X3pError::Element { element: element.to_owned(), found: "0".to_owned(), expected: at_least_1 }),
            count => Ok(count),
        };
        let columns: usize = size("Record3/MatrixDimension/SizeX")?;
        let rows = size("Record3/MatrixDimension/SizeY")?;
        let layers = "Record3/MatrixDimension/SizeZ";
        match size(layers)? {
            1 => Ok(Self { columns, rows, x, y, z }),
            found => Err(X3pError::Element {
                element: layers.to_owned(),
                found: found.to_string(),
                expected: "1 (a file of several layers is not read)",
            }),
        }
    }

    pub(super) fn count(&self) -> u128 {
        self.columns as u128 * self.rows as u128
    }

    /// Types of the coordinates that a point has, along x, y and z.
    fn stored(&self) -> impl Iterator<Item = Number> {
        [self.x, self.y, self.z].into_iter().filter_map(|axis| axis.stored)
    }

    /// Bytes of one point.
    pub(super) fn record_size(&self) -> usize {
        self.stored().map(Number::size).sum()
    }

    /// Bytes of all points.
    pub(super) fn bytes(&self) -> u128 {
        self.count().saturating_mul(self.record_size() as u128)
    }

    /// Compares the numbers of a `DataList` with the matrix.
    ///
    /// # Errors
    /// [`X3pError::Count`] when there are more or fewer.
    pub(super) fn check_count(&self, found: usize) -> Result<(), X3pError> {
        let needed = self.count().saturating_mul(self.stored().count() as u128);
        if found as u128 == needed { Ok(()) } else { Err(X3pError::Count { found, needed, what: self.describe() }) }
    }

    pub(super) fn describe(&self) -> String {
        format!("{} x {} points of {} bytes", self.columns, self.rows, self.record_size())
    }
}

fn number<T: FromStr>(element: &str, text: &str, expected: &'static str) -> Result<T, X3pError> {
    text.parse().map_err(|_| X3pError::Element {
        element: element.to_owned(),
        found: text.chars().take(40).collect(),
        expected,
    })
}
