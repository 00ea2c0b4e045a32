//! A picture of what became of a micrograph.

use std::path::Path;

use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::Base;
use plateau_core::surface::micrograph::{FibreMap, PinPlane};

use super::error::{FileError, SurfaceError};
use super::load::fibre_map;
use crate::scene::recipe::{BaseSource, Scene};

/// Pixels of the longer side of a panel.
const PANEL: usize = 800;
/// Pixels between and around the panels.
const MARGIN: usize = 16;

type Rgb = [u8; 3];
const PAPER: Rgb = [255, 255, 255];
const OUTLINE: Rgb = [220, 30, 30];
const FIBRE: Rgb = [240, 190, 60];
const RESIN: Rgb = [60, 60, 70];

/// The pin's fibre map `base`, which was loaded from the scene, as a PNG image: x along the sliding direction to the right, outward to the top, at the true
/// proportions of the pin. If it comes from a micrograph, that is on the left, with the outline of what was taken for
/// fibre, before it is mirrored; on the right is the base of the pin's cells.
///
/// # Errors
/// [`SurfaceError`] as for [`load`](super::load()).
pub fn base_preview(scene: &Scene, base: &[Base]) -> Result<Vec<u8>, SurfaceError> {
    let mesh = &scene.parameters.mesh;
    let failed = |file: &Path| {
        let path = file.to_owned();
        move |reason| SurfaceError::File { key: "pin.base", path, reason }
    };
    match &scene.pin_base {
        BaseSource::Image { path, recipe } => {
            let (map, _) = fibre_map(path, recipe, mesh).map_err(failed(path))?;
            let size = (map.grey.width as f64 * recipe.pixel, map.grey.height as f64 * recipe.pixel);
            let scale = PANEL as f64 / size.0.max(size.1);
            let panel = Panel { size, scale };
            let mut canvas = Canvas::new(2, &panel);
            panel.draw(&mut canvas, 0, |x, y| micrograph(&map, recipe.pixel, x, y));
            panel.draw(&mut canvas, 1, |x, y| cell(base, mesh, x, y));
            canvas.png().map_err(failed(path))
        }
        _ => {
            let half = PinPlane::new(mesh).half_extent();
            let size = (2.0 * half.0, 2.0 * half.1);
            let panel = Panel { size, scale: PANEL as f64 / size.0.max(size.1) };
            let mut canvas = Canvas::new(1, &panel);
            panel.draw(&mut canvas, 0, |x, y| cell(base, mesh, x, y));
            canvas.png().map_err(failed(&scene.path))
        }
    }
}

/// Colour of the micrograph at a point of the pin's plane, m.
fn micrograph(map: &FibreMap, pixel: f64, x: f64, y: f64) -> Rgb {
    let (width, height) = (map.fibre.width, map.fibre.height);
    // The casts saturate.
    let column = ((x / pixel + 0.5 * width as f64) as usize).min(width - 1);
    let line = ((0.5 * height as f64 - y / pixel) as usize).min(height - 1);
    let at = |column: usize, line: usize| map.fibre.pixels[line * width + column];
    let edge = at(column, line)
        && (!at(column.saturating_sub(1), line)
            || !at((column + 1).min(width - 1), line)
            || !at(column, line.saturating_sub(1))
            || !at(column, (line + 1).min(height - 1)));
    let grey = (255.0 * map.grey.pixels[line * width + column]).round() as u8;
    if edge { OUTLINE } else { [grey; 3] }
}

/// Colour of the pin's cells at a point of its plane, m.
fn cell(base: &[Base], mesh: &Mesh, x: f64, y: f64) -> Rgb {
    match PinPlane::new(mesh).cell(x, y).and_then(|cell| base.get(cell)) {
        Some(Base::Primary) => FIBRE,
        Some(Base::None) => RESIN,
        None => PAPER,
    }
}

/// A part of the plane as part of a picture.
struct Panel {
    /// Width and height, m.
    size: (f64, f64),
    /// Pixels of a metre.
    scale: f64,
}

impl Panel {
    fn pixels(&self) -> (usize, usize) {
        let pixels = |length: f64| ((length * self.scale).round() as usize).clamp(1, PANEL);
        (pixels(self.size.0), pixels(self.size.1))
    }

    /// Draws the panel number `at` from the left.
    fn draw(&self, canvas: &mut Canvas, at: usize, colour: impl Fn(f64, f64) -> Rgb) {
        let (width, height) = self.pixels();
        let left = MARGIN + at * (width + MARGIN);
        for line in 0..height {
            let y = 0.5 * self.size.1 - (line as f64 + 0.5) / self.scale;
            for column in 0..width {
                let x = (column as f64 + 0.5) / self.scale - 0.5 * self.size.0;
                canvas.pixels[(MARGIN + line) * canvas.width + left + column] = colour(x, y);
            }
        }
    }
}

struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<Rgb>,
}

impl Canvas {
    fn new(panels: usize, panel: &Panel) -> Self {
        let (width, height) = panel.pixels();
        let (width, height) = (panels * (width + MARGIN) + MARGIN, height + 2 * MARGIN);
        Self { width, height, pixels: vec![PAPER; width * height] }
    }

    fn png(&self) -> Result<Vec<u8>, FileError> {
        let mut png = Vec::new();
        let mut encoder = png::Encoder::new(&mut png, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        writer.finish()?;
        Ok(png)
    }
}
