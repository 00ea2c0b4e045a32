//! What a patch cannot tell of a larger body, in numbers.

use super::super::synthesis::grid::Grid;
use super::super::{Body, Length, Patch};
use crate::model::mesh::Mesh;

/// The autocorrelation at which the correlation length ends, as for Sal of ISO 25178-2.
const THRESHOLD: f64 = 0.2;
/// Fewest correlation lengths in a direction that are not warned of.
const FEW: f64 = 10.0;
/// Part of the patch at which the autocorrelation of the tapers themselves nearly falls to the threshold (it does so at 0.35):
/// a patch of equal heights would seem to be related as far.
const WHOLE: f64 = 0.3;

/// How far heights of a patch are related, and how much it has of them.
#[derive(Debug)]
pub(super) struct Reach {
    /// Distance along and across sliding at which the autocorrelation falls to 0.2, m; none where it does not within the
    /// patch.
    lengths: [Option<f64>; 2],
    /// Relative standard error of the patch's rms height.
    error: f64,
}

impl Reach {
    /// From the autocorrelation at every lag of the grid, column by column.
    ///
    /// The mean square of N normal heights has the relative variance 2 Σ ρ²/N (Bartlett 1946), their rms half that error.
    pub(super) fn of(correlation: &[f64], grid: &Grid, cells: &Patch) -> Self {
        let rows = grid.padded_rows;
        let along = correlation.iter().step_by(rows).take(cells.columns.min(grid.padded_columns / 2 + 1));
        let across = correlation.iter().take(cells.rows.min(rows / 2 + 1));
        let lengths = [
            crossing(along.copied()).map(|cells| cells * grid.column_width),
            crossing(across.copied()).map(|cells| cells * grid.row_height),
        ];
        let squares: f64 = correlation.iter().map(|value| value * value).sum();
        Self { lengths, error: (0.5 * squares / cells.heights.len() as f64).sqrt() }
    }

    /// What is to be said of it. That longer waves are missing is a warning where those as long as the patch have much of the height.
    pub(super) fn remarks(&self, misses_much: bool, patch: &Patch, body: Body, mesh: &Mesh) -> Vec<String> {
        let mut remarks = Vec::new();
        let sizes = [patch.length(), patch.height()];
        let body_sizes = [body.length(mesh), mesh.rows() as f64 * mesh.row_height()];
        if sizes[0] < body_sizes[0] || sizes[1] < body_sizes[1] {
            let mark = if misses_much { "warning: " } else { "" };
            remarks.push(format!(
                "{mark}waves longer than the patch, {} along and {} across sliding, are not known from it; the {} of \
                 {} by {} gets none",
                Length(sizes[0]),
                Length(sizes[1]),
                body.name(),
                Length(body_sizes[0]),
                Length(body_sizes[1])
            ));
        }
        for (axis, direction) in ["along", "across"].into_iter().enumerate() {
            let few = match self.lengths[axis].filter(|length| *length < WHOLE * sizes[axis]) {
                None => format!("{direction} sliding, heights are related over a third of the patch or more"),
                Some(length) if sizes[axis] < FEW * length => {
                    let times = sizes[axis] / length;
                    format!(
                        "{direction} sliding, the patch is only {times:.1} times its correlation length of {}",
                        Length(length)
                    )
                }
                Some(_) => continue,
            };
            remarks.push(format!(
                "warning: {few}, expected some {FEW} correlation lengths: its rms height is known to {:.0} %, its texture less",
                100.0 * self.error
            ));
        }
        remarks
    }
}

/// The place at which values first fall to the threshold, linear between them.
fn crossing(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut before = f64::INFINITY;
    for (place, value) in values.enumerate() {
        if value <= THRESHOLD {
            let part = if place == 0 { 1.0 } else { (before - THRESHOLD) / (before - value) };
            return Some((place as f64 - 1.0 + part).max(0.0));
        }
        before = value;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_crossing_of_a_line_is_where_it_falls_to_a_fifth() {
        assert_eq!(crossing([1.0, 0.6, 0.2].into_iter()), Some(2.0));
        let place = crossing((0..10).map(|n| 1.0 - f64::from(n) * 0.3)).unwrap();
        assert!((place - 0.8 / 0.3).abs() < 1e-15, "{place}");
        assert_eq!(crossing([1.0, 0.5, 0.3].into_iter()), None);
    }
}
