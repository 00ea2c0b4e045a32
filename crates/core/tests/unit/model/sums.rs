use super::*;

#[test]
fn ten_million_tenths_make_a_million() {
    // The exact sum of the doubles nearest to 0.1 is 1e6 (1 + 5.55e-17); plain summation is off by 1e-10 relative.
    let mut sum = RunningSum::default();
    (0..10_000_000).for_each(|_| sum.add(0.1));
    assert_eq!(sum.value(), 1e6);
}

#[test]
fn small_terms_survive_a_large_one() {
    let mut sum = RunningSum::default();
    [1.0, 1e100, 1.0, -1e100].into_iter().for_each(|term| sum.add(term));
    assert_eq!(sum.value(), 2.0);
}

#[test]
fn the_mean_is_over_all_steps_until_a_revolution_is_done() {
    let mut revolution = Revolution::new(4);
    assert_eq!((revolution.newest(), revolution.mean()), (None, 0.0));
    let means = [1.0, 3.0, 5.0, 7.0, 9.0, 11.0].map(|value| {
        revolution.record(value);
        assert_eq!(revolution.newest(), Some(value));
        revolution.mean()
    });
    assert_eq!(means, [1.0, 2.0, 3.0, 4.0, 6.0, 8.0]);
    assert_eq!(revolution.sum(), 32.0);
}
