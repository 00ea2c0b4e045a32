//! How much the parameters of a patch scatter, which is cut out of a larger surface.

use rayon::prelude::*;

use super::{Description, Grid, PARAMETERS};

/// Most cut-outs that are looked at.
const MOST_PARTS: usize = 64;

/// Standard deviation of every parameter of [`PARAMETERS`] over cut-outs of so many columns and rows of a surface, in its SI
/// unit: the standard error of a patch of that size. NaN with fewer than two cut-outs, or where one of them has no value.
pub fn sampling_errors(surface: &Grid, [columns, rows]: [usize; 2]) -> Vec<f64> {
    let starts = |length: usize, part: usize| (0..length / part.max(1)).map(move |index| index * part);
    let parts: Vec<[usize; 2]> =
        starts(surface.columns, columns).flat_map(|x| starts(surface.rows, rows).map(move |y| [x, y])).collect();
    // Evenly over the whole surface, where there are more.
    let every = parts.len().div_ceil(MOST_PARTS).max(1);
    let describe = |[x, y]: &[usize; 2]| {
        let of_column = |column: usize| &surface.heights[column * surface.rows + y..][..rows];
        let heights: Vec<f64> = (*x..x + columns).flat_map(of_column).copied().collect();
        Description::of(&Grid { columns, rows, pitch: surface.pitch, heights: &heights })
    };
    let chosen: Vec<[usize; 2]> = parts.into_iter().step_by(every).collect();
    let descriptions: Vec<Description> = chosen.par_iter().filter_map(describe).collect();
    let count = descriptions.len() as f64;
    let error = |value: fn(&Description) -> Option<f64>| {
        let values: Vec<f64> = descriptions.iter().map(|part| value(part).unwrap_or(f64::NAN)).collect();
        let mean = values.iter().sum::<f64>() / count;
        (values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / (count - 1.0)).sqrt()
    };
    PARAMETERS.iter().map(|parameter| error(parameter.value)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::random::{Random, Stream};

    #[test]
    fn independent_normal_heights_have_the_error_of_the_textbook() {
        // The standard error of the standard deviation of n normal numbers is σ/√(2n); its estimate from 64 cut-outs is off
        // by 1/√128 of itself, once. Four times.
        let (mut random, side) = (Random::new(5, Stream::DiscHeight), 120);
        let heights: Vec<f64> = (0..side * side).map(|_| random.normal()).collect();
        let surface = Grid { columns: side, rows: side, pitch: None, heights: &heights };
        let errors = sampling_errors(&surface, [15, 15]);
        let of_sq = PARAMETERS.iter().position(|parameter| parameter.symbol == "Sq").unwrap();
        let expected = 1.0 / (2.0 * 225.0_f64).sqrt();
        assert!((errors[of_sq] / expected - 1.0).abs() < 4.0 / 128.0_f64.sqrt(), "{} for {expected}", errors[of_sq]);
        assert!(sampling_errors(&surface, [200, 15])[of_sq].is_nan(), "no cut-out");
    }
}
