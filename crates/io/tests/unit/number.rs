use super::*;

#[test]
fn a_limit_is_rounded_down() {
    let found = [1.41652, 2.0, 3.0 - 1e-15, 0.9999999, 12345.67, 1e-7].map(|number| not_above(number, 4));
    assert_eq!(found, [1.416, 2.0, 3.0, 0.9999, 12340.0, 1e-7]);
}

#[test]
fn an_upper_bound_is_rounded_up() {
    let found = [0.304, 0.3, 0.30001, 0.037_39, 0.9991, 9.991, 1e-9 / 3.0].map(|bound| less_than(bound, 2));
    assert_eq!(found, ["< 0.31", "< 0.30", "< 0.31", "< 0.038", "< 1.0", "< 10", "< 3.4e-10"]);
}

#[test]
fn numbers_read_well() {
    assert_eq!(grouped(1_174_629), "1 174 629");
    assert_eq!(grouped(12), "12");
    assert_eq!(with_error(4.425_97, Some(0.012_34)), "4.426 ± 0.012");
    assert_eq!(with_error(4.425_97, Some(0.099_96)), "4.43 ± 0.10");
    assert_eq!(with_error(1234.5, Some(56.0)), "1234 ± 56");
    assert_eq!(with_error(4.425_97, Some(0.0)), "4.4260 ± 0.0000");
    assert_eq!(with_error(4.425_974, None), "4.4260");
    assert_eq!([0.012_345_6, 123.456, 1.5e-14].map(short), ["0.01235", "123.5", "1.500e\u{2212}14"]);
    assert_eq!(significant(9.9996, 4), "10.00");
    assert_eq!(significant(0.230_196_108, 6), "0.230196");
    assert_eq!(significant(-1_234_567.0, 6), "-1234567");
    assert_eq!(significant(1.5e-14, 3), "1.50e-14");
    assert_eq!(significant(0.0, 3), "0");
    assert_eq!((count(1, "map"), count(0, "map")), ("1 map".into(), "0 maps".into()));
    assert_eq!(duration(0.25), "250 ms");
    assert_eq!(duration(119.9), "1 min 59 s");
    assert_eq!(bytes(2_500_000), "2.5 MB");
}

#[test]
fn parts_are_given_in_per_cent() {
    let found = [1e-2, 1e-3, 0.002_84, 1.5, 0.0, 1.234e-9, f64::NAN].map(percent);
    assert_eq!(found, ["1 %", "0.1 %", "0.28 %", "150 %", "0 %", "1.2e\u{2212}7 %", "–"]);
}
