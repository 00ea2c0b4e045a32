//! Box-Behnken designs: a few factors at a time at their ends, the others at the centre.
//!
//! G. E. P. Box, D. W. Behnken, Some new three level designs for the study of quantitative variables, Technometrics 2,
//! 455–475 (1960), doi:10.1080/00401706.1960.10489912. Some programs (pyDOE3) take all pairs of factors for any number
//! of them; that agrees with the article up to five factors and needs more points from six on.

use super::definition::{Design, DesignError, Factor, Setting, counted, only_ends, room};
use super::fractional_factorial::combinations;

/// The blocks of the article: which factors, counted from 1, are at their ends together.
fn blocks(factors: usize) -> Option<&'static [&'static [usize]]> {
    Some(match factors {
        3 => &[&[1, 2], &[1, 3], &[2, 3]],
        4 => &[&[1, 2], &[3, 4], &[1, 4], &[2, 3], &[1, 3], &[2, 4]],
        5 => &[&[1, 2], &[3, 4], &[2, 5], &[1, 3], &[4, 5], &[2, 3], &[1, 4], &[3, 5], &[1, 5], &[2, 4]],
        6 => &[&[1, 2, 4], &[2, 3, 5], &[3, 4, 6], &[1, 4, 5], &[2, 5, 6], &[1, 3, 6]],
        7 => &[&[4, 5, 6], &[1, 6, 7], &[2, 5, 7], &[1, 2, 4], &[3, 4, 7], &[1, 3, 5], &[2, 3, 6]],
        _ => return None,
    })
}

/// The blocks, each with all combinations of its factors, and the centre points.
pub(super) fn box_behnken(centre: usize, factors: &[Factor]) -> Result<Design, DesignError> {
    only_ends(factors, "a Box-Behnken design")?;
    let count = factors.len();
    let Some(blocks) = blocks(count) else {
        return Err(DesignError(format!(
            "there is no Box-Behnken design of {}, only of 3 to 7 factors; \
             take a central composite design",
            counted(count)
        )));
    };
    let mut settings = Vec::new();
    for block in blocks {
        let combinations = combinations(block.len(), &[])?;
        for combination in combinations.chunks(block.len()) {
            let start = settings.len();
            settings.resize(start + count, Setting::Coded(0.0));
            for (factor, setting) in block.iter().zip(combination) {
                settings[start + factor - 1] = *setting;
            }
        }
    }
    room((settings.len() / count).checked_add(centre), count)?;
    settings.extend(std::iter::repeat_n(Setting::Coded(0.0), centre * count));
    Design::from_settings(count, settings, None)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PUBLISHED: [usize; 5] = [3, 4, 5, 6, 7];

    #[test]
    fn designs_have_the_numbers_of_points_of_the_article() {
        // Box and Behnken (1960), table 4: points and centre points.
        let sizes = [(15, 3), (27, 3), (46, 6), (54, 6), (62, 6)];
        for (factors, (points, centre)) in PUBLISHED.into_iter().zip(sizes) {
            let design = box_behnken(centre, &vec![Factor::Range; factors]).unwrap();
            assert_eq!(design.points(), points, "{factors} factors");
        }
    }

    #[test]
    fn every_factor_is_in_as_many_blocks_and_meets_every_other() {
        // The definition of (partially) balanced incomplete blocks with two classes of associates, for which numbers of
        // meetings differ by one at most here; without a meeting an interaction could not be estimated.
        for factors in PUBLISHED {
            let blocks = blocks(factors).unwrap();
            let meetings = |one: usize, other: usize| {
                blocks.iter().filter(|block| block.contains(&one) && block.contains(&other)).count()
            };
            let size = blocks[0].len();
            for one in 1..=factors {
                assert_eq!(meetings(one, one) * factors, blocks.len() * size, "{factors} factors");
                let others: Vec<usize> =
                    (1..=factors).filter(|other| *other != one).map(|other| meetings(one, other)).collect();
                let (least, most) = (others.iter().min().unwrap(), others.iter().max().unwrap());
                assert!(*least >= 1 && most - least <= 1, "{factors} factors, factor {one}: {others:?}");
            }
        }
    }

    #[test]
    fn other_numbers_of_factors_are_refused() {
        for factors in [1, 2, 8, 9, 16] {
            let error = box_behnken(3, &vec![Factor::Range; factors]).unwrap_err();
            assert!(error.0.contains("only of 3 to 7 factors"), "{error}");
        }
        assert!(box_behnken(usize::MAX, &[Factor::Range; 3]).is_err());
    }
}
