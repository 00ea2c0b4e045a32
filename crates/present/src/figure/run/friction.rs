//! Coefficient of friction against time and against contact pressure (model section 10).

use plateau_io::run_file::ReadError;

use super::legend::of_short_runs;
use super::spans::Spans;
use super::{Figures, Subject, operation};
use crate::figure::axes::{Axis, Scale};
use crate::figure::chart::{Chart, Meaning, TWO_COLUMNS, around, page, up_from_zero};
use crate::figure::page::Content;
use crate::figure::stroke::Stroke;
use crate::quantity::{SeriesLook, Unit};

const NAME: &str = "friction";
const SERIES: [&str; 3] = ["friction_coefficient_mean", "friction_coefficient", "mean_pressure"];
/// What the line of a run is.
const MEAN: &str = "mean of the last simulated revolution";
/// Samples of a run that are marked, at most: more would hide each other.
const MOST_MARKS: usize = 200;
/// Pressures that differ more than this many times are shown on a scale of equal ratios.
const MOST_LINEAR: f64 = 20.0;

/// Friction of a run, pressures in Pa.
struct Course<'a> {
    number: usize,
    subject: &'a Subject<'a>,
    /// Means over a simulated revolution, of every sample; no number where nothing rubs.
    means: Vec<f64>,
    /// Pressure and coefficient of single steps.
    steps: Vec<[f64; 2]>,
}

/// Adds the figure.
pub fn add(subjects: &[Subject], figures: &mut Figures) -> Result<(), ReadError> {
    let mut courses = Vec::new();
    for (number, subject) in figures.with_part(NAME, subjects, &SERIES) {
        let values = |name| Ok(subject.run.values(name)?.unwrap_or_default());
        let means = operation::while_rubbing(subject.run, values(SERIES[0])?)?;
        let coefficients = operation::while_rubbing(subject.run, values(SERIES[1])?)?;
        let steps = steps(&values(SERIES[2])?, &coefficients);
        courses.push(Course { number, subject, means, steps });
    }
    if courses.is_empty() {
        return Ok(());
    }
    let end = courses.iter().filter_map(|course| course.subject.run.time().last()).copied().fold(0.0, f64::max);
    let time = Unit::for_size("s", end);
    let steps = || courses.iter().flat_map(|course| &course.steps);
    let coefficients =
        courses.iter().flat_map(|course| &course.means).chain(steps().map(|[_, coefficient]| coefficient));
    let y = Axis::linear(around(coefficients), SeriesLook::of("friction_coefficient").title);
    let (x, pressure) = pressure_axis(steps().map(|[pressure, _]| *pressure));
    let times = || courses.iter().map(|course| course.subject.run.time());
    let spans = match courses.iter().any(|course| operation::has_cycle(course.subject)) {
        true => Spans::FINEST,
        false => Spans::calm(times().zip(courses.iter().map(|course| &course.means[..]))),
    };
    let (mut lines, mut marks) = (Vec::new(), Vec::new());
    for course in &courses {
        let stroke = Stroke::of(course.number, subjects.len());
        let in_units = |[at, mean]: [f64; 2]| [time.value(at), mean];
        lines.extend(spans.lines(course.subject.run.time(), &course.means, in_units, stroke));
        let points = course.steps.iter().map(|[at, coefficient]| [pressure.value(*at), *coefficient]).collect();
        marks.push(Content::Dots { points, colour: stroke.colour });
    }
    let mut charts = [
        Chart {
            title: spans.meaning(MEAN),
            x: Axis::linear(0.0..=time.value(end), time.label("time")),
            y: y.clone(),
            contents: lines,
        },
        Chart { title: "samples of single steps".to_owned(), x, y: y.shared(), contents: marks },
    ];
    let shade = operation::shade_events(subjects, &time, &mut charts[..1])?;
    let meanings = courses.iter().map(|course| Meaning::of_run(course.number, &course.subject.label));
    let short =
        of_short_runs(spans, courses.iter().map(|course| (&*course.subject.label, course.subject.run.time())), MEAN);
    let meanings: Vec<Meaning> = meanings.chain(short).chain(shade).collect();
    let width = figures.width(TWO_COLUMNS);
    figures.add(
        NAME,
        "Coefficient of friction",
        format!(
            "Coefficient of friction, left the mean of the last simulated revolution, weighted by load, or, where this goes up and down all along and the run is long enough, its weighted mean \
             over the time that is stated, against time, right that \
             of single steps against their mean contact pressure; of a run at most {MOST_MARKS} samples, evenly chosen. Events of a \
             single run with a cycle that has ended are shaded."
        ),
        page(width, 640.0, 2, charts.into(), &meanings),
    );
    Ok(())
}

/// Pressure and coefficient of the samples in which the pin rubs, evenly chosen.
fn steps(pressures: &[f64], coefficients: &[f64]) -> Vec<[f64; 2]> {
    let both = pressures.iter().zip(coefficients).map(|(pressure, coefficient)| [*pressure, *coefficient]);
    let touching: Vec<[f64; 2]> =
        both.filter(|[pressure, coefficient]| *pressure > 0.0 && coefficient.is_finite()).collect();
    let every = touching.len().div_ceil(MOST_MARKS).max(1);
    touching.into_iter().step_by(every).collect()
}

