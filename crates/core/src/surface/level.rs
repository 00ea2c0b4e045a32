//! Levelling: the mean, the least-squares plane or the least-squares surface of second order is taken out.

/// Form that is taken out of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// Nothing.
    None,
    /// The mean height.
    Mean,
    /// The least-squares plane; of heights that cover the whole ring only the mean and the radial slope.
    Plane,
    /// The least-squares surface of second order; of heights that cover the whole ring only the mean, the radial slope
    /// and the radial curvature.
    Quadratic,
}

/// Takes the form out of the heights of a grid, in place. Missing points (NaN) take no part and stay missing.
///
/// Stored column by column. With `closed` the columns run round a ring and only what closes is taken out: the mean, a
/// slope and a curvature along the rows. A slope round the ring would leave a step where it closes.
///
/// Heights that were nothing but the form are all 0 afterwards: what the rounding of numbers leaves of them is no surface.
pub fn level(heights: &mut [f64], rows: usize, level: Level, closed: bool) {
    let terms: &[Term] = match (level, closed) {
        (Level::None, _) => return,
        (Level::Mean, _) => &[Term(0, 0)],
        (Level::Plane, true) => &[Term(0, 0), Term(0, 1)],
        (Level::Plane, false) => &[Term(0, 0), Term(1, 0), Term(0, 1)],
        (Level::Quadratic, true) => &[Term(0, 0), Term(0, 1), Term(0, 2)],
        (Level::Quadratic, false) => &[Term(0, 0), Term(1, 0), Term(0, 1), Term(2, 0), Term(1, 1), Term(0, 2)],
    };
    let Some(form) = Form::new(heights, rows, terms) else { return };
    let before = largest(heights);
    // The second pass takes out what rounding left of a large offset or tilt in the first.
    for _ in 0..2 {
        let coefficients = form.fit(heights);
        form.take_out(heights, &coefficients);
    }
    if largest(heights) <= ROUNDING * before {
        heights.iter_mut().filter(|height| !height.is_nan()).for_each(|height| *height = 0.0);
    }
}

/// Rounding that is left of heights that are nothing but a form, over the largest of them: a few units of the last place, of
/// the heights themselves and of the sum of terms that is taken out.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The largest distance of a height from 0; missing points take no part.
fn largest(heights: &[f64]) -> f64 {
    heights.iter().fold(0.0, |largest, height| height.abs().max(largest))
}

/// Product of the Legendre polynomials of these orders, 0 to 2, in x and y.
#[derive(Debug, Clone, Copy)]
struct Term(usize, usize);

impl Term {
    fn at(self, [x, y]: [f64; 2]) -> f64 {
        let legendre = |order: usize, x: f64| match order {
            0 => 1.0,
            1 => x,
            _ => 1.5 * x * x - 0.5,
        };
        legendre(self.0, x) * legendre(self.1, y)
    }
}

/// Most terms of a form.
const MOST_TERMS: usize = 6;
/// A term of which no more than this is left beside the terms before it is not determined by the points.
const DEPENDENT: f64 = 1e-10;

/// A sum of terms over the points that are there, with the factors of its normal equations.
///
/// Coordinates run from −1 to 1 over these points. On a full grid the Legendre polynomials are all but orthogonal there,
/// so that the normal equations keep their digits.
struct Form<'a> {
    terms: &'a [Term],
    rows: usize,
    middle: [f64; 2],
    half: [f64; 2],
    /// L of the matrix L D Lᵀ of the normal equations, below its diagonal of ones, and D on the diagonal; D is 0 for a
    /// term that the points do not determine, which gets no part of the form.
    factors: [[f64; MOST_TERMS]; MOST_TERMS],
}

impl<'a> Form<'a> {
    /// Form of the points that are there; `None` without any point.
    fn new(heights: &[f64], rows: usize, terms: &'a [Term]) -> Option<Self> {
        let (mut lowest, mut highest) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for (index, _) in heights.iter().enumerate().filter(|(_, z)| !z.is_nan()) {
            for (axis, place) in place(index, rows).into_iter().enumerate() {
                lowest[axis] = place.min(lowest[axis]);
                highest[axis] = place.max(highest[axis]);
            }
        }
        if lowest[0] > highest[0] {
            return None;
        }
        let middle = [0, 1].map(|axis| 0.5 * (lowest[axis] + highest[axis]));
        // All points on one line leave the coordinate across it at 0.
        let half = [0, 1].map(|axis| (0.5 * (highest[axis] - lowest[axis])).max(1.0));
        let mut form = Self { terms, rows, middle, half, factors: [[0.0; MOST_TERMS]; MOST_TERMS] };
        for (index, _) in heights.iter().enumerate().filter(|(_, z)| !z.is_nan()) {
            let values = form.values(index);
            for (i, row) in form.factors.iter_mut().enumerate() {
                row.iter_mut().zip(&values[..=i]).for_each(|(sum, value)| *sum += values[i] * value);
            }
        }
        form.factorise();
        Some(form)
    }

    /// Turns the lower half of the matrix into its factors, in place.
    fn factorise(&mut self) {
        for i in 0..self.terms.len() {
            let whole = self.factors[i][i];
            for j in 0..=i {
                let earlier: f64 = (0..j).map(|k| self.factors[i][k] * self.factors[j][k] * self.factors[k][k]).sum();
                self.factors[i][j] -= earlier;
                if j < i {
                    let pivot = self.factors[j][j];
                    self.factors[i][j] = if pivot > 0.0 { self.factors[i][j] / pivot } else { 0.0 };
                }
            }
            if self.factors[i][i] <= DEPENDENT * whole {
                self.factors[i][i] = 0.0;
            }
        }
    }

    /// Coefficients of the terms with the least sum of squared residuals.
    fn fit(&self, heights: &[f64]) -> [f64; MOST_TERMS] {
        let mut solution = [0.0; MOST_TERMS];
        for (index, height) in heights.iter().enumerate().filter(|(_, z)| !z.is_nan()) {
            let values = self.values(index);
            solution.iter_mut().zip(values).for_each(|(sum, value)| *sum += value * height);
        }
        let count = self.terms.len();
        for i in 0..count {
            solution[i] -= (0..i).map(|k| self.factors[i][k] * solution[k]).sum::<f64>();
        }
        for i in (0..count).rev() {
            let pivot = self.factors[i][i];
            solution[i] = if pivot > 0.0 {
                solution[i] / pivot - (i + 1..count).map(|k| self.factors[k][i] * solution[k]).sum::<f64>()
            } else {
                0.0
            };
        }
        solution
    }

    fn take_out(&self, heights: &mut [f64], coefficients: &[f64; MOST_TERMS]) {
        for (index, height) in heights.iter_mut().enumerate() {
            // The first term is the largest: the others are taken from what is left.
            for (value, coefficient) in self.values(index).iter().zip(coefficients) {
                *height -= coefficient * value;
            }
        }
    }

    /// The terms at a point; 0 beyond the last.
    fn values(&self, index: usize) -> [f64; MOST_TERMS] {
        let place = place(index, self.rows);
        let place = [0, 1].map(|axis| (place[axis] - self.middle[axis]) / self.half[axis]);
        let mut values = [0.0; MOST_TERMS];
        values.iter_mut().zip(self.terms).for_each(|(value, term)| *value = term.at(place));
        values
    }
}

/// Column and row of a point.
fn place(index: usize, rows: usize) -> [f64; 2] {
    [(index / rows) as f64, (index % rows) as f64]
}
