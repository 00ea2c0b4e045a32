//! Surfaces of a scene before the first step: read or made as its settings say, prepared, and reported.

use std::path::{Path, PathBuf};

use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::{Base, InitialSurfaces};
use plateau_core::surface::micrograph::{FibreMap, Micrograph};
use plateau_core::surface::{
    Body, Extension, HeightParameters, HeightSynthesis, Length, Patch, Preparation, RawHeights, Texture,
    fibre_fraction, set_back_resin,
};

use super::error::{FileError, SurfaceError};
use super::files::{detect, read};
use super::format::Format;
use super::image::Grey;
use super::measured::{Lay, ProfileError, ReadOptions, grooves};
use super::{hdf5, image};
use crate::input::{self, digested};
use crate::limits;
use crate::scene::{BaseSource, HeightSettings, HeightSource, Scene};

/// Mark of a line of the report that is a warning, behind the table of the scene.
const MARK: &str = ": warning: ";

/// The surfaces of a scene, ready for the first step.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// Heights and bases of every cell.
    pub surfaces: InitialSurfaces,
    /// Fraction of the points that `disc.prepare.cutoff` cut; none without it.
    pub disc_cut: Option<f64>,
    /// Fraction of the points that `pin.prepare.cutoff` cut; none without it.
    pub pin_cut: Option<f64>,
    /// Every surface file read, each once, with the SHA-256 of what was read of it, in hexadecimal digits.
    pub inputs: Vec<(PathBuf, String)>,
    /// Steps of reading, making and preparing the surfaces, one a line, for people.
    pub report: Vec<String>,
}

impl Loaded {
    /// The lines of the report that are warnings, without the word.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.report.iter().filter(|line| line.contains(MARK)).map(|line| line.replacen(MARK, ": ", 1))
    }
}

/// The patches from which the heights of a scene come.
#[derive(Debug, Clone, Default)]
pub struct Patches {
    /// Patch of the disc; none if its heights come from no patch.
    pub disc: Option<Patch>,
    /// Patch of the pin; none if its heights come from no patch.
    pub pin: Option<Patch>,
}

/// Makes the surfaces of a scene, and notes what it reads and does.
struct Loader<'a> {
    mesh: &'a Mesh,
    /// Every surface file with the SHA-256 of what was read of it, in hexadecimal digits, each once.
    inputs: Vec<(PathBuf, String)>,
    report: Vec<String>,
    /// Bodies with heights that a run recorded.
    recorded: Vec<Body>,
    /// The patches from which heights come, where they are asked for.
    patches: Option<Patches>,
}

impl Loader<'_> {
    /// Reads a file, and adds it with the digest of what was read. A file that disc and pin have in common, and that changed in between, is
    /// there twice.
    fn read<T>(&mut self, path: &Path, read: impl FnMut() -> Result<T, FileError>) -> Result<T, FileError> {
        let (content, digest) = digested(path, read, FileError::from)?;
        let input = (path.to_owned(), digest);
        if !self.inputs.contains(&input) {
            self.inputs.push(input);
        }
        Ok(content)
    }

    fn base(&mut self, source: &BaseSource, mirror: bool) -> Result<Vec<Base>, SurfaceError> {
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
            BaseSource::File { path, dataset } => {
                self.file_base(path, dataset.as_deref()).map_err(in_file(key, path))?
            }
            BaseSource::Image { path, micrograph } => {
                let map = self.fibre_map(path, micrograph).map_err(in_file(key, path))?;
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
        let mesh = self.mesh;
        let (map, picture) = self.read(path, || fibre_map(path, micrograph, mesh))?;
        let pixel = Length(micrograph.pixel);
        self.report.push(format!("pin.base: {}, {picture}, {pixel} a pixel", path.display()));
        Ok(map)
    }

    fn file_base(&mut self, path: &Path, dataset: Option<&str>) -> Result<Vec<Base>, FileError> {
        let mesh = self.mesh;
        let shape = (mesh.pin_columns(), mesh.rows());
        let (name, base) = self.read(path, || match detect(path)? {
            Format::Hdf5 => Ok(hdf5::base(path, dataset, shape, |cell| mesh.is_present(cell))?),
            format => Err(FileError::NotABase(format)),
        })?;
        self.report.push(format!("pin.base: {}, dataset {name}", path.display()));
        Ok(base)
    }
}

