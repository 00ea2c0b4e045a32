//! Map, histogram and Abbott-Firestone curve of surfaces in one picture.

use std::io::Cursor;
use std::ops::RangeInclusive;

use image::{ImageFormat, RgbImage};
use plateau_core::surface::describe::{CoreHeight, Description, Grid};
use plotters::prelude::{BitMapBackend, DrawingBackend};

use super::axes::{Axes, Axis, Frame};
use super::canvas::{Anchor, Canvas, FigureError, LINE, TEXT, TITLE, failed};
use super::colour::{DATA, DATA_AREA, DERIVED, DERIVED_AREA, FAINT, MISSING};
use super::colour_bar::ColourBar;
use super::histogram::Histogram;
use super::raster::Raster;
use super::unit::AxisUnit;

/// Width and height of the part of a page that shows one surface, pixels: printed 90 mm wide, letters are of 6 points.
const BLOCK: [f64; 2] = [1440.0, 1560.0];
/// Room for the numbers and the label of an axis on the left.
const LEFT: f64 = 170.0;
/// Room for the map.
const MAP: Frame = Frame { x: [LEFT, 1170.0], y: [150.0, 850.0] };
/// The histogram, and beside it, with the same axis, the curve.
const HISTOGRAM: Frame = Frame { x: [LEFT, 620.0], y: [1000.0, 1430.0] };
const CURVE: Frame = Frame { x: [660.0, 1400.0], y: HISTOGRAM.y };
/// A map that is longer than this many times its width is stretched, or nothing could be seen on it.
const MOST_ELONGATED: f64 = 4.0;
/// Classes of the histogram.
const CLASSES: usize = 72;

/// What a picture shows of the heights themselves.
#[derive(Debug, Clone)]
pub struct Drawn {
    map: Raster,
    histogram: Histogram,
}

impl Drawn {
    /// Takes from the heights what is drawn of them.
    pub fn of(grid: &Grid, description: &Description) -> Self {
        let mean = description.heights.mean;
        let histogram = Histogram::of(grid.heights, mean, height_range(description), CLASSES);
        Self { map: Raster::of(grid, mean), histogram }
    }
}

/// One surface to be drawn.
#[derive(Debug, Clone)]
pub struct SurfaceFigure<'a> {
    /// Its name.
    pub title: String,
    /// Points along x and y.
    pub points: [usize; 2],
    /// Their distances, m, if known.
    pub pitch: Option<[f64; 2]>,
    /// Its heights.
    pub drawn: &'a Drawn,
    /// Its parameters.
    pub description: &'a Description,
}

/// Draws surfaces beside and below each other; gives the picture as PNG.
pub fn surfaces(figures: &[SurfaceFigure]) -> Result<Vec<u8>, FigureError> {
    let across = match figures.len() {
        0 | 1 => 1,
        2..=4 => 2,
        _ => 3,
    };
    let down = figures.len().div_ceil(across).max(1);
    let size = [BLOCK[0] as u32 * across as u32, BLOCK[1] as u32 * down as u32];
    let mut image = RgbImage::new(size[0], size[1]);
    let canvas = Canvas::new(BitMapBackend::with_buffer(&mut image, (size[0], size[1])))?;
    for (index, figure) in figures.iter().enumerate() {
        let origin = [(index % across) as f64 * BLOCK[0], (index / across) as f64 * BLOCK[1]];
        figure.draw(&canvas, origin)?;
    }
    canvas.finish()?;
    let mut png = Cursor::new(Vec::new());
    image.write_to(&mut png, ImageFormat::Png).map_err(failed)?;
    Ok(png.into_inner())
}

