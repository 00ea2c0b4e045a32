//! The largest value of a function in a box: from many starting points, then step by step from the best of them.
//!
//! The steps are those of Nelder, J. A. & Mead, R. (1965): A simplex method for function minimization. Computer Journal 7,
//! 308–313, doi:10.1093/comjnl/7.4.308, with what leaves the box moved onto its rim, and then steps along the axes that
//! become shorter (Hooke, R. & Jeeves, T. A. (1961), doi:10.1145/321062.321069), for a simplex may end on a rim.

/// Most values that one simplex asks for, times the dimensions.
const MOST_STEPS: usize = 200;
/// A simplex ends where its values differ by less than this.
const ALIKE: f64 = 1e-12;
/// The first and the last length of steps along the axes, in halves of the box.
const STEPS: [f64; 2] = [0.1, 1e-8];
/// Edge of the first simplex, in halves of the box.
const EDGE: f64 = 0.25;
/// How often a simplex begins anew where the last one ended.
const ROUNDS: usize = 6;

/// A function of a place in the box from −1 to 1 in all directions, better where larger.
type Merit<'a> = &'a mut dyn FnMut(&[f64]) -> f64;

/// A place and its value.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Place {
    pub at: Vec<f64>,
    pub value: f64,
}

/// The best place that is found from this one on.
pub(super) fn climb(start: Vec<f64>, merit: Merit<'_>) -> Place {
    let value = merit(&start);
    let mut best = Place { at: start, value };
    if best.at.is_empty() {
        return best;
    }
    for _ in 0..ROUNDS {
        let before = best.value;
        let with_simplex = simplex(&best, merit);
        best = along_axes(better(best, with_simplex), merit);
        if best.value - before <= ALIKE * best.value.abs().max(ALIKE) {
            break;
        }
    }
    best
}

fn better(one: Place, other: Place) -> Place {
    if other.value > one.value { other } else { one }
}

/// Nelder and Mead.
fn simplex(start: &Place, merit: Merit<'_>) -> Place {
    let dimensions = start.at.len();
    let mut corners = vec![start.clone()];
    for axis in 0..dimensions {
        let mut at = start.at.clone();
        // Inward, so that no corner falls upon another.
        at[axis] += if at[axis] > 0.0 { -EDGE } else { EDGE };
        let value = merit(&at);
        corners.push(Place { at, value });
    }
    for _ in 0..MOST_STEPS * dimensions {
        corners.sort_by(|one, other| other.value.total_cmp(&one.value));
        let (best, worst) = (corners[0].value, corners[dimensions].clone());
        if best - worst.value <= ALIKE * best.abs().max(ALIKE) {
            break;
        }
        let centre: Vec<f64> = (0..dimensions)
            .map(|axis| corners[..dimensions].iter().map(|corner| corner.at[axis]).sum::<f64>() / dimensions as f64)
            .collect();
        let mut beyond = |factor: f64| {
            let at: Vec<f64> = centre
                .iter()
                .zip(&worst.at)
                .map(|(centre, worst)| (centre + factor * (centre - worst)).clamp(-1.0, 1.0))
                .collect();
            let value = merit(&at);
            Place { at, value }
        };
        let reflected = beyond(1.0);
        let replacement = if reflected.value > best {
            better(reflected, beyond(2.0))
        } else if reflected.value > corners[dimensions - 1].value {
            reflected
        } else {
            let contracted = if reflected.value > worst.value { beyond(0.5) } else { beyond(-0.5) };
            better(reflected, contracted)
        };
        if replacement.value > worst.value {
            corners[dimensions] = replacement;
            continue;
        }
        let first = corners[0].at.clone();
        for corner in &mut corners[1..] {
            corner.at.iter_mut().zip(&first).for_each(|(own, first)| *own = 0.5 * (*own + first));
            corner.value = merit(&corner.at);
        }
    }
    corners.into_iter().reduce(better).unwrap_or_else(|| start.clone())
}

/// Steps along each axis, halved where none is better.
fn along_axes(mut best: Place, merit: Merit<'_>) -> Place {
    let mut step = STEPS[0];
    while step > STEPS[1] {
        let before = best.value;
        for axis in 0..best.at.len() {
            for direction in [step, -step] {
                let mut at = best.at.clone();
                at[axis] = (at[axis] + direction).clamp(-1.0, 1.0);
                let value = merit(&at);
                best = better(best, Place { at, value });
            }
        }
        if best.value <= before {
            step *= 0.5;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_within_and_one_beyond_the_rim() {
        // −(x − 0.3)² − 10·(y + x − 0.1)²: highest at x = 0.3, y = −0.2. Values are told apart to about 1e-16 there, so
        // places to the root of that.
        let inner = climb(vec![-0.9, 0.9], &mut |at| -(at[0] - 0.3).powi(2) - 10.0 * (at[1] + at[0] - 0.1).powi(2));
        assert!((inner.at[0] - 0.3).abs() < 1e-7 && (inner.at[1] + 0.2).abs() < 1e-7, "{inner:?}");
        // −(x − 2)² − (y + x)²: on the rim x = 1, there at y = −1.
        let rim = climb(vec![0.0, 0.0], &mut |at| -(at[0] - 2.0).powi(2) - (at[1] + at[0]).powi(2));
        assert!((rim.at[0] - 1.0).abs() < 1e-12 && (rim.at[1] + 1.0).abs() < 1e-7, "{rim:?}");
    }

    #[test]
    fn a_bent_ridge_is_followed() {
        // Rosenbrock's function in the box: highest at (0.5, 0.25) with y = x².
        let ridge = climb(vec![-0.8, 0.9], &mut |at| -(at[0] - 0.5).powi(2) - 100.0 * (at[1] - at[0] * at[0]).powi(2));
        assert!((ridge.at[0] - 0.5).abs() < 1e-5 && (ridge.at[1] - 0.25).abs() < 1e-5, "{ridge:?}");
    }

    #[test]
    fn a_function_of_nothing_has_one_value() {
        assert_eq!(climb(Vec::new(), &mut |_| 3.0), Place { at: Vec::new(), value: 3.0 });
    }
}