/// Makes the fibre map of the micrograph that a scene has for the pin's base; with the width of its pixels, m; none where the base comes
/// from something else.
pub fn micrograph(scene: &Scene) -> Result<Option<(FibreMap, f64)>, SurfaceError> {
    let BaseSource::Image { path, micrograph } = &scene.pin_base else { return Ok(None) };
    let (map, _) = fibre_map(path, micrograph, &scene.parameters.mesh).map_err(in_file("pin.base", path))?;
    Ok(Some((map, micrograph.pixel)))
}

/// The error of a file that a table of the scene names.
fn in_file(key: &'static str, path: &Path) -> impl Fn(FileError) -> SurfaceError {
    move |reason| SurfaceError::File { key, path: path.to_owned(), reason }
}

/// Makes the fibre map of an image file; says what the image is besides.
fn fibre_map(path: &Path, micrograph: &Micrograph, mesh: &Mesh) -> Result<(FibreMap, String), FileError> {
    let Grey { picture, told, .. } = grey(path)?;
    Ok((micrograph.fibre_map(picture, mesh)?, told))
}

fn grey(path: &Path) -> Result<Grey, FileError> {
    let format = detect(path)?;
    if !matches!(format, Format::Png | Format::Tiff | Format::Jpeg) {
        return Err(FileError::NotAnImage(format));
    }
    Ok(image::grey(&input::read(path, limits::SURFACE)?, format)?)
}

/// Distance of the pixels, m, that an image file states, the same along and across; none where it does not.
///
/// # Errors
/// [`FileError`] when the file is no image that is read.
pub fn stated_pixel(path: &Path) -> Result<Option<f64>, FileError> {
    let same = |[x, y]: [f64; 2]| ((x / y - 1.0).abs() < SAME_PITCH).then_some(x);
    Ok(grey(path)?.pixel.and_then(same))
}

/// Distances along and across that differ by less than this part are the same: files have few digits.
const SAME_PITCH: f64 = 0.01;

/// Points of the model's heights whose pitch is that of the cells but for rounding are the cells.
const SAME_CELL: f64 = 1e-9;

/// Tables of the scene that say where a body's heights come from, and how they are prepared.
fn keys(body: Body) -> [&'static str; 2] {
    match body {
        Body::Disc => ["disc.surface", "disc.prepare"],
        Body::Pin => ["pin.surface", "pin.prepare"],
    }
}

fn source_name(source: &HeightSource) -> String {
    match source {
        HeightSource::File { path, .. } => path.display().to_string(),
        HeightSource::Synthetic(_) => "synthetic heights".into(),
        HeightSource::Flat => "flat".into(),
    }
}

/// The lay of heights that come from a file that is taken as a profile.
fn profile_lay(source: &HeightSource) -> Option<Lay> {
    match source {
        HeightSource::File { options, .. } => options.profile_lay,
        _ => None,
    }
}

