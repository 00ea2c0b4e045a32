//! Factorial designs: all combinations of levels, a fraction of those of two levels, and Plackett-Burman designs, which tell main effects
//! of two levels in the least multiple of four points that is more than the factors.
//!
//! R. L. Plackett, J. P. Burman, The design of optimum multifactorial experiments, Biometrika 33, 305–325 (1946),
//! doi:10.1093/biomet/33.4.305.

use super::definition::{Design, DesignError, Factor, Fraction, Setting, only_ends, room};
use super::generators::{Generator, can_be_named, columns, parse};
use super::minimum_aberration::{COMPLETE, minimum_aberration};
use crate::design::generators::aliases;

/// The fraction, in standard order: the first factor changes fastest.
pub(super) fn fractional_factorial(fraction: &Fraction, factors: &[Factor]) -> Result<Design, DesignError> {
    only_ends(factors, "a fractional factorial design")?;
    let generators = match fraction {
        Fraction::Resolution(resolution) => of_resolution(*resolution, factors.len())?,
        Fraction::Generators(texts) => parse(factors.len(), texts)?,
    };
    let settings = combinations(factors.len(), &generators)?;
    Design::from_settings(factors.len(), settings, aliases(factors.len(), &generators))
}

/// Generators of the smallest fraction of at least this resolution; none where only all combinations have it.
pub(super) fn of_resolution(resolution: u32, factors: usize) -> Result<Vec<Generator>, DesignError> {
    if resolution < 3 {
        return Err(DesignError(format!(
            "a fraction of resolution {resolution} cannot tell main effects from each other; the least is 3"
        )));
    }
    can_be_named(factors)?;
    match minimum_aberration(factors, resolution) {
        Some(words) => parse(factors, &words),
        None if factors <= COMPLETE || resolution as usize > factors => Ok(Vec::new()),
        None => Err(DesignError(format!(
            "no fraction of resolution {resolution} is tabulated for {factors} factors: it has more than 4096 points; \
             take a lower resolution or give the generators"
        ))),
    }
}

/// The coded settings of all combinations of the base factors, the first changing fastest, and of the added factors.
pub(super) fn combinations(factors: usize, generators: &[Generator]) -> Result<Vec<Setting>, DesignError> {
    let columns = columns(factors, generators);
    let points = u32::try_from(factors - generators.len()).ok().and_then(|base| 1_usize.checked_shl(base));
    let points = room(points, factors)?;
    let mut settings = Vec::with_capacity(points * factors);
    // `room` admits fewer than 2³² points.
    for run in 0..points as u32 {
        settings.extend(columns.iter().map(|column| Setting::Coded(column.sign(run))));
    }
    Ok(settings)
}

/// Every combination of the levels, the first factor changing fastest (as in R's `expand.grid` and pyDOE's `fullfact`).
/// The ends of a range are its levels.
pub(super) fn full_factorial(factors: &[Factor]) -> Result<Design, DesignError> {
    let counts: Vec<usize> = factors.iter().map(Factor::levels).collect();
    let points = counts.iter().try_fold(1_usize, |points, count| points.checked_mul(*count));
    let points = room(points, factors.len())?;
    let mut settings = Vec::with_capacity(points * factors.len());
    let mut levels = vec![0; factors.len()];
    for _ in 0..points {
        settings.extend(factors.iter().zip(&levels).map(|(factor, level)| at(factor, *level)));
        for (level, count) in levels.iter_mut().zip(&counts) {
            *level += 1;
            if *level < *count {
                break;
            }
            *level = 0;
        }
    }
    Design::from_settings(factors.len(), settings, None)
}

fn at(factor: &Factor, level: usize) -> Setting {
    match factor {
        Factor::Levels(_) => Setting::Level(level),
        Factor::Range => Setting::Coded(if level == 0 { -1.0 } else { 1.0 }),
    }
}

/// Most factors.
const MOST_FACTORS: usize = 23;

/// First rows of the designs whose other rows follow by turning it, with a last row of minus signs.
const CYCLIC: &[&str] = &[
    // Not in the article: the smallest, one half of three factors.
    "++-",
    "+++-+--",
    "++-+++---+-",
    "++++-+-++--+---",
    "++--++++-+-+----++-",
    "+++++-+-++--++--+-+----",
];

/// The first columns of the design.
pub(super) fn plackett_burman(factors: &[Factor]) -> Result<Design, DesignError> {
    only_ends(factors, "a Plackett-Burman design")?;
    if factors.len() > MOST_FACTORS {
        let found = factors.len();
        return Err(DesignError(format!(
            "a Plackett-Burman design has at most {MOST_FACTORS} factors here, not {found}"
        )));
    }
    let rows = rows(4 * (factors.len() / 4 + 1));
    let settings = rows.iter().flat_map(|row| &row[..factors.len()]).map(|sign| Setting::Coded(f64::from(*sign)));
    Design::from_settings(factors.len(), settings.collect(), None)
}

/// All columns of the design of so many points, a multiple of four up to 24.
fn rows(points: usize) -> Vec<Vec<i8>> {
    let row = CYCLIC[points / 4 - 1];
    let turn = |by: usize| [&signs(row)[row.len() - by..], &signs(row)[..row.len() - by]].concat();
    (0..row.len()).map(turn).chain([vec![-1; row.len()]]).collect()
}

fn signs(row: &str) -> Vec<i8> {
    row.chars().map(|sign| if sign == '+' { 1 } else { -1 }).collect()
}

#[cfg(test)]
#[path = "../../tests/unit/design/factorial.rs"]
mod tests;
