//! What is wrong with a new scene, in the words of the command line that it was made of.

use plateau_io::brief;
use plateau_io::scene::{Problem, SceneError};

use crate::arguments::NewArguments;
use crate::failure::Failure;

/// Why the scene that the arguments ask for cannot be run; nothing is written.
pub fn of(arguments: &NewArguments, error: &SceneError) -> Failure {
    let told = brief::problems(error.problems().iter().map(|problem| told(arguments, problem)));
    Failure::input(format!("{told}\nnothing is written"))
}

/// A problem with the option that it comes from, or with its key where it comes from none.
fn told(arguments: &NewArguments, Problem { key, message, .. }: &Problem) -> String {
    let key = key.as_deref().unwrap_or_default();
    let name = key.rsplit('.').next().unwrap_or_default();
    let options = options(arguments);
    let message = options.iter().fold(message.clone(), |message, (name, option, _)| message.replace(name, option));
    match options.iter().find(|(known, ..)| *known == name) {
        Some((_, option, value)) => format!("{option} \"{value}\": {message}"),
        None => format!("{key}: {message}"),
    }
}

/// Keys of the scene, each with the option that it comes from and its value.
fn options(arguments: &NewArguments) -> [(&'static str, &'static str, &str); 6] {
    let NewArguments { pin_width, pin_length, diameter, radius, load, speed, duration, .. } = arguments;
    let width = match diameter {
        Some(diameter) => ("pin_width", "--diameter", diameter.as_str()),
        None => ("pin_width", "--pin-width", pin_width.as_str()),
    };
    [
        width,
        ("pin_length", "--pin-length", pin_length),
        ("mean_radius", "--radius", radius),
        ("normal_force", "--load", load),
        (arguments.speed_key(), "--speed", speed),
        ("duration", "--duration", duration),
    ]
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use clap::Parser as _;
    use plateau_io::scene;

    use super::*;
    use crate::arguments::{Arguments, Command};

    #[test]
    fn a_pin_that_does_not_fit_is_told_by_its_option() {
        for (options, expected) in [
            (&["--diameter", "60 mm"][..], "--diameter \"60 mm\": a pin of 60 mm does not fit"),
            (&["--diameter", "43.9 mm"], "--diameter \"43.9 mm\": a round pin of 43.9 mm"),
            (&["--pin-length", "200 mm"], "a larger --radius"),
        ] {
            let line = [&["plateau", "new", "nothing/mine.toml"][..], options].concat();
            let Command::New(arguments) = Arguments::try_parse_from(line).unwrap().command else { panic!("new") };
            let text = super::super::text(&arguments).unwrap().text;
            let error = scene::of_text(Path::new("nothing/mine.toml"), &text).unwrap_err();
            let Failure::Input(message) = of(&arguments, &error) else { panic!("input") };
            assert!(message.contains(expected) && message.contains("nothing is written"), "{message}");
        }
    }
}