/// The axis that all pressures lie on, and its unit.
fn pressure_axis(pressures: impl Iterator<Item = f64>) -> (Axis, Unit) {
    let (low, high) =
        pressures.fold((f64::INFINITY, 0.0_f64), |(low, high), pressure| (low.min(pressure), high.max(pressure)));
    let unit = Unit::for_size("Pa", high);
    let (scale, range) = if high > MOST_LINEAR * low {
        (Scale::Logarithmic, 0.9 * unit.value(low)..=1.1 * unit.value(high))
    } else {
        (Scale::Linear, up_from_zero(unit.value(high)))
    };
    let label = unit.label(SeriesLook::of("mean_pressure").title);
    (Axis { scale, ..Axis::linear(range, label) }, unit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::RUNS;
    use crate::figure::run::written::{Written, lines_of, marks_of, notes};

    /// Model section 12: flat on flat, μ = α + τ₀/p.
    fn law(pressure: f64) -> f64 {
        0.33 + 0.75e6 / pressure
    }

    /// Ten seconds in which the pressure grows; the pin is lifted at 4 s and 5 s.
    fn run(title: &'static str, factor: f64) -> Written {
        let value = move |name: &str, time: f64| {
            let (lifted, pressure) = ([4.0, 5.0].contains(&time), 1e6 * factor * time);
            match name {
                "mean_pressure" => {
                    if lifted {
                        0.0
                    } else {
                        pressure
                    }
                }
                "friction_coefficient" => {
                    if lifted {
                        f64::NAN
                    } else {
                        law(pressure)
                    }
                }
                // No number yet.
                "friction_coefficient_mean" if time < 2.0 => f64::NAN,
                "friction_coefficient_mean" => 0.5 + 0.01 * time,
                _ => 7.0 * time,
            }
        };
        Written::new(title, &["friction_coefficient", "friction_coefficient_mean", "friction_work"], value)
    }

    #[test]
    fn shows_the_mean_against_time_and_steps_against_their_pressure() {
        let runs = [run("one", 1.0), run("two", 2.0)];
        let figures = Written::figures(&runs);
        let figure = figures.figures.iter().find(|figure| figure.name == NAME).unwrap();
        let [left, right] = &figure.page.panels[..] else { panic!("two boxes") };
        assert_eq!(
            (left.axes.x.label.as_str(), right.axes.x.label.as_str()),
            ("time, s", "mean contact pressure, MPa")
        );
        for (number, factor) in [(0, 1.0), (1, 2.0)] {
            let lines = lines_of(left, RUNS[number]);
            let expected: Vec<[f64; 2]> = (2..=10).map(f64::from).map(|time| [time, 0.5 + 0.01 * time]).collect();
            assert_eq!(lines, [expected]);
            let marks = marks_of(right, RUNS[number]);
            assert_eq!(marks.len(), 8);
            for [pressure, coefficient] in marks {
                assert!((coefficient - law(1e6 * pressure)).abs() < 1e-12);
                assert!(right.axes.x.range.contains(&pressure) && right.axes.y.range.contains(&coefficient));
            }
            assert!(marks_of(right, RUNS[number]).iter().any(|[at, _]| (at - 10.0 * factor).abs() < 1e-12));
        }
        assert_eq!(left.axes.y.range, right.axes.y.range);
        assert!(notes(&figures, NAME).is_empty());
    }

    #[test]
    fn a_run_without_friction_is_told_beside_one_that_has_it_only() {
        let plain = || Written::new("plain", &[], |_, time| time);
        let figures = Written::figures(&[plain(), run("one", 1.0)]);
        assert_eq!(notes(&figures, NAME), ["no series friction_coefficient_mean"]);
        let figures = Written::figures(&[plain(), plain()]);
        let parts = [NAME, "temperature", "emission", "contact-temperature"];
        assert!(figures.figures.iter().all(|figure| !parts.contains(&figure.name.as_str())));
        assert!(parts.iter().all(|part| notes(&figures, part).is_empty()));
    }

    #[test]
    fn many_samples_are_thinned_evenly() {
        let many: Vec<f64> = (1..=1000).map(f64::from).collect();
        let chosen = steps(&many, &many);
        // By hand: every fifth of a thousand.
        assert_eq!((chosen.len(), chosen[1]), (200, [6.0, 6.0]));
        assert_eq!(steps(&[0.0, 2.0, 3.0], &[f64::NAN, f64::NAN, 0.4]), [[3.0, 0.4]]);
    }

    #[test]
    fn pressures_of_all_sizes_have_a_scale_of_equal_ratios() {
        let (axis, unit) = pressure_axis([1e5, 1e7].into_iter());
        assert_eq!((axis.scale, unit), (Scale::Logarithmic, Unit::MEGAPASCAL));
        let (axis, _) = pressure_axis([1e6, 1e7].into_iter());
        assert_eq!((axis.scale, *axis.range.start()), (Scale::Linear, 0.0));
        // Nothing touches in any sample.
        let (axis, _) = pressure_axis(std::iter::empty());
        assert_eq!((axis.scale, axis.range), (Scale::Linear, 0.0..=1.0));
    }
}
