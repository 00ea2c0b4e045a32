//! `plateau man`, `plateau completions` and `plateau schema`: manual pages, scripts with which shells complete the command line, and the
//! JSON Schema of scenes.

use std::path::Path;

use clap::{Command, CommandFactory};
use clap_mangen::Man;

use crate::arguments::{Arguments, CompletionsArguments, ManArguments};
use crate::failure::Failure;
use crate::output;

/// Prints a page, or writes all of them.
pub fn man(arguments: &ManArguments) -> Result<(), Failure> {
    let mut program = Arguments::command().disable_help_subcommand(true);
    // Only then do the commands know their full names.
    program.build();
    match &arguments.output {
        Some(directory) => write(&program, directory, arguments.force),
        None => print(&program, arguments.page.as_deref()),
    }
}

fn print(program: &Command, page: Option<&str>) -> Result<(), Failure> {
    let command = match page {
        Some(name) => program.find_subcommand(name).ok_or_else(|| unknown(program, name))?,
        None => program,
    };
    output::print(&Page::of(command)?.text)
}

/// Pages are written all or none, as far as that can be told beforehand; the folder is made unless it is there.
fn write(program: &Command, directory: &Path, force: bool) -> Result<(), Failure> {
    let shown = program.get_subcommands().filter(|command| !command.is_hide_set());
    let commands = [program].into_iter().chain(shown);
    let pages = commands.map(Page::of).collect::<Result<Vec<_>, _>>()?;
    output::make_directory(directory)?;
    for page in &pages {
        output::check(&directory.join(&page.file), force, &[])?;
    }
    for page in &pages {
        let path = directory.join(&page.file);
        output::write_in_folder(&path, page.text.as_bytes(), force)?;
        output::print(&format!("wrote {}\n", path.display()))?;
    }
    Ok(())
}

/// A manual page in roff.
struct Page {
    file: String,
    text: String,
}

impl Page {
    fn of(command: &Command) -> Result<Self, Failure> {
        let man = Man::new(command.clone());
        let mut text = Vec::new();
        man.render(&mut text).map_err(|error| Failure::run(format_args!("cannot make the manual page: {error}")))?;
        Ok(Self { file: man.get_filename(), text: String::from_utf8_lossy(&text).into_owned() })
    }
}

fn unknown(program: &Command, name: &str) -> Failure {
    let names: Vec<_> = program.get_subcommands().map(Command::get_name).collect();
    Failure::input(format!("no command is called \"{name}\", there are {}", names.join(", ")))
}

/// Prints the script of a shell.
pub fn completions(arguments: &CompletionsArguments) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "plateau", &mut script);
    output::print(&String::from_utf8_lossy(&script))
}

/// Prints the schema, which a test makes of the table of keys.
pub fn schema() -> Result<(), Failure> {
    output::print(include_str!("../../../../data/scene.schema.json"))
}
