//! Map, histogram and Abbott-Firestone curve of surfaces on one page.

use std::ops::RangeInclusive;

use plateau_core::surface::describe::{CoreHeight, Description, Grid};

use super::axes::Frame;
use super::canvas::{Anchor, TEXT, TITLE};
use super::chart::{TWO_COLUMNS, legend};
use super::font::{shortened, text_width};
use super::format::Figure;
use super::histogram::Histogram;
use super::page::{Key, KeyStyle, Page};
use super::pages::in_pages;
use super::raster::Raster;
use super::surface_charts::{CAPTION, SurfaceCharts, meanings, number, percent};
use super::surface_map::{LEFT, SurfaceMap};
use crate::colour::MISSING;
use crate::quantity::Unit;

/// Room for the axis of a chart, from the longest colour bar to the histogram; from there to the curve beside it, which shares that axis; and to the
/// end of the page, pixels.
const BEFORE_CHARTS: f64 = 150.0;
const BETWEEN_CHARTS: f64 = 60.0;
const END: f64 = TWO_COLUMNS - 50.0;
/// Distance of the title from the words of charts.
const BEFORE_WORDS: f64 = 40.0;
/// The part of the room for charts that the histogram has.
const HISTOGRAM: f64 = 0.46;
/// Their height.
const CHART: f64 = 360.0;
/// Where the words of charts begin, beside the title; room for the title, for the line of remarks above the map, and for the numbers and the label of an axis below a box.
const ABOVE_CHARTS: f64 = 20.0;
const HEAD: f64 = 70.0;
const REMARKS: f64 = 50.0;
const FOOT: f64 = 106.0;
/// Heights farther than this many times the interquartile range outside the quartiles do not widen axes and colours.
const FENCE: f64 = 5.0;
/// Classes of the histogram.
const CLASSES: usize = 64;

/// What axes and colours span: the same for surfaces that are compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranges {
    /// Heights that histogram and curve show, m above the mean.
    heights: RangeInclusive<f64>,
    /// Heights that the colour map spans, m above the mean.
    colours: RangeInclusive<f64>,
}

impl Ranges {
    /// Those of a surface.
    pub fn of(description: &Description) -> Self {
        Self { heights: height_range(description), colours: colour_range(description) }
    }

    /// Those of two surfaces together.
    pub fn with(self, other: Self) -> Self {
        let both = |one: RangeInclusive<f64>, other: RangeInclusive<f64>| {
            one.start().min(*other.start())..=one.end().max(*other.end())
        };
        Self { heights: both(self.heights, other.heights), colours: both(self.colours, other.colours) }
    }
}

/// What a picture shows of the heights themselves.
#[derive(Debug, Clone)]
pub struct Drawn {
    map: Raster,
    histogram: Histogram,
    colours: RangeInclusive<f64>,
}

impl Drawn {
    /// Takes from the heights what is drawn of them within these ranges.
    pub fn of(grid: &Grid, description: &Description, ranges: &Ranges) -> Self {
        let mean = description.heights.mean;
        let histogram = Histogram::of(grid.heights, mean, ranges.heights.clone(), CLASSES);
        Self { map: Raster::of(grid, mean), histogram, colours: ranges.colours.clone() }
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

/// The figure of surfaces below each other: of each map and charts, beside each other. Four of them fit into the page of a journal.
pub fn figures(surfaces: &[DescribedSurface]) -> Vec<Figure> {
    let right = |surface: &DescribedSurface| surface.map().right(&surface.drawn.colours, &surface.height_unit());
    let charts_begin = (surfaces.iter().map(right).fold(0.0, f64::max) + BEFORE_CHARTS).ceil();
    let has_core = surfaces.iter().any(|surface| surface.description.core.peak_ratio.is_finite());
    let meanings = if has_core { meanings() } else { Vec::new() };
    let pages = in_pages(surfaces.len(), |some| {
        let mut page = Page { size: [TWO_COLUMNS, 0.0], ..Page::default() };
        let top = surfaces[some].iter().fold(0.0, |top, surface| surface.place(&mut page, top, charts_begin));
        page.size[1] = legend(&mut page, &meanings, top).ceil();
        page
    });
    Figure::of_pages(
        "surfaces",
        "Surfaces",
        "Map of the heights, their distribution and the Abbott-Firestone curve.",
        pages,
    )
}

impl DescribedSurface<'_> {
    /// Puts the surface on the page, this far from its top, with its charts from there on; gives the place below.
    fn place(&self, page: &mut Page, y: f64, charts_begin: f64) -> f64 {
        self.write_title(page, y, charts_begin);
        let top = y + HEAD + if self.has_remarks() { REMARKS } else { 0.0 };
        let bottom = self.map().place(page, top, &self.drawn.colours, &self.height_unit());
        let first = y + ABOVE_CHARTS + CAPTION;
        let width = HISTOGRAM * (END - charts_begin - BETWEEN_CHARTS);
        let chart = |begin: f64, end: f64| Frame { x: [begin, end], y: [first, first + CHART] };
        let unit = self.height_unit();
        let charts = SurfaceCharts { histogram: &self.drawn.histogram, description: self.description, unit: &unit };
        charts.add_histogram(page, chart(charts_begin, charts_begin + width));
        charts.add_curve(page, chart(charts_begin + width + BETWEEN_CHARTS, END));
        bottom.max(first + CHART) + FOOT
    }

    /// Its map.
    fn map(&self) -> SurfaceMap<'_> {
        let pitch = self.pitch.unwrap_or([1.0; 2]);
        let extent = [0, 1].map(|axis| self.points[axis] as f64 * pitch[axis]);
        SurfaceMap { raster: &self.drawn.map, extent, has_lengths: self.pitch.is_some() }
    }

    /// The name, and what is to know of the map.
    fn write_title(&self, page: &mut Page, y: f64, end: f64) {
        let title = shortened(&self.title, TITLE, end - BEFORE_WORDS - LEFT);
        page.write(title, (LEFT, y + 20.0), Anchor::BelowRight, TITLE);
        let (middle, mut begin) = (y + 90.0, LEFT);
        let missing = 1.0 - self.description.measured as f64 / (self.points[0] * self.points[1]) as f64;
        if missing > 0.0 {
            let frame = Frame { x: [begin, begin + 34.0], y: [middle - 13.0, middle + 13.0] };
            page.keys.push(Key { frame, colour: MISSING, style: KeyStyle::Area });
            let text = format!("no height: {} %", percent(missing));
            let width = text_width(&text, TEXT);
            page.write(text, (frame.x[1] + 12.0, middle), Anchor::Right, TEXT);
            begin = frame.x[1] + 12.0 + width + 40.0;
        }
        for (axis, stretched) in ["x", "y"].into_iter().zip(self.map().stretch()) {
            if stretched > 1.0 {
                let text = format!("{axis} stretched {} times", number(stretched));
                page.write(text, (begin, middle), Anchor::Right, TEXT);
            }
        }
    }

    /// Whether there is anything to know of the map.
    fn has_remarks(&self) -> bool {
        self.description.measured < self.points[0] * self.points[1]
            || self.map().stretch().iter().any(|times| *times > 1.0)
    }

    /// The unit of heights.
    fn height_unit(&self) -> Unit {
        let range = &self.drawn.histogram.range;
        Unit::for_size("m", 0.5 * (range.end() - range.start()))
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
