//! How the program was called, for commands that a user may copy from a message.

use std::env;
use std::ffi::OsStr;
use std::path::Path;

/// Set by the script `plateau` to its own name: the program itself is elsewhere.
const LAUNCHER: &str = "PLATEAU_CALLED";
/// What is in no file system.
const PLAIN: &str = "plateau";

/// The program as the user called it: `plateau` where a shell finds it by that name, else with its path, such as `./plateau`.
pub fn program() -> String {
    let called = env::var_os(LAUNCHER).or_else(|| env::args_os().next());
    called.map_or_else(|| PLAIN.to_owned(), |called| as_typed(&called, env::var_os("PATH").as_deref()))
}

/// A shell gives a program that it found in one of the folders of `PATH` the whole path, also where its name alone was typed.
fn as_typed(called: &OsStr, path: Option<&OsStr>) -> String {
    let Some(name) = Path::new(called).file_name() else { return PLAIN.to_owned() };
    let is_found = path.is_some_and(|path| {
        env::split_paths(path).any(|folder| folder.is_absolute() && folder.join(name).as_os_str() == called)
    });
    argument(&if is_found { name } else { called }.to_string_lossy())
}

/// A text as one argument of a shell.
pub fn argument(text: &str) -> String {
    let is_plain = |each: char| each.is_alphanumeric() || "-_./+,:=@%".contains(each);
    if !text.is_empty() && text.chars().all(is_plain) {
        text.to_owned()
    } else {
        // Of text the quotes leave text.
        String::from_utf8_lossy(&quoted(text.as_bytes())).into_owned()
    }
}

/// Bytes, as those of a path, as one argument of a shell, whatever they are.
pub fn quoted(bytes: &[u8]) -> Vec<u8> {
    let quote = |byte: &u8| if *byte == b'\'' { b"'\\''".to_vec() } else { vec![*byte] };
    [b'\''].into_iter().chain(bytes.iter().flat_map(quote)).chain([b'\'']).collect()
}

#[cfg(test)]
mod tests {
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
}
