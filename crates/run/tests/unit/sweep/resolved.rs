use super::*;

fn length(duration: f64, revolutions: Option<f64>) -> RunLength {
    RunLength { duration, revolutions }
}

#[test]
fn a_tenth_with_few_revolutions_is_said_to_be_longer() {
    assert_eq!(longer(&[length(60.0, Some(100.0)), length(60.0, None)]), None);
    let some = longer(&[length(60.0, Some(40.0)), length(60.0, Some(200.0))]).unwrap();
    assert!(some.contains("in 1 of 2 runs") && some.contains("over the last 15 s of 60 s"), "{some}");
    let all = longer(&[length(60.0, Some(8.5))]).unwrap();
    assert!(all.contains("with 8.5 revolutions in all it is over all of the 60 s"), "{all}");
}

#[test]
fn a_few_are_taken_from_all_over() {
    assert_eq!(super::spread(5, 9).collect::<Vec<_>>(), [1, 2, 3, 4, 5]);
    assert_eq!(super::spread(100, 3).collect::<Vec<_>>(), [1, 50, 100]);
    assert_eq!(super::spread(1, 3).collect::<Vec<_>>(), [1]);
}
