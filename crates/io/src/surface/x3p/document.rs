//! `main.xml`: what the elements say, and the points where they stand there too.

use std::collections::BTreeMap;
use std::io::{self, BufReader, Read};

use quick_xml::events::Event;
use quick_xml::{Reader, escape};

use super::error::X3pError;

/// Name of the entry.
pub(super) const MAIN: &str = "main.xml";
/// Where the binary points are.
pub(super) const DATA_LINK: &str = "Record3/DataLink/PointDataLink";
/// Where the validity bits are.
pub(super) const VALID_LINK: &str = "Record3/DataLink/ValidPointsLink";
/// A point in the text.
const DATUM: &str = "Record3/DataList/Datum";
/// Whether points have coordinates along x and y too.
const AXIS_TYPES: [&str; 2] = ["Record1/Axes/CX/AxisType", "Record1/Axes/CY/AxisType"];

/// Elements in each other; the standard has 5.
const DEEPEST: usize = 16;
/// Elements that are kept; the standard has about 50.
const MOST_ELEMENTS: usize = 1000;
/// Longest text of an element that is kept, in bytes.
const LONGEST: usize = 10_000;

/// What `main.xml` says.
#[derive(Debug, Default)]
pub(super) struct Document {
    /// Text of each element without elements in it, by the names of the elements around it and its own.
    elements: BTreeMap<String, String>,
    /// The coordinates of all points, point by point, if they stand in the text.
    datums: Option<Vec<f64>>,
}

impl Document {
    /// Reads the whole of `main.xml`.
    ///
    /// # Errors
    /// [`X3pError`] when it is no XML, declares entities, or says of the same element two things.
    pub(super) fn read(source: impl Read) -> Result<Self, X3pError> {
        let mut reader = Reader::from_reader(BufReader::new(Ascii(source)));
        reader.config_mut().expand_empty_elements = true;
        let mut document = Self::default();
        let (mut path, mut text, mut buffer) = (Vec::new(), String::new(), Vec::new());
        // Whether the element that is open has no elements in it.
        let mut leaf = false;
        loop {
            buffer.clear();
            let at = reader.buffer_position();
            let refuse = |reason: String| X3pError::Xml { at, reason };
            let event = reader.read_event_into(&mut buffer).map_err(|error| refuse(error.to_string()))?;
            match event {
                // Empty ones come as a start and an end.
                Event::Start(start) | Event::Empty(start) => {
                    if path.len() == DEEPEST {
                        return Err(refuse(format!("more than {DEEPEST} elements in each other")));
                    }
                    path.push(start.local_name().as_ref().to_owned());
                    text.clear();
                    leaf = true;
                }
                Event::Text(more) => text.push_str(&more),
                Event::CData(more) => text.push_str(&more),
                Event::GeneralRef(reference) => match reference.resolve_char_ref() {
                    Ok(Some(character)) => text.push(character),
                    _ => match escape::resolve_xml_entity(&reference) {
                        Some(known) => text.push_str(known),
                        None => return Err(refuse("an entity of its own, which is not read".to_owned())),
                    },
                },
                Event::DocType(_) => {
                    return Err(refuse("a document type declaration, which is not read".to_owned()));
                }
                Event::End(_) => {
                    if leaf {
                        document.element(&path, text.trim(), at)?;
                    }
                    path.pop();
                    leaf = false;
                }
                Event::Eof if path.is_empty() => return Ok(document),
                Event::Eof => return Err(refuse("the text ends within an element".to_owned())),
                Event::Comment(_) | Event::Decl(_) | Event::PI(_) => {}
            }
        }
    }

