use super::is_unicode;

#[test]
fn the_locale_is_that_of_the_first_variable_that_is_set() {
    let with = |all: &'static str, lang: &'static str| {
        is_unicode(move |name| match name {
            "LC_ALL" => Some(all.to_owned()),
            "LANG" => Some(lang.to_owned()),
            _ => None,
        })
    };
    assert!(with("", "de_DE.UTF-8") && with("C.utf8", "C") && !with("C", "de_DE.UTF-8") && !with("", ""));
    assert!(!with("", "de_DE.ISO-8859-1"));
}
