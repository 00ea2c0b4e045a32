//! Numbers of lines or coordinates beside a matrix, which are no heights.

/// Fewest numbers that are looked at: four heights in a row may be evenly spaced by chance.
const FEWEST: usize = 6;
/// Numbers that are off by no more than this, in steps, are evenly spaced: labels are often rounded.
const OFF: f64 = 0.05;

/// What of a matrix, in columns of so many rows, counts evenly while its neighbour does not: its first column, and its first line.
pub(super) fn labels(heights: &[f64], rows: usize) -> impl Iterator<Item = String> {
    let at = |column: usize, row: usize| heights[column * rows + row];
    let columns = heights.len() / rows.max(1);
    let line = move |row: usize| (1..columns).map(move |column| at(column, row)).collect::<Vec<_>>();
    // The first number of each may be the corner of both.
    let column = move |column: usize| (1..rows).map(move |row| at(column, row)).collect::<Vec<_>>();
    let told = |what: &str, numbers: Vec<f64>, beside: Vec<f64>| {
        let [first, last] = [*numbers.first()?, *numbers.last()?];
        (is_even(&numbers) && !is_even(&beside)).then(|| {
            format!(
                "the first {what} counts evenly to {last}, from {first} on, and the next does not: if it has numbers of lines or coordinates, \
                 take it out, for it is read as heights"
            )
        })
    };
    let has_next = columns > 1 && rows > 1;
    let of_column = has_next.then(|| told("column", column(0), column(1))).flatten();
    let of_line = has_next.then(|| told("line", line(0), line(1))).flatten();
    of_column.into_iter().chain(of_line)
}

/// Whether numbers are evenly spaced, and not all the same.
fn is_even(numbers: &[f64]) -> bool {
    let [first, .., last] = *numbers else { return false };
    let step = (last - first) / (numbers.len() - 1) as f64;
    let is_there = |(place, number): (usize, &f64)| (number - first - step * place as f64).abs() <= OFF * step.abs();
    numbers.len() >= FEWEST && step != 0.0 && numbers.iter().enumerate().all(is_there)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rough heights of 8 columns by 7 rows, column by column.
    fn rough() -> Vec<f64> {
        (0..56).map(|point| f64::from(point * point % 17) / 7.0).collect()
    }

    #[test]
    fn numbers_of_lines_and_coordinates_are_told() {
        assert_eq!(labels(&rough(), 7).count(), 0);
        // As pandas writes a table: numbers of lines in front of them, an empty corner, and numbers of columns above.
        let mut table = rough();
        (0..7).for_each(|row| table[row] = row as f64 - 1.0);
        let told: Vec<_> = labels(&table, 7).collect();
        assert_eq!(told.len(), 1, "{told:?}");
        assert!(told[0].starts_with("the first column counts evenly to 5, from 0 on"), "{told:?}");
        table[0] = f64::NAN;
        // Coordinates in mm, rounded.
        (1..8).for_each(|column| table[7 * column] = [0.33, 0.67, 1.0, 1.33, 1.67, 2.0, 2.33][column - 1]);
        assert_eq!(labels(&table, 7).count(), 2);
    }

    #[test]
    fn a_plane_steps_and_a_few_heights_have_none() {
        let plane: Vec<f64> = (0..56).map(f64::from).collect();
        let level = [1.0; 56];
        assert_eq!([labels(&plane, 7).count(), labels(&level, 7).count()], [0, 0]);
        // Four lines and four columns are too few to tell; a profile has nothing beside it.
        let mut few: Vec<f64> = (0..16).map(|point| f64::from(point * point % 7)).collect();
        (0..4).for_each(|row| few[row] = row as f64);
        assert_eq!([labels(&few, 4).count(), labels(&plane, 1).count(), labels(&plane, 56).count()], [0; 3]);
        assert_eq!(labels(&[], 0).count(), 0);
    }
}
