//! Map, histogram and Abbott-Firestone curve of surfaces on one page.

use std::ops::RangeInclusive;

use plateau_core::surface::describe::{CoreHeight, Description, Grid};

use super::axes::{Axes, Axis, Frame};
use super::canvas::{Anchor, LINE, TEXT, TITLE};
use super::colour_bar::ColourBar;
use super::font::{shortened, text_width};
use super::format::Figure;
use super::histogram::Histogram;
use super::page::{Content, Key, KeyStyle, Page, Panel};
use super::raster::Raster;
use super::stroke::{SOLID, Stroke};
use crate::colour::{DATA, DATA_AREA, DERIVED, DERIVED_AREA, FAINT, MISSING};
use crate::quantity::Unit;
use plateau_io::number::{significant, with_minus};

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
/// Room below the charts for what is drawn about the curve, in two lines.
const LEGEND: f64 = 2.0 * SPACING + 20.0;
/// Width of the sample of a colour, pixels.
const KEY: f64 = 60.0;
/// Room for the lines of text above a chart, and their distance.
const CAPTION: f64 = 3.0 * SPACING + 10.0;
const SPACING: f64 = 1.25 * TEXT as f64;
/// A map that is longer than this many times its width is stretched, or nothing could be seen on it.
const MOST_ELONGATED: f64 = 5.0;
/// Heights farther than this many times the interquartile range outside the quartiles do not widen axes and colours.
const FENCE: f64 = 5.0;
/// Classes of the histogram.
const CLASSES: usize = 64;

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
pub struct DescribedSurface<'a> {
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

/// The figure of surfaces, beside and below each other.
pub fn figure(surfaces: &[DescribedSurface]) -> Figure {
    let across = match surfaces.len() {
        0 | 1 => 1,
        2..=4 => 2,
        _ => 3,
    };
    let down = surfaces.len().div_ceil(across).max(1);
    let remarks = if surfaces.iter().any(DescribedSurface::has_remarks) { REMARKS } else { 0.0 };
    let largest = surfaces.iter().map(|surface| surface.map_size()[1]).fold(0.0, f64::max);
    let room = Room { head: HEAD + remarks, map: largest };
    let height = room.head + room.map + FOOT + CAPTION + CHART + FOOT + LEGEND;
    let size = [WIDTH * across as f64, (height * down as f64).floor()];
    let mut page = Page { size, ..Page::default() };
    for (index, surface) in surfaces.iter().enumerate() {
        let origin = [(index % across) as f64 * WIDTH, (index / across) as f64 * height];
        surface.place(&mut page, origin, room);
    }
    Figure {
        name: "surfaces".to_owned(),
        title: "Surfaces".to_owned(),
        caption: "Map of the heights, their distribution and the Abbott-Firestone curve.".to_owned(),
        page,
    }
}

