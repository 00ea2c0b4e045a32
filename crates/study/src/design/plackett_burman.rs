//! Plackett-Burman designs: main effects of two levels in the least multiple of four points that is more than the
//! factors.
//!
//! R. L. Plackett, J. P. Burman, The design of optimum multifactorial experiments, Biometrika 33, 305–325 (1946),
//! doi:10.1093/biomet/33.4.305.

use super::definition::{Design, DesignError, Factor, Setting, only_ends};

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
mod tests {
    use super::*;

    #[test]
    fn columns_of_every_size_are_balanced_and_orthogonal() {
        // The definition: 1 + factors columns, the first all 1, are a Hadamard matrix.
        for points in (4..=24).step_by(4) {
            let rows = rows(points);
            assert_eq!(rows.len(), points);
            assert!(rows.iter().all(|row| row.len() == points - 1));
            for one in 0..points - 1 {
                assert_eq!(rows.iter().map(|row| i32::from(row[one])).sum::<i32>(), 0, "{points} points: {one}");
                for other in 0..one {
                    let product: i32 = rows.iter().map(|row| i32::from(row[one] * row[other])).sum();
                    assert_eq!(product, 0, "{points} points: {one} and {other}");
                }
            }
        }
    }

    #[test]
    fn rows_of_a_prime_number_of_columns_are_its_quadratic_residues() {
        // R. E. A. C. Paley, On orthogonal matrices, J. Math. Phys. 12, 311–320 (1933): + at 0 and at the squares.
        for prime in [3, 7, 11, 19, 23] {
            let squares: Vec<usize> = (1..prime).map(|root| root * root % prime).collect();
            let row: String = (0..prime).map(|at| if at == 0 || squares.contains(&at) { '+' } else { '-' }).collect();
            assert!(CYCLIC.contains(&row.as_str()), "{prime}: {row}");
        }
    }

    #[test]
    fn any_number_of_factors_up_to_23_has_the_next_multiple_of_four() {
        for factors in 1..=23 {
            let design = plackett_burman(&vec![Factor::Levels(2); factors]).unwrap();
            assert_eq!(design.points(), (factors + 1).next_multiple_of(4));
            assert_eq!(design.point(0).len(), factors);
        }
        assert!(plackett_burman(&[Factor::Range; 24]).unwrap_err().0.contains("at most 23"));
    }
}
