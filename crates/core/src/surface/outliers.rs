//! Outliers: heights that no surface has, as spikes and dropouts of an optical instrument.

/// Standard deviation of a normal distribution over its median absolute deviation, 1/Φ⁻¹(¾).
const NORMAL: f64 = 1.482_602_218_505_602;

/// Makes every point missing that lies further than `limit` robust standard deviations from the median.
///
/// The robust standard deviation is 1.4826 times the median absolute deviation from the median, which up to half of the
/// points being outliers cannot carry away (Rousseeuw and Croux 1993, doi:10.1080/01621459.1993.10476408).
/// Gives the number of points and the distance from the median in m; `None`, and nothing done, when half of the points
/// or more have the median's height, so that there is no such deviation.
pub(super) fn remove_outliers(heights: &mut [f64], limit: f64) -> Option<(usize, f64)> {
    let mut sorted: Vec<f64> = heights.iter().copied().filter(|height| !height.is_nan()).collect();
    let median = median(&mut sorted)?;
    sorted.iter_mut().for_each(|height| *height = (*height - median).abs());
    let distance = limit * NORMAL * self::median(&mut sorted)?;
    if distance == 0.0 {
        return None;
    }
    let mut count = 0;
    for height in heights.iter_mut().filter(|height| (**height - median).abs() > distance) {
        *height = f64::NAN;
        count += 1;
    }
    Some((count, distance))
}

/// Median; of an even number of values the mean of the two in the middle. Reorders the values.
fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    if values.is_empty() {
        return None;
    }
    let even = values.len().is_multiple_of(2);
    let (below, upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    let lower = below.iter().copied().max_by(f64::total_cmp).filter(|_| even).unwrap_or(*upper);
    Some(0.5 * lower + 0.5 * *upper)
}