    fn element(&mut self, path: &[String], text: &str, at: u64) -> Result<(), X3pError> {
        let path = path.get(1..).unwrap_or_default().join("/");
        if path == DATUM {
            return self.datum(text, at);
        }
        let mut end = text.len().min(LONGEST);
        while !text.is_char_boundary(end) {
            end -= 1;
        }
        let text = &text[..end];
        match self.elements.get(&path) {
            Some(first) if first != text && is_used(&path) => {
                let [first, text] = [first.as_str(), text].map(short);
                Err(X3pError::Xml { at, reason: format!("{path} stands twice, as \"{first}\" and \"{text}\"") })
            }
            None if self.elements.len() < MOST_ELEMENTS => {
                self.elements.insert(path, text.to_owned());
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// A point: its coordinates along the absolute axes, separated by semicolons; empty where none was measured.
    fn datum(&mut self, text: &str, at: u64) -> Result<(), X3pError> {
        let count = self.coordinates();
        let datums = self.datums.get_or_insert_default();
        if text.is_empty() {
            datums.extend(std::iter::repeat_n(f64::NAN, count));
            return Ok(());
        }
        let before = datums.len();
        for word in text.split(';') {
            let number = word.trim().parse().ok();
            // More than any number of the type is not what stands for a missing point.
            let number =
                number.filter(|number: &f64| number.is_finite() || !word.contains(|c: char| c.is_ascii_digit()));
            datums.push(number.ok_or_else(|| X3pError::Xml {
                at,
                reason: format!("found the coordinate \"{}\", expected a number", short(word)),
            })?);
        }
        match datums.len() - before {
            found if found == count => Ok(()),
            found => Err(X3pError::Xml {
                at,
                reason: format!("found a point of {found} coordinates, expected {count}: one for each absolute axis"),
            }),
        }
    }

    /// Coordinates of a point: z, and x and y where those axes are absolute.
    pub(super) fn coordinates(&self) -> usize {
        1 + AXIS_TYPES.iter().filter(|axis| self.get(axis) == Some("A")).count()
    }

    /// The coordinates of all points, if they stand in the text.
    pub(super) fn datums(&self) -> Option<&[f64]> {
        self.datums.as_deref()
    }

    /// What an element says, if it is there and says anything.
    pub(super) fn get(&self, element: &str) -> Option<&str> {
        self.elements.get(element).map(String::as_str).filter(|text| !text.is_empty())
    }

    /// What an element says.
    ///
    /// # Errors
    /// [`X3pError::NoElement`] when it is not there or empty.
    pub(super) fn require(&self, element: &'static str) -> Result<&str, X3pError> {
        self.get(element).ok_or(X3pError::NoElement { element })
    }

    /// What the file says of instrument and orientation.
    pub(super) fn notes(&self) -> Vec<String> {
        let known = |element: &str| self.get(element).filter(|text| !text.eq_ignore_ascii_case("not available"));
        let instrument = ["Record2/Instrument/Manufacturer", "Record2/Instrument/Model"].map(known);
        let mut notes = Vec::new();
        if instrument.iter().any(Option::is_some) {
            notes
                .push(format!("instrument {}", short(&instrument.into_iter().flatten().collect::<Vec<_>>().join(" "))));
        }
        let turned = ["r11", "r22", "r33"].iter().any(|element| {
            let number = self.get(&format!("Record1/Axes/Rotation/{element}")).map(str::parse::<f64>);
            number.is_some_and(|number| number != Ok(1.0))
        });
        if turned {
            notes.push("the rotation of the axes is not used".to_owned());
        }
        notes
    }
}

/// Whether heights or their distances depend on what an element says; others may say several things.
fn is_used(element: &str) -> bool {
    let used = ["Record1/FeatureType", "Record1/Axes/C", "Record3/MatrixDimension/", "Record3/DataLink/"];
    used.iter().any(|start| element.starts_with(start))
}

/// What is shown of a text.
fn short(text: &str) -> String {
    text.chars().take(60).collect()
}

/// Text with a question mark for every byte beyond ASCII: whatever the encoding, what counts here is ASCII.
struct Ascii<R>(R);

impl<R: Read> Read for Ascii<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.0.read(buffer)?;
        buffer[..count].iter_mut().filter(|byte| !byte.is_ascii()).for_each(|byte| *byte = b'?');
        Ok(count)
    }
}
