//! Invocation: the command line as the user typed it, for commands that can be copied from a message; and its help, version, and errors.

use std::env;
use std::ffi::OsStr;
use std::path::Path;
use std::process::ExitCode;

use clap::CommandFactory as _;
use clap::error::{ContextKind, ContextValue, ErrorKind};

use crate::arguments::Arguments;
use crate::failure::{Failure, report};
use crate::output::printed;

/// Set by the script `plateau` to its own name: the program itself is elsewhere.
const LAUNCHER: &str = "PLATEAU_CALLED";
/// Name that is in no file system.
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

/// Gives what clap answers instead of arguments: help and version as they are, errors as every other wrong input.
pub fn answered(mut answer: clap::Error) -> ExitCode {
    if !answer.use_stderr() || answer.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        return match printed(answer.print()) {
            Ok(()) => ExitCode::from(answer.exit_code() as u8),
            Err(failure) => report(failure),
        };
    }
    if let Some(tip) = tip(&answer) {
        answer.remove(ContextKind::SuggestedSubcommand);
        answer.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    }
    let message = in_plain_words(&answer.to_string());
    report(Failure::input(message.trim_start_matches("error: ").trim_end()))
}

/// Message of the standard library on a text that is no number, as one says it who does not know programming.
fn in_plain_words(message: &str) -> String {
    let words = [
        ("invalid digit found in string", "expected a whole number"),
        ("number too large to fit in target type", "the number is too large"),
        ("number too small to fit in target type", "the number is too small"),
        ("cannot parse integer from empty string", "expected a whole number"),
        ("invalid float literal", "expected a number"),
        ("cannot parse float from empty string", "expected a number"),
    ];
    words.iter().fold(message.to_owned(), |message, (found, plain)| message.replace(found, plain))
}

/// Word that one who is new to the program may have meant.
fn tip(answer: &clap::Error) -> Option<String> {
    let word = |kind| answer.get(kind).map(ToString::to_string);
    match answer.kind() {
        ErrorKind::InvalidSubcommand => {
            let word = word(ContextKind::InvalidSubcommand)?;
            match word.rsplit_once('.').map_or("", |(_, ending)| ending) {
                "toml" if is_sweep() => Some(format!("to run a study: {} sweep run {word}", program())),
                "toml" => Some(format!("to run a scene: {} run {word}", program())),
                "h5" => Some(format!("to see a run: {0} report {word}, or {0} plot {word}", program())),
                _ if word == "version" => Some(format!("the version: {} --version", program())),
                _ => command_like(&word).or_else(|| command_of_sweep(&word)),
            }
        }
        ErrorKind::UnknownArgument => {
            let set = std::env::args_os().any(|argument| argument == "--set");
            word(ContextKind::InvalidArg).filter(|word| set && !word.starts_with('-'))?;
            Some("quote a value with a space in it: --set operation.normal_force=\"20 N\"".to_owned())
        }
        _ => None,
    }
}

/// Tells whether a command of studies was begun.
fn is_sweep() -> bool {
    std::env::args_os().nth(1).is_some_and(|first| first == "sweep")
}

/// The command of studies with this name.
fn command_of_sweep(word: &str) -> Option<String> {
    let all = Arguments::command();
    all.find_subcommand("sweep")?.find_subcommand(word)?;
    Some(format!("did you mean {} sweep {word}?", program()))
}

/// The command whose name is the nearest to a word, if it is near: two letters that change places, one that is missing or
/// wrong. A word behind a command with commands of its own is meant as one of these.
fn command_like(word: &str) -> Option<String> {
    let all = Arguments::command();
    // A path of the program that is no UTF-8 is nobody's mistake.
    let first = std::env::args_os().nth(1).and_then(|first| first.into_string().ok()).filter(|first| first != word);
    let parent = first.and_then(|first| all.find_subcommand(&first)).filter(|parent| parent.has_subcommands());
    let names = parent.unwrap_or(&all).get_subcommands().map(|command| command.get_name().to_owned());
    let distance = |name: &String| strsim::osa_distance(name, word);
    let most = 1 + word.len() / 5;
    let name = names.filter(|name| distance(name) <= most).min_by_key(distance)?;
    let parent = parent.map_or(String::new(), |parent| format!("{} ", parent.get_name()));
    Some(format!("did you mean {} {parent}{name}?", program()))
}

#[cfg(test)]
#[path = "../tests/unit/invocation.rs"]
mod tests;
