use super::*;

#[test]
fn what_has_no_design_is_refused() {
    let message = |factors: &[Factor]| design(&Kind::FullFactorial, factors).unwrap_err().0;
    assert_eq!(message(&[]), "a design needs at least one factor");
    assert_eq!(message(&[Factor::Range, Factor::Levels(1)]), "factor 2 needs at least two levels, not 1");
    assert_eq!(
        message(&[Factor::Levels(usize::MAX); 2]),
        "a design of 2 factors has at most 10000000 points, not far more"
    );
    assert_eq!(message(&[Factor::Levels(2); 24]), "a design of 24 factors has at most 4166666 points, not 16777216");
    let three = design(&Kind::BoxBehnken { centre: 1 }, &[Factor::Range, Factor::Levels(3), Factor::Range]);
    assert_eq!(three.unwrap_err().0, "a Box-Behnken design needs ranges or two levels, but factor 2 has 3 levels");
}

#[test]
fn settings_are_whole_points() {
    assert!(Design::from_settings(2, vec![Setting::Level(0); 3], None).is_err());
    assert!(Design::from_settings(0, Vec::new(), None).is_err());
    assert_eq!(Design::from_settings(2, vec![Setting::Level(0); 6], None).unwrap().points(), 3);
}
