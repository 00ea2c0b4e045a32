//! Surfaces as JSON.

use serde::ser::{Serialize, SerializeMap as _, Serializer};

use super::comparison::{Comparison, Row};
use super::describe::{Units, parameters, scale};
use super::subject::Subject;
use crate::failure::Failure;
use crate::output::json;

/// An object for one surface, an array of such for several.
pub fn document(subjects: &[Subject]) -> Result<String, Failure> {
    let documents: Vec<Document> = subjects.iter().map(Document).collect();
    match documents.as_slice() {
        [one] => json(one),
        several => json(&several),
    }
}

/// A surface: what it is, its parameters by their symbols, and their units.
///
/// What the heights do not determine is null; what needs a pitch that is unknown is not there.
struct Document<'a>(&'a Subject);

impl Serialize for Document<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(subject) = self;
        let micrometres = |pair: [f64; 2]| pair.map(|length| length * 1e6);
        let counts = [subject.columns as f64, subject.rows as f64];
        let size = subject.pitch.map(|pitch| [counts[0] * pitch[0], counts[1] * pitch[1]]);
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("name", &subject.name)?;
        map.serialize_entry("format", &subject.origin)?;
        map.serialize_entry("columns", &subject.columns)?;
        map.serialize_entry("rows", &subject.rows)?;
        map.serialize_entry("pitch", &subject.pitch.map(micrometres))?;
        map.serialize_entry("size", &size.map(micrometres))?;
        map.serialize_entry("points", &subject.points())?;
        map.serialize_entry("measured", &subject.description.measured)?;
        map.serialize_entry("coverage", &subject.coverage())?;
        map.serialize_entry("level", subject.level)?;
        map.serialize_entry("notes", &subject.notes)?;
        map.serialize_entry("warnings", &subject.warnings)?;
        for (symbol, value) in parameters(&subject.description) {
            map.serialize_entry(symbol, &value)?;
        }
        if let Some(spatial) = subject.description.autocorrelation {
            map.serialize_entry("Str_below", &spatial.aspect_ratio_below)?;
        }
        if let Some(comparison) = &subject.comparison {
            map.serialize_entry("comparison", &Compared { subject, comparison })?;
        }
        map.serialize_entry("units", &Units)?;
        map.end()
    }
}

/// A body beside the patch that it was made of, parameter by parameter.
struct Compared<'a> {
    subject: &'a Subject,
    comparison: &'a Comparison,
}

impl Serialize for Compared<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let rows: Vec<Row> = self.comparison.rows(&self.subject.description).collect();
        let values = |of: fn(&Row) -> f64| Values { rows: &rows, of };
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("cells", &self.comparison.cells.as_ref().map(|cells| cells.counts))?;
        map.serialize_entry("patch", &values(|row| row.patch))?;
        map.serialize_entry("patch_in_cells", &values(|row| row.cells))?;
        map.serialize_entry("sampling_error", &values(|row| row.error))?;
        map.serialize_entry("difference", &values(|row| row.difference))?;
        map.end()
    }
}

/// One value of every parameter, by its symbol.
struct Values<'a> {
    rows: &'a [Row],
    of: fn(&Row) -> f64,
}

impl Serialize for Values<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer
            .collect_map(self.rows.iter().map(|row| (row.parameter.symbol, (self.of)(row) * scale(row.parameter).1)))
    }
}
