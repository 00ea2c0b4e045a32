//! Centre points against the plane: whether a two-level design with centre points shows a curve.
//!
//! Where all numbers of a design have the middle value at the same points, their squares are one column: that of the centre
//! points. It tells whether there is a curve, and not in which factor. D. C. Montgomery, Design and Analysis of Experiments (8th
//! ed., Wiley, 2013), section 6.8; Minitab calls the term Ct Pt.

use nalgebra::DVector;

use super::distribution::t_quantile;
use super::fit::Fit;
use super::residual::{Residuals, test};
use super::result::{Effects, Squares, Test};
use crate::design::Setting;

/// Parts of a column that differ by less than this are the same.
const SAME: f64 = 1e-6;

/// What centre points differ by from the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curvature {
    /// The response at the centre less that of the model of the other points, in the unit of the response.
    pub difference: f64,
    /// Its confidence interval.
    pub interval: [f64; 2],
    /// Test against the error that the model leaves with this term.
    pub test: Test,
}

impl Effects {
    /// What centre points differ by from a model without squares; none of a model that has them, of designs whose squares can be
    /// told apart or whose numbers have two values alone, and where nothing is left for an error.
    pub fn curvature(&self) -> Option<Curvature> {
        if self.terms.iter().any(|term| matches!(term.factors[..], [one, other] if one == other)) {
            return None;
        }
        let inner = &self.inner;
        let centre = self.centre()?;
        let matrix = inner.regressors.matrix(&inner.usable).ok()?;
        let count = matrix.ncols();
        let mut larger = matrix.resize_horizontally(count + 1, 0.0);
        larger.column_mut(count).copy_from(&centre);
        let centred = inner.usable.responses.iter().map(|response| response - inner.offset);
        let fit = Fit::new(&larger, &DVector::from_iterator(larger.nrows(), centred));
        let position = fit.kept.binary_search(&count).ok()?;
        let left = Residuals { usable: &inner.usable, fit: &fit, rounding: inner.rounding }.left();
        let error = left.mean().filter(|mean| *mean > 0.0)?;
        let difference = fit.coefficients[position];
        let reach = t_quantile(1.0 - self.confidence, left.freedom as f64) * (error * fit.variance(position)).sqrt();
        let own = Squares { freedom: 1, sum: fit.sum_of_squares(&[position]) };
        let interval = [difference - reach, difference + reach];
        Some(Curvature { difference, interval, test: test(own, left)? })
    }

    /// 1 for each observation at the centre and 0 for the others, if all numbers with more than two values are there together.
    fn centre(&self) -> Option<DVector<f64>> {
        let inner = &self.inner;
        let curved = (0..inner.factors.len()).filter(|factor| inner.regressors.is_curved(*factor, &inner.usable));
        let mut columns = curved.map(|factor| {
            let squares = inner.usable.settings.iter().map(|settings| match settings[factor] {
                Setting::Coded(coded) => Some(coded * coded),
                setting @ Setting::Level(_) => inner.factors[factor].coded(setting).map(|coded| coded * coded),
            });
            let squares = squares.collect::<Option<Vec<f64>>>()?;
            let middle = squares.iter().copied().fold(f64::INFINITY, f64::min);
            Some(squares.into_iter().map(|square| (1.0 - square) / (1.0 - middle)).collect::<Vec<f64>>())
        });
        let first = columns.next()??;
        let is_mark = |value: &f64| value.abs() < SAME || (value - 1.0).abs() < SAME;
        let is_first = |column: Option<Vec<f64>>| {
            column.is_some_and(|column| column.iter().zip(&first).all(|(one, other)| (one - other).abs() < SAME))
        };
        (first.iter().all(is_mark) && columns.all(is_first)).then(|| DVector::from_vec(first.clone()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Factor, FactorKind, Model, Observation, Options, analyse};

    fn of(places: &[[f64; 2]], responses: &[f64], model: Model) -> Effects {
        let range = |name: &str| Factor { name: name.into(), kind: FactorKind::Range { low: 10.0, high: 20.0 } };
        let run = |(run, (place, response)): (usize, (&[f64; 2], &f64))| Observation {
            settings: place.map(Setting::Coded).to_vec(),
            replicate: 0,
            run,
            response: *response,
        };
        let observations: Vec<Observation> = places.iter().zip(responses).enumerate().map(run).collect();
        analyse(&[range("time"), range("temperature")], &observations, &Options { model, ..Options::default() })
            .unwrap()
    }

    const PLACES: [[f64; 2]; 9] = [
        [-1.0, -1.0],
        [1.0, -1.0],
        [-1.0, 1.0],
        [1.0, 1.0],
        [0.0, 0.0],
        [0.0, 0.0],
        [0.0, 0.0],
        [0.0, 0.0],
        [0.0, 0.0],
    ];
    /// The yields of Montgomery's example 6.7: sum of squares of the curvature 0.0027, error 0.0430 with 4 degrees of freedom.
    const YIELDS: [f64; 9] = [39.3, 40.0, 40.9, 41.5, 40.3, 40.5, 40.7, 40.2, 40.6];

    #[test]
    fn centre_points_are_tested_as_montgomery_does() {
        let found = of(&PLACES, &YIELDS, Model::Interactions).curvature().unwrap();
        // 40.46 − 40.425, and 4·5·0.035²/9 by 0.172/4.
        assert!((found.difference - 0.035).abs() < 1e-9);
        assert!((found.test.f - 0.002_722_222_222_222 / 0.043).abs() < 1e-9, "{found:?}");
        // 0.035 ± 2.776445105 · √(0.043·(1/4 + 1/5)), with the quantile of t of R.
        let reach = 2.776_445_105_197_793 * (0.043_f64 * 0.45).sqrt();
        assert!((found.interval[1] - 0.035 - reach).abs() < 1e-9);
        // R: pf(0.06330749, 1, 4, lower.tail = FALSE)
        assert!((found.test.p - 0.8137).abs() < 2e-3, "{found:?}");
    }

    #[test]
    fn squares_that_can_be_told_have_no_common_test() {
        let axial = [[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]];
        let places = [&PLACES[..], &axial].concat();
        let responses = [&YIELDS[..], &[39.9, 40.7, 39.8, 41.0]].concat();
        assert_eq!(of(&places, &responses, Model::Interactions).curvature(), None);
        assert_eq!(of(&PLACES, &YIELDS, Model::Quadratic).curvature(), None);
    }

    #[test]
    fn what_the_runs_do_not_tell_is_known() {
        // With squares that are one column, the middle of one number at the end of the other is not told; corners and the
        // centre are.
        let squares = of(&PLACES, &YIELDS, Model::Quadratic);
        let tells = |place: [f64; 2]| squares.tells(&place.map(Setting::Coded)).unwrap();
        assert_eq!([[0.0, 0.0], [1.0, -1.0], [0.5, 0.5], [0.0, 1.0]].map(tells), [true, true, true, false]);
        let plane = of(&PLACES, &YIELDS, Model::Interactions);
        assert!(plane.tells(&[0.0, 1.0].map(Setting::Coded)).unwrap());
    }
}
