//! A measured series as a few numbers: what runs differ in, as far as the measurement can see it.
//!
//! The series of all runs are made white (see [`MeasuredSeries`]), so that each direction among them is measured with a deviation
//! of one. Their principal components that vary by a part of that are kept. Each becomes a response of its own: its score in a run, and
//! the score of what was measured. What is left of the measurement does not depend on the keys.
//!
//! D. Higdon, J. Gattiker, B. Williams, M. Rightley, J. Am. Stat. Assoc. 103(482), 570–583 (2008),
//! doi:10.1198/016214507000000888.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::{MeasuredSeries, Measurement};
use crate::design::Setting;
use crate::effects::Observation;

/// Variance over the runs, as a part of that of the measurement, below which a component is left out.
const LEAST: f64 = 0.02;
/// Most components.
const MOST: usize = 10;

/// The series of a run at the times of a measured one.
#[derive(Debug, Clone, PartialEq)]
pub struct ObservedSeries {
    /// A coded setting for each key.
    pub settings: Vec<Setting>,
    /// Which set of seeds.
    pub replicate: usize,
    /// Which run.
    pub run: usize,
    /// The values; none where the run has none.
    pub values: Vec<f64>,
}

/// A measured series in components.
#[derive(Debug, Clone)]
pub(super) struct Components {
    pub measured: MeasuredSeries,
    /// Mean over the runs, white.
    mean: DVector<f64>,
    /// A column for each component, of length 1, white.
    basis: DMatrix<f64>,
    /// Variance of what is measured of each component: 1, and what the components leave out of the runs at each point.
    variance: f64,
}

impl Components {
    /// The components of a measured series, from the runs that have one; none where no run has.
    pub fn new(measured: &MeasuredSeries, runs: &[ObservedSeries]) -> Option<Self> {
        let points = measured.times().len();
        let mut known = std::collections::BTreeSet::new();
        let is_whole = |run: &&ObservedSeries| run.values.len() == points && run.values.iter().all(|v| v.is_finite());
        let white: Vec<DVector<f64>> = runs
            .iter()
            .filter(is_whole)
            .filter(|run| known.insert(run.run))
            .map(|run| DVector::from_vec(measured.white(&run.values)))
            .collect();
        let count = white.len() as f64;
        let mean = white.iter().fold(DVector::zeros(points), |sum, run| sum + run) / count;
        if white.is_empty() || !mean.iter().all(|value| value.is_finite()) {
            return None;
        }
        let away = DMatrix::from_columns(&white.iter().map(|run| run - &mean).collect::<Vec<_>>());
        // The matrix of runs is smaller than that of points, and has the same eigenvalues but for zeros.
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(away.tr_mul(&away));
        let mut order: Vec<usize> = (0..eigenvalues.len()).collect();
        order.sort_by(|one, other| eigenvalues[*other].total_cmp(&eigenvalues[*one]));
        let most = MOST.min(points).min(white.len().saturating_sub(1)).max(1);
        let is_kept = |(place, at): &(usize, &usize)| *place == 0 || eigenvalues[**at] / count > LEAST;
        let kept: Vec<usize> = order.iter().enumerate().take(most).take_while(is_kept).map(|(_, at)| *at).collect();
        let column = |at: &usize| {
            let direction = &away * eigenvectors.column(*at);
            let length = direction.norm();
            // Runs that do not differ at all have no direction: the scores are 0 along any.
            if length > 0.0 {
                direction / length
            } else {
                DVector::from_element(points, (points as f64).sqrt().recip())
            }
        };
        let basis = DMatrix::from_columns(&kept.iter().map(column).collect::<Vec<_>>());
        let left_out: f64 = order[kept.len()..].iter().map(|at| eigenvalues[*at].max(0.0) / count).sum();
        let others = points.saturating_sub(kept.len()).max(1) as f64;
        Some(Self { measured: measured.clone(), mean, basis, variance: 1.0 + left_out / others })
    }

    /// What was measured of each component.
    pub fn measurements(&self) -> Vec<Measurement> {
        let scores = self.scores(self.measured.values());
        scores.iter().map(|value| Measurement { value: *value, uncertainty: self.variance.sqrt() }).collect()
    }

