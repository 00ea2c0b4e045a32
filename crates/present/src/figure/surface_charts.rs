//! The charts of a surface beside its map: how its heights are distributed, and the Abbott-Firestone curve.

use std::ops::RangeInclusive;

use plateau_core::surface::describe::{CoreHeight, Description};

use super::axes::{Axes, Axis, Frame};
use super::canvas::{Anchor, LINE, TEXT};
use super::chart::Meaning;
use super::histogram::Histogram;
use super::page::{Content, KeyStyle, Page, Panel};
use super::stroke::Stroke;
use crate::colour::{DATA, DATA_AREA, DERIVED, DERIVED_AREA, FAINT};
use crate::quantity::Unit;
use plateau_io::number::{significant, with_minus};

/// Distance of the lines of text above a chart, pixels, and the room that they take.
const SPACING: f64 = 1.25 * TEXT as f64;
pub const CAPTION: f64 = 3.0 * SPACING + 10.0;

/// What the charts of a surface show.
pub struct SurfaceCharts<'a> {
    /// How its heights are distributed.
    pub histogram: &'a Histogram,
    /// Its parameters.
    pub description: &'a Description,
    /// In which its heights are drawn.
    pub unit: &'a Unit,
}

impl SurfaceCharts<'_> {
    /// Adds the distribution of the heights with its words.
    pub fn add_histogram(&self, page: &mut Page, frame: Frame) {
        let (unit, range) = (self.unit, scaled(&self.histogram.range, self.unit));
        let fractions = &self.histogram.fractions;
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
        page.panels.push(Panel { axes: Axes { frame, x, y: height_axis(range, unit) }, contents });
        let (heights, outside) = (&self.description.heights, self.histogram.outside);
        // Spikes are beyond the axis, and single points of the map: the farthest one tells how far they go.
        let (peak, pit) = (heights.maximum_peak_height, heights.maximum_pit_depth);
        let farthest = if peak >= pit { ("Sp", peak) } else { ("Sv", pit) };
        let mut lines = vec![
            format!("Sq {}   Ssk {}", height_text(heights.root_mean_square_height, unit), number(heights.skewness)),
            format!("Sku {}   {} {}", number(heights.kurtosis), farthest.0, height_text(farthest.1, unit)),
        ];
        if outside > 0.0 {
            lines.push(format!("beyond axis: {} %", percent(outside)));
        }
        write_above(page, &frame, lines);
    }

    /// Adds the Abbott-Firestone curve with its words.
    pub fn add_curve(&self, page: &mut Page, frame: Frame) {
        let unit = self.unit;
        let y = Axis::linear(scaled(&self.histogram.range, unit), "").shared();
        let axes = Axes { frame, x: Axis::linear(0.0..=100.0, "material ratio, %"), y };
        let CoreHeight { core_height, reduced_peak_height, reduced_dale_depth, peak_ratio, dale_ratio, upper, lower } =
            self.description.core;
        let line = |points, colour, width| Content::Line { points, stroke: Stroke::solid(colour, width) };
        let mut contents = Vec::new();
        if peak_ratio.is_finite() {
            let span = |ratio: f64, ends: [f64; 2]| [100.0 * ratio, unit.value(ends[0]), unit.value(ends[1])];
            // What reaches beyond the axis is cut off there.
            let [least, most] = [*self.histogram.range.start(), *self.histogram.range.end()];
            let cut = |height: f64, room: f64| if height > room { room / height } else { 1.0 };
            let part = cut(reduced_peak_height, most - upper);
            let peaks = vec![
                span(0.0, [upper, upper + part * reduced_peak_height]),
                span((1.0 - part) * peak_ratio, [upper, upper + part * reduced_peak_height]),
                span(peak_ratio, [upper; 2]),
            ];
            let part = cut(reduced_dale_depth, lower - least);
            let dales = vec![
                span(dale_ratio, [lower; 2]),
                span(dale_ratio + part * (1.0 - dale_ratio), [lower - part * reduced_dale_depth, lower]),
                span(1.0, [lower - part * reduced_dale_depth, lower]),
            ];
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
}

/// What is drawn about the curves.
pub fn meanings() -> Vec<Meaning> {
    let line = |colour, text: &str| Meaning::of_line(Stroke::solid(colour, LINE), text);
    let triangles = "peaks and valleys beyond the core: Spk and Svk are the heights of the triangles".to_owned();
    vec![
        line(DERIVED, "line through the flattest 40 % of the curve"),
        line(FAINT, "upper and lower end of the core: Sk is the distance between them"),
        Meaning { colour: DERIVED_AREA, style: KeyStyle::Area, text: triangles },
    ]
}

/// The axis of heights.
pub fn height_axis(range: RangeInclusive<f64>, unit: &Unit) -> Axis {
    Axis::linear(range, unit.label("height"))
}

/// A range of heights in the unit in which they are drawn.
pub fn scaled(range: &RangeInclusive<f64>, unit: &Unit) -> RangeInclusive<f64> {
    unit.value(*range.start())..=unit.value(*range.end())
}

/// A height in the unit that suits it, for the one of the axes may suit a rougher surface; nothing in that of the axes.
fn height_text(height: f64, of_axes: &Unit) -> String {
    let unit = if height.abs() < 1e-12 { of_axes.clone() } else { Unit::for_size("m", height.abs()) };
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

/// Three significant digits, with a minus sign.
pub fn number(value: f64) -> String {
    if value.is_nan() {
        return "\u{2013}".to_owned();
    }
    with_minus(&significant(if value.abs() < 1e-3 { 0.0 } else { value }, 3))
}

/// A part in per cent, of three significant digits.
pub fn percent(fraction: f64) -> String {
    if fraction.is_nan() { "\u{2013}".to_owned() } else { significant(100.0 * fraction, 3) }
}
