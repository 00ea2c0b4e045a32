//! Map, histogram and Abbott-Firestone curve of surfaces in one picture.

use std::io::Cursor;
use std::ops::RangeInclusive;

use image::{ImageFormat, RgbImage};
use plateau_core::surface::describe::{CoreHeight, Description, Grid};
use plotters::prelude::{BitMapBackend, DrawingBackend};

use super::axes::{Axes, Axis, Frame};
use super::canvas::{Anchor, Canvas, FigureError, LINE, Place, TEXT, TITLE, failed};
use super::colour::{DATA, DATA_AREA, DERIVED, DERIVED_AREA, FAINT, MISSING};
use super::colour_bar::ColourBar;
use super::font::{shortened, text_width};
use super::histogram::Histogram;
use super::raster::Raster;
use super::unit::AxisUnit;

/// Width of the part of a page that shows one surface, pixels: printed 90 mm wide, letters are of 6 points.
const WIDTH: f64 = 1440.0;
/// Room for the numbers and the label of an axis on the left.
const LEFT: f64 = 170.0;
/// Left and right end of the map, and its largest height.
const MAP: ([f64; 2], f64) = ([LEFT, 1170.0], 700.0);
/// Left and right end of the histogram, and of the curve beside it, which shares its axis.
const HISTOGRAM: [f64; 2] = [LEFT, 620.0];
const CURVE: [f64; 2] = [660.0, 1400.0];
/// Their height.
const CHART: f64 = 430.0;
/// Room for the title, for the line of remarks above the map, and for the numbers and the label of an axis below a box.
const HEAD: f64 = 100.0;
const REMARKS: f64 = 50.0;
const FOOT: f64 = 120.0;
/// Room for the lines of text above a chart, and their distance.
const CAPTION: f64 = 3.0 * SPACING + 10.0;
const SPACING: f64 = 1.25 * TEXT as f64;
/// A map that is longer than this many times its width is stretched, or nothing could be seen on it.
const MOST_ELONGATED: f64 = 5.0;
/// Heights farther than this many times the interquartile range outside the quartiles do not widen axes and colours.
const FENCE: f64 = 5.0;
/// Classes of the histogram.
const CLASSES: usize = 64;
/// Distance of the places that a curve is drawn through, pixels: rounded to pixels, nearer ones would make it ragged.
const STEP: f64 = 8.0;

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

/// Room that all surfaces of a page have, pixels: above the map, and for the map.
#[derive(Debug, Clone, Copy)]
struct Room {
    head: f64,
    map: f64,
}

/// Draws surfaces beside and below each other; gives the picture as PNG.
pub fn surfaces(figures: &[SurfaceFigure]) -> Result<Vec<u8>, FigureError> {
    let across = match figures.len() {
        0 | 1 => 1,
        2..=4 => 2,
        _ => 3,
    };
    let down = figures.len().div_ceil(across).max(1);
    let remarks = if figures.iter().any(SurfaceFigure::has_remarks) { REMARKS } else { 0.0 };
    let room =
        Room { head: HEAD + remarks, map: figures.iter().map(|figure| figure.map_size()[1]).fold(0.0, f64::max) };
    let height = room.head + room.map + FOOT + CAPTION + CHART + FOOT;
    let size = [(WIDTH * across as f64) as u32, (height * down as f64) as u32];
    let mut image = RgbImage::new(size[0], size[1]);
    let canvas = Canvas::new(BitMapBackend::with_buffer(&mut image, (size[0], size[1])))?;
    for (index, figure) in figures.iter().enumerate() {
        let origin = [(index % across) as f64 * WIDTH, (index / across) as f64 * height];
        figure.draw(&canvas, origin, room)?;
    }
    canvas.finish()?;
    let mut png = Cursor::new(Vec::new());
    image.write_to(&mut png, ImageFormat::Png).map_err(failed)?;
    Ok(png.into_inner())
}

