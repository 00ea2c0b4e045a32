use super::*;

#[test]
fn levels_in_one_unit_have_that_of_the_study() {
    let unit = |texts: [&str; 2]| {
        let levels = texts.map(|text| Level::parse("operation.rotational_speed", text));
        stated_unit(&levels.each_ref()).map(str::to_owned)
    };
    assert_eq!(unit(["425 rpm", "8.5e2 rpm"]).as_deref(), Some("rpm"));
    assert_eq!([unit(["425 rpm", "89 rad/s"]), unit(["425", "850"]), unit(["none", "425 rpm"])], [None, None, None]);
}

#[test]
fn heads_have_units_and_differ() {
    let mut names = Names::default();
    let heads = [
        names.head("state", "", ""),
        names.head("load", "factor", "N"),
        names.head("state", "factor", ""),
        names.head("load", "response", "N"),
        names.head("load", "response", "m2"),
    ];
    assert_eq!(heads, ["state", "load [N]", "state (factor)", "load (response) [N]", "load [m2]"]);
}
