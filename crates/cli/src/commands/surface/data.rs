//! Surfaces as the Python package gets them, which describes and draws them: a folder with their heights, all else in documents.

use std::fs;
use std::path::{Path, PathBuf};

use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::{Base, InitialSurfaces};
use plateau_core::surface::micrograph::{Enlargement, FibreMap, PinPlane};
use plateau_core::surface::{Body, HeightParameters, Length, Level, Patch, Preparation, implausible, level};
use plateau_io::memory::refuse_beyond;
use plateau_io::scene::{BaseSource, Scene};
use plateau_io::surface::npy::write_array;
use plateau_io::surface::{Measured, Patches};
use serde::Serialize;
use serde_json::{Value, json};

use super::recorded::NamedHeights;
use crate::failure::Failure;
use crate::message;

/// Bytes for each point that the package takes to describe a surface, about.
const TO_DESCRIBE: u64 = 56;
/// Points along the longer side of the picture of the pin's base: more than a figure shows.
const LONGEST: f64 = 1000.0;
/// Value in the picture of the base where there is no cell.
const NOTHING: u8 = 3;

/// The data of surfaces: their heights as arrays, all else in one document.
pub struct Data {
    folder: PathBuf,
    surfaces: Vec<Value>,
}

impl Data {
    /// Data in this folder, which is there.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), surfaces: Vec::new() }
    }

    /// Number of the surfaces that are drawn.
    pub fn count(&self) -> usize {
        self.surfaces.len()
    }

    /// Adds the heights of a file, with the form taken out.
    pub fn add_file(&mut self, heights: NamedHeights, form: Level) -> Result<(), Failure> {
        let NamedHeights { name, map, mut measured } = heights;
        // What a run has made of its surfaces is as it is.
        let is_measured = measured.body.is_none();
        let stand_in = is_measured.then(|| implausible::stand_in(&measured.heights)).flatten();
        level(&mut measured.heights, measured.rows, form, measured.body == Some(Body::Disc));
        let Measured { rows, pitch, ref heights, ref mut warnings, .. } = measured;
        let none = || Failure::input(format!("{name}: none of its {} points has a height", heights.len()));
        let rms = HeightParameters::of(heights).ok_or_else(none)?.root_mean_square_height;
        // Numbers that stand for no height make odd heights of any unit.
        if is_measured && stand_in.is_none() {
            warnings.extend(implausible::odd_units(heights, rows, pitch, rms));
        }
        warnings.extend(stand_in);
        for warning in warnings {
            message::warning(format_args!("{name}: {warning}"));
        }
        self.add_levelled(&name, &map, &measured, form)
    }

    /// Adds heights from which the form was taken out.
    pub fn add_levelled(&mut self, name: &str, map: &str, measured: &Measured, form: Level) -> Result<(), Failure> {
        let Measured { format, columns, rows, pitch, body, ref heights, ref notes, ref warnings, .. } = *measured;
        let title = Path::new(name).file_name().map_or(name.into(), |file| file.to_string_lossy());
        let grid = Grid { columns, rows, pitch, heights };
        self.surfaces.push(json!({
            "name": name, "title": title, "map": map, "body": body.map(name_of), "format": format.to_string(),
            "level": level_name(form, body == Some(Body::Disc)), "notes": notes, "warnings": warnings, "is_patch": false,
            "cells": null, "grid": self.heights("heights", name, &grid)?,
        }));
        Ok(())
    }

    /// Adds disc and pin of a scene, peaks positive on both, each behind the patch that it was made of.
    pub fn add_scene(
        &mut self,
        scene: &Path,
        mesh: &Mesh,
        surfaces: InitialSurfaces,
        patches: Patches,
        report: &[String],
        form: Level,
    ) -> Result<(), Failure> {
        let InitialSurfaces { disc_height, mut pin_height, .. } = surfaces;
        Body::Pin.turn(&mut pin_height);
        mesh.absent_cells().for_each(|cell| pin_height[cell] = f64::NAN);
        for (body, mut heights, patch) in
            [(Body::Disc, disc_height, patches.disc), (Body::Pin, pin_height, patches.pin)]
        {
            let (name, closed) = (name_of(body), body == Body::Disc);
            let cells = match patch {
                Some(patch) => self.add_patch(body, patch, mesh, form)?,
                None => Value::Null,
            };
            level(&mut heights, mesh.rows(), form, closed);
            let own = |line: &&String| line.starts_with(&format!("{name}."));
            let notes: Vec<&String> = report.iter().filter(own).collect();
            let grid = Grid {
                columns: body.columns(mesh),
                rows: mesh.rows(),
                pitch: Some([mesh.column_width(), mesh.row_height()]),
                heights: &heights,
            };
            self.surfaces.push(json!({
                "name": name, "title": name, "map": "", "body": name, "format": format!("prepared by {}", scene.display()),
                "level": level_name(form, closed), "notes": notes, "warnings": [], "is_patch": false, "cells": cells,
                "grid": self.heights("heights", name, &grid)?,
            }));
        }
        Ok(())
    }

    /// Adds the patch of a body; gives its averages over cells, null where no cell lies in it.
    fn add_patch(&mut self, body: Body, mut patch: Patch, mesh: &Mesh, form: Level) -> Result<Value, Failure> {
        let name = name_of(body);
        body.turn(&mut patch.heights);
        level(&mut patch.heights, patch.rows, form, false);
        let cells = match patch.cell_averages(mesh) {
            Some(cells) => self.heights("cells", name, &Grid::of(&cells))?,
            None => Value::Null,
        };
        let grid = self.heights("heights", name, &Grid::of(&patch))?;
        let title = format!("{name} patch");
        self.surfaces.push(json!({ "name": name, "title": title, "body": name, "is_patch": true, "grid": grid }));
        Ok(cells)
    }

    /// Writes heights as they are described and drawn, and returns what there is to tell of them.
    fn heights(&self, part: &str, name: &str, grid: &Grid) -> Result<Value, Failure> {
        let Grid { columns, rows, pitch, heights } = *grid;
        refuse_beyond(TO_DESCRIBE.saturating_mul(heights.len() as u64)).map_err(|no_room| {
            Failure::input(format!(
                "{name}: its {columns} x {rows} points can be read, but to describe them needs {no_room}; give a coarser surface, or a part of it"
            ))
        })?;
        let file = format!("{part}-{}.npy", self.surfaces.len());
        // Line by line, as pictures have them.
        let lines = (0..rows).flat_map(|row| (0..columns).map(move |column| heights[column * rows + row]));
        self.array(&file, "<f8", [rows, columns], lines.flat_map(f64::to_le_bytes))?;
        let words = |lengths: [f64; 2]| lengths.map(|length| Length(length).to_string());
        Ok(json!({
            "heights": file, "columns": columns, "rows": rows, "pitch": pitch, "pitch_in_words": pitch.map(words),
            "size_in_words": pitch.map(|[x, y]| words([columns as f64 * x, rows as f64 * y])),
        }))
    }

    /// Writes the document of the surfaces and returns the folder, which is then complete.
    pub fn finish(&self) -> Result<&Path, Failure> {
        self.document("surfaces.json", &self.surfaces)?;
        Ok(&self.folder)
    }

    /// Writes the picture of the pin's base on its ring, with the micrograph that it comes from and the width of its pixels, m: x
    /// along the sliding direction, y outward from the mean radius, lines from the top.
    pub fn fibre_map(
        &self,
        scene: &Scene,
        base: &[Base],
        patch: Option<&Patch>,
        micrograph: Option<(&FibreMap, f64)>,
    ) -> Result<(), Failure> {
        let mesh = &scene.parameters.mesh;
        let plane = PinPlane::new(mesh);
        let (half_x, half_y) = plane.half_extent();
        let extent = [2.0 * half_x, 2.0 * half_y];
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
        let is_tiled = match &scene.pin_base {
            BaseSource::Image { micrograph, .. } => micrograph.enlargement == Some(Enlargement::Tiles),
            _ => false,
        };
        let Preparation { repeat, extend, .. } = scene.disc_surface.preparation;
        let laid = patch.filter(|_| extend.is_none());
        let [angles, radii] = laid.map_or_else(Default::default, |patch| patch.seams(repeat, mesh));
        let mut document = json!({
            "extent": extent, "base": "base.npy", "micrograph": null, "fibre": null, "picture": null, "is_tiled": false,
            "mean_radius": mesh.mean_radius(), "row_height": mesh.row_height(), "pin_columns": mesh.pin_columns(),
            "leading_edge": leading_edge(mesh), "seams": { "angles": angles, "radii": radii },
        });
        if let Some((map, pixel)) = micrograph {
            let shape = [map.grey.height, map.grey.width];
            let grey = map.grey.pixels.iter().map(|level| (255.0 * f64::from(*level)).round() as u8);
            self.array("micrograph.npy", "|u1", shape, grey)?;
            self.array("fibre.npy", "|b1", shape, map.fibre.pixels.iter().map(|is_fibre| u8::from(*is_fibre)))?;
            document["micrograph"] = "micrograph.npy".into();
            document["fibre"] = "fibre.npy".into();
            document["picture"] = json!(map.grey.size(pixel));
            document["is_tiled"] = (is_tiled && !plane.is_covered_by(map.grey.size(pixel))).into();
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

/// Points of the edge of the pin under which the disc enters, in its plane, m, from the inside outward.
fn leading_edge(mesh: &Mesh) -> Vec<[f64; 2]> {
    let inner = mesh.mean_radius() - 0.5 * mesh.rows() as f64 * mesh.row_height();
    let ends = |row: usize| {
        let angle = (mesh.chord(row).start as f64 - 0.5 * mesh.pin_columns() as f64) * mesh.column_angle();
        [row, row + 1].map(|edge| {
            let radius = inner + edge as f64 * mesh.row_height();
            [radius * angle.sin(), radius * angle.cos() - mesh.mean_radius()]
        })
    };
    (0..mesh.rows()).filter(|row| !mesh.chord(*row).is_empty()).flat_map(ends).collect()
}

fn unwritten(path: &Path, error: &std::io::Error) -> Failure {
    Failure::run(format_args!("cannot write {}: {error}", path.display()))
}

/// Heights on a grid, column by column, m, of which the pitch along x and y, m, may be unknown.
struct Grid<'a> {
    columns: usize,
    rows: usize,
    pitch: Option<[f64; 2]>,
    heights: &'a [f64],
}

impl<'a> Grid<'a> {
    fn of(patch: &'a Patch) -> Self {
        let Patch { columns, rows, column_pitch, row_pitch, ref heights } = *patch;
        Self { columns, rows, pitch: Some([column_pitch, row_pitch]), heights }
    }
}

/// Names a body.
fn name_of(body: Body) -> &'static str {
    if body == Body::Disc { "disc" } else { "pin" }
}

/// The form that is taken out of a surface, or of one that closes round the ring.
fn level_name(level: Level, closed: bool) -> &'static str {
    match (level, closed) {
        (Level::None, _) => "nothing",
        (Level::Mean, _) => "mean",
        (Level::Plane, false) => "least-squares plane",
        (Level::Plane, true) => "mean and radial slope",
        (Level::Quadratic, false) => "least-squares quadric",
        (Level::Quadratic, true) => "mean, radial slope and curvature",
    }
}