impl DescribedSurface<'_> {
    /// Puts the surface on the page with its upper left corner there.
    fn place(&self, page: &mut Page, [x, y]: [f64; 2], room: Room) {
        self.write_title(page, [x + LEFT, y]);
        let ([left, _], [width, height]) = (MAP.0, self.map_size());
        let top = y + room.head;
        self.add_map(page, Frame { x: [x + left, x + left + width], y: [top, top + height] });
        let top = top + room.map + FOOT + CAPTION;
        let chart = |ends: [f64; 2]| Frame { x: ends.map(|end| x + end), y: [top, top + CHART] };
        let unit = self.height_unit();
        let range = scaled(&self.drawn.histogram.range, &unit);
        self.add_histogram(page, chart(HISTOGRAM), &range, &unit);
        self.add_curve(page, chart(CURVE), &range, &unit);
        if self.description.core.peak_ratio.is_finite() {
            write_legend(page, [x + LEFT, top + CHART + FOOT]);
        }
    }

    /// The name, and what is to know of the map.
    fn write_title(&self, page: &mut Page, [x, y]: [f64; 2]) {
        let title = shortened(&self.title, TITLE, WIDTH - LEFT - 40.0);
        page.write(title, (x, y + 30.0), Anchor::BelowRight, TITLE);
        let (middle, mut begin) = (y + 106.0, x);
        let missing = 1.0 - self.description.measured as f64 / (self.points[0] * self.points[1]) as f64;
        if missing > 0.0 {
            let frame = Frame { x: [begin, begin + 34.0], y: [middle - 13.0, middle + 13.0] };
            page.keys.push(Key { frame, colour: MISSING, style: KeyStyle::Area });
            let text = format!("no height: {} %", percent(missing));
            let width = text_width(&text, TEXT);
            page.write(text, (frame.x[1] + 12.0, middle), Anchor::Right, TEXT);
            begin = frame.x[1] + 12.0 + width + 40.0;
        }
        for (axis, stretched) in ["x", "y"].into_iter().zip(self.stretch()) {
            if stretched > 1.0 {
                let text = format!("{axis} stretched {} times", number(stretched));
                page.write(text, (begin, middle), Anchor::Right, TEXT);
            }
        }
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

    fn add_map(&self, page: &mut Page, frame: Frame) {
        let extent = self.extent();
        let axis = |extent: f64, name: &str| {
            let unit = if self.pitch.is_some() { Unit::for_size("m", extent) } else { Unit::POINTS };
            Axis::linear(0.0..=unit.value(extent), unit.label(name))
        };
        let colours = colour_range(self.description);
        let picture = self.drawn.map.picture(&colours);
        let axes = Axes { frame, x: axis(extent[0], "x"), y: axis(extent[1], "y") };
        page.panels.push(Panel { axes, contents: vec![Content::Map(picture)] });
        let unit = self.height_unit();
        // Points at its ends and room for them.
        let bar = Frame { x: [frame.x[1] + 40.0, frame.x[1] + 80.0], y: [frame.y[0] + 28.0, frame.y[1] - 28.0] };
        page.colour_bars.push(ColourBar::new(bar, height_axis(scaled(&colours, &unit), &unit)));
    }

    fn add_histogram(&self, page: &mut Page, frame: Frame, range: &RangeInclusive<f64>, unit: &Unit) {
        let fractions = &self.drawn.histogram.fractions;
        let largest = fractions.iter().copied().fold(0.0, f64::max).max(1e-6);
        let x = Axis::linear(0.0..=105.0 * largest, "points per class, %");
        let class = (range.end() - range.start()) / fractions.len() as f64;
        let ends = |number: usize| [0, 1].map(|end| range.start() + (number + end) as f64 * class);
        let bar = |(number, fraction): (usize, &f64)| {
            let [low, high] = ends(number);
            let spans = [0.0, 100.0 * fraction].map(|x| [x, low, high]).to_vec();
            Content::Band { spans, colour: DATA_AREA, opacity: 1.0 }
        };
        let filled = fractions.iter().enumerate().filter(|(_, fraction)| **fraction > 0.0);
        let mut contents: Vec<Content> = filled.map(bar).collect();
        let steps = fractions.iter().enumerate();
        let points = steps.flat_map(|(number, fraction)| ends(number).map(|y| [100.0 * fraction, y])).collect();
        contents.push(Content::Line { points, stroke: Stroke::solid(DATA, LINE) });
        page.panels.push(Panel { axes: Axes { frame, x, y: height_axis(range.clone(), unit) }, contents });
        let (heights, outside) = (&self.description.heights, self.drawn.histogram.outside);
        let mut lines = vec![
            format!("Sq {}", height_text(heights.root_mean_square_height, unit)),
            format!("Ssk {}   Sku {}", number(heights.skewness), number(heights.kurtosis)),
        ];
        if outside > 0.0 {
            lines.push(format!("beyond the axis: {} %", percent(outside)));
        }
        write_above(page, &frame, lines);
    }

    fn add_curve(&self, page: &mut Page, frame: Frame, range: &RangeInclusive<f64>, unit: &Unit) {
        let y = Axis::linear(range.clone(), "").shared();
        let axes = Axes { frame, x: Axis::linear(0.0..=100.0, "material ratio, %"), y };
        let CoreHeight { core_height, reduced_peak_height, reduced_dale_depth, peak_ratio, dale_ratio, upper, lower } =
            self.description.core;
        let line = |points, colour, width| Content::Line { points, stroke: Stroke::solid(colour, width) };
        let mut contents = Vec::new();
        if peak_ratio.is_finite() {
            let span = |ratio: f64, ends: [f64; 2]| [100.0 * ratio, unit.value(ends[0]), unit.value(ends[1])];
            let peaks = vec![span(0.0, [upper, upper + reduced_peak_height]), span(peak_ratio, [upper; 2])];
            let dales = vec![span(dale_ratio, [lower; 2]), span(1.0, [lower - reduced_dale_depth, lower])];
            let triangle = |spans| Content::Band { spans, colour: DERIVED_AREA, opacity: 1.0 };
            contents.extend([triangle(peaks), triangle(dales)]);
            let [upper, lower] = [upper, lower].map(|height| unit.value(height));
            contents.extend([upper, lower].map(|height| line(vec![[0.0, height], [100.0, height]], FAINT, 2)));
            contents.push(line(vec![[0.0, upper], [100.0, lower]], DERIVED, LINE));
        }
        let curve = &self.description.material_curve;
        let last = curve.len().saturating_sub(1).max(1) as f64;
        let point = |(class, height): (usize, &f64)| [100.0 * class as f64 / last, unit.value(*height)];
        contents.push(line(curve.iter().enumerate().map(point).collect(), DATA, LINE + 2));
        page.panels.push(Panel { axes, contents });
        let [core, peak, dale] =
            [core_height, reduced_peak_height, reduced_dale_depth].map(|height| height_text(height, unit));
        let lines = vec![
            format!("Sk {core}"),
            format!("Spk {peak}   Svk {dale}"),
            format!("Smr1 {} %   Smr2 {} %", percent(peak_ratio), percent(dale_ratio)),
        ];
        write_above(page, &frame, lines);
    }

    /// The unit of heights.
    fn height_unit(&self) -> Unit {
        let range = &self.drawn.histogram.range;
        Unit::for_size("m", 0.5 * (range.end() - range.start()))
    }
}

