use super::*;

#[test]
fn what_is_no_time_of_a_run_and_no_length_is_refused() {
    assert_eq!(run_time("2 min"), Ok(120.0));
    assert!(run_time("-1 s").unwrap_err().contains("before the start of a run"));
    assert_eq!(length(" 2 mm "), Ok(2e-3));
    assert!(length("2 s").unwrap_err().contains("expected a length"));
    assert_eq!(positive("30 N", Dimension::Force).as_deref(), Ok("30 N"));
    assert!(positive("0 N", Dimension::Force).unwrap_err().contains("more than 0"));
}
