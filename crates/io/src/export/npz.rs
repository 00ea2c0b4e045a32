//! NumPy archives (.npz): every array under a name of its own, readable without pickle.

use std::collections::BTreeMap;
use std::io::{Seek, Write};

use plateau_core::observe::{Map, MapValues};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::{ExportError, write_floats};
use crate::archive::{self, Output};
use crate::run_file::{RunFile, map_unit};
use crate::surface::npy;

/// Arrays of more bytes than this need the long form of an archive.
const SHORT: u64 = u32::MAX as u64 / 2;

/// Writes coordinates, series and maps as arrays, and `title`, `state`, `scene` and `units` as texts.
///
/// A series has the name of its dataset; a quantity of events begins with `event_`; a map the name that scenes have for it, such as `disc_height`, and the shape
/// (map_time, columns, rows); the base of the pin is `pin_base`. `units` is a JSON object, name of the array → unit.
///
/// # Errors
/// [`ExportError`] when a part of the run file cannot be read or the output takes no more.
pub fn write(run: &RunFile, out: impl Write + Seek) -> Result<(), ExportError> {
    let mut archive = Archive { zip: archive::create(out), units: BTreeMap::new() };
    let mesh = run.mesh();
    let angles = |columns: usize| (0..columns).map(|c| (c as f64 + 0.5) * mesh.column_angle()).collect::<Vec<_>>();
    archive.floats("time", "s", run.time())?;
    for series in run.series() {
        if let Some(values) = run.values(&series.name)? {
            archive.floats(&series.name, &series.unit, &values)?;
        }
    }
    for (quantity, values) in run.events()? {
        archive.floats(&format!("event_{}", quantity.name), quantity.unit, &values)?;
    }
    archive.floats("radius", "m", mesh.radius())?;
    archive.floats("disc_angle", "rad", &angles(mesh.disc_columns()))?;
    archive.floats("pin_angle", "rad", &angles(mesh.pin_columns()))?;
    archive.floats("map_time", "s", run.map_time())?;
    for map in Map::ALL.into_iter().filter(|map| run.has_map(*map)) {
        archive.map(run, map)?;
    }
    if let Some(base) = run.pin_base()? {
        archive.start("pin_base", "|u1", &[mesh.pin_columns(), mesh.rows()])?;
        archive.zip.write_all(&base)?;
        archive.units.insert("pin_base".into(), "1".into());
    }
    archive.text("title", run.title())?;
    archive.text("state", run.state().name())?;
    archive.text("scene", &run.attribute("scene").unwrap_or_default())?;
    let units = serde_json::to_string(&archive.units).map_err(std::io::Error::from)?;
    archive.text("units", &units)?;
    archive.zip.finish()?.flush()?;
    Ok(())
}

/// An archive that is written array by array.
struct Archive<W: Write + Seek> {
    zip: ZipWriter<Output<W>>,
    units: BTreeMap<String, String>,
}

impl<W: Write + Seek> Archive<W> {
    /// Begins an array: its elements follow.
    fn start(&mut self, name: &str, descr: &str, shape: &[usize]) -> Result<(), ExportError> {
        let bytes = shape.iter().map(|size| *size as u64).fold(8, u64::saturating_mul);
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .compression_level(Some(1))
            .large_file(bytes > SHORT);
        self.zip.start_file(format!("{name}.npy"), options)?;
        Ok(self.zip.write_all(&npy::preamble(descr, shape)?)?)
    }

    fn floats(&mut self, name: &str, unit: &str, values: &[f64]) -> Result<(), ExportError> {
        self.units.insert(name.into(), unit.into());
        self.start(name, "<f8", &[values.len()])?;
        Ok(write_floats(&mut self.zip, values)?)
    }

    /// All moments of a map, one after the other.
    fn map(&mut self, run: &RunFile, map: Map) -> Result<(), ExportError> {
        let mesh = run.mesh();
        let columns = if map.on_disc() { mesh.disc_columns() } else { mesh.pin_columns() };
        let moments = run.map_time().len();
        let descr = if map.is_status() { "|u1" } else { "<f8" };
        self.units.insert(map.name().into(), map_unit(map).into());
        self.start(map.name(), descr, &[moments, columns, mesh.rows()])?;
        for index in 0..moments {
            match run.map(map, index)? {
                Some(MapValues::Float(values)) => write_floats(&mut self.zip, &values)?,
                Some(MapValues::Status(values)) => self.zip.write_all(&values)?,
                None => {}
            }
        }
        Ok(())
    }

    /// A text, as an array without dimensions. NumPy stores the code points, four bytes each.
    fn text(&mut self, name: &str, text: &str) -> Result<(), ExportError> {
        let points: Vec<u8> = text.chars().flat_map(|point| u32::from(point).to_le_bytes()).collect();
        // NumPy knows no text without room for a character.
        let length = (points.len() / 4).max(1);
        self.start(name, &format!("<U{length}"), &[])?;
        self.zip.write_all(&points)?;
        Ok(self.zip.write_all(&[0; 4][points.len().min(4)..])?)
    }
}
