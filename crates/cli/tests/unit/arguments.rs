//! Options, all of them.

use clap::CommandFactory as _;

use super::*;

/// What a quantity or a number is called in help.
const NUMBERS: [&str; 10] = ["LENGTH", "LENGTHS", "FORCE", "SPEED", "TIME", "N", "P", "SECONDS", "LINES", "I/N"];

/// Options of a command and those below it that take a number and refuse to look at one below 0.
fn blind(command: &clap::Command) -> Vec<String> {
    let named = |argument: &clap::Arg| {
        argument.get_value_names().is_some_and(|names| names.iter().any(|name| NUMBERS.contains(&name.as_str())))
    };
    let options = command.get_opts().filter(|option| option.get_action().takes_values() && named(option));
    let options = options.filter(|option| !option.is_allow_hyphen_values_set());
    let own = options.map(|option| format!("{} --{}", command.get_name(), option.get_id()));
    own.chain(command.get_subcommands().flat_map(blind)).collect()
}

#[test]
fn a_negative_number_is_a_value_and_no_option() {
    assert_eq!(blind(&Arguments::command()), [""; 0]);
    let refused = Arguments::try_parse_from(["plateau", "new", "a.toml", "--load", "-5 N"]).unwrap_err().to_string();
    assert!(refused.contains("expected more than 0"), "{refused}");
}

#[test]
fn what_is_no_time_of_a_run_and_no_length_is_refused() {
    assert_eq!(run_time("2 min"), Ok(120.0));
    assert!(run_time("-1 s").unwrap_err().contains("before the start of a run"));
    assert_eq!(length(" 2 mm "), Ok(2e-3));
    assert!(length("2 s").unwrap_err().contains("expected a length"));
    assert_eq!(positive(Dimension::Force)("30 N").as_deref(), Ok("30 N"));
    assert!(positive(Dimension::Force)("0 N").unwrap_err().contains("more than 0"));
}

#[test]
fn a_speed_is_of_turns_or_of_sliding() {
    assert_eq!(speed("3 m/s").as_deref(), Ok("3 m/s"));
    assert_eq!(speed("850 rpm").as_deref(), Ok("850 rpm"));
    assert!(speed("3 mm").unwrap_err().contains("is a length, expected a rotational speed"));
    assert!(speed("-3 m/s").unwrap_err().contains("more than 0"));
    assert!(is_sliding_speed("10 km/h") && !is_sliding_speed("2 rad/s"));
}
