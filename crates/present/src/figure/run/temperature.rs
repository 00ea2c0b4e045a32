//! Temperatures of contact, disc and pin against time (model section 11).

use plateau_io::run_file::ReadError;

use super::spans::pieces;
use super::{Figures, Subject, operation};
use crate::envelope::thin;
use crate::figure::axes::Axis;
use crate::figure::chart::{Chart, Meaning, TWO_COLUMNS, around, page};
use crate::figure::page::Content;
use crate::figure::stroke::Stroke;
use crate::quantity::{SeriesLook, Unit};

const NAME: &str = "temperature";
/// Those that every run with heat has: they share a scale.
const BODIES: [&str; 3] = ["contact_temperature", "disc_temperature", "pin_temperature"];
/// Those over the cells of the pin, which can be far hotter: each has a scale of its own.
const CELLS: [&str; 2] = ["contact_temperature_heated", "contact_temperature_max"];
/// Samples of a line, at most: temperatures do not fluctuate from step to step, and none of their peaks is lost.
const MOST_POINTS: usize = 2000;

/// A series of several runs, by the numbers of the runs.
struct Course<'a> {
    look: SeriesLook,
    runs: Vec<(usize, &'a Subject<'a>, Vec<f64>)>,
}

/// Adds the figure.
pub fn add(subjects: &[Subject], figures: &mut Figures) -> Result<(), ReadError> {
    let mut courses = Vec::new();
    for names in [&BODIES[..], &CELLS[..1], &CELLS[1..]] {
        let having = figures.with_part(NAME, subjects, names);
        for name in names {
            let mut runs = Vec::new();
            for (number, subject) in &having {
                runs.push((*number, *subject, celsius(subject, name)?));
            }
            if !runs.is_empty() {
                courses.push(Course { look: SeriesLook::of(name), runs });
            }
        }
    }
    if courses.is_empty() {
        return Ok(());
    }
    let runs = || courses.iter().flat_map(|course| &course.runs);
    let end = runs().filter_map(|(_, subject, _)| subject.run.time().last()).copied().fold(0.0, f64::max);
    let time = Unit::for_size("s", end);
    let is_body = |course: &&Course| BODIES.contains(&course.look.name);
    let of_bodies =
        around(courses.iter().filter(is_body).flat_map(|course| &course.runs).flat_map(|(_, _, values)| values));
    let chart = |course: &Course| {
        let own = || around(course.runs.iter().flat_map(|(_, _, values)| values));
        let range = if is_body(&course) { of_bodies.clone() } else { own() };
        let lines = course.runs.iter().flat_map(|(number, subject, values)| {
            let stroke = Stroke::of(*number, subjects.len());
            let curve = curve(subject.run.time(), values, &time);
            curve.into_iter().map(move |points| Content::Line { points, stroke })
        });
        Chart {
            title: course.look.title.to_owned(),
            x: Axis::linear(0.0..=time.value(end), time.label("time")),
            y: Axis::linear(range, course.look.unit.label("temperature")),
            contents: lines.collect(),
        }
    };
    let mut charts: Vec<Chart> = courses.iter().map(chart).collect();
    let shade = operation::shade_events(subjects, &time, &mut charts)?;
    let of_cells = if courses.iter().all(|course| is_body(&course)) {
        ""
    } else {
        " Those of cells count pressures as frozen during a pass and have no conduction along the surface: on rough discs the \
         hottest may be half of their rise too low."
    };
    let is_shown = |number: usize| runs().any(|(other, ..)| *other == number);
    let shown = subjects.iter().enumerate().filter(|(number, _)| is_shown(*number));
    let meanings = shown.map(|(number, subject)| Meaning::of_run(number, &subject.label));
    let meanings: Vec<Meaning> = meanings.chain(shade).collect();
    let width = figures.width(TWO_COLUMNS);
    figures.add(
        NAME,
        "Temperatures",
        format!(
            "Temperatures against time; contact, disc and pin share a scale. A lifted pin has no contact, and no temperature of \
             it. Events of a single run with a cycle that has ended are shaded.{of_cells}"
        ),
        page(width, 560.0, 3, charts, &meanings),
    );
    Ok(())
}