impl Loader<'_> {
    /// Heights of a body, and the fraction of its points that a cutoff cut.
    fn heights(&mut self, settings: &HeightSettings, body: Body) -> Result<(Vec<f64>, Option<f64>), SurfaceError> {
        let [surface, prepare] = keys(body);
        let (raw, has_peaks_positive) = match &settings.source {
            HeightSource::Flat => {
                self.report.push(format!("{surface}: flat"));
                (RawHeights::OnMesh(vec![0.0; body.columns(self.mesh) * self.mesh.rows()]), false)
            }
            HeightSource::Synthetic(synthesis) => {
                let heights = synthesis
                    .field(body, self.mesh)
                    .map_err(|reason| SurfaceError::Synthesis { key: surface, reason })?;
                self.report.push(format!("{surface}: synthetic, {}", describe(synthesis)));
                (RawHeights::OnMesh(heights), false)
            }
            HeightSource::File { path, options } => {
                let Preparation { pixel, extend, .. } = settings.preparation;
                if options.profile_lay == Some(Lay::Isotropic) && extend.is_none() {
                    return Err(in_file(surface, path)(ProfileError::Isotropic.into()));
                }
                self.file_heights(path, options, body, pixel).map_err(in_file(surface, path))?
            }
        };
        let mut preparation = settings.preparation;
        if preparation.cutoff.is_some() {
            self.warn_of_second(body, prepare, "cutoff");
        }
        let lay = profile_lay(&settings.source);
        if lay.is_some() {
            // It has been taken into the profile, which has a pitch in one direction only.
            preparation.pixel = None;
        }
        if let (Some(Lay::Isotropic), Some(Extension::Statistics { seed })) = (lay, preparation.extend) {
            preparation.extend = Some(Extension::Isotropic { seed });
        }
        let prepared = preparation.apply(raw, settings.mirror, body, self.mesh).map_err(|reason| {
            SurfaceError::Preparation { key: prepare, source_name: source_name(&settings.source), reason }
        })?;
        self.report.extend(prepared.report.iter().map(|step| format!("{prepare}: {step}")));
        if let Some(patches) = &mut self.patches {
            let sign = if has_peaks_positive { body.peak_sign() } else { 1.0 };
            let factor = sign * settings.preparation.scale;
            let patch = prepared.patch.map(|mut patch| {
                patch.heights.iter_mut().for_each(|height| *height *= factor);
                patch
            });
            *(if body == Body::Disc { &mut patches.disc } else { &mut patches.pin }) = patch;
        }
        let mut heights = prepared.heights;
        if has_peaks_positive && body == Body::Pin {
            body.turn(&mut heights);
            self.report.push(format!("{surface}: negated, for the pin's z grows away from the disc"));
        }
        self.report.push(format!("{surface}: {}", self.spread(&heights, body)));
        Ok((heights, prepared.cut))
    }

    /// Heights of a file. Heights of the model with the shape of the body's fields are those of its cells; any other
    /// are a patch and need a pitch.
    fn file_heights(
        &mut self,
        path: &Path,
        options: &ReadOptions,
        body: Body,
        pixel: Option<f64>,
    ) -> Result<(RawHeights, bool), FileError> {
        let measured = self.read(path, || read(path, options))?;
        let notes = measured.notes.iter().map(|note| format!("{note}, ")).collect::<String>();
        let [surface, _] = keys(body);
        self.report.push(format!("{surface}: {}, {notes}{}", path.display(), measured.describe()));
        self.report.extend(measured.warnings.iter().map(|warning| format!("{surface}: warning: {warning}")));
        let instrument = measured.instrument;
        let mesh = (body.columns(self.mesh), self.mesh.rows());
        let found = (measured.columns, measured.rows);
        if let Some(lay) = measured.profile_lay {
            let pitch = pixel.or(measured.pitch.map(|pitch| pitch[0])).ok_or(ProfileError::NoPitch)?;
            let (patch, told) = grooves(measured.heights, pitch, lay, body, self.mesh);
            self.report.push(format!("{surface}: {told}, points {} apart", Length(pitch)));
            return Ok((RawHeights::Patch(patch), instrument));
        }
        if found.0 == 1 || found.1 == 1 {
            self.report.push(format!(
                "{surface}: warning: {} x {} points are one line, and the heights are the same on both sides of it: of a profile \
                 say how its surface goes on, with profile_lay = \"along\", \"across\" or \"isotropic\"",
                found.0, found.1
            ));
        }
        match measured.body {
            Some(recorded) if recorded != body => return Err(FileError::OtherBody),
            recorded => self.recorded.extend(recorded),
        }
        let pitch = measured.pitch.or(pixel.map(|pixel| [pixel; 2]));
        let cell = [self.mesh.column_width(), self.mesh.row_height()];
        let is_cell =
            |pitch: [f64; 2]| pitch.iter().zip(cell).all(|(pitch, cell)| (pitch / cell - 1.0).abs() < SAME_CELL);
        let raw = match pitch {
            Some(pitch) if !instrument && pixel.is_none() && found == mesh && is_cell(pitch) => {
                RawHeights::OnMesh(measured.heights)
            }
            Some([column_pitch, row_pitch]) => {
                let (columns, rows) = found;
                RawHeights::Patch(Patch { columns, rows, column_pitch, row_pitch, heights: measured.heights })
            }
            None if instrument => return Err(FileError::NoPitchOfFile),
            None if found == mesh => RawHeights::OnMesh(measured.heights),
            None => return Err(FileError::NoPitch { what: notes, found, mesh }),
        };
        Ok((raw, instrument))
    }

    /// Warns of a step that the run which recorded the heights of a body has already taken.
    fn warn_of_second(&mut self, body: Body, table: &str, key: &str) {
        if self.recorded.contains(&body) {
            self.report.push(format!(
                "{table}: warning: {key} is applied to the map of a run, which has already been prepared: leave it out, unless \
                 these heights are to be changed once more"
            ));
        }
    }

    /// Describes the spread of the heights of a body within the pin's outline.
    fn spread(&self, heights: &[f64], body: Body) -> String {
        if body == Body::Disc || self.mesh.is_rectangle() {
            return spread(heights);
        }
        let mut within = heights.to_vec();
        self.mesh.absent_cells().for_each(|cell| within[cell] = f64::NAN);
        spread(&within)
    }
}

