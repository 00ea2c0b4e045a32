//! The round pin through the whole program: the same bits, kills, files, figures and exports.

use plateau_tests::program::{WorkingDirectory, go_on_through_kills, run_words, scene, sets};
use plateau_tests::run_file::{RunFile, differences};
use plateau_tests::scenes::{Stream, few_or_all};

/// A round pin of 4 mm, and so much acceleration that resin touches.
const ROUND: [&str; 6] = [
    "mesh.shape=disc",
    "mesh.pin_width=4 mm",
    "mesh.cell_size=200 um",
    "mesh.mean_radius=22 mm",
    "numerics.time_acceleration=400",
    "output.roughness=true",
];

/// Runs `quick.toml` with changes.
fn run(directory: &WorkingDirectory, file: &str, sets: &[&str], more: &[&str]) -> RunFile {
    directory.plateau(run_words("quick.toml", file, sets, more)).ends(0, &[]);
    directory.run_file(file)
}

/// Whether a cell is within the circle of 2 mm about the middle, by the definition.
fn is_within(file: &RunFile, column: usize, row: usize) -> bool {
    let (radius, angle) = (file.floats("radius")[row], file.floats("pin_angle"));
    let middle = 0.5 * (angle[0] + angle[angle.len() - 1]);
    (radius * (angle[column] - middle)).hypot(radius - 22e-3) <= 2e-3
}

#[test]
fn the_file_of_a_round_pin_has_its_outline_and_any_worker_and_engine_gives_it() {
    let directory = WorkingDirectory::new();
    for debris in [
        &["operation.steps=400"][..],
        &["operation.steps=400", "plateaus.debris=track", "plateaus.captured_fraction=0.5"],
    ] {
        let sets = [&ROUND[..], debris].concat();
        let one = run(&directory, "one.h5", &sets, &["--force"]);
        let content = one.content();
        for workers in ["2", "3"] {
            let other = run(&directory, "other.h5", &sets, &["--force", "--workers", workers]).content();
            assert_eq!(differences(&content, &other), [""; 0], "{workers} workers, {debris:?}");
        }
        let plain = run(&directory, "plain.h5", &sets, &["--force", "--engine", "plain"]);
        for series in
            ["contact_area", "worn_pin", "worn_resin", "emitted", "pin_secondary", "pin_sq", "filled_fraction"]
        {
            let [fast, plain] = [&one, &plain].map(|file| file.floats(&format!("series/{series}")));
            for (fast, plain) in fast.iter().zip(&plain) {
                let tolerance = 1e-9 * plain.abs().max(fast.abs()) + 1e-24;
                assert!((fast - plain).abs() <= tolerance, "{series}: {fast:e} {plain:e}");
            }
        }
        let [columns, rows] = one.shape("pin/base")[..] else { panic!("two dimensions") };
        let base = one.bytes("pin/base");
        let status = one.bytes("pin/status");
        let last = status.len() - columns * rows;
        for (cell, height) in one.last_map("pin/height").into_iter().enumerate() {
            let is_absent = !is_within(&one, cell / rows, cell % rows);
            assert_eq!([base[cell] == 3, status[last + cell] == 3, height.is_nan()], [is_absent; 3], "cell {cell}");
        }
        assert!(one.bytes("disc/status").iter().all(|status| *status < 3));
        // Σ A over the cells that are there: what a ratio of contact is of.
        let area = one.floats("series/contact_area")[0] / one.floats("series/contact_ratio")[0];
        let mean = std::f64::consts::PI * 4e-6;
        assert!((area / mean - 1.0).abs() < 0.05, "{area:e}");
        directory.plateau(["verify", "one.h5"]).quiet_success();
    }
}

#[test]
fn flags_of_absent_cells_are_in_files_of_round_pins_alone() {
    let directory = WorkingDirectory::new();
    let steps = "operation.steps=30";
    let round = run(&directory, "round.h5", &[&ROUND[..], &[steps]].concat(), &[]);
    let rectangle = run(&directory, "rectangle.h5", &[steps], &[]);
    for (file, dataset, meanings) in [
        (&round, "pin/status", "none primary secondary absent"),
        (&round, "pin/base", "none primary secondary absent"),
        (&round, "disc/status", "none primary secondary"),
        (&rectangle, "pin/status", "none primary secondary"),
        (&rectangle, "pin/base", "none primary secondary"),
    ] {
        assert_eq!(file.text_of(dataset, "flag_meanings"), meanings, "{dataset}");
    }
}

#[test]
fn a_killed_run_of_a_round_pin_ends_as_an_undisturbed_one() {
    let directory = WorkingDirectory::new();
    let more = ["operation.steps=150000", "output.sample_every_steps=2000", "output.checkpoint_every=0.03 s"];
    let sets = [&ROUND[..], &more].concat();
    let words = |file: &str, more: &[&str]| run_words("quick.toml", file, &sets, more);
    let (_, killed) = go_on_through_kills(&directory, words, few_or_all(2, 6), 0.5, Stream(3));
    assert!(killed > 0);
}

#[test]
fn fibres_of_a_round_pin_are_read_from_its_run_file() {
    let directory = WorkingDirectory::new();
    let sets = [&ROUND[..], &["operation.steps=60"]].concat();
    run(&directory, "one.h5", &sets, &[]);
    // The fibres of one run as those of the next: what stands beyond the outline is not looked at.
    let file = format!("pin.base.file={}", directory.path("one.h5").display());
    let second = run(&directory, "two.h5", &[&sets[..], &[&file, "pin.base.dataset=/pin/base"]].concat(), &[]);
    assert_eq!(second.bytes("pin/base"), directory.run_file("one.h5").bytes("pin/base"));
}

#[test]
fn check_tells_the_mesh_and_the_circle() {
    let directory = WorkingDirectory::new();
    let text = directory.plateau([&["check", &scene("quick.toml")], &sets(&ROUND)[..]].concat()).stdout;
    assert!(text.contains("20 rows, 691 columns round the ring, 20 under the pin"), "{text}");
    assert!(text.contains("a circle of 4.000 mm in diameter: "), "{text}");
}
