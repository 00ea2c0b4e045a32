//! Designs for quadratic response surfaces.
//!
//! Central composite designs have two-level combinations, axial points and centre points: G. E. P. Box, K. B. Wilson, On the experimental
//! attainment of optimum conditions, J. R. Stat. Soc. B 13, 1–45 (1951); G. E. P. Box, J. S. Hunter, Multi-factor experimental designs for
//! exploring response surfaces, Ann. Math. Stat. 28, 195–241 (1957), doi:10.1214/aoms/1177707047.
//!
//! Box-Behnken designs have a few factors at a time at their ends, the others at the centre: G. E. P. Box, D. W. Behnken, Some new three
//! level designs for the study of quantitative variables, Technometrics 2, 455–475 (1960), doi:10.1080/00401706.1960.10489912. Some programs
//! (pyDOE3) take all pairs of factors for any number of them; that agrees with the article up to five factors and needs more points from
//! six on.

use super::definition::{Alpha, Design, DesignError, Factor, Setting, counted, only_ends, room};
use super::factorial::{combinations, of_resolution};

/// Up to so many factors the core has all combinations; beyond, a fraction of resolution V, which tells all two-factor
/// interactions apart.
const WHOLE_CORE: usize = 4;

/// Core, its centre points, axial points (lower and upper of each factor), their centre points.
///
/// The core lies at −1 and 1, so axial points with a larger alpha lie outside the range.
pub(super) fn central_composite(alpha: Alpha, centre: [usize; 2], factors: &[Factor]) -> Result<Design, DesignError> {
    only_ends(factors, "a central composite design")?;
    let count = factors.len();
    let generators = if count <= WHOLE_CORE { Vec::new() } else { of_resolution(5, count)? };
    let mut settings = combinations(count, &generators)?;
    let core = settings.len() / count;
    let outer = centre[0].checked_add(centre[1]).and_then(|centre| centre.checked_add(core + 2 * count));
    room(outer, count)?;
    let distance = distance(alpha, core as f64, count as f64, centre.map(|points| points as f64));
    let at_centre = |points: usize| std::iter::repeat_n(Setting::Coded(0.0), points * count);
    settings.extend(at_centre(centre[0]));
    for axis in 0..count {
        for end in [-distance, distance] {
            settings.extend((0..count).map(|factor| Setting::Coded(if factor == axis { end } else { 0.0 })));
        }
    }
    settings.extend(at_centre(centre[1]));
    Design::from_settings(count, settings, None)
}

/// Distance of the axial points.
fn distance(alpha: Alpha, core: f64, factors: f64, [with_core, with_axial]: [f64; 2]) -> f64 {
    match alpha {
        // Two square roots, which are the same on every machine.
        Alpha::Rotatable => core.sqrt().sqrt(),
        Alpha::Orthogonal => (factors * (1.0 + with_axial / (2.0 * factors)) / (1.0 + with_core / core)).sqrt(),
        Alpha::Face => 1.0,
    }
}

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
#[path = "../../tests/unit/design/response_surface.rs"]
mod tests;
