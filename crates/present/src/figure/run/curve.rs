//! Curves with gaps: their pieces, and means of their points with those beside them.

/// The pieces of a curve whose points have gaps between them: those that are no numbers.
pub fn pieces(points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let is_number = |point: &[f64; 2]| point[1].is_finite();
    points.split(|point| !is_number(point)).filter(|piece| !piece.is_empty()).map(<[_]>::to_vec).collect()
}

/// Means of every value and those beside it, with weights that fall to nothing at so many places from it; near the begin, where most
/// happens, of as few as there are before it, near the end of those before it.
pub fn weighted(points: &[[f64; 2]], beside: usize) -> Vec<[f64; 2]> {
    let mean = |at: usize| {
        let reach = (beside - 1).min(at);
        let part = |other: usize| (reach + 1 - at.abs_diff(other)) as f64;
        let around = at - reach..=(at + reach).min(points.len() - 1);
        let (sum, weights) = around
            .fold((0.0, 0.0), |(sum, weights), other| (sum + part(other) * points[other][1], weights + part(other)));
        [points[at][0], sum / weights]
    };
    (0..points.len()).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_broken_where_there_is_no_number() {
        let [gap, one, two, three] = [f64::NAN, 1.0, 2.0, 3.0].map(|value| [value, value]);
        assert_eq!(pieces(&[gap, one, two, gap, gap, three]), [vec![one, two], vec![three]]);
        assert_eq!(pieces(&[gap]), [[[0.0; 2]; 0]; 0]);
    }

    #[test]
    fn weights_fall_with_distance() {
        // By hand: 1, 2, 3, 2, 1 in the middle, 1, 2, 1 behind the begin; 1, 2, 3, 2 and 1, 2, 3 at the end.
        let points = [0.0, 0.0, 9.0, 0.0, 0.0].map(|value| [1.0, value]);
        let means: Vec<f64> = weighted(&points, 3).iter().map(|point| point[1]).collect();
        assert_eq!(means, [0.0, 2.25, 3.0, 2.25, 1.5]);
    }
}
