use proptest::prelude::*;

use super::*;

proptest! {
    #[test]
    fn no_rectangle_has_more_points(columns in 1_usize..8, rows in 1_usize..8, bits: u64, holes in 0_u32..4) {
        let within: Vec<bool> =
            (0..columns * rows).map(|i| holes == 0 || !bits.rotate_left(holes * 7 * i as u32).is_multiple_of(4)).collect();
        let is_full = |x: usize, y: usize, w: usize, h: usize| {
            (x..x + w).all(|column| (y..y + h).all(|row| within[column * rows + row]))
        };
        // Every rectangle there is.
        let mut most = 0;
        for (x, y) in (0..columns).flat_map(|x| (0..rows).map(move |y| (x, y))) {
            for (w, h) in (1..=columns - x).flat_map(|w| (1..=rows - y).map(move |h| (w, h))) {
                if is_full(x, y, w, h) {
                    most = most.max(w * h);
                }
            }
        }
        match largest_rectangle(&within, rows) {
            None => prop_assert_eq!(most, 0),
            Some(Rectangle { first, count }) => {
                prop_assert_eq!(count[0] * count[1], most);
                prop_assert!(is_full(first[0], first[1], count[0], count[1]));
            }
        }
    }
}
