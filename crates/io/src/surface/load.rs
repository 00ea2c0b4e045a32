//! From the recipes of a scene to the surfaces before the first step.

use std::path::{Path, PathBuf};

use plateau_core::mesh::Mesh;
use plateau_core::state::{Base, InitialSurfaces};
use plateau_core::surface::{Body, Length, Patch, RawHeights, fibre_fraction};

use super::error::{FileError, SurfaceError};
use super::format::{Format, detect};
use super::hdf5::{self, Hdf5Error};
use super::inputs::Inputs;
use super::sdf;
use crate::scene::recipe::{BaseSource, HeightRecipe, HeightSource, Scene};

/// The surfaces of a scene, ready for the first step.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// Heights and bases of every cell.
    pub surfaces: InitialSurfaces,
    /// Every surface file read, each once, with its SHA-256 in hexadecimal digits.
    pub inputs: Vec<(PathBuf, String)>,
    /// What was read, made and done, one step a line, for people.
    pub report: Vec<String>,
}

/// Reads or makes the initial surfaces of a scene and prepares them.
///
/// Heights of the pin that come from an instrument (SDF) are negated after their preparation: an instrument's peaks
/// are positive, while the pin's z grows away from the disc. HDF5 and synthetic heights are taken as they are.
///
/// # Errors
/// [`SurfaceError`], which names the scene's table and the file.
pub fn load(scene: &Scene) -> Result<Loaded, SurfaceError> {
    let mut loader = Loader { mesh: &scene.parameters.mesh, inputs: Inputs::default(), report: Vec::new() };
    let disc_height = loader.heights(&scene.disc_surface, Body::Disc)?;
    let mut pin_height = loader.heights(&scene.pin_surface, Body::Pin)?;
    let pin_base = loader.base(&scene.pin_base)?;
    if scene.resin_recess != 0.0 {
        let resin = pin_height.iter_mut().zip(&pin_base).filter(|(_, base)| **base == Base::None);
        resin.for_each(|(height, _)| *height += scene.resin_recess);
        loader.report.push(format!("pin.surface: resin set back by {}", Length(scene.resin_recess)));
    }
    let surfaces = InitialSurfaces { disc_height, pin_height, pin_base };
    Ok(Loaded { surfaces, inputs: loader.inputs.0, report: loader.report })
}

struct Loader<'a> {
    mesh: &'a Mesh,
    inputs: Inputs,
    report: Vec<String>,
}

/// What heights are called in an error of their preparation.
fn source_name(source: &HeightSource) -> String {
    match source {
        HeightSource::File { path, .. } => path.display().to_string(),
        HeightSource::Synthetic(_) => "synthetic heights".into(),
        HeightSource::Flat => "flat".into(),
    }
}

/// Heights of a file before their preparation.
struct FileHeights {
    raw: RawHeights,
    /// Peaks are positive whatever the body.
    instrument: bool,
    description: String,
}

