use super::*;

#[test]
fn the_change_in_the_second_half_is_told_with_its_error() {
    let quarter = |from: f64, to: f64, mean: f64| WindowMean {
        from,
        to,
        revolutions: None,
        contact_time: None,
        mean,
        standard_error: Some(0.02e-6),
    };
    let filled_by = |filled: f64, change: f64, standard_error: f64, pulses: Option<f64>| {
        let drift = Drift {
            third_quarter: quarter(30.0, 45.0, 1e-6),
            last_quarter: quarter(45.0, 60.0, (1.0 + change) * 1e-6),
            change,
            standard_error,
            pulses,
        };
        running_in(&Ok(drift), filled)
    };
    let with = |change: f64, standard_error: f64, pulses: Option<f64>| filled_by(0.9, change, standard_error, pulses);
    let of = |change: f64, standard_error: f64| with(change, standard_error, Some(3.0));
    assert_eq!(
        with(0.12, 0.03, Some(0.6)),
        "cannot be told: a quarter of the run has at most 0.6 pulses of the contact area, 3 are needed"
    );
    assert_eq!(with(0.12, 0.03, None), of(0.12, 0.03));
    assert_eq!(of(0.12, 0.03), "contact area still rises: +12.0 ± 3.0 % from 30 … 45 s to 45 … 60 s");
    assert_eq!(of(-0.12, 0.03), "contact area still falls: -12.0 ± 3.0 % from 30 … 45 s to 45 … 60 s");
    assert_eq!(of(0.05, 0.03), "cannot be told from a run of this length: +5.0 ± 3.0 % from 30 … 45 s to 45 … 60 s");
    assert_eq!(
        running_in(&Err(NoDrift::Cycle), 0.1),
        "cannot be told: with a cycle the contact area follows load and speed"
    );
    let steady = "contact area is steady: +1.0 ± 1.0 % from 30 … 45 s to 45 … 60 s";
    assert_eq!(of(0.01, 0.01), steady);
    let fills_on = "; the disc is filled by 7.1 %, and as it fills on the area may rise";
    assert_eq!(filled_by(0.0712, 0.01, 0.01, Some(3.0)), format!("{steady}{fills_on}"));
    // Nothing fills a flat disc.
    assert_eq!(filled_by(0.0, 0.01, 0.01, Some(3.0)), steady);
}

#[test]
fn the_running_in_time_is_told_or_why_there_is_none() {
    assert_eq!(running_in_time(&Ok(1225.0)), "1225 s, to 90 % of the contact area at the end");
    assert_eq!(
        running_in_time(&Err(NotDefined::NotSteady(0.102))),
        "not defined: still rises at the end, by 10.2 % from the third quarter of the run to the last"
    );
}

#[test]
fn it_tells_range_error_and_whether_the_tolerance_is_met() {
    let chosen =
        Chosen { smallest: 1.0, largest: 28.26, last: 2.0, estimated_error: 0.0117, met: false, ..Chosen::never(0.01) };
    assert_eq!(
        acceleration(&chosen),
        "m = 1 to 28.3, last 2; estimated error of the contact area 1.2 %, tolerance 1 % not met"
    );
    assert_eq!(
        acceleration(&Chosen::never(0.005)),
        "m = 1; estimated error of the contact area 0 %, tolerance 0.5 % met"
    );
}
