//! The data of the figures of surfaces: a folder that `plateau-figure` draws.

use std::fs;
use std::path::{Path, PathBuf};

use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::Base;
use plateau_core::surface::Body;
use plateau_core::surface::describe::{Description, Grid};
use plateau_core::surface::micrograph::{FibreMap, PinPlane};
use plateau_io::surface::npy::write_array;
use serde::Serialize;
use serde_json::{Value, json};

use super::describe::{Units, parameters};
use crate::failure::Failure;

/// Points along the longer side of the picture of the pin's base: more than a figure shows.
const LONGEST: f64 = 1000.0;
/// What the picture of the base has where there is no cell.
const NOTHING: u8 = 3;

/// The data of surfaces that are to be drawn: their heights as arrays, all else in one document.
pub struct FigureData {
    folder: PathBuf,
    surfaces: Vec<Value>,
}

impl FigureData {
    /// Data in this folder, which is there.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), surfaces: Vec::new() }
    }

    /// Number of the surfaces.
    pub fn count(&self) -> usize {
        self.surfaces.len()
    }

    /// Adds heights, levelled and with peaks positive; those of one body have a common scale.
    pub fn add(&mut self, title: &str, body: Option<Body>, grid: &Grid, of: &Description) -> Result<(), Failure> {
        let name = format!("heights-{}.npy", self.surfaces.len());
        let Grid { columns, rows, heights, .. } = *grid;
        // Line by line, as pictures have them.
        let lines = (0..rows).flat_map(|row| (0..columns).map(move |column| heights[column * rows + row]));
        self.array(&name, "<f8", [rows, columns], lines.flat_map(f64::to_le_bytes))?;
        let body = body.map(|body| if body == Body::Disc { "disc" } else { "pin" });
        let micrometres = grid.pitch.map(|pitch| pitch.map(|length| 1e6 * length));
        let mut surface = json!({
            "title": title, "body": body, "columns": columns, "rows": rows, "pitch": micrometres, "points": columns * rows,
            "measured": of.measured, "heights": name, "material_curve": of.material_curve, "units": Units,
        });
        for (symbol, value) in parameters(of) {
            surface[symbol] = value.into();
        }
        self.surfaces.push(surface);
        Ok(())
    }

    /// Writes the document of the surfaces; the folder, which is complete.
    pub fn finish(&self) -> Result<&Path, Failure> {
        self.document("surfaces.json", &self.surfaces)?;
        Ok(&self.folder)
    }

    /// Writes the picture of the pin's base, with the micrograph that it comes from and the width of its pixels, m: x along the
    /// sliding direction, y outward from the mean radius, lines from the top.
    pub fn fibre_map(&self, mesh: &Mesh, base: &[Base], micrograph: Option<(&FibreMap, f64)>) -> Result<(), Failure> {
        let plane = PinPlane::new(mesh);
        let (half_x, half_y) = plane.half_extent();
        let extent = micrograph.map_or([2.0 * half_x, 2.0 * half_y], |(map, pixel)| {
            [map.grey.width, map.grey.height].map(|pixels| pixels as f64 * pixel)
        });
        let scale = LONGEST / extent[0].max(extent[1]);
        let [columns, lines] = extent.map(|length| (length * scale).round().max(1.0) as usize);
        let cell = |line: usize, column: usize| {
            let x = extent[0] * ((column as f64 + 0.5) / columns as f64 - 0.5);
            let y = extent[1] * (0.5 - (line as f64 + 0.5) / lines as f64);
            let within = plane.cell(x, y).filter(|cell| mesh.is_present(*cell));
            match within.and_then(|cell| base.get(cell)) {
                Some(Base::Resin) => 0,
                Some(Base::Primary) => 1,
                None => NOTHING,
            }
        };
        let points = (0..lines).flat_map(|line| (0..columns).map(move |column| cell(line, column)));
        self.array("base.npy", "|u1", [lines, columns], points)?;
        let mut document = json!({ "extent": extent, "base": "base.npy", "micrograph": null, "fibre": null });
        if let Some((map, _)) = micrograph {
            let shape = [map.grey.height, map.grey.width];
            let grey = map.grey.pixels.iter().map(|level| (255.0 * f64::from(*level)).round() as u8);
            self.array("micrograph.npy", "|u1", shape, grey)?;
            self.array("fibre.npy", "|b1", shape, map.fibre.pixels.iter().map(|is_fibre| u8::from(*is_fibre)))?;
            document["micrograph"] = "micrograph.npy".into();
            document["fibre"] = "fibre.npy".into();
        }
        self.document("fibre_map.json", &document)
    }

    fn array(
        &self,
        name: &str,
        descr: &str,
        shape: [usize; 2],
        bytes: impl Iterator<Item = u8>,
    ) -> Result<(), Failure> {
        let path = self.folder.join(name);
        write_array(&path, descr, &shape, bytes).map_err(|error| unwritten(&path, &error))
    }

    fn document(&self, name: &str, document: &impl Serialize) -> Result<(), Failure> {
        let path = self.folder.join(name);
        let text = serde_json::to_string(document).map_err(Failure::run)?;
        fs::write(&path, text).map_err(|error| unwritten(&path, &error))
    }
}

fn unwritten(path: &Path, error: &std::io::Error) -> Failure {
    Failure::run(format_args!("cannot write {}: {error}", path.display()))
}
