//! How the cells of a body are laid out on paper: unrolled, in windows below each other, as the ring is, or as a round pin is.

use std::f64::consts::TAU;
use std::ops::{Range, RangeInclusive};

use plateau_core::model::mesh::Mesh;
use plotters::style::RGBColor;

use crate::figure::picture::Picture;

/// Length of a window of an unrolled ring over its height, about.
const ELONGATION: f64 = 8.6;
/// Windows that an unrolled ring is broken into, at most.
const MOST_WINDOWS: usize = 6;
const MILLIMETRES: f64 = 1e3;
/// Ways to say what the axis below measures.
pub const X_LABELS: usize = 3;

/// How a body is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// Arc length at the mean radius against radius.
    Unrolled,
    /// From above; column 0 on the right, columns counted to the left round the middle.
    Polar,
    /// Arc length at the radius of each row, from the middle of the pin, against radius: a round pin is round.
    Arcs,
}

/// A part of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Window {
    /// Its columns.
    pub columns: Range<usize>,
    /// Its extent along x, mm.
    pub x: RangeInclusive<f64>,
}

impl Shape {
    /// How the pin is shown.
    pub fn of_pin(mesh: &Mesh) -> Self {
        if mesh.is_rectangle() { Self::Unrolled } else { Self::Arcs }
    }

    /// What the axis below measures, and where the disc moves, toward higher columns (model 1), in words that are the fewer the higher their
    /// number is.
    pub fn x_label(self, words: usize) -> &'static str {
        let labels: [_; X_LABELS] = match self {
            Self::Unrolled => [
                "arc length at the mean radius, mm; the disc moves \u{2192}",
                "arc length, mm; the disc moves \u{2192}",
                "arc length, mm",
            ],
            Self::Polar => ["x, mm; the disc turns against the clock", "x, mm; turns against the clock", "x, mm"],
            Self::Arcs => [
                "arc length from the middle, mm; the disc moves \u{2192}",
                "arc length, mm; the disc moves \u{2192}",
                "arc length from the middle, mm",
            ],
        };
        labels[words.min(X_LABELS - 1)]
    }

    /// What the axis to the left measures.
    pub fn y_label(self) -> &'static str {
        match self {
            Self::Unrolled | Self::Arcs => "radius, mm",
            Self::Polar => "y, mm",
        }
    }

    /// Extent of the body along y, mm.
    pub fn y_range(self, mesh: &Mesh) -> RangeInclusive<f64> {
        let [inner, outer] = radii(mesh).map(|radius| radius * MILLIMETRES);
        match self {
            Self::Unrolled | Self::Arcs => inner..=outer,
            Self::Polar => -outer..=outer,
        }
    }

    /// The windows in which a body of so many columns is shown; those of an unrolled one are `stretch` times as long over their
    /// height as they mostly are, and so much fewer.
    pub fn windows(self, mesh: &Mesh, columns: usize, stretch: f64) -> Vec<Window> {
        let width = mesh.column_width() * MILLIMETRES;
        match self {
            Self::Polar => return vec![Window { columns: 0..columns, x: self.y_range(mesh) }],
            Self::Arcs => {
                let half = 0.5 * columns as f64 * width;
                return vec![Window { columns: 0..columns, x: -half..=half }];
            }
            Self::Unrolled => {}
        }
        let [inner, outer] = radii(mesh).map(|radius| radius * MILLIMETRES);
        let elongation = columns as f64 * width / (outer - inner);
        let count = ((elongation / (ELONGATION * stretch)).round() as usize).clamp(1, MOST_WINDOWS).min(columns);
        let begin = |window: usize| window * columns / count;
        let window =
            |columns: Range<usize>| Window { x: columns.start as f64 * width..=columns.end as f64 * width, columns };
        (0..count).map(|number| window(begin(number)..begin(number + 1))).collect()
    }

    /// The cells of a window, as many points as there are to see on so many pixels; `cells` has the number of the colour
    /// of every cell, and the last colour is that of what is no cell.
    pub fn picture(
        self,
        mesh: &Mesh,
        window: &Window,
        cells: &[u8],
        palette: &[RGBColor],
        [width, height]: [usize; 2],
    ) -> Picture {
        let (columns, rows) = match self {
            Self::Unrolled => (window.columns.len().min(width), mesh.rows().min(height)),
            Self::Polar | Self::Arcs => (width, height),
        };
        let ground = (palette.len() - 1) as u8;
        let mut indices = Vec::with_capacity(columns * rows);
        for line in 0..rows {
            for point in 0..columns {
                // From 0 to 1, of the middle of the point; y grows upward.
                let x = (point as f64 + 0.5) / columns as f64;
                let y = 1.0 - (line as f64 + 0.5) / rows as f64;
                let cell = match self {
                    Self::Unrolled => {
                        let column = window.columns.start + (x * window.columns.len() as f64) as usize;
                        Some(column * mesh.rows() + (y * mesh.rows() as f64) as usize)
                    }
                    Self::Polar => polar_cell(mesh, x, y),
                    Self::Arcs => arc_cell(mesh, window.columns.len(), x, y),
                };
                indices.push(cell.and_then(|cell| cells.get(cell)).copied().unwrap_or(ground));
            }
        }
        Picture { columns, rows, indices, palette: palette.to_vec() }
    }
}

