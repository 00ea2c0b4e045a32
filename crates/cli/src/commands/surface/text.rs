//! Surfaces as a table: a line for every parameter, a column for every surface.

use plateau_core::surface::Length;
use plateau_core::surface::describe::{PARAMETERS, Parameter};
use plateau_io::number;

use super::comparison::{Cells, Comparison, Row};
use super::describe::scale;
use super::subject::Subject;

/// What the heights do not determine, or what needs a pitch.
const NONE: &str = "-";

/// The table, and what there is to say besides.
pub fn text(subjects: &[Subject]) -> String {
    let cells = |cell: &dyn Fn(&Subject) -> String| subjects.iter().map(cell).collect::<Vec<_>>();
    let mut lines = vec![
        Line::new("", "", cells(&|subject| short_name(subject, subjects))),
        Line::new("size", "", cells(&size)),
        Line::new("points", "", cells(&|subject| format!("{} x {}", subject.columns, subject.rows))),
        Line::new("pitch", "", cells(&pitch)),
        Line::new(
            "measured",
            "",
            cells(&|subject| format!("{} %", number::significant(100.0 * subject.coverage(), 5))),
        ),
        Line::new("taken out", "", cells(&|subject| subject.level.to_owned())),
    ];
    let mut group = None;
    for parameter in PARAMETERS {
        if group != Some(parameter.group) {
            lines.push(Line::new("", "", Vec::new()));
            group = Some(parameter.group);
        }
        let name = format!("{:5}  {}", parameter.symbol, parameter.name);
        lines.push(Line::new(&name, scale(parameter).0, cells(&|subject| value(parameter, subject))));
    }
    let mut text = aligned(&lines);
    for subject in subjects {
        text.extend(subject.comparison.as_ref().map(|comparison| beside(subject, comparison)));
    }
    text.push_str(&remarks(subjects));
    text
}

/// A body beside the patch that it was made of.
fn beside(subject: &Subject, comparison: &Comparison) -> String {
    let heading = match &comparison.cells {
        Some(Cells { counts, size, .. }) => format!(
            "\n{}: its patch, the same averaged over {} x {} cells of {} x {} with its sampling error, and the difference to \
             these averages\n",
            subject.name,
            counts[0],
            counts[1],
            Length(size[0]),
            Length(size[1])
        ),
        None => format!("\n{}: its patch, in which no whole cell lies\n", subject.name),
    };
    let names = ["patch", "in cells", "+-", &subject.name, "difference"].map(str::to_owned);
    let mut lines = vec![Line::new("", "", names.into())];
    for Row { parameter, patch, cells, error, body, difference } in comparison.rows(&subject.description) {
        let (unit, factor) = scale(parameter);
        let cell = |value: f64, digits| {
            if value.is_nan() { NONE.to_owned() } else { number::significant(value * factor, digits) }
        };
        let cells = [cell(patch, 5), cell(cells, 5), cell(error, 2), cell(body, 5), cell(difference, 2)];
        lines.push(Line::new(parameter.symbol, unit, cells.into()));
    }
    heading + &aligned(&lines)
}

/// A line of the table.
struct Line {
    name: String,
    unit: &'static str,
    cells: Vec<String>,
}

impl Line {
    fn new(name: &str, unit: &'static str, cells: Vec<String>) -> Self {
        Self { name: name.to_owned(), unit, cells }
    }
}

/// Names to the left, values to the right of their columns.
fn aligned(lines: &[Line]) -> String {
    let length = |text: &str| text.chars().count();
    let name = lines.iter().map(|line| length(&line.name)).max().unwrap_or(0);
    let unit = lines.iter().map(|line| length(line.unit)).max().unwrap_or(0);
    let columns = lines.iter().map(|line| line.cells.len()).max().unwrap_or(0);
    let width = |column: usize| lines.iter().filter_map(|line| line.cells.get(column)).map(|cell| length(cell)).max();
    let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
    let mut text = String::new();
    for line in lines {
        let blanks = |text: &str, width: usize| " ".repeat(width.saturating_sub(length(text)));
        let mut row = format!("{}{}  {}{}", line.name, blanks(&line.name, name), line.unit, blanks(line.unit, unit));
        for (cell, width) in line.cells.iter().zip(&widths) {
            row.push_str(&format!("  {}{cell}", blanks(cell, *width)));
        }
        text.push_str(row.trim_end());
        text.push('\n');
    }
    text
}

/// The name of a file without its folder, unless another has the same; of maps of one run file what they are.
fn short_name(subject: &Subject, subjects: &[Subject]) -> String {
    // All are of one run file: its name would stand above each.
    let file = |subject: &Subject| subject.name.strip_suffix(&subject.map).map(str::to_owned);
    let is_beside = |other: &Subject| !other.map.is_empty() && file(other) == file(subject);
    if subjects.len() > 1 && subjects.iter().all(is_beside) {
        return subject.map.clone();
    }
    let short = |subject: &Subject| subject.name.rsplit('/').next().unwrap_or_default().to_owned();
    let name = short(subject);
    if subjects.iter().filter(|other| short(other) == name).count() > 1 { subject.name.clone() } else { name }
}

fn size(subject: &Subject) -> String {
    let Some([x, y]) = subject.pitch else { return NONE.to_owned() };
    format!("{} x {}", Length(subject.columns as f64 * x), Length(subject.rows as f64 * y))
}

fn pitch(subject: &Subject) -> String {
    match subject.pitch {
        None => "unknown".to_owned(),
        Some([x, y]) if x == y => Length(x).to_string(),
        Some([x, y]) => format!("{} x {}", Length(x), Length(y)),
    }
}

fn value(parameter: &Parameter, subject: &Subject) -> String {
    let below = subject.description.autocorrelation.map_or(f64::NAN, |spatial| spatial.aspect_ratio_below);
    match (parameter.value)(&subject.description) {
        Some(value) if !value.is_nan() => number::significant(value * scale(parameter).1, 6),
        Some(_) if parameter.symbol == "Str" && !below.is_nan() => number::less_than(below, 3),
        _ => NONE.to_owned(),
    }
}

/// What files say of themselves, what a scene did, and why parameters are not there.
fn remarks(subjects: &[Subject]) -> String {
    let mut text = String::new();
    for subject in subjects.iter() {
        text.push_str(&format!("\n{}: {}\n", subject.name, subject.origin));
        for note in &subject.notes {
            text.push_str(&format!("  {note}\n"));
        }
        let missing = subject.points() - subject.description.measured;
        if missing > 0 {
            text.push_str(&format!("  {} of {} points are missing and take no part\n", missing, subject.points()));
        }
        if subject.description.heights.maximum_height() == 0.0 {
            text.push_str("  flat: all its heights are equal, so what tells of their shape has no value\n");
        }
        if subject.description.autocorrelation.is_some_and(|spatial| spatial.below_pitch) {
            text.push_str(
                "  Sal and Str have no value: from each point to the next the heights are all but unrelated\n",
            );
        }
        if subject.pitch.is_none() {
            text.push_str("  Sdq, Sdr, Sal and Str need the distance of the points: give --pitch\n");
        }
    }
    text
}
