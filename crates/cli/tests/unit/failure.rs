use std::io;
use std::path::Path;

use plateau_core::simulation::SimulationError;
use plateau_io::scene::{Origin, Problem};
use plateau_run::{InputError, RunError};

use super::*;

#[test]
fn the_mark_stands_below_the_column() {
    let text = "version = 1\n\tname = \"a\u{7}\"\n";
    assert_eq!(marked(text, 2, 9).as_deref(), Some("  2 |  name = \"a \"\n    |         ^"));
    assert_eq!(marked(text, 1, 12).as_deref(), Some("  1 | version = 1\n    |            ^"));
    assert_eq!(marked("\u{540d} = 1", 1, 5).as_deref(), Some("  1 | \u{540d} = 1\n    |      ^"));
    assert_eq!(marked(text, 3, 1), None);
    assert_eq!(marked(text, 1, 40), None);
    assert_eq!(marked(&"x".repeat(1000), 1, 170), None);
}

#[test]
fn the_status_comes_from_the_error_and_not_from_its_words() {
    let named = "cannot read notes (os error 24), errno = 12, of mine.toml";
    assert_eq!(Failure::input(named).status, 2);
    let system = |number| io::Error::from_raw_os_error(number);
    for (number, status) in [(2, 2), (13, 2), (11, 1), (12, 1), (23, 1), (24, 1)] {
        assert_eq!(Failure::input(system(number)).status, status, "{number}");
        assert_eq!(Failure::because(&system(number), "said in other words").status, status, "{number}");
        // However deep it lies.
        let aside = InputError::Aside("moved".to_owned(), system(number));
        assert_eq!(Failure::from(RunError::Input(aside)).status, status, "{number}");
        let origin = Origin::File(Path::new("mine.toml").into());
        let scene = Problem { origin, key: None, message: named.into(), system: Some(number) };
        assert_eq!(Failure::input(SceneError::from(scene.clone())).status, status, "{number}");
        assert_eq!(of_scene(SceneError::from(scene.clone())).status, status, "{number}");
        assert_eq!(of_study(StudyError(vec![scene])).status, status, "{number}");
    }
    let threads = SimulationError::Threads { workers: 2, message: "no".into() };
    assert_eq!(Failure::from(RunError::Input(InputError::Simulation(threads))).status, 1);
}
