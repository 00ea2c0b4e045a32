//! How far the heights of one surface are from those of another.

/// Area-weighted rms of the difference of two fields, m; `areas` are those of the cells of a column.
pub fn rms_difference(heights: &[f64], reference: &[f64], areas: &[f64]) -> f64 {
    about(0.0, heights, reference, areas)
}

/// The same after the mean of the difference is taken out: how far the shapes are from each other.
pub fn rms_difference_about_mean(heights: &[f64], reference: &[f64], areas: &[f64]) -> f64 {
    let mean = weighted_mean(heights.iter().zip(reference).map(|(a, b)| a - b), areas);
    about(mean, heights, reference, areas)
}

fn about(level: f64, heights: &[f64], reference: &[f64], areas: &[f64]) -> f64 {
    weighted_mean(heights.iter().zip(reference).map(|(a, b)| (a - b - level).powi(2)), areas).sqrt()
}

fn weighted_mean(values: impl Iterator<Item = f64>, areas: &[f64]) -> f64 {
    let (sum, area) = values
        .zip(areas.iter().cycle())
        .fold((0.0, 0.0), |(sum, area), (value, weight)| (sum + value * weight, area + weight));
    sum / area
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_count_by_their_areas() {
        // Two columns of two rows with areas 1 and 3; differences 0, 2, 0, 2: mean square (3·4 + 3·4)/8 = 3, mean 1.5,
        // and about it 3 − 2.25 = 0.75.
        let (heights, reference, areas) = ([5.0, 9.0, 1.0, 4.0], [5.0, 7.0, 1.0, 2.0], [1.0, 3.0]);
        assert!((rms_difference(&heights, &reference, &areas) - 3_f64.sqrt()).abs() < 1e-15);
        assert!((rms_difference_about_mean(&heights, &reference, &areas) - 0.75_f64.sqrt()).abs() < 1e-15);
    }
}
