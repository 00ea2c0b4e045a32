use super::*;

#[test]
fn the_finest_reference_is_taken_that_half_of_the_budget_allows() {
    // The model itself takes 90 s; beside others 2 s are for the check.
    let cost = |m: f64| 90.0 / m + if m > 1.0 { 2.0 } else { 0.0 };
    let within = |budget: f64| finest(&[1.0, 2.0, 10.0], budget, cost);
    assert_eq!(
        [1000.0, 180.0, 179.9, 94.0, 93.9, 22.0].map(|budget| within(budget).unwrap()),
        [1.0, 1.0, 2.0, 2.0, 10.0, 10.0]
    );
    assert_eq!(within(21.9), Err(Some((10.0, 22.0))));
    assert_eq!(finest(&[], 21.9, cost), Err(None));
}