/// A series in degrees Celsius.
fn celsius(subject: &Subject, name: &str) -> Result<Vec<f64>, ReadError> {
    let kelvins = subject.run.values(name)?.unwrap_or_default();
    Ok(kelvins.iter().map(|value| Unit::CELSIUS.value(*value)).collect())
}

/// A curve in the unit of time, with gaps where there is no number.
fn curve(times: &[f64], values: &[f64], time: &Unit) -> Vec<Vec<[f64; 2]>> {
    let points = thin(values, MOST_POINTS).into_iter().map(|sample| [time.value(times[sample]), values[sample]]);
    pieces(&points.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::RUNS;
    use crate::figure::run::written::{Written, lines_of, notes};

    /// Ten seconds with a pin that is lifted at 4 s and 5 s, in K.
    fn run(title: &'static str, series: &[&'static str]) -> Written {
        Written::new(title, series, |name, time| match name {
            "contact_temperature" if [4.0, 5.0].contains(&time) => f64::NAN,
            "contact_temperature" => 300.0 + 10.0 * time,
            "contact_temperature_heated" => 400.0 + time,
            "contact_temperature_max" => 900.0 + time,
            "disc_temperature" => 296.15,
            "pin_temperature" => 296.15 + time,
            _ => time,
        })
    }

    #[test]
    fn temperatures_are_in_degrees_celsius_with_gaps_where_nothing_touches() {
        let cells = [&BODIES[..], &CELLS].concat();
        let runs = [run("one", &cells), run("two", &BODIES), run("cold", &[])];
        let figures = Written::figures(&runs);
        let figure = figures.figures.iter().find(|figure| figure.name == NAME).unwrap();
        let [contact, disc, pin, heated, largest] = &figure.page.panels[..] else { panic!("five boxes") };
        assert_eq!(contact.axes.y.label, "temperature, °C");
        let line = |panel, number: usize| lines_of(panel, RUNS[number]);
        for number in [0, 1] {
            let [before, after] = &line(contact, number)[..] else { panic!("a gap") };
            // By hand: 300 K are 26.85 °C; three samples before the gap, five behind it.
            assert_eq!((before.len(), after.len(), after[0][0]), (3, 5, 6.0));
            assert!((before[0][1] - 36.85).abs() < 1e-9 && (after[4][1] - 126.85).abs() < 1e-9);
            assert!(line(disc, number)[0].iter().all(|[_, value]| (value - 23.0).abs() < 1e-9));
            assert!((line(pin, number)[0][9][1] - 33.0).abs() < 1e-9);
        }
        assert!((line(heated, 0)[0][0][1] - 127.85).abs() < 1e-9 && (line(largest, 0)[0][0][1] - 627.85).abs() < 1e-9);
        assert!(line(heated, 1).is_empty() && line(contact, 2).is_empty());
        assert!(contact.axes.y.range == pin.axes.y.range && contact.axes.y.range.contains(&23.0));
        let [heated, largest] = CELLS.map(|name| format!("no series {name}"));
        assert_eq!(notes(&figures, NAME), [&heated, &largest, "no series contact_temperature", &heated, &largest]);
    }

    #[test]
    fn no_peak_of_many_samples_is_lost() {
        let times: Vec<f64> = (0..50_000).map(f64::from).collect();
        let mut values = vec![20.0; times.len()];
        values[12_345] = 80.0;
        values[30_000..31_000].fill(f64::NAN);
        let pieces = curve(&times, &values, &Unit::usual("s"));
        assert_eq!(pieces.len(), 2);
        assert!(pieces.concat().len() <= MOST_POINTS && pieces[0].contains(&[12_345.0, 80.0]));
    }
}
