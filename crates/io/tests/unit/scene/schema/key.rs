use super::*;

#[test]
fn ranges_say_what_they_contain() {
    let poisson = Range::new(-1.0, false, 0.5, true);
    assert_eq!(poisson.to_string(), "more than -1 and at most 0.5");
    for (number, inside) in [(-1.0, false), (-0.99, true), (0.5, true), (0.51, false), (f64::NAN, false)] {
        assert_eq!(poisson.contains(number), inside, "{number}");
    }
    assert!(!Range::ANY.contains(f64::INFINITY));
    assert!(!Range::POSITIVE.contains(0.0) && Range::NOT_NEGATIVE.contains(0.0));
    assert_eq!(Range::POSITIVE.to_string(), "more than 0");
}