impl Loader<'_> {
    fn heights(&mut self, recipe: &HeightRecipe, body: Body) -> Result<Vec<f64>, SurfaceError> {
        let (surface, prepare) = match body {
            Body::Disc => ("disc.surface", "disc.prepare"),
            Body::Pin => ("pin.surface", "pin.prepare"),
        };
        let (raw, negate) = match &recipe.source {
            HeightSource::Flat => {
                self.report.push(format!("{surface}: flat"));
                (RawHeights::OnMesh(vec![0.0; body.columns(self.mesh) * self.mesh.rows()]), false)
            }
            HeightSource::Synthetic(synthesis) => {
                let heights = synthesis
                    .field(body, self.mesh)
                    .map_err(|reason| SurfaceError::Synthesis { key: surface, reason })?;
                self.report.push(format!(
                    "{surface}: synthetic, seed {}, rms height {}, correlation length {}",
                    synthesis.seed,
                    Length(synthesis.rms_height),
                    Length(synthesis.correlation_length)
                ));
                (RawHeights::OnMesh(heights), false)
            }
            HeightSource::File { path, dataset } => {
                let pixel = recipe.preparation.pixel;
                let read = self
                    .file_heights(path, dataset.as_deref(), body, pixel)
                    .map_err(|reason| SurfaceError::File { key: surface, path: path.clone(), reason })?;
                self.report.push(format!("{surface}: {}, {}", path.display(), read.description));
                (read.raw, read.instrument && body == Body::Pin)
            }
        };
        let prepared = recipe.preparation.apply(raw, recipe.mirror, body, self.mesh).map_err(|reason| {
            SurfaceError::Preparation { key: prepare, source_name: source_name(&recipe.source), reason }
        })?;
        self.report.extend(prepared.report.iter().map(|step| format!("{prepare}: {step}")));
        let mut heights = prepared.heights;
        if negate {
            heights.iter_mut().for_each(|height| *height = -*height);
            self.report.push(format!("{surface}: negated, for the pin's z grows away from the disc"));
        }
        self.report.push(format!("{surface}: {}", spread(&heights)));
        Ok(heights)
    }

    fn file_heights(
        &mut self,
        path: &Path,
        dataset: Option<&str>,
        body: Body,
        pixel: Option<f64>,
    ) -> Result<FileHeights, FileError> {
        let format = detect(path)?;
        let read = match format {
            Format::Hdf5 => hdf5_heights(path, dataset, (body.columns(self.mesh), self.mesh.rows()), pixel)?,
            Format::SdfAscii | Format::SdfBinary => {
                if let Some(dataset) = dataset {
                    return Err(FileError::NoDatasets { format, dataset: dataset.to_owned() });
                }
                let patch = sdf::read(&std::fs::read(path)?)?;
                let description = describe(&patch);
                FileHeights { raw: RawHeights::Patch(patch), instrument: true, description }
            }
            other => return Err(FileError::NotReadable(other)),
        };
        self.inputs.add(path)?;
        Ok(read)
    }

    fn base(&mut self, source: &BaseSource) -> Result<Vec<Base>, SurfaceError> {
        let key = "pin.base";
        let base = match source {
            BaseSource::Uniform(base) => {
                self.report.push(format!("{key}: uniform"));
                vec![*base; self.mesh.pin_cells()]
            }
            BaseSource::Synthetic(synthesis) => {
                self.report.push(format!(
                    "{key}: synthetic, seed {}, fibres of {} by {}",
                    synthesis.seed,
                    Length(synthesis.fibre_length),
                    Length(synthesis.fibre_width)
                ));
                synthesis.base(self.mesh).map_err(|reason| SurfaceError::Fibre { key, reason })?
            }
            BaseSource::File { path, dataset } => self
                .file_base(path, dataset.as_deref())
                .map_err(|reason| SurfaceError::File { key, path: path.clone(), reason })?,
        };
        self.report.push(format!("{key}: fibre fraction {:.4}", fibre_fraction(&base, self.mesh)));
        Ok(base)
    }

    fn file_base(&mut self, path: &Path, dataset: Option<&str>) -> Result<Vec<Base>, FileError> {
        let format = detect(path)?;
        if format != Format::Hdf5 {
            return Err(FileError::NotABase(format));
        }
        let (name, base) = hdf5::base(path, dataset, (self.mesh.pin_columns(), self.mesh.rows()))?;
        self.inputs.add(path)?;
        self.report.push(format!("pin.base: {}, dataset {name}", path.display()));
        Ok(base)
    }
}

/// A dataset with the shape `mesh` of the body's fields covers the body; any other is a patch and needs a pitch.
fn hdf5_heights(
    path: &Path,
    dataset: Option<&str>,
    mesh: (usize, usize),
    pixel: Option<f64>,
) -> Result<FileHeights, FileError> {
    let read = hdf5::heights(path, dataset)?;
    let (columns, rows) = (read.columns, read.rows);
    let description = format!("dataset {}, {columns} x {rows} points", read.dataset);
    let raw = match pixel {
        None if (columns, rows) == mesh => RawHeights::OnMesh(read.heights),
        None => {
            let (dataset, found) = (read.dataset, (columns, rows));
            return Err(Hdf5Error::NoPitch { dataset, found, mesh }.into());
        }
        Some(pixel) => {
            RawHeights::Patch(Patch { columns, rows, column_pitch: pixel, row_pitch: pixel, heights: read.heights })
        }
    };
    Ok(FileHeights { raw, instrument: false, description })
}

fn describe(patch: &Patch) -> String {
    let pitch = if patch.column_pitch == patch.row_pitch {
        format!("{} pitch", Length(patch.column_pitch))
    } else {
        format!("{} by {} pitch", Length(patch.column_pitch), Length(patch.row_pitch))
    };
    format!("{} x {} points, {pitch}", patch.columns, patch.rows)
}

/// Root-mean-square deviation from the mean, lowest and highest of the heights.
fn spread(heights: &[f64]) -> String {
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    let square = heights.iter().map(|height| (height - mean) * (height - mean)).sum::<f64>() / heights.len() as f64;
    let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    format!("heights from {} to {}, rms {}", Length(lowest), Length(highest), Length(square.sqrt()))
}