impl SurfaceFigure<'_> {
    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>, origin: [f64; 2]) -> Result<(), FigureError> {
        let moved = |frame: Frame| Frame { x: frame.x.map(|x| x + origin[0]), y: frame.y.map(|y| y + origin[1]) };
        self.draw_title(canvas, origin)?;
        self.draw_map(canvas, moved(MAP))?;
        let unit = self.height_unit();
        let range = scaled(&self.drawn.histogram.range, unit);
        self.draw_histogram(canvas, moved(HISTOGRAM), &range, unit)?;
        self.draw_curve(canvas, moved(CURVE), &range, unit)
    }

    fn draw_title<B: DrawingBackend>(&self, canvas: &Canvas<B>, [x, y]: [f64; 2]) -> Result<(), FigureError> {
        let room = BLOCK[0] - LEFT - 40.0;
        canvas.text(&shortened(canvas, &self.title, room), (x + LEFT, y + 30.0), Anchor::BelowRight, TITLE)?;
        let missing = 1.0 - self.description.measured as f64 / (self.points[0] * self.points[1]) as f64;
        if missing > 0.0 {
            let box_end = [x + LEFT + 34.0, y + 92.0 + 26.0];
            let key = Frame { x: [x + LEFT, box_end[0]], y: [y + 92.0, box_end[1]] };
            canvas.area(&key.corners(), MISSING)?;
            let text = format!("no height: {} %", percent(missing));
            canvas.text(&text, (box_end[0] + 12.0, 0.5 * (key.y[0] + key.y[1])), Anchor::Right, TEXT)?;
        }
        Ok(())
    }

    fn draw_map<B: DrawingBackend>(&self, canvas: &Canvas<B>, room: Frame) -> Result<(), FigureError> {
        let points = self.points.map(|points| points as f64);
        let pitch = self.pitch.unwrap_or([1.0; 2]);
        let extent = [points[0] * pitch[0], points[1] * pitch[1]];
        let frame = fitted(room, extent);
        let axis = |extent: f64, name: &str| {
            let unit = if self.pitch.is_some() { AxisUnit::for_length(extent) } else { AxisUnit::POINTS };
            let label = format!("{name}, {}", unit.symbol);
            Axis { range: 0.0..=extent * unit.per_metre, label, numbered: true }
        };
        let colours = colour_range(self.description);
        let (width, height) = (frame.width() as u32, frame.height() as u32);
        canvas.bitmap((frame.x[0], frame.y[0]), (width, height), self.drawn.map.picture(width, height, &colours))?;
        Axes { frame, x: axis(extent[0], "x"), y: axis(extent[1], "y") }.draw(canvas)?;
        let unit = self.height_unit();
        // Points at its ends and room for them.
        let bar = Frame { x: [frame.x[1] + 40.0, frame.x[1] + 80.0], y: [frame.y[0] + 28.0, frame.y[1] - 28.0] };
        ColourBar { frame: bar, range: scaled(&colours, unit), label: format!("height, {}", unit.symbol) }.draw(canvas)
    }

    fn draw_histogram<B: DrawingBackend>(
        &self,
        canvas: &Canvas<B>,
        frame: Frame,
        range: &RangeInclusive<f64>,
        unit: AxisUnit,
    ) -> Result<(), FigureError> {
        let fractions = &self.drawn.histogram.fractions;
        let largest = fractions.iter().copied().fold(0.0, f64::max).max(1e-6);
        let y = Axis { range: range.clone(), label: format!("height, {}", unit.symbol), numbered: true };
        // The text has its place beyond the longest bars.
        let x = Axis { range: 0.0..=125.0 * largest, label: "points per class, %".to_owned(), numbered: true };
        let axes = Axes { frame, x, y };
        let class = (range.end() - range.start()) / fractions.len() as f64;
        let end = |class_number: usize| range.start() + class_number as f64 * class;
        for (number, fraction) in fractions.iter().enumerate().filter(|(_, fraction)| **fraction > 0.0) {
            let ((left, bottom), (right, top)) =
                (axes.place(0.0, end(number)), axes.place(100.0 * fraction, end(number + 1)));
            canvas.area(&Frame { x: [left, right], y: [top, bottom] }.corners(), DATA_AREA)?;
        }
        let outline = fractions
            .iter()
            .enumerate()
            .flat_map(|(number, fraction)| [end(number), end(number + 1)].map(|y| axes.place(100.0 * fraction, y)));
        canvas.line(&outline.collect::<Vec<_>>(), DATA, LINE)?;
        axes.draw(canvas)?;
        let heights = &self.description.heights;
        let lines = [
            format!("Sq {}", self.height(heights.root_mean_square_height, unit)),
            format!("Ssk {}", number(heights.skewness)),
            format!("Sku {}", number(heights.kurtosis)),
        ];
        write_in_corner(canvas, &frame, &lines)
    }

    fn draw_curve<B: DrawingBackend>(
        &self,
        canvas: &Canvas<B>,
        frame: Frame,
        range: &RangeInclusive<f64>,
        unit: AxisUnit,
    ) -> Result<(), FigureError> {
        let y = Axis { range: range.clone(), label: String::new(), numbered: false };
        let axes =
            Axes { frame, x: Axis { range: 0.0..=100.0, label: "material ratio, %".to_owned(), numbered: true }, y };
        let CoreHeight { core_height, reduced_peak_height, reduced_dale_depth, peak_ratio, dale_ratio, upper, lower } =
            self.description.core;
        let place = |ratio: f64, height: f64| axes.place_within(100.0 * ratio, height * unit.per_metre);
        if core_height.is_finite() {
            let peaks = [place(0.0, upper), place(0.0, upper + reduced_peak_height), place(peak_ratio, upper)];
            let dales = [place(1.0, lower), place(1.0, lower - reduced_dale_depth), place(dale_ratio, lower)];
            canvas.area(&peaks, DERIVED_AREA)?;
            canvas.area(&dales, DERIVED_AREA)?;
            for height in [upper, lower] {
                canvas.line(&[place(0.0, height), place(1.0, height)], FAINT, 2)?;
            }
            canvas.line(&[place(0.0, upper), place(1.0, lower)], DERIVED, LINE)?;
        }
        let curve = &self.description.material_curve;
        let classes = curve.len().saturating_sub(1).max(1) as f64;
        let places = curve.iter().enumerate().map(|(class, height)| place(class as f64 / classes, *height));
        canvas.line(&places.collect::<Vec<_>>(), DATA, LINE + 2)?;
        axes.draw(canvas)?;
        let ratio = |ratio: f64| format!("{} %", percent(ratio));
        let lines = [
            format!("Sk {}", self.height(core_height, unit)),
            format!("Spk {}", self.height(reduced_peak_height, unit)),
            format!("Svk {}", self.height(reduced_dale_depth, unit)),
            format!("Smr1 {}", ratio(peak_ratio)),
            format!("Smr2 {}", ratio(dale_ratio)),
        ];
        write_in_corner(canvas, &frame, &lines)
    }

    /// The unit of heights.
    fn height_unit(&self) -> AxisUnit {
        let range = &self.drawn.histogram.range;
        AxisUnit::for_length(0.5 * (range.end() - range.start()))
    }

    fn height(&self, height: f64, unit: AxisUnit) -> String {
        format!("{} {}", number(height * unit.per_metre), unit.symbol)
    }
}

