//! Pictures, pixels line by line: Gaussian smoothing, Otsu's threshold, removal of specks.

use super::super::gaussian_filter::mirrored;

/// A picture; its first line is at the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture<T> {
    /// Pixels of a line.
    pub width: usize,
    /// Lines.
    pub height: usize,
    /// Pixels, line by line.
    pub pixels: Vec<T>,
}

impl<T: Copy> Picture<T> {
    /// Turned counterclockwise by quarters of a turn.
    pub(super) fn turned(self, quarters: u8) -> Self {
        let Self { width, height, ref pixels } = self;
        let old = |x: usize, y: usize| pixels[y * width + x];
        match quarters % 4 {
            // What was the right edge is the new top.
            1 => Self::from_fn(height, width, |x, y| old(width - 1 - y, x)),
            2 => Self::from_fn(width, height, |x, y| old(width - 1 - x, height - 1 - y)),
            3 => Self::from_fn(height, width, |x, y| old(y, height - 1 - x)),
            _ => self,
        }
    }

    fn from_fn(width: usize, height: usize, pixel: impl Fn(usize, usize) -> T) -> Self {
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
        Self { width, height, pixels }
    }
}

impl Picture<bool> {
    /// Fraction of the pixels that are set.
    pub fn fraction(&self) -> f64 {
        self.pixels.iter().filter(|pixel| **pixel).count() as f64 / self.pixels.len() as f64
    }
}

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

/// Grey levels that are told apart: those of 16 bits. Those of 8 bits are every 257th of them.
const LEVELS: usize = 1 << 16;

/// The grey level, 0 to 1, that parts darker pixels from brighter ones so that the variance between the two classes,
/// ω₁ω₂(μ₁ − μ₂)², is largest (Otsu 1979, DOI 10.1109/TSMC.1979.4310076, eq. 14); of several such levels the darkest.
/// It lies half a level of 16 bits above the brightest of the darker class. None if all pixels are alike.
pub(super) fn otsu(levels: &[f32]) -> Option<f64> {
    let top = (LEVELS - 1) as f64;
    let mut histogram = vec![0.0; LEVELS];
    for level in levels {
        histogram[((f64::from(*level) * top).round() as usize).min(LEVELS - 1)] += 1.0;
    }
    let total = levels.len() as f64;
    let sum: f64 = histogram.iter().enumerate().map(|(level, count)| level as f64 * count).sum();
    let (mut darker, mut darker_sum) = (0.0, 0.0);
    let (mut best, mut threshold) = (0.0, None);
    for (level, count) in histogram.iter().enumerate() {
        darker += count;
        darker_sum += level as f64 * count;
        let brighter = total - darker;
        if darker == 0.0 || brighter == 0.0 {
            continue;
        }
        let distance = darker_sum / darker - (sum - darker_sum) / brighter;
        let variance = darker * brighter * distance * distance;
        if variance > best {
            (best, threshold) = (variance, Some((level as f64 + 0.5) / top));
        }
    }
    threshold
}

/// Turns every region of `value` of fewer than `smallest` pixels into its opposite; gives their number. Pixels belong
/// together that share a side.
pub(super) fn despeckle(picture: &mut Picture<bool>, value: bool, smallest: usize) -> usize {
    let Picture { width, ref mut pixels, .. } = *picture;
    let mut seen = vec![false; pixels.len()];
    let mut region = Vec::new();
    let mut specks = 0;
    for start in 0..pixels.len() {
        if pixels[start] != value || seen[start] {
            continue;
        }
        seen[start] = true;
        region.clear();
        region.push(start);
        let mut next = 0;
        while let Some(&pixel) = region.get(next) {
            next += 1;
            for neighbour in neighbours(pixel, width, pixels.len()).into_iter().flatten() {
                if pixels[neighbour] == value && !seen[neighbour] {
                    seen[neighbour] = true;
                    region.push(neighbour);
                }
            }
        }
        if region.len() < smallest {
            specks += 1;
            region.iter().for_each(|pixel| pixels[*pixel] = !value);
        }
    }
    specks
}

/// Pixels that share a side with this one.
fn neighbours(pixel: usize, width: usize, count: usize) -> [Option<usize>; 4] {
    let x = pixel % width;
    [
        (x > 0).then(|| pixel - 1),
        (x + 1 < width).then_some(pixel + 1),
        pixel.checked_sub(width),
        (pixel + width < count).then_some(pixel + width),
    ]
}

