//! Minima of smooth functions in a box.
//!
//! A quasi-Newton method with projection: the inverse Hessian of the free variables is kept by the formula of Broyden, Fletcher,
//! Goldfarb and Shanno, variables at a bound to which the gradient pushes them stay there, and steps are shortened until the
//! function falls enough (Armijo). D. P. Bertsekas, SIAM J. Control Optim. 20(2), 221–246 (1982), doi:10.1137/0320018.

/// Steps at most.
const MOST_STEPS: usize = 200;
/// Halvings of a step at most.
const MOST_HALVINGS: usize = 30;
/// Part of the decrease that the gradient promises which a step has to bring.
const SUFFICIENT: f64 = 1e-4;

/// Decrease, as a part of the value, that rounding hides: no shorter step is tried.
const HIDDEN: f64 = 1e-14;

/// A value and its gradient.
pub(crate) type Slope = (f64, Vec<f64>);

/// Where a minimum was found.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Minimum {
    pub place: Vec<f64>,
    pub value: f64,
}

/// The local minimum that is found from a start, between `low` and `high`; none where the function has no value at the start.
///
/// The search ends when the projected gradient is below `tolerance`, or steps bring nothing any more. A function without a
/// value, `None`, is taken for one that is too large there.
pub(crate) fn minimise(
    mut function: impl FnMut(&[f64]) -> Option<Slope>,
    start: &[f64],
    low: &[f64],
    high: &[f64],
    tolerance: f64,
) -> Option<Minimum> {
    let clamp = |place: &mut [f64]| {
        place.iter_mut().zip(low.iter().zip(high)).for_each(|(x, (low, high))| *x = x.clamp(*low, *high));
    };
    let mut place = start.to_vec();
    clamp(&mut place);
    let (mut value, mut gradient) = function(&place).filter(|(value, _)| value.is_finite())?;
    let mut inverse = Inverse::new(place.len());
    for _ in 0..MOST_STEPS {
        let free: Vec<bool> = (0..place.len())
            .map(|at| !(place[at] <= low[at] && gradient[at] > 0.0 || place[at] >= high[at] && gradient[at] < 0.0))
            .collect();
        let largest =
            gradient.iter().zip(&free).filter(|(_, free)| **free).fold(0.0, |most: f64, (g, _)| most.max(g.abs()));
        if largest <= tolerance {
            break;
        }
        let mut direction = inverse.times(&gradient, &free);
        if dot(&direction, &gradient) >= 0.0 {
            inverse = Inverse::new(place.len());
            direction = inverse.times(&gradient, &free);
        }
        // A first step without a scale goes no farther than a tenth of the box.
        if inverse.is_new {
            let reach = (0..place.len()).map(|at| direction[at].abs() / (high[at] - low[at]).max(f64::MIN_POSITIVE));
            let reach = reach.fold(0.0, f64::max);
            direction.iter_mut().for_each(|step| *step *= (0.1 / reach).min(1.0));
        }
        let found = search(&mut function, &place, (value, &gradient), &direction, &clamp);
        let Some((next, moved, (next_value, next_gradient))) = found else {
            if inverse.is_new {
                break;
            }
            inverse = Inverse::new(place.len());
            continue;
        };
        let change: Vec<f64> = next_gradient.iter().zip(&gradient).map(|(next, before)| next - before).collect();
        let gained = value - next_value;
        inverse.learn(&moved, &change, &free);
        (place, value, gradient) = (next, next_value, next_gradient);
        if gained <= 1e-14 * value.abs() {
            break;
        }
    }
    Some(Minimum { place, value })
}

/// The first step along a direction, halved until it brings enough: where it leads, how far it moved, and what is there.
fn search(
    function: &mut impl FnMut(&[f64]) -> Option<Slope>,
    place: &[f64],
    (value, gradient): (f64, &[f64]),
    direction: &[f64],
    clamp: &impl Fn(&mut [f64]),
) -> Option<(Vec<f64>, Vec<f64>, Slope)> {
    let mut length = 1.0;
    for _ in 0..MOST_HALVINGS {
        let mut next: Vec<f64> = place.iter().zip(direction).map(|(x, step)| x + length * step).collect();
        clamp(&mut next);
        let moved: Vec<f64> = next.iter().zip(place).map(|(next, x)| next - x).collect();
        let promised = dot(&moved, gradient);
        if promised.abs() < HIDDEN * value.abs() {
            return None;
        }
        if let Some(slope) = function(&next).filter(|(next, _)| *next <= value + SUFFICIENT * promised) {
            return Some((next, moved, slope));
        }
        length *= 0.5;
    }
    None
}

