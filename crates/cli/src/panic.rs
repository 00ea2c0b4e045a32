//! A panic, told in one line: the system gives no thread or no memory, or the program is wrong.

use std::any::Any;
use std::env;
use std::panic::{self, AssertUnwindSafe};
use std::process::ExitCode;

use crate::message;

/// How libraries say that there is no thread to be had: the standard library, rayon.
const NO_THREAD: [&str; 2] = ["failed to spawn thread", "ThreadPoolBuildError"];

/// How libraries say that there is no memory to be had: those that deflate.
const NO_MEMORY: [&str; 3] = ["MemError", "InsufficientMemory", "memory allocation of"];

/// Does `work`; a panic in it, or in a thread, is told in one line, and makes the exit status 1. With `RUST_BACKTRACE` it is told as
/// usual.
pub fn told(work: impl FnOnce() -> ExitCode) -> ExitCode {
    if env::var_os("RUST_BACKTRACE").is_none_or(|value| value == "0") {
        panic::set_hook(Box::new(|panic| {
            let place =
                panic.location().map_or_else(String::new, |place| format!(" at {}:{}", place.file(), place.line()));
            message::error(in_words(&text(panic.payload()), &place));
        }));
    }
    panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or(ExitCode::FAILURE)
}

fn in_words(text: &str, place: &str) -> String {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if NO_THREAD.iter().any(|known| text.contains(known)) {
        return format!("the system gives no more threads: allow more of them, or more memory ({text})");
    }
    if NO_MEMORY.iter().any(|known| text.contains(known)) {
        return format!("the system gives no more memory: allow more of it ({text})");
    }
    format!("the program panicked{place}: {text}: this is a mistake of the program, please report it with the command")
}

fn text(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::in_words;

    #[test]
    fn what_is_lacking_is_told_from_what_is_wrong() {
        let lacking = in_words("failed to spawn thread: Os { code: 11,\n kind: WouldBlock }", " at a.rs:1");
        assert!(lacking.starts_with("the system gives no more threads") && !lacking.contains('\n'), "{lacking}");
        let lacking = in_words("called `Result::unwrap()` on an `Err` value: MemError", " at a.rs:1");
        assert!(lacking.starts_with("the system gives no more memory") && !lacking.contains("mistake"), "{lacking}");
        assert!(in_words("index out of bounds", " at a.rs:1").starts_with("the program panicked at a.rs:1: index"));
    }
}
