use std::time::{Duration, Instant};

use super::*;

#[test]
fn the_locale_is_that_of_the_first_variable_that_is_set() {
    let with = |all: &'static str, lang: &'static str| {
        is_unicode(move |name| match name {
            "LC_ALL" => Some(all.to_owned()),
            "LANG" => Some(lang.to_owned()),
            _ => None,
        })
    };
    assert!(with("", "de_DE.UTF-8") && with("C.utf8", "C") && !with("C", "de_DE.UTF-8") && !with("", ""));
    assert!(!with("", "de_DE.ISO-8859-1"));
}

#[test]
fn a_straight_line_is_a_diagonal() {
    let lines = curve(&[0.0, 4.0], &[1.0, 5.0], (1.0, 5.0), (5, 5), false);
    assert_eq!(lines, ["    *", "   * ", "  *  ", " *   ", "*    "]);
    // In Braille, by the table of the Unicode standard: dots 7, 3+... going up one row and one column at a time.
    let lines = curve(&[0.0, 3.0], &[0.0, 3.0], (0.0, 3.0), (2, 1), true);
    assert_eq!(lines, ["\u{2860}\u{280a}"]); // dots 7 and 6, then 2 and 4
}

#[test]
fn many_samples_in_one_column_are_all_seen() {
    let times: Vec<f64> = (0..1000).map(f64::from).collect();
    let values: Vec<f64> = (0..1000).map(|sample| f64::from(sample % 2)).collect();
    assert_eq!(curve(&times, &values, (0.0, 1.0), (3, 2), false), ["***", "***"]);
}

#[test]
fn nothing_constant_and_not_finite_are_drawn() {
    assert_eq!(curve(&[], &[], (0.0, 1.0), (3, 1), false), ["   "]);
    assert_eq!(curve(&[1.0], &[2.0], (2.0, 2.0), (1, 1), false), ["*"]);
    let values = [1.0, f64::NAN, 1.0];
    assert_eq!(curve(&[0.0, 1.0, 2.0], &values, (0.0, 1.0), (3, 2), false), ["***", "   "]);
    assert_eq!(curve(&[0.0, 1.0], &[0.0, 1.0], (0.0, 1.0), (0, 0), true), [""; 0]);
}

fn look() -> Look {
    Look {
        title: "Größe\u{1b}[2J".into(),
        state: State::Running,
        error: None,
        times: vec![1.0, 2.0, 3.0],
        duration: Some(12.0),
        contact_area: vec![1e-6, 2e-6, 4e-6],
        contact_area_mean: vec![1e-6, 1.5e-6, 2e-6],
        filled_fraction: Some(0.25),
        elapsed: Some(Duration::from_secs(6)),
        age: Duration::ZERO,
    }
}

#[test]
fn a_line_says_it_all() {
    let pace = Pace::new(Instant::now());
    // 3 s in 6 s: 0.5 s a second, 9 s to go.
    assert_eq!(
        line(&look(), &pace, None, false),
        "running: 3.000 of 12.00 s (25 %), 0.5000 simulated s per s, 18.0 s left, 3 samples, \
             contact area 4.0000 mm2, mean of the last revolution 2.0000 mm2, disc filled 25.0 %"
    );
    let warned = line(&look(), &pace, Some("no new sample"), true);
    assert!(warned.contains(", 0.5000 simulated s per s, 3 samples, "), "{warned}");
}

#[test]
fn pages_fit_every_terminal() {
    let pace = Pace::new(Instant::now());
    for unicode in [false, true] {
        for width in [1, 10, 30, 80, 200] {
            for height in [1, 5, 10, 24, 80] {
                let lines =
                    page(&look(), &pace, Some("the run may have been killed"), Style { unicode, width, height });
                let longest = lines.iter().map(|line| console::measure_text_width(line)).max().unwrap();
                assert!(longest < width.max(2), "{width} x {height}: {lines:?}");
                assert!(lines.len() < height.max(2), "{width} x {height}: {lines:?}");
                assert!(unicode || lines.iter().all(|line| line.is_ascii()), "{lines:?}");
                assert!(!lines[0].contains("\u{1b}[2J"), "{lines:?}");
            }
        }
    }
    let narrow = page(&look(), &pace, None, Style { unicode: false, width: 40, height: 10 });
    assert_eq!(
        narrow[1..],
        [
            "###-----------  3.000 of 12.00 s (25 %)",
            "0.5000 simulated s per s, 18.0 s left,",
            "3 samples",
            "contact area 4.0000 mm2,",
            "mean of the last revolution 2.0000 mm2,",
            "disc filled 25.0 %",
        ]
    );
    let lines = page(&look(), &pace, None, Style { unicode: false, width: 60, height: 24 });
    assert!(lines.iter().any(|line| line.starts_with("2.000 |") && line.ends_with('*')), "{lines:?}");
    assert!(lines.iter().any(|line| line.starts_with("1.000 |*")), "{lines:?}");
}
