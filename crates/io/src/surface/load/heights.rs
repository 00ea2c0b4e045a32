//! The initial heights of a body: read or made, prepared, and told of.

use std::path::Path;

use plateau_core::surface::describe::HeightParameters;
use plateau_core::surface::{Body, Extension, HeightSynthesis, Length, Patch, Preparation, RawHeights, Texture};

use super::super::error::{FileError, SurfaceError};
use super::super::options::ReadOptions;
use super::super::read::read;
use super::super::stylus_profile::{Lay, ProfileError};
use super::loader::Loader;
use crate::scene::{HeightSettings, HeightSource};

/// Points of the model's heights whose pitch is that of the cells but for rounding are the cells.
const SAME_CELL: f64 = 1e-9;

/// Table of the scene that says where a body's heights come from.
fn surface_key(body: Body) -> &'static str {
    match body {
        Body::Disc => "disc.surface",
        Body::Pin => "pin.surface",
    }
}

/// Table of the scene that says how they are prepared.
fn prepare_key(body: Body) -> &'static str {
    match body {
        Body::Disc => "disc.prepare",
        Body::Pin => "pin.prepare",
    }
}

/// What heights are called in an error of their preparation.
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
    pub(super) fn heights(
        &mut self,
        settings: &HeightSettings,
        body: Body,
    ) -> Result<(Vec<f64>, Option<f64>), SurfaceError> {
        let (surface, prepare) = (surface_key(body), prepare_key(body));
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
                    let reason = ProfileError::Isotropic.into();
                    return Err(SurfaceError::File { key: surface, path: path.clone(), reason });
                }
                let (raw, instrument) = self
                    .file_heights(path, options, body, pixel)
                    .map_err(|reason| SurfaceError::File { key: surface, path: path.clone(), reason })?;
                (raw, instrument)
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
        let measured = self.inputs.read(path, || read(path, options))?;
        let notes = measured.notes.iter().map(|note| format!("{note}, ")).collect::<String>();
        let surface = surface_key(body);
        self.report.push(format!("{surface}: {}, {notes}{}", path.display(), measured.describe()));
        self.report.extend(measured.warnings.iter().map(|warning| format!("{surface}: warning: {warning}")));
        let instrument = measured.instrument;
        let mesh = (body.columns(self.mesh), self.mesh.rows());
        let found = (measured.columns, measured.rows);
        if let Some(profile) = measured.stylus_profile(pixel)? {
            let pitch = Length(profile.pitch);
            self.report.push(format!("{surface}: {}, points {pitch} apart", profile.describe()));
            return Ok((RawHeights::Patch(profile.into_patch(body, self.mesh)), instrument));
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
    pub(super) fn warn_of_second(&mut self, body: Body, table: &str, key: &str) {
        if self.recorded.contains(&body) {
            self.report.push(format!(
                "{table}: warning: {key} is applied to the map of a run, which has already been prepared: leave it out, unless \
                 these heights are to be changed once more"
            ));
        }
    }

    /// What the heights of a body are like, within the pin's outline.
    fn spread(&self, heights: &[f64], body: Body) -> String {
        if body == Body::Disc || self.mesh.is_rectangle() {
            return spread(heights);
        }
        let mut within = heights.to_vec();
        self.mesh.absent_cells().for_each(|cell| within[cell] = f64::NAN);
        spread(&within)
    }
}

/// What synthetic heights were asked for, in words.
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
