//! Otsu's threshold.

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

#[cfg(test)]
mod tests {
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