impl SurfaceFigure<'_> {
    /// Draws the surface with the upper left corner there.
    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<B>, [x, y]: [f64; 2], room: Room) -> Result<(), FigureError> {
        self.draw_title(canvas, [x + LEFT, y])?;
        let ([left, _], [width, height]) = (MAP.0, self.map_size());
        let top = y + room.head;
        self.draw_map(canvas, Frame { x: [x + left, x + left + width], y: [top, top + height] })?;
        let top = top + room.map + FOOT + CAPTION;
        let chart = |ends: [f64; 2]| Frame { x: ends.map(|end| x + end), y: [top, top + CHART] };
        let unit = self.height_unit();
        let range = scaled(&self.drawn.histogram.range, unit);
        self.draw_histogram(canvas, chart(HISTOGRAM), &range, unit)?;
        self.draw_curve(canvas, chart(CURVE), &range, unit)
    }

    /// The name, and what is to know of the map.
    fn draw_title<B: DrawingBackend>(&self, canvas: &Canvas<B>, [x, y]: [f64; 2]) -> Result<(), FigureError> {
        canvas.text(&shortened(&self.title, TITLE, WIDTH - LEFT - 40.0), (x, y + 30.0), Anchor::BelowRight, TITLE)?;
        let (middle, mut begin) = (y + 106.0, x);
        let missing = 1.0 - self.description.measured as f64 / (self.points[0] * self.points[1]) as f64;
        if missing > 0.0 {
            let key = Frame { x: [begin, begin + 34.0], y: [middle - 13.0, middle + 13.0] };
            canvas.area(&key.corners(), MISSING)?;
            let text = format!("no height: {} %", percent(missing));
            canvas.text(&text, (key.x[1] + 12.0, middle), Anchor::Right, TEXT)?;
            begin = key.x[1] + 12.0 + text_width(&text, TEXT) + 40.0;
        }
        let [stretched_x, stretched_y] = self.stretch();
        for (axis, stretched) in [("x", stretched_x), ("y", stretched_y)] {
            if stretched > 1.0 {
                let text = format!("{axis} stretched {} times", number(stretched));
                canvas.text(&text, (begin, middle), Anchor::Right, TEXT)?;
            }
        }
        Ok(())
    }

    /// Whether there is anything to know of the map.
    fn has_remarks(&self) -> bool {
        self.description.measured < self.points[0] * self.points[1] || self.stretch().iter().any(|times| *times > 1.0)
    }

    /// Extent along x and y, m or points.
    fn extent(&self) -> [f64; 2] {
        let pitch = self.pitch.unwrap_or([1.0; 2]);
        [self.points[0] as f64 * pitch[0], self.points[1] as f64 * pitch[1]]
    }

    /// Width and height of the map, pixels.
    fn map_size(&self) -> [f64; 2] {
        let [x, y] = self.extent();
        let proportion = (x / y).clamp(1.0 / MOST_ELONGATED, MOST_ELONGATED);
        let width = (MAP.0[1] - MAP.0[0]).min(MAP.1 * proportion).floor();
        [width, (width / proportion).floor()]
    }

    /// How many times larger than in proportion the map is along x and y.
    fn stretch(&self) -> [f64; 2] {
        let [x, y] = self.extent();
        [y / x / MOST_ELONGATED, x / y / MOST_ELONGATED]
    }

    fn draw_map<B: DrawingBackend>(&self, canvas: &Canvas<B>, frame: Frame) -> Result<(), FigureError> {
        let extent = self.extent();
        let axis = |extent: f64, name: &str| {
            let unit = if self.pitch.is_some() { AxisUnit::for_length(extent) } else { AxisUnit::POINTS };
            let label = format!("{name}, {}", unit.symbol);
            Axis::linear(0.0..=extent * unit.per_metre, label)
        };
        let colours = colour_range(self.description);
        let (width, height) = (frame.width() as u32, frame.height() as u32);
        canvas.bitmap((frame.x[0], frame.y[0]), (width, height), self.drawn.map.picture(width, height, &colours))?;
        Axes { frame, x: axis(extent[0], "x"), y: axis(extent[1], "y") }.draw(canvas)?;
        let unit = self.height_unit();
        // Points at its ends and room for them.
        let bar = Frame { x: [frame.x[1] + 40.0, frame.x[1] + 80.0], y: [frame.y[0] + 28.0, frame.y[1] - 28.0] };
        let axis = Axis::linear(scaled(&colours, unit), format!("height, {}", unit.symbol));
        ColourBar { frame: bar, axis }.draw(canvas)
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
        let y = Axis::linear(range.clone(), format!("height, {}", unit.symbol));
        let x = Axis::linear(0.0..=105.0 * largest, "points per class, %");
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
        let (heights, outside) = (&self.description.heights, self.drawn.histogram.outside);
        let mut lines = vec![
            format!("Sq {}", self.height(heights.root_mean_square_height, unit)),
            format!("Ssk {}   Sku {}", number(heights.skewness), number(heights.kurtosis)),
        ];
        if outside > 0.0 {
            lines.push(format!("beyond the axis: {} %", percent(outside)));
        }
        write_above(canvas, &frame, &lines)
    }

    fn draw_curve<B: DrawingBackend>(
        &self,
        canvas: &Canvas<B>,
        frame: Frame,
        range: &RangeInclusive<f64>,
        unit: AxisUnit,
    ) -> Result<(), FigureError> {
        let y = Axis::linear(range.clone(), "").shared();
        let axes = Axes { frame, x: Axis::linear(0.0..=100.0, "material ratio, %"), y };
        let CoreHeight { core_height, reduced_peak_height, reduced_dale_depth, peak_ratio, dale_ratio, upper, lower } =
            self.description.core;
        let place = |ratio: f64, height: f64| axes.place_within(100.0 * ratio, height * unit.per_metre);
        if peak_ratio.is_finite() {
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
        canvas.line(&apart(&places.collect::<Vec<_>>()), DATA, LINE + 2)?;
        axes.draw(canvas)?;
        let [core, peak, dale] =
            [core_height, reduced_peak_height, reduced_dale_depth].map(|height| self.height(height, unit));
        let lines = [
            format!("Sk {core}"),
            format!("Spk {peak}   Svk {dale}"),
            format!("Smr1 {} %   Smr2 {} %", percent(peak_ratio), percent(dale_ratio)),
        ];
        write_above(canvas, &frame, &lines)
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

/// Lines of text above a box.
fn write_above<B: DrawingBackend>(canvas: &Canvas<B>, frame: &Frame, lines: &[String]) -> Result<(), FigureError> {
    for (line, text) in lines.iter().enumerate() {
        let place = (frame.x[0], frame.y[0] - 10.0 - (lines.len() - line) as f64 * SPACING);
        canvas.text(text, place, Anchor::BelowRight, TEXT)?;
    }
    Ok(())
}

/// The first, the last and of the places between them those that are not too near to each other.
fn apart(places: &[Place]) -> Vec<Place> {
    let mut kept: Vec<Place> = Vec::new();
    for place in places {
        if kept.last().is_none_or(|last| (place.0 - last.0).hypot(place.1 - last.1) >= STEP) {
            kept.push(*place);
        }
    }
    kept.extend(places.last());
    kept
}

/// Heights between two material ratios, as far as they are not far out, m above the mean.
fn central_heights(description: &Description, [low, high]: [f64; 2]) -> [f64; 2] {
    let curve = &description.material_curve;
    let at = |ratio: f64| {
        let class = (ratio * curve.len().saturating_sub(1) as f64).round() as usize;
        curve.get(class).copied().unwrap_or(0.0)
    };
    let quartiles = [at(0.75), at(0.25)];
    let fence = FENCE * (quartiles[1] - quartiles[0]);
    // More than half of the heights may be equal.
    if fence > 0.0 {
        [at(high).max(quartiles[0] - fence), at(low).min(quartiles[1] + fence)]
    } else {
        [at(high), at(low)]
    }
}

/// Heights that histogram and curve show: nearly all, with the ends of the core, and a margin, m above the mean.
fn height_range(description: &Description) -> RangeInclusive<f64> {
    let [low, high] = central_heights(description, [0.001, 0.999]);
    let CoreHeight { upper, lower, .. } = description.core;
    let (low, high) = (low.min(lower), high.max(upper));
    let margin = (0.06 * (high - low)).max(1e-10);
    low - margin..=high + margin
}

/// Heights that the colour map spans, m above the mean.
fn colour_range(description: &Description) -> RangeInclusive<f64> {
    let [low, high] = central_heights(description, [0.005, 0.995]);
    if high > low { low..=high } else { low - 1e-10..=high + 1e-10 }
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
    crate::number::with_minus(&crate::number::significant(value, 3))
}

fn percent(fraction: f64) -> String {
    if fraction.is_nan() { "\u{2013}".to_owned() } else { crate::number::significant(100.0 * fraction, 3) }
}
