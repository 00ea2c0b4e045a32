//! What shells and manuals are given comes from the command line itself: every command and option is in it.

use std::process::{Command, Stdio};

use plateau_tests::program::{Outcome, WorkingDirectory, commands, own_commands, program, run};

/// Long options that the help of a command lists.
fn options(command: &str) -> Vec<String> {
    let help = WorkingDirectory::new().plateau([command, "--help"]).quiet_success();
    let (_, list) = help.split_once("Options:\n").expect("a list of options");
    let starts = list.lines().filter(|line| line.starts_with("  -") || line.starts_with("      --"));
    let words = starts.filter_map(|line| line.split_whitespace().find(|word| word.starts_with("--")));
    words.map(str::to_owned).collect()
}

/// Whether a program is installed.
fn is_there(name: &str) -> bool {
    let found = Command::new(name).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    if found.is_err() {
        println!("skipped: {name} is not installed");
    }
    found.is_ok()
}

/// Runs lines of bash in which `plateau` is the program.
fn bash(directory: &WorkingDirectory, lines: &str) -> Outcome {
    let mut bash = Command::new("bash");
    bash.current_dir(directory.path(".")).args(["--norc", "-c", &format!("plateau() {{ \"$0\" \"$@\"; }}\n{lines}")]);
    bash.arg(program());
    run(bash)
}

#[test]
fn every_command_and_option_is_in_the_completions_of_every_shell() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = WorkingDirectory::new().plateau(["completions", shell]).quiet_success();
        for command in commands() {
            assert!(script.contains(&command), "{shell}: {command}");
        }
        for command in own_commands() {
            for option in options(&command) {
                // fish names long options without their dashes.
                let name = if shell == "fish" { format!("-l {}", &option[2..]) } else { option };
                assert!(script.contains(&name), "{shell}: {command} {name}");
            }
        }
    }
}

#[test]
fn bash_completes_commands_and_options() {
    if !is_there("bash") {
        return;
    }
    let directory = WorkingDirectory::with("my-scene.toml", "");
    let load = "source <(plateau completions bash) && complete -p plateau >/dev/null || exit 1\n";
    let complete = |words: &str, current: &str, previous: &str| {
        let count = words.split_whitespace().count() - 1;
        let lines = format!(
            "{load}COMP_WORDS=({words}); COMP_CWORD={count}; _plateau plateau '{current}' '{previous}'\n\
             printf '%s\\n' \"${{COMPREPLY[@]}}\""
        );
        let replies = bash(&directory, &lines).quiet_success();
        replies.lines().map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(complete("plateau ch", "ch", "plateau"), ["check"]);
    assert_eq!(complete("plateau run --outp", "--outp", "run"), ["--output"]);
    assert_eq!(complete("plateau run --output my", "my", "--output"), ["my-scene.toml"]);
    let shells = complete("plateau completions z", "z", "completions");
    assert_eq!(shells, ["zsh"]);
}

#[test]
fn every_command_has_a_manual_page_with_its_options() {
    let directory = WorkingDirectory::new();
    std::fs::create_dir(directory.path("man1")).unwrap();
    directory.plateau(["man", "-o", "man1"]).quiet_success();
    let page = |name: &str| directory.text(&format!("man1/{name}.1"));
    let plain = |text: &str| text.replace("\\-", "-");
    assert_eq!(page("plateau"), directory.plateau(["man"]).quiet_success());
    for command in commands() {
        assert!(plain(&page("plateau")).contains(&format!("plateau-{command}(1)")), "{command}");
        let page = page(&format!("plateau-{command}"));
        assert_eq!(page, directory.plateau(["man", &command]).quiet_success());
    }
    for command in own_commands() {
        for option in options(&command) {
            assert!(plain(&page(&format!("plateau-{command}"))).contains(&option), "{command} {option}");
        }
    }
    let pages = std::fs::read_dir(directory.path("man1")).unwrap().count();
    assert_eq!(pages, commands().len() + 1);
}

#[test]
fn manual_pages_are_replaced_only_with_force() {
    let directory = WorkingDirectory::new();
    let mine = directory.write("plateau-run.1", "mine");
    directory.plateau(["man", "-o", "."]).ends(2, &["plateau-run.1 exists; give --force to replace it"]);
    assert_eq!(directory.names(), ["plateau-run.1"]);
    directory.plateau(["man", "-o", ".", "--force"]).quiet_success();
    assert!(std::fs::read_to_string(mine).unwrap().starts_with(".ie"));

    let said = directory.plateau(["man", "-o", "not/there"]).quiet_success();
    assert!(said.contains("wrote not/there/plateau-run.1\n"), "{said}");
    let outcome = directory.plateau(["man", "-o", "plateau-run.1"]).ends(2, &[]);
    let message = "cannot make the folder plateau-run.1: there is a file of that name; name another one with -o";
    assert!(outcome.stderr.contains(message), "{}", outcome.stderr);
    directory.plateau(["man", "rum"]).ends(2, &["no command is called \"rum\", there are new, cycle, run, "]);
}
