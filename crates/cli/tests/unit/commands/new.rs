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
        let text = super::scene_text(&arguments).unwrap().text;
        let error = scene::of_text(Path::new("nothing/mine.toml"), &text).unwrap_err();
        let Failure::Input(message) = refusal(&arguments, &error) else { panic!("input") };
        assert!(message.contains(expected) && message.contains("nothing is written"), "{message}");
    }
}
