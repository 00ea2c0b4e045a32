//! Gaussian smoothing.

use super::super::mirrored::mirrored;
use super::Picture;

/// The kernel ends after this many standard deviations.
const REACH: f64 = 4.0;

/// Pixels that a kernel of this standard deviation (pixels) reaches to either side.
pub(super) fn reach(sigma: f64) -> usize {
    (REACH * sigma).round() as usize
}

/// Smooths with a Gaussian kernel of standard deviation `sigma` (pixels), cut off at four of them; beyond its edges the
/// picture is continued by its mirror image.
pub(super) fn smooth(picture: &Picture<f32>, sigma: f64) -> Picture<f32> {
    let Picture { width, height, ref pixels } = *picture;
    let reach = reach(sigma);
    let kernel = kernel(sigma, reach);
    let mut along = Vec::with_capacity(pixels.len());
    for line in pixels.chunks_exact(width) {
        let padded: Vec<f64> = (0..width + 2 * reach).map(|at| f64::from(line[mirrored(at, reach, width)])).collect();
        along.extend(
            padded.windows(kernel.len()).map(|part| part.iter().zip(&kernel).map(|(p, k)| p * k).sum::<f64>() as f32),
        );
    }
    let mut smoothed = Vec::with_capacity(pixels.len());
    let mut sums = vec![0.0; width];
    for y in 0..height {
        sums.fill(0.0);
        for (offset, weight) in kernel.iter().enumerate() {
            let from = mirrored(y + offset, reach, height) * width;
            sums.iter_mut().zip(&along[from..from + width]).for_each(|(sum, level)| *sum += weight * f64::from(*level));
        }
        smoothed.extend(sums.iter().map(|sum| *sum as f32));
    }
    Picture { width, height, pixels: smoothed }
}

fn kernel(sigma: f64, reach: usize) -> Vec<f64> {
    let weights: Vec<f64> = (0..=2 * reach)
        .map(|at| {
            let place = (at as f64 - reach as f64) / sigma;
            libm::exp(-0.5 * place * place)
        })
        .collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SMOOTHED: &[(f64, [f64; 35])] = &[
        (
            0.7,
            [
                0.073148582,
                0.181265912,
                0.269377731,
                0.395367450,
                0.452719518,
                0.311529775,
                0.434446720,
                0.278102007,
                0.468881641,
                0.419447312,
                0.375849305,
                0.334997778,
                0.335587463,
                0.386024269,
                0.415054783,
                0.473637984,
                0.322733567,
                0.315806256,
                0.286760820,
                0.435340065,
                0.461648986,
                0.243624394,
                0.243245326,
                0.167365873,
                0.245309963,
                0.293045656,
                0.418496175,
                0.513319831,
                0.184064740,
                0.310054829,
                0.284856205,
                0.474033799,
                0.458460099,
                0.378857142,
                0.357538044,
            ],
        ),
        (
            1.6,
            [
                0.259295678,
                0.286634557,
                0.322412024,
                0.350558391,
                0.368189294,
                0.380678506,
                0.389670491,
                0.288103925,
                0.305993557,
                0.328466846,
                0.347446288,
                0.364494721,
                0.382057897,
                0.395389224,
                0.304510992,
                0.313800294,
                0.326201596,
                0.341152741,
                0.361820562,
                0.386050933,
                0.403716476,
                0.291053163,
                0.300568774,
                0.316677627,
                0.338776141,
                0.365309824,
                0.390911306,
                0.407446887,
                0.271767523,
                0.286099352,
                0.311191221,
                0.342204069,
                0.371762884,
                0.393805253,
                0.405780985,
            ],
        ),
    ];

    #[test]
    fn agrees_with_scipy() {
        // scipy 1.17.1 ndimage.gaussian_filter(numpy.arange(35).reshape(5, 7)**2 % 23 / 23, sigma), its default mode and
        // truncation, in float64; the levels of a picture here are float32, twice rounded: 2⁻²⁴ each.
        let pixels = (0..35).map(|i| ((i * i % 23) as f64 / 23.0) as f32).collect();
        let picture = Picture { width: 7, height: 5, pixels };
        for (sigma, expected) in SMOOTHED {
            let found = smooth(&picture, *sigma);
            for (found, expected) in found.pixels.iter().zip(expected) {
                assert!((f64::from(*found) - expected).abs() < 2.0e-7, "{found} {expected}");
            }
        }
    }
}
