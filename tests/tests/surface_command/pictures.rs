//! The pictures of `plateau surface --plot`: where they go, and what is handed to those that draw them.

use std::fs;

use plateau_tests::program::WorkingDirectory;

use super::small_sdf;

#[test]
fn pictures_have_the_format_of_their_ending_and_a_page_each() {
    let directory = WorkingDirectory::with("small.sdf", small_sdf());
    let micrograph = plateau_tests::program::scene("micrograph.toml");
    for ending in ["png", "svg", "PDF"] {
        let (plot, preview) = (format!("plot.{ending}"), format!("preview.{ending}"));
        let said = directory.plateau(["surface", "small.sdf", "--plot", &plot]).quiet_success();
        let second = format!("plot-2.{}", ending.to_lowercase());
        assert!(said.contains(&format!("wrote {plot}\n")) && said.contains(&format!("wrote {second}\n")), "{said}");
        directory.plateau(["surface", "--prepare", &micrograph, "--preview", &preview]).quiet_success();
        for (name, kind) in [(plot, "surfaces"), (second, "surfaces-2"), (preview, "fibre-map")] {
            let content = directory.text(&name);
            assert!(content.contains(&format!(" as {}", ending.to_lowercase())), "{name}: {content}");
            assert!(kind.starts_with(content.split(' ').next().unwrap()), "{name}: {content}");
        }
    }
}

#[test]
fn no_page_takes_the_place_of_an_input_or_of_another_output() {
    let directory = WorkingDirectory::new();
    let scene = plateau_tests::program::scene("micrograph.toml");
    let picture = |name: &str| directory.path(name).is_file();
    // Surfaces of a run and of a scene have two pages.
    let quick = plateau_tests::program::scene("quick.toml");
    let maps = "output.maps_at=[\"0 s\", \"1 s\"]";
    directory
        .plateau(["run", &quick, "-o", "run.h5", "--set", "operation.duration=2 s", "--set", maps])
        .quiet_success();
    let call = |plot: &str, preview: &str| {
        let always = ["surface", "run.h5", "--prepare", &scene, "--plot", plot, "--preview", preview, "--force"];
        directory.plateau(always)
    };
    for (plot, preview, named) in [("p.png", "./p.png", "./p.png"), ("p.png", "./p-2.png", "./p-2.png")] {
        call(plot, preview).ends(2, &[&format!("{named} is named for two outputs")]);
        assert!(!picture("p.png") && !picture("p-2.png"));
    }
    call("p.png", "q.png").ends(0, &[]);
    assert!(picture("p.png") && picture("p-2.png") && picture("q.png"));
    // The micrograph of a scene, where a page would be.
    let micrograph = plateau_tests::program::repository().join("data/surfaces/micrograph.png");
    fs::copy(micrograph, directory.path("own-2.png")).unwrap();
    directory.write("own.toml", format!("extends = \"{scene}\"\n[pin.base]\nimage = \"own-2.png\"\n"));
    let before = fs::read(directory.path("own-2.png")).unwrap();
    let outcome = directory.plateau(["surface", "run.h5", "--prepare", "own.toml", "--plot", "own.png", "--force"]);
    assert!(outcome.stderr.contains("own-2.png is an input and is not replaced"), "{}", outcome.stderr);
    assert!(fs::read(directory.path("own-2.png")).unwrap() == before && !picture("own.png"));
}