/// Describes the synthetic heights that were asked for.
fn describe(synthesis: &HeightSynthesis) -> String {
    let HeightSynthesis { seed, rms_height, texture, skewness, kurtosis, patch } = *synthesis;
    let texture = match texture {
        Texture::Correlation { along, across } if along == across => format!("correlation length {}", Length(along)),
        Texture::Correlation { along, across } => {
            format!("correlation length {} along and {} across sliding", Length(along), Length(across))
        }
        Texture::PowerLaw { hurst, roll_off, short_cutoff } => {
            let cutoff = short_cutoff.map(|cutoff| format!(", cut off at {}", Length(cutoff))).unwrap_or_default();
            format!("power law with Hurst exponent {hurst} below {}{cutoff}", Length(roll_off))
        }
    };
    let normal = skewness == 0.0 && kurtosis == 3.0;
    let moments = if normal { String::new() } else { format!(", skewness {skewness}, kurtosis {kurtosis}") };
    let patch = patch.map(|patch| format!(", repeated about every {}", Length(patch))).unwrap_or_default();
    format!("seed {seed}, rms height {}, {texture}{moments}{patch}", Length(rms_height))
}

/// Lowest and highest of the heights, their root-mean-square deviation from the mean, skewness and kurtosis.
fn spread(heights: &[f64]) -> String {
    let Some(parameters) = HeightParameters::of(heights) else { return "no heights".to_owned() };
    let HeightParameters { root_mean_square_height, skewness, kurtosis, .. } = parameters;
    let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let shape =
        if skewness.is_nan() { String::new() } else { format!(", skewness {skewness:.3}, kurtosis {kurtosis:.3}") };
    let rms = Length(root_mean_square_height);
    format!("heights from {} to {}, rms {rms}{shape}", Length(lowest), Length(highest))
}

/// Reads or makes the initial surfaces of a scene and prepares them.
///
/// Heights of the pin that come from an instrument (SDF, text, images) are negated after their preparation: an
/// instrument's peaks are positive, while the pin's z grows away from the disc. HDF5, NumPy and synthetic heights are
/// taken as they are.
pub fn load(scene: &Scene) -> Result<Loaded, SurfaceError> {
    Ok(made(scene, None)?.0)
}

/// Loads as [`load`] does, with the patches from which the heights of disc and pin come: prepared, scaled and with the sign that the
/// heights have, at their own pitch; none for a body whose heights come from no patch.
pub fn load_with_patches(scene: &Scene) -> Result<(Loaded, Patches), SurfaceError> {
    made(scene, Some(Patches::default()))
}

/// The surfaces, and the patches from which they come where these are asked for.
fn made(scene: &Scene, patches: Option<Patches>) -> Result<(Loaded, Patches), SurfaceError> {
    let mesh = &scene.parameters.mesh;
    let mut loader = Loader { mesh, inputs: Vec::new(), report: Vec::new(), recorded: Vec::new(), patches };
    let (disc_height, disc_cut) = loader.heights(&scene.disc_surface, Body::Disc)?;
    let (mut pin_height, pin_cut) = loader.heights(&scene.pin_surface, Body::Pin)?;
    let pin_base = loader.base(&scene.pin_base, scene.pin_base_mirror)?;
    if scene.resin_recess != 0.0 {
        loader.warn_of_second(Body::Pin, "pin.surface", "resin_recess");
        set_back_resin(&mut pin_height, &pin_base, scene.resin_recess);
        loader.report.push(format!("pin.surface: resin set back by {}", Length(scene.resin_recess)));
    }
    let surfaces = InitialSurfaces { disc_height, pin_height, pin_base };
    let Loader { inputs, report, patches, .. } = loader;
    Ok((Loaded { surfaces, disc_cut, pin_cut, inputs, report }, patches.unwrap_or_default()))
}
