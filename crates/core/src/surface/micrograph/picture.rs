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
