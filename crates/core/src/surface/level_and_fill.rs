//! Levels a surface, takes out its outliers, and gives missing points a height.

use super::level::{Level, level, rms};
use super::missing::{Fill, fill, remove_outliers};
use super::preparation::Preparation;
use super::preparation_error::PreparationError;
use super::report::change;
use super::slope_outliers::remove_slope_outliers;
use super::warnings::rougher_by_filling;
use super::{Length, Patch};

impl Preparation {
    /// Gives the number of points that were missing and got a height.
    pub(super) fn level_and_fill(
        &self,
        patch: &mut Patch,
        closed: bool,
        beyond: &[usize],
        report: &mut Vec<String>,
    ) -> Result<usize, PreparationError> {
        let points = patch.heights.len() - beyond.len();
        let measured = patch.heights.len() - patch.missing();
        refuse_none(patch, points, 0)?;
        self.level(patch, closed, report);
        let mut outliers = 0;
        if let Some(limit) = self.outlier_slope {
            let before = rms(&patch.heights);
            outliers = remove_slope_outliers(patch, limit, closed);
            report.push(format!(
                "outliers by slope: {outliers} of {measured} points are on spikes or in pits with slopes above {limit}: {}",
                change(before, &patch.heights)
            ));
            refuse_none(patch, points, outliers)?;
            if outliers > 0 {
                self.level(patch, closed, report);
            }
        }
        if let Some(limit) = self.outliers {
            let before = rms(&patch.heights);
            let (count, distance) = remove_outliers(&mut patch.heights, limit).ok_or(PreparationError::NoDeviation)?;
            outliers += count;
            report.push(format!(
                "outliers: {count} of {measured} points lie more than {} from the median ({limit} robust standard \
                 deviations): {}",
                Length(distance),
                change(before, &patch.heights)
            ));
            refuse_none(patch, points, outliers)?;
            if count > 0 {
                self.level(patch, closed, report);
            }
        }
        let missing = patch.missing() - beyond.len();
        if missing == 0 {
            return Ok(0);
        }
        let how = self.fill.ok_or(PreparationError::Missing { missing, outliers, points })?;
        let before = rms(&patch.heights);
        fill(patch, how, closed);
        beyond.iter().for_each(|cell| patch.heights[*cell] = f64::NAN);
        let what = match how {
            Fill::Level => "got the mean of the others",
            Fill::Interpolate => "were interpolated from those around them",
        };
        report
            .push(format!("{missing} of {points} points were missing and {what}: {}", change(before, &patch.heights)));
        report.extend(rougher_by_filling(before, rms(&patch.heights), self.outliers.is_some()));
        Ok(missing)
    }

    fn level(&self, patch: &mut Patch, closed: bool, report: &mut Vec<String>) {
        let what = match (self.level, closed) {
            (Level::None, _) => return,
            (Level::Mean, _) => "the mean",
            (Level::Plane, true) => "the mean and the radial slope",
            (Level::Plane, false) => "the least-squares plane",
            (Level::Quadratic, true) => "the mean, the radial slope and the radial curvature",
            (Level::Quadratic, false) => "the least-squares surface of second order",
        };
        let before = rms(&patch.heights);
        level(&mut patch.heights, patch.rows, self.level, closed);
        report.push(format!("levelled by {what}: {}", change(before, &patch.heights)));
    }
}

/// Refuses a patch of so many points of which none has a height, so many of them because they were outliers.
fn refuse_none(patch: &Patch, points: usize, outliers: usize) -> Result<(), PreparationError> {
    if patch.missing() == patch.heights.len() {
        return Err(PreparationError::AllMissing { outliers, points });
    }
    Ok(())
}
