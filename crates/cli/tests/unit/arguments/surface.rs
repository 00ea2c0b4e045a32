use super::*;

#[test]
fn a_unit_is_more_than_0() {
    assert_eq!(unit("um"), Ok(1e-6));
    assert_eq!(unit("2.5 nm"), Ok(2.5e-9));
    assert_eq!([unit("0 um"), unit("-1 um")], [(); 2].map(|()| Err("expected more than 0".to_owned())));
    assert!(unit("kg").unwrap_err().contains("a unit of length"));
}

#[test]
fn a_key_that_a_message_names_is_told_as_its_option() {
    assert_eq!(as_options("unit = \"um\" below file in the scene does"), " (on the command line: --unit)");
    assert_eq!(
        as_options("say profile_lay = \"along\" below file in the scene"),
        " (on the command line: --profile-lay)"
    );
    assert_eq!(as_options("the file has no line of numbers"), "");
    assert_eq!(as_options("sub_unit = 3"), "");
}
