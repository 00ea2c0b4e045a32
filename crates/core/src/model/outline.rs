//! The outline of the pin seen from above: which cells of its rectangle of rows and columns are there (model 1, extension).

use std::ops::Range;

/// Outline of the pin.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Outline {
    /// All cells of its rows and columns.
    #[default]
    Rectangle,
    /// The cells whose centres lie within a circle about the middle of the rectangle.
    Disc {
        /// Radius of the circle, m.
        radius: f64,
    },
}

impl Outline {
    /// Whether a cell is there whose centre lies so far (m) from the middle: `along` the sliding direction as arc length at the
    /// cell's own radius, `across` it as a difference of radii.
    fn contains(self, along: f64, across: f64) -> bool {
        match self {
            Self::Rectangle => true,
            Self::Disc { radius } => along * along + across * across <= radius * radius,
        }
    }

    /// The columns of the pin that are there in a row of this radius (m), `across` (m) away from the middle of the track; none
    /// where the outline goes beyond the columns.
    pub(super) fn chord(self, pin_columns: usize, column_angle: f64, radius: f64, across: f64) -> Option<Range<usize>> {
        // Exact in steps of one half, so that both sides of the middle are alike.
        let from_middle = |column: f64| column + 0.5 - 0.5 * pin_columns as f64;
        let is_there = |column: f64| self.contains(radius * (from_middle(column) * column_angle), across);
        if self != Self::Rectangle && is_there(-1.0) {
            return None;
        }
        // The chord is symmetric, so it is empty where no column up to the middle is there.
        let first = (0..pin_columns.div_ceil(2)).find(|column| is_there(*column as f64));
        Some(first.map_or(0..0, |first| first..pin_columns - first))
    }
}

/// How many columns of the angle `column_angle` (rad) a circle of this radius (m) about the mean radius (m) takes: its longest
/// arc, which lies a little inward of its middle, in columns, rounded. No cell of the circle is left out, and no column is
/// empty for want of one. `None` where the circle reaches the axis.
pub fn columns_of_disc(radius: f64, mean_radius: f64, column_angle: f64) -> Option<f64> {
    // Half the arc at the radius r is √(R² − (r − r̄)²)/r, which is largest where r = (r̄² − R²)/r̄.
    let farthest = (mean_radius - radius) * (mean_radius + radius);
    (farthest > 0.0).then(|| libm::round(2.0 * (radius / farthest.sqrt()) / column_angle).max(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_has_as_many_columns_as_its_longest_arc() {
        // The longest arc by trying every radius, where the closed form is the function's own.
        for (radius, mean) in [(5e-3, 22e-3), (1e-3, 22e-3), (20e-3, 22e-3)] {
            let angle: f64 = 1e-4;
            let half = |r: f64| (radius * radius - (r - mean) * (r - mean)).max(0.0).sqrt() / r;
            let longest = (0..=100_000).map(|place| half(mean - radius + 2.0 * radius * f64::from(place) / 1e5));
            let longest = 2.0 * longest.fold(0.0, f64::max) / angle;
            let columns = columns_of_disc(radius, mean, angle).unwrap();
            assert!((columns - longest).abs() <= 0.5 + 1e-4 * longest, "{columns} of {longest}");
        }
        assert_eq!(columns_of_disc(22e-3, 22e-3, 1e-3), None);
    }

    #[test]
    fn chords_are_symmetric_and_those_that_go_beyond_the_columns_are_none() {
        let disc = Outline::Disc { radius: 2.4 };
        // Columns of one metre at a radius of 1000 m: centres at ±0.5, ±1.5, ±2.5 or at 0, ±1, ±2, ±3 m.
        let chord = |columns, across| disc.chord(columns, 1e-3, 1e3, across);
        assert_eq!(chord(6, 0.0), Some(1..5));
        assert_eq!(chord(7, 0.0), Some(1..6));
        assert_eq!(chord(7, 2.3), Some(3..4));
        assert_eq!(chord(6, 2.39), Some(0..0));
        assert_eq!(chord(7, 2.5), Some(0..0));
        assert_eq!(chord(5, 0.0), Some(0..5));
        assert_eq!(chord(3, 0.0), None);
        assert_eq!(Outline::Rectangle.chord(3, 1e-3, 1e3, 0.0), Some(0..3));
    }
}
