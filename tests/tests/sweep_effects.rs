//! `plateau sweep effects`: figures and page show what the table has.

mod ranges;

use std::fs;

use plateau_tests::figure::{Figure, Frame};
use plateau_tests::program::{Outcome, WorkingDirectory, scene};
use plateau_tests::table::{Row, number, rows};
use serde_json::Value;

/// Colour of means, and of bars and dots that are significant.
const DATA: &str = "#31688E";
/// Colour of bars and dots that are not.
const PALE: &str = "#9DBFD6";
/// Colours of the lines of interaction plots.
const LINES: [&str; 2] = ["#0072B2", "#D55E00"];

const LOAD: &str = "[[factor]]\nname = \"load\"\nkey = \"operation.normal_force\"\n";
const SPEED: &str = "[[factor]]\nname = \"speed\"\nkey = \"operation.rotational_speed\"\n";
const POOL: &str = "[[factor]]\nname = \"pool\"\nkey = \"plateaus.debris\"\nlevels = [\"contact\", \"track\"]\n";
const FIBRES: &str = "[[factor]]\nname = \"fibres\"\nkey = \"pin.base.synthetic.fibre_fraction\"\n";
const REPLICATES: &str = "[replicates]\nkeys = [\"disc.surface.synthetic.seed\"]\nseeds = [1, 2, 3]\n";
const AREA: &str = "[[response]]\nname = \"contact area\"\ndataset = \"/series/contact_area_mean\"\nat = \"end\"\n";
/// The disc wears only where a scene says so.
const CONSTANT: &str = "[[response]]\nname = \"disc wear\"\ndataset = \"/series/worn_disc\"\nat = \"end\"\n";

/// A directory with `study.toml`, all of whose runs were made, as far as they can be.
fn studied(head: &str, tables: &[&str]) -> WorkingDirectory {
    let directory = WorkingDirectory::new();
    let base = scene("quick.toml");
    directory.write(
        "study.toml",
        format!(
            "version = 1\nbase = \"{base}\"\nset = [\"operation.duration = '3 s'\", \"output.sample_every = '0.5 s'\", \
             \"plateaus.debris = 'contact'\", \"plateaus.captured_fraction = 0.06\"]\n\
             directory = \"results\"\n{head}\n{}",
            tables.join("\n")
        ),
    );
    let outcome = directory.plateau(["sweep", "run", "study.toml"]);
    assert!(matches!(outcome.status, Some(0 | 1)), "{outcome:?}");
    directory
}

/// Analyses the study.
fn effects(directory: &WorkingDirectory, arguments: &[&str]) -> Outcome {
    let outcome = directory.plateau(["sweep", "effects", "study.toml", "--force"].iter().chain(arguments));
    assert_eq!(outcome.status, Some(0), "{outcome:?}");
    outcome
}