fn height_axis(range: RangeInclusive<f64>, unit: &Unit) -> Axis {
    Axis::linear(range, unit.label("height"))
}

fn height_text(height: f64, unit: &Unit) -> String {
    unit.with_symbol(&number(unit.value(height)))
}

/// Lines of text above a box.
fn write_above(page: &mut Page, frame: &Frame, lines: Vec<String>) {
    let count = lines.len();
    for (line, text) in lines.into_iter().enumerate() {
        let place = (frame.x[0], frame.y[0] - 10.0 - (count - line) as f64 * SPACING);
        page.write(text, place, Anchor::BelowRight, TEXT);
    }
}

/// Writes what is drawn about the curve, from the upper left corner on.
fn write_legend(page: &mut Page, [x, y]: [f64; 2]) {
    let line = KeyStyle::Line(SOLID);
    let meanings = [
        (DERIVED, line, "line along the flattest 40 % of the curve", 0),
        (FAINT, line, "its ends, Sk apart", 0),
        (DERIVED_AREA, KeyStyle::Area, "triangles as large as peaks and dales, Spk and Svk high", 1),
    ];
    let mut begins = [x; 2];
    for (colour, style, text, row) in meanings {
        let (begin, middle) = (&mut begins[row], y + (row as f64 + 0.5) * SPACING);
        let frame = Frame { x: [*begin, *begin + KEY], y: [middle - 13.0, middle + 13.0] };
        page.keys.push(Key { frame, colour, style });
        page.write(text, (frame.x[1] + 12.0, middle), Anchor::Right, TEXT);
        *begin = frame.x[1] + 12.0 + text_width(text, TEXT) + 36.0;
    }
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

fn scaled(range: &RangeInclusive<f64>, unit: &Unit) -> RangeInclusive<f64> {
    unit.value(*range.start())..=unit.value(*range.end())
}

/// Three significant digits, with a minus sign.
fn number(value: f64) -> String {
    if value.is_nan() {
        return "\u{2013}".to_owned();
    }
    with_minus(&significant(if value.abs() < 1e-3 { 0.0 } else { value }, 3))
}

fn percent(fraction: f64) -> String {
    if fraction.is_nan() { "\u{2013}".to_owned() } else { significant(100.0 * fraction, 3) }
}