#[cfg(test)]
mod picture_tests {
    use super::*;

    #[test]
    fn turns_counterclockwise() {
        // numpy.rot90([[1, 2, 3], [4, 5, 6]], k)
        let picture = Picture { width: 3, height: 2, pixels: vec![1, 2, 3, 4, 5, 6] };
        for (quarters, width, pixels) in [
            (0, 3, [1, 2, 3, 4, 5, 6]),
            (1, 2, [3, 6, 2, 5, 1, 4]),
            (2, 3, [6, 5, 4, 3, 2, 1]),
            (3, 2, [4, 1, 5, 2, 6, 3]),
        ] {
            let turned = picture.clone().turned(quarters);
            assert_eq!((turned.width, turned.height), (width, 6 / width));
            assert_eq!(turned.pixels, pixels, "{quarters}");
        }
    }
}

#[cfg(test)]
mod smooth_tests {
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

#[cfg(test)]
mod otsu_tests {
    use super::*;

    /// Grey levels with their counts, and the level that is found.
    const OTSU: &[(&[(u8, usize)], u8)] = &[
        (&[(10, 5), (20, 9), (30, 4), (180, 3), (200, 12), (230, 2)], 30),
        (&[(0, 100), (1, 90), (2, 50), (3, 5), (4, 1)], 0),
        (
            &[
                (0, 1),
                (25, 2),
                (50, 5),
                (75, 10),
                (100, 17),
                (125, 26),
                (150, 8),
                (175, 21),
                (200, 7),
                (225, 24),
                (250, 14),
            ],
            150,
        ),
        (&[(100, 50), (120, 40), (140, 45), (160, 3)], 120),
    ];

    fn bytes(counts: &[(u8, usize)]) -> Vec<f32> {
        counts.iter().flat_map(|(level, count)| vec![f32::from(*level) / 255.0; *count]).collect()
    }

    #[test]
    fn parts_two_levels_above_the_darker() {
        assert_eq!(otsu(&bytes(&[(50, 10), (200, 30)])), Some((50.0 * 257.0 + 0.5) / 65535.0));
        assert_eq!(otsu(&bytes(&[(0, 1), (255, 1000)])), Some(0.5 / 65535.0));
    }

    #[test]
    fn agrees_with_scikit_image() {
        // skimage 0.26.0 filters.threshold_otsu on 8-bit pictures of these counts.
        for (counts, expected) in OTSU {
            let found = otsu(&bytes(counts)).unwrap();
            assert_eq!(found, (f64::from(*expected) * 257.0 + 0.5) / 65535.0);
        }
    }

    #[test]
    fn one_level_has_no_threshold() {
        assert_eq!(otsu(&bytes(&[(77, 9)])), None);
        assert_eq!(otsu(&[]), None);
    }
}

#[cfg(test)]
mod despeckle_tests {
    use super::*;

    fn picture(lines: &[&str]) -> Picture<bool> {
        let pixels = lines.iter().flat_map(|line| line.chars()).map(|pixel| pixel == '#').collect();
        Picture { width: lines[0].len(), height: lines.len(), pixels }
    }

    #[test]
    fn takes_away_what_is_small_and_leaves_the_rest() {
        // Regions of 1, 2 and 5 pixels that touch each other at corners only.
        let before = picture(&["#....##", ".##....", "...#...", "..###..", "...#..."]);
        for (smallest, specks, after) in [
            (1, 0, ["#....##", ".##....", "...#...", "..###..", "...#..."]),
            (2, 1, [".....##", ".##....", "...#...", "..###..", "...#..."]),
            (3, 3, [".......", ".......", "...#...", "..###..", "...#..."]),
            (6, 4, [".......", ".......", ".......", ".......", "......."]),
        ] {
            let mut found = before.clone();
            assert_eq!(despeckle(&mut found, true, smallest), specks);
            assert_eq!(found, picture(&after), "{smallest}");
        }
    }

    #[test]
    fn fills_holes() {
        let mut found = picture(&["#####", "#.#.#", "###.#", "#####"]);
        assert_eq!(despeckle(&mut found, false, 2), 1);
        assert_eq!(found, picture(&["#####", "###.#", "###.#", "#####"]));
    }
}
