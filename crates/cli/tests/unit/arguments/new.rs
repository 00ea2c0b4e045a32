use super::*;

#[test]
fn a_speed_is_of_turns_or_of_sliding() {
    assert_eq!(speed("3 m/s").as_deref(), Ok("3 m/s"));
    assert_eq!(speed("850 rpm").as_deref(), Ok("850 rpm"));
    assert!(speed("3 mm").unwrap_err().contains("is a length, expected a rotational speed"));
    assert!(speed("-3 m/s").unwrap_err().contains("more than 0"));
    assert!(is_sliding_speed("10 km/h") && !is_sliding_speed("2 rad/s"));
}
