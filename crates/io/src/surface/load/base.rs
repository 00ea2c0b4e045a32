//! The base of the pin's cells, fibre or resin: read or made.

use std::path::Path;

use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::Base;
use plateau_core::surface::micrograph::{FibreMap, Micrograph};
use plateau_core::surface::{Length, fibre_fraction};

use super::super::detect::detect;
use super::super::error::{FileError, SurfaceError};
use super::super::format::Format;
use super::super::{hdf5, image};
use super::loader::Loader;
use crate::scene::{BaseSource, Scene};
use crate::{limits, regular};

impl Loader<'_> {
    /// Base of every cell of the pin.
    pub(super) fn base(&mut self, source: &BaseSource, mirror: bool) -> Result<Vec<Base>, SurfaceError> {
        let key = "pin.base";
        let mut base = match source {
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
            BaseSource::Image { path, micrograph } => {
                let map = self.fibre_map(path, micrograph).map_err(|reason| SurfaceError::File {
                    key,
                    path: path.clone(),
                    reason,
                })?;
                self.report.extend(map.report.iter().map(|step| format!("{key}: {step}")));
                map.base
            }
        };
        if mirror {
            let columns: Vec<&[Base]> = base.chunks_exact(self.mesh.rows()).rev().collect();
            base = columns.concat();
            self.report.push(format!("{key}: mirrored along the sliding direction"));
        }
        self.report.push(format!("{key}: fibre fraction {:.4}", fibre_fraction(&base, self.mesh)));
        Ok(base)
    }

    fn fibre_map(&mut self, path: &Path, micrograph: &Micrograph) -> Result<FibreMap, FileError> {
        let (map, picture) = self.inputs.read(path, || fibre_map(path, micrograph, self.mesh))?;
        let pixel = Length(micrograph.pixel);
        self.report.push(format!("pin.base: {}, {picture}, {pixel} a pixel", path.display()));
        Ok(map)
    }

    fn file_base(&mut self, path: &Path, dataset: Option<&str>) -> Result<Vec<Base>, FileError> {
        let shape = (self.mesh.pin_columns(), self.mesh.rows());
        let (name, base) = self.inputs.read(path, || match detect(path)? {
            Format::Hdf5 => Ok(hdf5::base(path, dataset, shape, |cell| self.mesh.is_present(cell))?),
            format => Err(FileError::NotABase(format)),
        })?;
        self.report.push(format!("pin.base: {}, dataset {name}", path.display()));
        Ok(base)
    }
}

/// What a scene makes of the micrograph that the pin's base comes from, and the width of its pixels, m; none where it comes
/// from something else.
///
/// # Errors
/// [`SurfaceError`] as for [`load`](super::load).
pub fn micrograph(scene: &Scene) -> Result<Option<(FibreMap, f64)>, SurfaceError> {
    let BaseSource::Image { path, micrograph } = &scene.pin_base else { return Ok(None) };
    let map = fibre_map(path, micrograph, &scene.parameters.mesh);
    let (map, _) = map.map_err(|reason| SurfaceError::File { key: "pin.base", path: path.clone(), reason })?;
    Ok(Some((map, micrograph.pixel)))
}

/// Makes the fibre map of an image file; says what the image is besides.
fn fibre_map(path: &Path, micrograph: &Micrograph, mesh: &Mesh) -> Result<(FibreMap, String), FileError> {
    let format = detect(path)?;
    if !matches!(format, Format::Png | Format::Tiff) {
        return Err(FileError::NotAnImage(format));
    }
    let (grey, picture) = image::grey(&regular::read(path, limits::SURFACE)?, format)?;
    Ok((micrograph.fibre_map(grey, mesh)?, picture))
}