    /// What runs give of each component.
    pub fn observations(&self, runs: &[ObservedSeries]) -> Vec<Vec<Observation>> {
        let points = self.measured.times().len();
        let scores: Vec<Option<DVector<f64>>> =
            runs.iter().map(|run| (run.values.len() == points).then(|| self.scores(&run.values))).collect();
        let observation = |at: usize, (run, scores): (&ObservedSeries, &Option<DVector<f64>>)| Observation {
            settings: run.settings.clone(),
            replicate: run.replicate,
            run: run.run,
            response: scores.as_ref().map_or(f64::NAN, |scores| scores[at]),
        };
        let all = |at: usize| runs.iter().zip(&scores).map(move |each| observation(at, each)).collect();
        (0..self.basis.ncols()).map(all).collect()
    }

    /// What is left of the measurement beside the components, in variances: Σ over the other directions.
    pub fn rest(&self) -> f64 {
        let away = DVector::from_vec(self.measured.white(self.measured.values())) - &self.mean;
        let scores = self.basis.tr_mul(&away);
        (away.norm_squared() - scores.norm_squared()).max(0.0) / self.variance
    }

    /// The series of which the components have these scores, and white deviations of the measured one from it.
    pub fn series(&self, scores: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let white = &self.mean + &self.basis * DVector::from_column_slice(scores);
        let measured = self.measured.white(self.measured.values());
        let away = measured.iter().zip(white.iter()).map(|(measured, run)| measured - run).collect();
        (self.measured.coloured(white.as_slice()), away)
    }

    /// Standard deviations at the times, of scores with these variances.
    pub fn deviations(&self, variances: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.measured.times().len()];
        for (column, variance) in self.basis.column_iter().zip(variances) {
            let coloured = self.measured.coloured(column.as_slice());
            sums.iter_mut().zip(coloured).for_each(|(sum, value)| *sum += variance * value * value);
        }
        sums.into_iter().map(f64::sqrt).collect()
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.basis.ncols()
    }

    fn scores(&self, values: &[f64]) -> DVector<f64> {
        self.basis.tr_mul(&(DVector::from_vec(self.measured.white(values)) - &self.mean))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_of_two_shapes_have_two_components_and_lose_nothing() {
        let times: Vec<f64> = (0..40).map(f64::from).collect();
        let curve = |a: f64, b: f64| times.iter().map(|t| 3.0 + a * (-t / 8.0).exp() + b * t).collect::<Vec<f64>>();
        for time in [0.0, 3.0] {
            let measured = MeasuredSeries::new(times.clone(), curve(1.5, 0.04), vec![0.1; 40], time).unwrap();
            let runs: Vec<ObservedSeries> = [(1.0, 0.0), (2.0, 0.05), (1.0, 0.1), (3.0, 0.02), (2.5, 0.07)]
                .into_iter()
                .enumerate()
                .map(|(run, (a, b))| ObservedSeries { settings: Vec::new(), replicate: 0, run, values: curve(a, b) })
                .collect();
            let components = Components::new(&measured, &runs).unwrap();
            assert_eq!(components.count(), 2);
            // The measured curve is of the same shapes: nothing is left beside them, and its scores give it back.
            assert!(components.rest() < 1e-12 && (components.variance - 1.0).abs() < 1e-12);
            let scores: Vec<f64> = components.measurements().iter().map(|each| each.value).collect();
            let (series, away) = components.series(&scores);
            assert!(series.iter().zip(measured.values()).all(|(one, other)| (one - other).abs() < 1e-10));
            assert!(away.iter().all(|away| away.abs() < 1e-9));
            // Squares of distances are those of the scores.
            let of_run: f64 = components
                .observations(&runs)
                .iter()
                .zip(&scores)
                .map(|(component, score)| (component[3].response - score).powi(2))
                .sum();
            let distance = measured.distance(&runs[3].values).powi(2) * 40.0;
            assert!((of_run / distance - 1.0).abs() < 1e-9, "{of_run} {distance}");
        }
    }

    #[test]
    fn runs_that_do_not_differ_have_one_component_of_nothing() {
        let measured = MeasuredSeries::new(vec![0.0, 1.0], vec![1.0, 2.0], vec![0.1; 2], 0.0).unwrap();
        let run = |run| ObservedSeries { settings: Vec::new(), replicate: 0, run, values: vec![1.0, 1.0] };
        let components = Components::new(&measured, &[run(0), run(1)]).unwrap();
        assert_eq!(components.count(), 1);
        assert!(components.observations(&[run(0)])[0][0].response.abs() < 1e-12);
        assert!(Components::new(&measured, &[]).is_none());
    }
}