fn read(directory: &WorkingDirectory, file: &str) -> String {
    fs::read_to_string(directory.path("results/effects").join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
}

fn figure(directory: &WorkingDirectory, name: &str) -> Figure {
    Figure::read(&read(directory, &format!("{name}.svg")))
}

/// Names of all figures, each of which is there in every format.
fn figures(directory: &WorkingDirectory) -> Vec<String> {
    let entries = fs::read_dir(directory.path("results/effects")).unwrap();
    let names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    let mut figures: Vec<String> =
        names.iter().filter_map(|name| name.strip_suffix(".svg")).map(str::to_owned).collect();
    figures.sort();
    for figure in &figures {
        for ending in ["png", "pdf"] {
            assert!(names.contains(&format!("{figure}.{ending}")), "{figure} in {names:?}");
        }
    }
    figures
}

/// The row of a term.
fn term(directory: &WorkingDirectory, name: &str) -> Row {
    rows(&read(directory, "effects.csv")).into_iter().find(|row| row["term"] == name).expect("the term")
}

/// The mean of the contact area, mm², over the runs that have these cells in their table.
fn mean(directory: &WorkingDirectory, cells: &[(&str, &str)]) -> f64 {
    directory.plateau(["sweep", "collect", "study.toml"]).quiet_success();
    let rows = rows(&fs::read_to_string(directory.path("results/results.csv")).unwrap());
    let own = rows.iter().filter(|row| cells.iter().all(|(column, cell)| row[*column] == *cell));
    let values: Vec<f64> = own.map(|row| number(row, "contact area [m2]") * 1e6).collect();
    values.iter().sum::<f64>() / values.len() as f64
}

fn width(frame: Frame) -> f64 {
    frame.x[1] - frame.x[0]
}

/// Every text begins or ends on the page.
fn expect_texts_on_the_page(svg: &str) {
    let (_, view) = svg.split_once("viewBox=\"0 0 ").expect("a size");
    let size: Vec<f64> = view.split('"').next().unwrap().split(' ').map(|side| side.parse().unwrap()).collect();
    let figure = Figure::read(svg);
    for text in &figure.texts {
        let inside = |place: f64, size: f64| (0.0..=size).contains(&place);
        assert!(inside(text.place[0], size[0]) && inside(text.place[1], size[1]), "{text:?} on {size:?}");
    }
    for (_, places) in figure.lines.iter().chain(&figure.areas) {
        assert!(places.iter().all(|[x, y]| (0.0..=size[0]).contains(x) && (0.0..=size[1]).contains(y)));
    }
}

/// Three factors of two levels, three sets of surfaces: an error is known.
fn replicated() -> WorkingDirectory {
    let factors = [&format!("{LOAD}levels = [\"5 N\", \"10 N\"]"), POOL, &format!("{FIBRES}levels = [0.2, 0.4]")];
    studied(
        "title = \"Replicated\"\ndesign = \"full-factorial\"",
        &[REPLICATES, factors[0], factors[1], factors[2], AREA],
    )
}

#[test]
fn a_design_with_as_many_terms_as_runs_says_what_would_tell_an_error() {
    let levels = "[[factor]]\nname = \"pin\"\nkey = \"pin.base.synthetic.fibre_fraction\"\nlevels = [0.2, 0.5, 0.7]\n";
    let directory = studied("design = \"full-factorial\"", &[POOL, levels, AREA]);
    let said = effects(&directory, &["--model", "interactions"]).stdout;
    assert!(
        said.contains("give [replicates] of seeds, such as those of the disc, or a smaller model such as --model main"),
        "{said}"
    );
    // Levels have no units: one equation says it.
    assert_eq!(said.matches("contact area [mm²] =").count(), 1, "{said}");
    assert!(said.contains("by levels: [factor level] is 1 at this level, else 0"), "{said}");
    // The scene of the study is that of none of its runs.
    directory.plateau(["sweep", "collect", "study.toml"]);
    let scene = hdf5::File::open(directory.path("results/results.h5")).unwrap().attr("base_scene").unwrap();
    let scene: hdf5::types::VarLenUnicode = scene.read_scalar().unwrap();
    assert!(scene.contains("fibre_fraction = 0.3"), "{scene}");
}

#[test]
fn figures_show_the_means_and_effects_of_the_table() {
    let directory = replicated();
    let text = effects(&directory, &[]).stdout;
    let names = ["half-normal", "interactions", "main-effects", "pareto", "residuals"]
        .map(|name| format!("contact-area-{name}"));
    assert_eq!(figures(&directory), names);
    assert!(text.contains("effects.html") && text.contains("5 figures as PNG, SVG and PDF"), "{text}");

    // Means of the runs at a level, and their difference: the effect.
    let main = figure(&directory, "contact-area-main-effects");
    let boxes = main.boxes();
    assert_eq!(boxes.len(), 3);
    let y = main.y_axis(boxes[0]);
    let factors = [
        ("load", "load [N]", ["5.0", "10.0"]),
        ("pool", "pool", ["contact", "track"]),
        ("fibres", "fibres", ["0.2", "0.4"]),
    ];
    for (frame, (factor, column, levels)) in boxes.iter().zip(factors) {
        let dots = main.dots(DATA, *frame);
        assert_eq!(dots.len(), 2, "{factor}");
        for (dot, level) in dots.iter().zip(levels) {
            let expected = y.place(mean(&directory, &[(column, level)]));
            assert!((dot[1] - expected).abs() < 1.5, "{factor} {level}: {} and {expected}", dot[1]);
        }
        let effect = number(&term(&directory, factor), "effect") * 1e6;
        assert!((dots[0][1] - dots[1][1] - (y.place(0.0) - y.place(effect))).abs() < 2.5, "{factor}");
    }

    // Means of pairs of levels.
    let pairs = figure(&directory, "contact-area-interactions");
    let boxes = pairs.boxes();
    assert_eq!(boxes.len(), 3);
    let y = pairs.y_axis(boxes[0]);
    for (colour, load) in LINES.iter().zip(["5.0", "10.0"]) {
        for (dot, pool) in pairs.dots(colour, boxes[0]).iter().zip(["contact", "track"]) {
            let expected = y.place(mean(&directory, &[("load [N]", load), ("pool", pool)]));
            assert!((dot[1] - expected).abs() < 1.5, "{load}, {pool}");
        }
    }

    // Bars as long as abs(t), the longest on top.
    let pareto = figure(&directory, "contact-area-pareto");
    let frame = pareto.boxes()[0];
    let x = pareto.x_axis(frame);
    let rows = rows(&read(&directory, "effects.csv"));
    let mut lengths: Vec<f64> =
        rows.iter().filter(|row| !row["t"].is_empty()).map(|row| number(row, "t").abs()).collect();
    lengths.sort_by(|one, other| other.total_cmp(one));
    let bars: Vec<_> = pareto
        .areas
        .iter()
        .filter(|(colour, bar)| (colour == DATA || colour == PALE) && bar[0][1] > frame.y[0])
        .collect();
    assert_eq!(bars.len(), 6);
    for ((_, bar), length) in bars.iter().zip(lengths) {
        let end = bar.iter().map(|corner| corner[0]).fold(0.0, f64::max);
        assert!((end - x.place(length)).abs() < 2.0, "{end} and {}", x.place(length));
    }

    // Sizes of effects, from the smallest; the load is named.
    let half = figure(&directory, "contact-area-half-normal");
    let panel = half.panel(half.boxes()[0]);
    let mut dots = [half.dots(DATA, panel.frame), half.dots(PALE, panel.frame)].concat();
    dots.sort_by(|one, other| one[0].total_cmp(&other[0]));
    let mut sizes: Vec<f64> =
        rows.iter().filter(|row| !row["effect"].is_empty()).map(|row| number(row, "effect").abs() * 1e6).collect();
    sizes.sort_by(f64::total_cmp);
    assert_eq!(dots.len(), sizes.len());
    for (dot, size) in dots.iter().zip(sizes) {
        assert!((dot[1] - panel.y.place(size)).abs() < 1.5);
    }
    assert!(half.texts.iter().any(|text| text.text == "load"));
    for name in names {
        expect_texts_on_the_page(&read(&directory, &format!("{name}.svg")));
    }
}

#[test]
fn the_page_holds_every_term_and_loads_nothing() {
    let directory = replicated();
    let report: Value = serde_json::from_str(&effects(&directory, &["--json"]).stdout).unwrap();
    let files: Vec<&str> = report["files"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    assert_eq!(files.len(), 3 + 3 * 5);
    assert!(files.iter().all(|file| directory.path(file).is_file()), "{files:?}");
    let page = read(&directory, "effects.html");
    for row in rows(&read(&directory, "effects.csv")) {
        assert!(page.contains(&format!("<th scope=\"row\">{}</th>", row["term"])), "{row:?}");
    }
    for loading in ["src=", "http:", "https:", "url(", "@import", "fetch(", "<link rel=\"stylesheet"] {
        let rest = page.replace("http://www.w3.org/2000/svg", "");
        assert!(!rest.contains(loading), "{loading}");
    }
    // The design, and all runs with their values.
    assert!(page.contains("8 points × 3 replicates = 24 runs: 24 finished"));
    let (_, data) = page.split_once("<script type=\"application/json\" id=\"data\">").unwrap();
    let data: Value = serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap();
    let runs = data["runs"].as_array().unwrap();
    assert_eq!((runs.len(), page.matches("<path class=\"c").count()), (24, 24));
    let total: f64 = runs.iter().map(|run| run[3].as_f64().unwrap()).sum();
    assert!((total / 24.0 / mean(&directory, &[]) - 1.0).abs() < 1e-5);
}

#[test]
fn names_are_text_wherever_they_stand() {
    let name = "</script><script>alert(1)</script><b>\\\"x\\\" & 'y'";
    let load = format!("[[factor]]\nname = \"{name}\"\nkey = \"operation.normal_force\"\nlevels = [\"5 N\", \"10 N\"]");
    let area = AREA.replace("contact area", name);
    let directory = studied(&format!("title = \"{name}\"\ndesign = \"full-factorial\""), &[&load, POOL, &area]);
    effects(&directory, &[]);
    let page = read(&directory, "effects.html");
    assert_eq!(page.matches("<script").count(), 2);
    assert_eq!(
        page.matches("alert(1)").count(),
        page.matches("script&gt;alert(1)").count() + page.matches("script>alert(1)\\u003c").count()
    );
    assert!(!page.contains("<b>"));
    for figure in figures(&directory) {
        assert!(figure.chars().all(|letter| letter.is_alphanumeric() || letter == '-'), "{figure}");
        expect_texts_on_the_page(&read(&directory, &format!("{figure}.svg")));
    }
}

#[test]
fn one_factor_without_replicates_has_what_there_is() {
    let directory = studied("design = \"full-factorial\"", &[&format!("{LOAD}levels = [\"5 N\", \"10 N\"]"), AREA]);
    effects(&directory, &[]);
    assert_eq!(figures(&directory), ["contact-area-main-effects", "contact-area-pareto"]);
    let page = read(&directory, "effects.html");
    assert!(page.contains("Interactions need two factors") && page.contains("half-normal plot needs at least 3"));
    let pareto = figure(&directory, "contact-area-pareto");
    let frame = pareto.boxes()[0];
    let effect = pareto.x_axis(frame).place(number(&term(&directory, "load"), "effect").abs() * 1e6);
    let ends = pareto.areas.iter().flat_map(|(_, bar)| bar).map(|corner| corner[0]);
    assert!((ends.fold(0.0, f64::max) - effect).abs() < 2.0);
}

#[test]
fn a_saturated_study_is_judged_by_the_margin_of_lenth() {
    let factors = [
        format!("{LOAD}levels = [\"5 N\", \"10 N\"]"),
        format!("{SPEED}levels = [\"425 rpm\", \"850 rpm\"]"),
        format!("{FIBRES}levels = [0.2, 0.4]"),
    ];
    let directory = studied("design = \"full-factorial\"", &[&factors[0], &factors[1], &factors[2], AREA]);
    let text = effects(&directory, &["--model", "full"]).stdout;
    let (_, after) = text.split_once("margin of error ").expect("a margin");
    let (margins, _) = after.split_once(" (Lenth)").unwrap();
    let in_si = |margin: &str| 1e-6 * margin.strip_suffix(" mm²").expect("mm²").parse::<f64>().unwrap();
    let margins: Vec<f64> = margins.split(", simultaneous ").map(in_si).collect();
    // Of seven effects: qt((1 + 0.95^(1/7))/2, 7/3) by qt(0.975, 7/3) of R 4.2.2.
    assert!((margins[1] / margins[0] / (9.008_307_114 / 3.764_123_072) - 1.0).abs() < 2e-3, "{margins:?}");
    let report: Value = serde_json::from_str(&effects(&directory, &["--model", "full", "--json"]).stdout).unwrap();
    let row = term(&directory, "load");
    let lenth = &report["responses"][0]["lenth"];
    let told = [("margin_of_error", "#C44E1C"), ("simultaneous_margin_of_error", "#222222")];
    let pareto = figure(&directory, "contact-area-pareto");
    let frame = pareto.boxes()[0];
    for ((key, colour), margin) in told.into_iter().zip(margins) {
        assert!((lenth[key].as_f64().unwrap() / margin - 1.0).abs() < 1e-3);
        assert_eq!(lenth[key].as_f64(), Some(number(&row, key)));
        // From the top of the box to its bottom, between its sides.
        let height = frame.y[1] - frame.y[0];
        let is_limit = |(other, line): &&(String, Vec<[f64; 2]>)| {
            let is_inside = |[x, _]: &[f64; 2]| *x > frame.x[0] + 1.0 && *x < frame.x[1] - 1.0;
            other == colour && line.iter().all(is_inside) && (line[0][1] - line[line.len() - 1][1]).abs() > 0.9 * height
        };
        let (_, line) = pareto.lines.iter().find(is_limit).expect("a line");
        assert!((line[0][0] - pareto.x_axis(frame).place(margin * 1e6)).abs() < 3.0, "{margin} at {line:?}");
    }
    for label in ["margin of error (Lenth, 95 %)", "simultaneous margin: "] {
        assert!(pareto.texts.iter().any(|text| text.text.starts_with(label)), "{label}");
    }
}

/// The rows of terms.
fn table_of_terms(directory: &WorkingDirectory) -> Vec<Row> {
    let rows = rows(&read(directory, "effects.csv"));
    rows.into_iter().filter(|row| !["residual", "total"].contains(&row["term"].as_str())).collect()
}

#[test]
fn a_constant_response_and_failed_runs_are_told() {
    let load = format!("{LOAD}levels = [\"5 N\", \"10 N\", \"20 N\", \"1e300 N\"]");
    let directory = studied("design = \"full-factorial\"", &[REPLICATES, &load, POOL, CONSTANT, AREA]);
    let outcome = effects(&directory, &["--json"]);
    assert!(outcome.stderr.contains("6 of 24 runs have no results"), "{}", outcome.stderr);
    assert!(figures(&directory).iter().all(|name| name.starts_with("contact-area-")));
    let page = read(&directory, "effects.html");
    assert!(page.contains("no factor has an effect on it") && page.contains("6 failed, 0 not made yet"));
    // Runs without a response end before its axis.
    assert_eq!(page.matches("<path class=\"none\"").count(), 6);
    let main = figure(&directory, "contact-area-main-effects");
    assert_eq!(main.dots(DATA, main.boxes()[0]).len(), 3);
    expect_texts_on_the_page(&read(&directory, "contact-area-main-effects.svg"));
}