/// What the inverse Hessian is taken for.
struct Inverse {
    size: usize,
    rows: Vec<f64>,
    /// Whether nothing was learned yet.
    is_new: bool,
}

impl Inverse {
    fn new(size: usize) -> Self {
        let rows = (0..size * size).map(|at| if at % (size + 1) == 0 { 1.0 } else { 0.0 }).collect();
        Self { size, rows, is_new: true }
    }

    /// The step that it advises: against the gradient, with variables that are not free left where they are.
    fn times(&self, gradient: &[f64], free: &[bool]) -> Vec<f64> {
        let row = |row: usize| {
            let terms = (0..self.size).filter(|at| free[*at]).map(|at| self.rows[row * self.size + at] * gradient[at]);
            -terms.sum::<f64>()
        };
        (0..self.size).map(|at| if free[at] { row(at) } else { 0.0 }).collect()
    }

    /// Learns from a step and the change of the gradient along it, of the free variables.
    fn learn(&mut self, step: &[f64], change: &[f64], free: &[bool]) {
        let masked = |values: &[f64]| -> Vec<f64> {
            values.iter().zip(free).map(|(value, free)| if *free { *value } else { 0.0 }).collect()
        };
        let (step, change) = (masked(step), masked(change));
        let curvature = dot(&step, &change);
        if curvature <= 1e-12 * dot(&step, &step).sqrt() * dot(&change, &change).sqrt() {
            return;
        }
        if self.is_new {
            let scale = curvature / dot(&change, &change);
            self.rows.iter_mut().for_each(|value| *value *= scale);
            self.is_new = false;
        }
        let size = self.size;
        let product: Vec<f64> =
            (0..size).map(|row| (0..size).map(|at| self.rows[row * size + at] * change[at]).sum()).collect();
        let factor = (1.0 + dot(&change, &product) / curvature) / curvature;
        for row in 0..size {
            for column in 0..size {
                self.rows[row * size + column] += factor * step[row] * step[column]
                    - (product[row] * step[column] + step[row] * product[column]) / curvature;
            }
        }
    }
}

pub(crate) fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rosenbrock's valley, whose minimum is 0 at (1, 1).
    fn valley(x: &[f64]) -> Option<Slope> {
        let (a, b) = (1.0 - x[0], x[1] - x[0] * x[0]);
        Some((a * a + 100.0 * b * b, vec![-2.0 * a - 400.0 * x[0] * b, 200.0 * b]))
    }

    #[test]
    fn the_floor_of_a_curved_valley_is_found() {
        let found = minimise(valley, &[-1.2, 1.0], &[-2.0; 2], &[2.0; 2], 1e-9).unwrap();
        assert!(found.place.iter().all(|x| (x - 1.0).abs() < 1e-6), "{found:?}");
    }

    #[test]
    fn a_bound_holds() {
        // By hand: with x at most 0.5 the minimum is at (0.5, 0.25), where the value is 0.25.
        let found = minimise(valley, &[-1.2, 1.0], &[-2.0; 2], &[0.5, 2.0], 1e-9).unwrap();
        assert!((found.place[0] - 0.5).abs() < 1e-12 && (found.place[1] - 0.25).abs() < 1e-6, "{found:?}");
        assert!((found.value - 0.25).abs() < 1e-10);
    }

    #[test]
    fn where_there_is_no_value_there_is_no_minimum() {
        assert_eq!(minimise(|_| None, &[0.0], &[-1.0], &[1.0], 1e-9), None);
        // ln x has none left of 0; x − ln x is least at 1.
        let function = |x: &[f64]| (x[0] > 0.0).then(|| (x[0] - libm::log(x[0]), vec![1.0 - 1.0 / x[0]]));
        let found = minimise(function, &[3.0], &[-5.0], &[5.0], 1e-10).unwrap();
        assert!((found.place[0] - 1.0).abs() < 1e-8);
    }
}
