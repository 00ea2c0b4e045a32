//! Airborne mass and number of particles: what is added in a time, and for each kilometre of road (model section 12).

use plateau_io::number;
use plateau_io::run_file::ReadError;

use super::legend::{only_stroke, with_names};
use super::rates::{Rate, per_metre, rates, steps};
use super::{Figures, Subject, operation};
use crate::figure::axes::Axis;
use crate::figure::chart::{Chart, Meaning, TWO_COLUMNS, page, up_from_zero};
use crate::figure::page::Content;
use crate::figure::stroke::Stroke;
use crate::quantity::Unit;

const NAME: &str = "emission";
const SERIES: [&str; 3] = ["pm10_mass", "pm25_mass", "particle_number"];
const ROAD: &str = "road_distance";

/// One of the series of a run as a curve, SI.
struct Curve {
    stroke: Stroke,
    points: Vec<[f64; 2]>,
}

/// Adds the figure.
pub fn add(subjects: &[Subject], figures: &mut Figures) -> Result<(), ReadError> {
    let having = figures.with_part(NAME, subjects, &SERIES);
    if having.is_empty() {
        return Ok(());
    }
    let on_road = figures.with_part(NAME, subjects, &[SERIES[0], SERIES[1], SERIES[2], ROAD]);
    let end = having.iter().filter_map(|(_, subject)| subject.run.time().last()).copied().fold(0.0, f64::max);
    let time = Unit::for_size("s", end);
    let in_time = |times: &[f64], values: &[f64], _: &[f64]| {
        let rates: Vec<Rate> = rates(times, values);
        steps(&rates)
    };
    let [masses, numbers] = curves(&having, subjects.len(), in_time)?;
    let mut charts = vec![
        chart("airborne mass of the simulated pin", "rate", "kg s-1", &masses, &time, end),
        chart("airborne particles of the simulated pin", "rate", "s-1", &numbers, &time, end),
    ];
    if !on_road.is_empty() {
        let [masses, numbers] = curves(&on_road, subjects.len(), per_metre)?;
        let mean = "mean since the start";
        charts.push(chart(
            "airborne mass of the simulated pin for each kilometre of road",
            mean,
            "kg m-1",
            &masses,
            &time,
            end,
        ));
        charts.push(chart(
            "airborne particles of the simulated pin for each kilometre of road",
            mean,
            "m-1",
            &numbers,
            &time,
            end,
        ));
    }
    let shade = operation::shade_events(subjects, &time, &mut charts)?;
    let mut own = match only_stroke(subjects, having.iter().map(|(number, _)| *number)) {
        Some(stroke) => {
            vec![Meaning::of_line(stroke, "PM10, particles"), Meaning::of_line(stroke.paler(), "PM2.5")]
        }
        None => vec![Meaning::in_words("lines: PM10, particles; paler: PM2.5")],
    };
    own.extend(shade);
    own.extend(of_windows(&having)?);
    own.push(Meaning::in_words(&of_pins(&having)));
    let meanings = with_names(subjects, |shown| having.iter().any(|(number, _)| *number == shown), own);
    let of_road = if on_road.is_empty() {
        ""
    } else {
        " Below, all since the start for each kilometre that the vehicle has travelled, without the first twentieth of its way: \
         the line ends at the emission factor of the whole run."
    };
    let width = figures.width(TWO_COLUMNS);
    figures.add(
        NAME,
        "Airborne emission",
        format!(
            "Airborne mass (PM10 and, paler, PM2.5) and number of particles that are added in a time, in windows with equally \
             many samples, of the simulated pin alone.{of_road} Events of a single run with a cycle that has ended are shaded."
        ),
        page(width, 560.0, 2, charts, &meanings),
    );
    Ok(())
}

/// Over how long a time rates are means; none of runs without any. The last window of a run may be shorter than the others.
fn of_windows(runs: &[(usize, &Subject)]) -> Result<Option<Meaning>, ReadError> {
    let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
    for (_, subject) in runs {
        let masses = subject.run.values(SERIES[0])?.unwrap_or_default();
        let rates = rates(subject.run.time(), &masses);
        let whole = if rates.len() > 1 { &rates[..rates.len() - 1] } else { &rates[..] };
        for Rate { begin, end, .. } in whole {
            (shortest, longest) = (shortest.min(end - begin), longest.max(end - begin));
        }
    }
    let unit = Unit::for_size("s", longest);
    let rounded = |seconds: f64| number::rounded(unit.value(seconds), 2);
    let said = match [shortest, longest].map(rounded) {
        _ if longest <= 0.0 => return Ok(None),
        [one, other] if one == other => one,
        [one, other] => format!("{one} to {other}"),
    };
    Ok(Some(Meaning::in_words(&format!("rates: means of {}", unit.with_symbol(&said)))))
}

/// What a reader must not take for the emission of a brake: the area that it is of.
fn of_pins(runs: &[(usize, &Subject)]) -> String {
    let area =
        |subject: &Subject| Unit::MM2.with_symbol(&number::rounded(Unit::MM2.value(subject.run.mesh().pin_area()), 3));
    let mut areas: Vec<String> = runs.iter().map(|(_, subject)| area(subject)).collect();
    areas.dedup();
    match &areas[..] {
        [one] => format!("of the simulated pin, {one}, not of a brake"),
        several => format!("of the simulated pins, {}, not of brakes", several.join(", ")),
    }
}