/// Lines of text in the upper right corner of a box.
fn write_in_corner<B: DrawingBackend>(canvas: &Canvas<B>, frame: &Frame, lines: &[String]) -> Result<(), FigureError> {
    let spacing = 1.25 * f64::from(TEXT);
    for (line, text) in lines.iter().enumerate() {
        let place = (frame.x[1] - 16.0, frame.y[0] + 14.0 + line as f64 * spacing);
        canvas.text(text, place, Anchor::BelowLeft, TEXT)?;
    }
    Ok(())
}

/// The largest frame of these proportions in the room; stretched where it would be a line.
fn fitted(room: Frame, [length, height]: [f64; 2]) -> Frame {
    let proportion = (length / height).clamp(1.0 / MOST_ELONGATED, MOST_ELONGATED);
    let width = room.width().min(room.height() * proportion).floor();
    let height = (width / proportion).floor();
    Frame { x: [room.x[0], room.x[0] + width], y: [room.y[1] - height, room.y[1]] }
}

/// Heights between the material ratios 99.9 % and 0.1 %, with the ends of the core, and a margin, m above the mean.
fn height_range(description: &Description) -> RangeInclusive<f64> {
    let curve = &description.material_curve;
    let classes = curve.len().saturating_sub(1);
    let at = |class: usize| curve.get(class).copied().unwrap_or(0.0);
    let CoreHeight { upper, lower, .. } = description.core;
    let (low, high) = (at(classes - classes / 1000).min(lower), at(classes / 1000).max(upper));
    let margin = 0.06 * (high - low).max(1e-9);
    low - margin..=high + margin
}

/// Heights that the colour map spans: between the material ratios 99.5 % and 0.5 %, m above the mean.
fn colour_range(description: &Description) -> RangeInclusive<f64> {
    let curve = &description.material_curve;
    let classes = curve.len().saturating_sub(1);
    let at = |class: usize| curve.get(class).copied().unwrap_or(0.0);
    let (low, high) = (at(classes - classes / 200), at(classes / 200));
    if high > low { low..=high } else { low - 1e-9..=high + 1e-9 }
}

fn scaled(range: &RangeInclusive<f64>, unit: AxisUnit) -> RangeInclusive<f64> {
    range.start() * unit.per_metre..=range.end() * unit.per_metre
}

/// Three significant digits, with a minus sign.
fn number(value: f64) -> String {
    if value.is_nan() {
        return "\u{2013}".to_owned();
    }
    let value = if value.abs() < 1e-3 { 0.0 } else { value };
    crate::number::significant(value, 3).replace('-', "\u{2212}")
}

fn percent(fraction: f64) -> String {
    if fraction.is_nan() { "\u{2013}".to_owned() } else { crate::number::significant(100.0 * fraction, 3) }
}

/// A text that is too long for its room, with its middle left out.
fn shortened<B: DrawingBackend>(canvas: &Canvas<B>, text: &str, room: f64) -> String {
    let letters: Vec<char> = text.chars().collect();
    let mut kept = letters.len();
    loop {
        let shown: String = if kept == letters.len() {
            text.to_owned()
        } else {
            let (begin, end) = (&letters[..kept.div_ceil(2)], &letters[letters.len() - kept / 2..]);
            begin.iter().chain(&['\u{2026}']).chain(end).collect()
        };
        if kept == 0 || canvas.text_width(&shown, TITLE) <= room {
            return shown;
        }
        kept -= 1;
    }
}
