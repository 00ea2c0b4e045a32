use super::*;

#[test]
fn what_is_lacking_is_told_from_what_is_wrong() {
    let lacking = in_words("failed to spawn thread: Os { code: 11,\n kind: WouldBlock }", " at a.rs:1");
    assert!(lacking.starts_with("the system gives no more threads") && !lacking.contains('\n'), "{lacking}");
    let lacking = in_words("called `Result::unwrap()` on an `Err` value: MemError", " at a.rs:1");
    assert!(lacking.starts_with("the system gives no more memory") && !lacking.contains("mistake"), "{lacking}");
    assert!(in_words("index out of bounds", " at a.rs:1").starts_with("the program panicked at a.rs:1: index"));
}
