use super::*;

#[test]
fn common_multiples_are_found_where_there_are_small_ones() {
    assert_eq!(common_multiple(&[1.0, 2.0, 5.0, 10.0]), 10.0);
    assert_eq!(common_multiple(&[1.0, 10.0, 20.0, 50.0]), 100.0);
    assert_eq!(common_multiple(&[2.5, 3.0, 10.0]), 30.0);
    assert_eq!(common_multiple(&[7.3, 100.0]), 100.0);
}

#[test]
fn windows_are_whole_units_and_wide_enough() {
    for (duration, unit, least, width, count) in [
        (3000.0, 70.0, 5.0, 70.0, 42),
        (3000.0, 0.75, 5.0, 5.25, 571),
        (60.0, 2.5, 5.0, 5.0, 12),
        (2.0, 0.75, 5.0, 2.0, 1),
        (7.0, 8.0, 5.0, 7.0, 1),
    ] {
        assert_eq!(Windows::new(duration, unit, least), Windows { width, count });
    }
    assert_eq!(Windows::new(10.0, 5.0, 5.0).ends().collect::<Vec<_>>(), [5.0, 10.0]);
}
