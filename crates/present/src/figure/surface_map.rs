//! The map of a surface on its page: in proportion, one that is long in windows below each other.

use std::ops::RangeInclusive;

use super::axes::{Axes, Axis, Frame};
use super::canvas::{Anchor, TEXT};
use super::chart::MARGIN;
use super::colour_bar::ColourBar;
use super::font::text_width;
use super::page::{Content, Page, Panel};
use super::raster::{Raster, windows};
use super::surface_charts::{height_axis, scaled};
use crate::quantity::Unit;

/// Left end of maps, with room for the numbers and the label of an axis, and what they are as large as, pixels.
pub const LEFT: f64 = 150.0;
const MAP: [f64; 2] = [600.0, 430.0];
/// Height of a window, at least.
const LEAST_HEIGHT: f64 = 26.0;
/// Distance of the windows of one map below each other, with the numbers of an axis.
const BELOW: f64 = 68.0;
/// A map that is longer upward than this many times its width is stretched, or nothing could be seen on it.
const MOST_UPRIGHT: f64 = 5.0;
/// Distance of the colour bar, its width, and its length at least: it has three numbers.
const BESIDE: f64 = 40.0;
const BAR: f64 = 40.0;
const SHORTEST_BAR: f64 = 200.0;

/// A map of heights and the size of what it shows.
pub struct SurfaceMap<'a> {
    /// The heights.
    pub raster: &'a Raster,
    /// Extent along x and y, m, or points where the distance of these is not known.
    pub extent: [f64; 2],
    /// Whether the extent is in m.
    pub has_lengths: bool,
}

impl SurfaceMap<'_> {
    /// How many times larger than in proportion the map is along x and y, if more than once.
    pub fn stretch(&self) -> [f64; 2] {
        let ([x, y], longest) = (self.window(), MAP[0] / LEAST_HEIGHT);
        [y / x / MOST_UPRIGHT, x / y / longest]
    }

    /// Right end of the map with its colour bar, pixels.
    pub fn right(&self, colours: &RangeInclusive<f64>, unit: &Unit) -> f64 {
        let axis = height_axis(scaled(colours, unit), unit);
        let widest = axis.ticks(5).iter().map(|(_, label)| text_width(label, TEXT)).fold(0.0, f64::max);
        LEFT + self.box_size()[0] + BESIDE + BAR + 30.0 + widest + f64::from(TEXT)
    }

    /// Puts the map on the page, this far from its top; gives the place below its last box.
    pub fn place(&self, page: &mut Page, top: f64, colours: &RangeInclusive<f64>, unit: &Unit) -> f64 {
        let ([width, height], count) = (self.box_size(), self.count());
        let mut bottom = top;
        for window in 0..count {
            let begin = top + window as f64 * (height + BELOW);
            bottom = begin + height;
            let columns = self.raster.window(window, count);
            let part = |column: usize| column as f64 / self.raster.columns() as f64 * self.extent[0];
            let (name, y_name) = (if window + 1 == count { "x" } else { "" }, if count == 1 { "y" } else { "" });
            let mut y = self.axis(0.0..=self.extent[1], self.extent[1], y_name);
            if height < f64::from(TEXT) {
                // Two numbers would touch.
                y.marks = Some(vec![(0.0, String::new()), y.ticks(2).pop().unwrap_or_default()]);
            }
            let axes = Axes {
                frame: Frame { x: [LEFT, LEFT + width], y: [begin, bottom] },
                x: self.axis(part(columns.start)..=part(columns.end), self.extent[0], name),
                y,
            };
            let picture = self.raster.picture(colours, columns, [width as usize, height as usize]);
            page.panels.push(Panel { axes, contents: vec![Content::Map(picture)] });
        }
        if count > 1 {
            let middle = (MARGIN + 1.1 * f64::from(TEXT), 0.5 * (top + bottom));
            page.write(self.unit(self.extent[1]).label("y"), middle, Anchor::Upward, TEXT);
        }
        // Points at its ends and room for them. Beside a low map there is room below.
        let (first, last) = (top + 28.0, (top + MAP[1] - 28.0).min(bottom - 28.0));
        let end = last.max(first + SHORTEST_BAR);
        let left = LEFT + width + BESIDE;
        let bar = Frame { x: [left, left + BAR], y: [first, end] };
        page.colour_bars.push(ColourBar::new(bar, height_axis(scaled(colours, unit), unit)));
        bottom
    }

    fn count(&self) -> usize {
        windows(self.extent[0] / self.extent[1]).min(self.raster.columns().max(1))
    }

    /// Extent of a window along x and y.
    fn window(&self) -> [f64; 2] {
        [self.extent[0] / self.count() as f64, self.extent[1]]
    }

    /// Width and height of a window, pixels.
    fn box_size(&self) -> [f64; 2] {
        let [x, y] = self.window();
        let proportion = (x / y).clamp(1.0 / MOST_UPRIGHT, MAP[0] / LEAST_HEIGHT);
        let width = MAP[0].min(MAP[1] * proportion).floor();
        [width, (width / proportion).floor()]
    }

    fn unit(&self, extent: f64) -> Unit {
        if self.has_lengths { Unit::for_size("m", extent) } else { Unit::POINTS }
    }

    /// An axis from where to where in the unit of an extent; without a name it has no label.
    fn axis(&self, range: RangeInclusive<f64>, extent: f64, name: &str) -> Axis {
        let unit = self.unit(extent);
        let label = if name.is_empty() { String::new() } else { unit.label(name) };
        Axis::linear(scaled(&range, &unit), label)
    }
}

#[cfg(test)]
mod tests {
    use plateau_core::surface::describe::Grid;

    use super::*;

    #[test]
    fn a_ring_is_shown_in_windows_in_proportion() {
        // The ring of `quick.toml`: 690 by 8 cells on 129 mm by 1 mm; the paper's is 138.2 mm by 4 mm.
        for (columns, rows, extent, expected) in [
            (690, 8, [0.129, 1e-3], 6),
            (2764, 80, [0.1382, 4e-3], 4),
            (42, 8, [7.45e-3, 1e-3], 1),
            (80, 80, [4e-3, 4e-3], 1),
        ] {
            let heights: Vec<f64> = (0..columns * rows).map(|point| (point % 7) as f64 * 1e-6).collect();
            let pitch = Some([extent[0] / columns as f64, extent[1] / rows as f64]);
            let raster = Raster::of(&Grid { columns, rows, pitch, heights: &heights }, 0.0);
            let map = SurfaceMap { raster: &raster, extent, has_lengths: true };
            let mut page = Page::default();
            let bottom = map.place(&mut page, 100.0, &(0.0..=6e-6), &Unit::MICROMETRE);
            assert_eq!(page.panels.len(), expected);
            // One after the other they hold the whole length, each as many pixels along x as along y for a length.
            let mut end = 0.0;
            for Panel { axes: Axes { frame, x, y }, .. } in &page.panels {
                assert!((x.range.start() - end).abs() < 1e-9, "{:?}", x.range);
                end = *x.range.end();
                let scale =
                    [frame.width() / (end - x.range.start()), frame.height() / (y.range.end() - y.range.start())];
                assert!((scale[0] / scale[1] - 1.0).abs() < 0.04, "{scale:?}");
            }
            assert!((end - 1e3 * extent[0]).abs() < 1e-9 && bottom <= 800.0, "{end} {bottom}");
            assert!(map.stretch().iter().all(|times| *times <= 1.0));
        }
    }
}
