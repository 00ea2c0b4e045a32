//! Tables of comma-separated values: a line with names and units, then numbers.

use std::fmt::Write as _;
use std::io::Write;

use csv::Writer;
use plateau_core::observe::{Map, MapValues};
use plateau_core::surface::Body;

use super::{ExportError, maps_of, name};
use crate::run_file::{RunFile, map_unit};
use crate::text::cell;

/// Writes the times and every series, one sample a line.
///
/// # Errors
/// [`ExportError`] when a series cannot be read or the output takes no more.
pub fn write_series(run: &RunFile, out: impl Write) -> Result<(), ExportError> {
    let mut table = Table::new(out);
    let mut columns = vec![run.time().to_vec()];
    table.text("time [s]")?;
    for series in run.series() {
        if let Some(values) = run.values(&series.name)? {
            table.text(&format!("{} [{}]", series.name, series.unit))?;
            columns.push(values);
        }
    }
    table.end_line()?;
    for sample in 0..run.time().len() {
        for column in &columns {
            table.number(column[sample])?;
        }
        table.end_line()?;
    }
    table.finish()
}

/// Writes what is reported of the events of a cycle, one event a line.
///
/// # Errors
/// [`ExportError`] when they cannot be read or the output takes no more.
pub fn write_events(run: &RunFile, out: impl Write) -> Result<(), ExportError> {
    let (mut table, events) = (Table::new(out), run.events()?);
    table.text("event")?;
    for (quantity, _) in &events {
        table.text(&format!("{} [{}]", quantity.name, quantity.unit))?;
    }
    table.end_line()?;
    for event in 0..events.first().map_or(0, |(_, values)| values.len()) {
        table.text(&(event + 1).to_string())?;
        for (_, values) in &events {
            table.number(values[event])?;
        }
        table.end_line()?;
    }
    table.finish()
}

/// Writes the maps of a body at the time of that index, one cell a line: time, angle and radius of its centre, and the
/// value of every map that was recorded; for the pin its base too.
///
/// # Errors
/// [`ExportError`] when a map cannot be read or the output takes no more.
pub fn write_maps(run: &RunFile, body: Body, index: usize, out: impl Write) -> Result<(), ExportError> {
    let mut table = Table::new(out);
    for heading in ["time [s]", "angle [rad]", "radius [m]"] {
        table.text(heading)?;
    }
    let mut fields = Vec::new();
    for map in maps_of(run, body) {
        fields.extend(run.map(map, index)?);
        table.text(&format!("{} [{}]", name(map), map_unit(map)))?;
    }
    if let (Body::Pin, Some(base)) = (body, run.pin_base()?) {
        fields.push(MapValues::Status(base));
        table.text(&format!("base [{}]", map_unit(Map::PinStatus)))?;
    }
    table.end_line()?;
    let mesh = run.mesh();
    let time = run.map_time()[index];
    for column in 0..body.columns(mesh) {
        let angle = (column as f64 + 0.5) * mesh.column_angle();
        for (cell, radius) in mesh.column(column).zip(mesh.radius()) {
            for number in [time, angle, *radius] {
                table.number(number)?;
            }
            for field in &fields {
                match field {
                    MapValues::Float(values) => table.number(values[cell])?,
                    MapValues::Status(values) => table.status(values[cell])?,
                }
            }
            table.end_line()?;
        }
    }
    table.finish()
}

/// A table that is written value by value.
struct Table<W: Write> {
    writer: Writer<W>,
    text: String,
}

impl<W: Write> Table<W> {
    fn new(out: W) -> Self {
        Self { writer: Writer::from_writer(out), text: String::new() }
    }

    fn text(&mut self, text: &str) -> Result<(), ExportError> {
        Ok(self.writer.write_field(cell(text).as_bytes())?)
    }

    /// The shortest text that reads back as this number.
    fn number(&mut self, number: f64) -> Result<(), ExportError> {
        self.text.clear();
        // Writing to a String cannot fail.
        let _ = write!(self.text, "{number:?}");
        Ok(self.writer.write_field(&self.text)?)
    }

    fn status(&mut self, status: u8) -> Result<(), ExportError> {
        self.text.clear();
        let _ = write!(self.text, "{status}");
        Ok(self.writer.write_field(&self.text)?)
    }

    fn end_line(&mut self) -> Result<(), ExportError> {
        Ok(self.writer.write_record(None::<&[u8]>)?)
    }

    fn finish(mut self) -> Result<(), ExportError> {
        Ok(self.writer.flush()?)
    }
}
