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