/// The disc cell at a place of the square round the ring, from 0 to 1 along its sides.
fn polar_cell(mesh: &Mesh, x: f64, y: f64) -> Option<usize> {
    let [inner, outer] = radii(mesh);
    let (x, y) = ((2.0 * x - 1.0) * outer, (2.0 * y - 1.0) * outer);
    let row = (x.hypot(y) - inner) / mesh.row_height();
    if row < 0.0 || row >= mesh.rows() as f64 {
        return None;
    }
    let angle = y.atan2(x).rem_euclid(TAU);
    let column = ((angle / mesh.column_angle()) as usize).min(mesh.disc_columns() - 1);
    Some(column * mesh.rows() + row as usize)
}

/// The pin cell at a place of the box round the pin, from 0 to 1 along its sides.
fn arc_cell(mesh: &Mesh, columns: usize, x: f64, y: f64) -> Option<usize> {
    let [inner, outer] = radii(mesh);
    let from_middle = (x - 0.5) * columns as f64 * mesh.mean_radius() / (inner + y * (outer - inner));
    let column = from_middle + 0.5 * columns as f64;
    let row = (y * mesh.rows() as f64) as usize;
    (column >= 0.0 && column < columns as f64).then(|| column as usize * mesh.rows() + row)
}

/// Inner and outer radius, m.
fn radii(mesh: &Mesh) -> [f64; 2] {
    let half = 0.5 * mesh.row_height() * mesh.rows() as f64;
    [mesh.mean_radius() - half, mesh.mean_radius() + half]
}

#[cfg(test)]
mod tests {
    use super::*;

    const PALETTE: [RGBColor; 9] = [RGBColor(0, 0, 0); 9];

    #[test]
    fn maps_say_where_the_disc_moves() {
        // Model 1: in step n the pin's column j lies over the disc's column j - n, so what is under 2 comes from under 1.
        let mesh = Mesh::new(1, 12, 3, 1.0, 2.0).unwrap();
        let under = |step: usize, column: usize| (column + mesh.disc_columns() - step) % mesh.disc_columns();
        assert_eq!(under(1, 2), under(0, 1));
        // Higher columns are on the right, and come later round the ring against the clock.
        let window = &Shape::Unrolled.windows(&mesh, 12, 1.0)[0];
        let cells: Vec<u8> = (0..12).collect();
        let picture = Shape::Unrolled.picture(&mesh, window, &cells, &PALETTE, [12, 1]);
        assert!(picture.indices.is_sorted(), "{:?}", picture.indices);
        for (shape, moves) in
            [(Shape::Unrolled, "\u{2192}"), (Shape::Arcs, "\u{2192}"), (Shape::Polar, "against the clock")]
        {
            let labels = [0, 1, 2].map(|words| shape.x_label(words));
            assert_eq!(labels.each_ref().map(|label| label.contains(moves)), [true, true, false], "{labels:?}");
        }
    }

    #[test]
    fn windows_hold_every_column_once() {
        let paper = Mesh::new(80, 2764, 161, 20e-3, 24e-3).unwrap();
        let windows = Shape::Unrolled.windows(&paper, 2764, 1.0);
        // By hand: 2π · 22 mm = 138.2 mm over 4 mm is 34.6, of which each window takes about 8.6.
        let bounds: Vec<_> = windows.iter().map(|window| window.columns.clone()).collect();
        assert_eq!(bounds, [0..691, 691..1382, 1382..2073, 2073..2764]);
        assert!((windows[3].x.end() - 138.230_077).abs() < 1e-5);
        let cell = Mesh::new(1, 1, 1, 20e-3, 24e-3).unwrap();
        assert_eq!(Shape::Unrolled.windows(&cell, 1, 1.0).len(), 1);
    }

    #[test]
    fn unrolled_the_outermost_row_is_on_top() {
        let mesh = Mesh::new(2, 3, 1, 1.0, 2.0).unwrap();
        let window = &Shape::Unrolled.windows(&mesh, 3, 1.0)[0];
        let picture = Shape::Unrolled.picture(&mesh, window, &[0, 1, 2, 3, 4, 5], &PALETTE, [90, 90]);
        assert_eq!((picture.columns, picture.rows), (3, 2));
        assert_eq!(picture.indices, [1, 3, 5, 0, 2, 4]);
    }

    #[test]
    fn by_arcs_inner_rows_are_shorter() {
        // Radii 1 and 3 in the middle of the rows, 2 in the mean: by 1/2 and 3/2 as long as at the mean radius, so that inward the
        // middle two of four quarters have all four columns, and outward of four columns the middle ones and a third of others.
        let mesh = Mesh::new(2, 40, 4, 1e-9, 4.0).unwrap();
        let window = &Shape::Arcs.windows(&mesh, 4, 1.0)[0];
        let picture = Shape::Arcs.picture(&mesh, window, &[0, 1, 2, 3, 4, 5, 6, 7], &PALETTE, [8, 2]);
        let expected = [[1, 3, 3, 3, 5, 5, 5, 7], [8, 8, 0, 2, 4, 6, 8, 8]];
        assert_eq!(picture.indices, expected.concat());
    }

    #[test]
    fn from_above_columns_go_round_against_the_clock() {
        // One row of four columns: the quarters of the ring, the first one from the right to the top.
        let mesh = Mesh::new(1, 4, 1, 1e-6, 1.0).unwrap();
        let window = &Shape::Polar.windows(&mesh, 4, 1.0)[0];
        let picture = Shape::Polar.picture(&mesh, window, &[0, 1, 2, 3], &PALETTE, [4, 4]);
        let ground = 8;
        let expected = [[ground, 1, 0, ground], [1, 1, 0, 0], [2, 2, 3, 3], [ground, 2, 3, ground]];
        assert_eq!(picture.indices, expected.concat());
    }
}
