//! Factors with ranges: response surfaces and lines of predictions.

use plateau_tests::figure::Text;
use plateau_tests::program::scene;
use plateau_tests::table::number;
use serde_json::Value;

use super::{
    AREA, DATA, FIBRES, LOAD, POOL, SPEED, effects, figure, figures, mean, read, studied, table_of_terms, term, width,
};

#[test]
fn a_central_composite_has_a_surface() {
    let factors = [
        format!("{LOAD}range = [\"8 N\", \"20 N\"]"),
        format!("{SPEED}range = [\"425 rpm\", \"850 rpm\"]"),
        format!("{FIBRES}range = [0.2, 0.4]"),
    ];
    let head = "design = \"central-composite\"\nalpha = \"rotatable\"";
    let directory = studied(head, &[&factors[0], &factors[1], &factors[2], AREA]);
    effects(&directory, &[]);
    let names = ["half-normal", "interactions", "main-effects", "pareto", "residuals", "surface"];
    assert_eq!(figures(&directory), names.map(|name| format!("contact-area-{name}")));
    let surface = figure(&directory, "contact-area-surface");
    let panel = surface.panel(surface.boxes()[0]);
    // Corners, axial points and the centre: by hand in the units of the study.
    let dots = surface.dots("#222222", panel.frame);
    assert_eq!(dots.len(), 9);
    assert!(surface.texts.iter().any(|text| text.text == "load, N"));
    let expected = panel.x.place(20.0);
    assert!(dots.iter().any(|dot| (dot[0] - expected).abs() < 2.0), "no dot at 20 N: {dots:?}");
    assert_eq!(surface.images.len(), 2);
    let page = read(&directory, "effects.html");
    assert!(page.contains("the others are at 0 in coded units") && page.contains("The fitted surface"));
}

#[test]
fn ranges_have_lines_of_predictions() {
    let factors =
        [format!("{LOAD}range = [\"5 N\", \"20 N\"]"), format!("{FIBRES}range = [0.02, 0.4]\nscale = \"logarithmic\"")];
    let directory = studied("design = \"latin-hypercube\"\npoints = 24", &[&factors[0], &factors[1], POOL, AREA]);
    effects(&directory, &[]);
    assert_eq!(figures(&directory).len(), 6, "a surface, for there are squares");
    let main = figure(&directory, "contact-area-main-effects");
    let boxes = main.boxes();
    let y = main.y_axis(boxes[0]);
    let line = main.line(DATA, boxes[0]);
    // Squares are the same at both ends: from end to end the line rises by the effect.
    let effect = number(&term(&directory, "load"), "effect") * 1e6;
    let rise = y.value(line[line.len() - 1][1]) - y.value(line[0][1]);
    let pixel = (y.value(0.0) - y.value(1.0)).abs();
    assert!((rise - effect).abs() < 2.5 * pixel, "{rise} and {effect}");
    assert!(width(boxes[1]) > 100.0 && main.texts.iter().any(|text| text.text == "fibres"));
    // Equal ratios are equally long: a decade is a decade of the axis.
    let ticks = ["0.02", "0.05", "0.1", "0.2"].map(|tick| {
        let own = |text: &&Text| text.text == tick && text.place[0] > boxes[1].x[0] && text.place[0] < boxes[1].x[1];
        main.texts.iter().find(own).unwrap_or_else(|| panic!("{tick}")).place[0]
    });
    assert!(((ticks[3] - ticks[2]) - (ticks[2] - ticks[1])).abs() < 2.0 && ticks[1] > ticks[0], "{ticks:?}");
    assert_eq!(main.dots(DATA, boxes[2]).len(), 2, "words have means");
}

#[test]
fn a_space_filling_design_is_fitted_with_squares_or_says_why_not() {
    let factors = [format!("{LOAD}range = [\"2 N\", \"40 N\"]"), format!("{FIBRES}range = [0.05, 0.6]")];
    let directory = studied("design = \"latin-hypercube\"\npoints = 20", &[&factors[0], &factors[1], AREA]);
    let of = |arguments: &[&str]| -> Value {
        let report: Value = serde_json::from_str(&effects(&directory, arguments).stdout).unwrap();
        report["responses"][0].clone()
    };
    let quadratic = of(&["--json"]);
    assert_eq!((quadratic["model"].as_str(), quadratic["misfit"].is_null()), (Some("quadratic"), true));
    // The mean is that of the runs, not what the model says in the middle, though that is near.
    let mean = mean(&directory, &[]) * 1e-6;
    assert!((quadratic["mean"].as_f64().unwrap() / mean - 1.0).abs() < 1e-12);
    assert!((quadratic["middle"].as_f64().unwrap() / mean - 1.0).abs() > 1e-5);

    // Interactions alone miss the curve, and the first lines say which model does not.
    let straight = of(&["--json", "--model", "interactions"]);
    assert_eq!(straight["misfit"]["model_to_try"].as_str(), Some("quadratic"));
    assert_eq!(straight["misfit"]["r_squared"], quadratic["r_squared"]);
    let text = effects(&directory, &["--model", "interactions"]).stdout;
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[1], "  model: main effects and interactions of two factors; as asked for");
    assert!(
        lines[2].starts_with("  lack of fit: try --model quadratic, which explains significantly more (p"),
        "{text}"
    );
    let page = read(&directory, "effects.html");
    assert!(page.contains("<p class=\"notice\">Lack of fit: try --model quadratic"));

    // A table of one's own that is too short for squares, with a line that is there twice.
    let table = "load,fibres\n2 N,0.3\n2 N,0.3\n9 N,0.1\n15 N,0.5\n22 N,0.2\n31 N,0.6\n40 N,0.4\n";
    directory.write("points.csv", table);
    let names = [LOAD, FIBRES, AREA];
    let base = scene("quick.toml");
    directory.write(
        "study.toml",
        format!("version = 1\nbase = \"{base}\"\nset = [\"operation.duration = '3 s'\"]\ndesign = \"csv\"\nfile = \"points.csv\"\n\
                 directory = \"results\"\n{}", names.join("\n")),
    );
    let ran = directory.plateau(["sweep", "run", "study.toml"]);
    // Those of the hypercube are still in the journal.
    assert!(ran.status == Some(0) && ran.stderr.contains("20 results are left out: of scenes that no run"), "{ran:?}");
    let text = effects(&directory, &[]).stdout;
    let reason = "model: main effects and interactions of two factors; no squares: 6 runs are too few for 6 coefficients and an error";
    assert!(text.starts_with("1 of 7 runs repeats another one and counts once with it: "), "{text}");
    assert!(text.lines().nth(3).unwrap().ends_with(reason), "{text}");
    // Six values of a number are a range, not six classes: two main effects and their product.
    let freedom: f64 = table_of_terms(&directory).iter().map(|row| number(row, "degrees_of_freedom")).sum();
    assert_eq!(freedom, 3.0);
}
