#[test]
fn a_few_are_taken_from_all_over() {
    assert_eq!(super::spread(5, 9).collect::<Vec<_>>(), [1, 2, 3, 4, 5]);
    assert_eq!(super::spread(100, 3).collect::<Vec<_>>(), [1, 50, 100]);
    assert_eq!(super::spread(1, 3).collect::<Vec<_>>(), [1]);
}
