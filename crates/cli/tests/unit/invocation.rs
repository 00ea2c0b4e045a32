use super::*;

#[test]
fn a_program_is_told_as_it_was_typed() {
    let path = Some(OsStr::new("/usr/bin:/home/me/bin"));
    for (called, told) in [
        ("./plateau", "./plateau"),
        ("plateau", "plateau"),
        ("/home/me/bin/plateau", "plateau"),
        ("/opt/plateau", "/opt/plateau"),
        ("/my tools/plateau", "'/my tools/plateau'"),
    ] {
        assert_eq!(as_typed(OsStr::new(called), path), told);
    }
    assert_eq!(as_typed(OsStr::new("/opt/plateau"), None), "/opt/plateau");
}

#[test]
fn an_argument_with_blanks_is_quoted() {
    assert_eq!(argument("mine.toml"), "mine.toml");
    assert_eq!(argument("it's mine.toml"), "'it'\\''s mine.toml'");
    assert_eq!(argument(""), "''");
}