/// Curves of the masses and of the numbers of runs, made of times, values and ways.
fn curves(
    runs: &[(usize, &Subject)],
    count: usize,
    make: impl Fn(&[f64], &[f64], &[f64]) -> Vec<[f64; 2]>,
) -> Result<[Vec<Curve>; 2], ReadError> {
    let (mut masses, mut numbers) = (Vec::new(), Vec::new());
    for (number, subject) in runs {
        let times = subject.run.time();
        let values = |name: &str| Ok(subject.run.values(name)?.unwrap_or_default());
        let (way, own) = (values(ROAD)?, Stroke::of(*number, count));
        let curve = |name: &str, stroke| Ok(Curve { stroke, points: make(times, &values(name)?, &way) });
        // The smaller mass would be hidden below the larger one.
        masses.extend([curve("pm10_mass", own)?, curve("pm25_mass", own.paler())?]);
        numbers.push(curve("particle_number", own)?);
    }
    Ok([masses, numbers])
}

/// A chart of curves in a unit that makes them readable.
fn chart(title: &str, what: &str, si: &str, curves: &[Curve], time: &Unit, end: f64) -> Chart {
    let largest = curves.iter().flat_map(|curve| &curve.points).map(|[_, value]| *value).fold(0.0, f64::max);
    let unit = Unit::readable(si, largest);
    let line = |curve: &Curve| Content::Line {
        points: curve.points.iter().map(|[at, value]| [time.value(*at), unit.value(*value)]).collect(),
        stroke: curve.stroke,
    };
    Chart {
        title: title.to_owned(),
        x: Axis::linear(0.0..=time.value(end), time.label("time")),
        y: Axis::linear(up_from_zero(unit.value(largest)), unit.label(what)),
        contents: curves.iter().map(line).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::RUNS;
    use crate::figure::run::written::{Written, lines_of, notes};

    /// Ten seconds: 2 µg PM10 a second, from 5 s on twice as much, while the vehicle goes 20 m a second.
    fn run(title: &'static str, series: &[&'static str]) -> Written {
        Written::new(title, series, |name, time| {
            let mass = 2e-9 * time + 2e-9 * (time - 5.0).max(0.0);
            match name {
                "pm10_mass" => mass,
                "pm25_mass" => 0.25 * mass,
                "particle_number" => 1e15 * mass,
                ROAD => 20.0 * time,
                _ => time,
            }
        })
    }

    fn close(points: &[[f64; 2]], expected: &[[f64; 2]]) {
        assert_eq!(points.len(), expected.len(), "{points:?}");
        for (point, expected) in points.iter().zip(expected) {
            assert!((0..2).all(|at| (point[at] - expected[at]).abs() < 1e-9), "{points:?}");
        }
    }

    #[test]
    fn rates_are_differences_and_factors_are_of_the_way() {
        let road = [&SERIES[..], &[ROAD]].concat();
        let figures = Written::figures(&[run("road", &road), run("bench", &SERIES)]);
        let figure = figures.figures.iter().find(|figure| figure.name == NAME).unwrap();
        let [mass, number, mass_of_way, number_of_way] = &figure.page.panels[..] else { panic!("four boxes") };
        let labels = [mass, number, mass_of_way, number_of_way].map(|panel| panel.axes.y.label.clone());
        let factor = "mean since the start";
        assert_eq!(
            labels,
            [
                "rate, µg/s".to_owned(),
                "rate, 10⁶ s⁻¹".into(),
                format!("{factor}, mg/km"),
                format!("{factor}, 10⁶ km⁻¹")
            ]
        );
        let windows = (1..=10).map(f64::from).map(|end| (end, if end > 5.0 { 2.0 } else { 1.0 }));
        let rate =
            |unit: f64| windows.clone().flat_map(move |(end, twice)| [[end - 1.0, unit * twice], [end, unit * twice]]);
        for run in [0, 1] {
            close(&lines_of(mass, RUNS[run])[0], &rate(2.0).collect::<Vec<_>>());
            close(&lines_of(mass, Stroke::of(run, 1).paler().colour)[0], &rate(0.5).collect::<Vec<_>>());
            close(&lines_of(number, RUNS[run])[0], &rate(2.0).collect::<Vec<_>>());
        }
        // 30 µg in 200 m are 0.15 mg/km, and 30 million particles 150 million for a kilometre.
        let last = |panel, colour| lines_of(panel, colour)[0].last().copied().unwrap();
        close(&[last(mass_of_way, RUNS[0])], &[[10.0, 0.15]]);
        close(&[last(mass_of_way, Stroke::of(0, 1).paler().colour)], &[[10.0, 0.0375]]);
        close(&[last(number_of_way, RUNS[0])], &[[10.0, 150.0]]);
        assert!(lines_of(mass_of_way, RUNS[1]).is_empty());
        // Eleven samples, a second from each other, are fewer than windows.
        assert!(figure.page.texts.iter().any(|words| words.text == "rates: means of 1 s"), "{:?}", figure.page.texts);
        // By hand: 5 of 60 columns of a ring between 20 mm and 24 mm, π (24² − 20²)/12 mm².
        assert!(figure.page.texts.iter().any(|words| words.text.contains("of the simulated pin, 46.1 mm²")));
        assert_eq!(notes(&figures, NAME), ["no series road_distance"]);
    }

    #[test]
    fn without_road_there_is_nothing_of_it() {
        let figures = Written::figures(&[run("bench", &SERIES)]);
        let figure = figures.figures.iter().find(|figure| figure.name == NAME).unwrap();
        assert!(
            figure.page.panels.len() == 2 && notes(&figures, NAME).is_empty() && !figure.caption.contains("kilometre")
        );
    }
}
