use toml::Table;

use super::*;

fn said(text: &str) -> String {
    not_toml(text, &text.parse::<Table>().unwrap_err())
}

#[test]
fn what_is_often_wrong_is_named() {
    assert_eq!(said("load = 4,5"), "4,5 has a comma, write 4.5");
    assert_eq!(said("[a]\nload = 1\nload = 2"), "load is there already in this table, further up: keep one of them");
    assert!(said("load = ").starts_with("this is not TOML: "), "{}", said("load = "));
}
