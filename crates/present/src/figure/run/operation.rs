//! Load and speed of runs with a cycle, above their contact area, and their events as shaded spans of time.

use plateau_io::run_file::{ReadError, RunFile};

use super::Subject;
use super::spans::Spans;
use crate::colour::{INK, paler};
use crate::figure::axes::Axis;
use crate::figure::chart::{Chart, Meaning, up_from_zero};
use crate::figure::page::{Content, KeyStyle};
use crate::figure::stroke::Stroke;
use crate::quantity::{SeriesLook, Unit};

/// How much of what lies below an event hides.
const SHADE: f64 = 0.08;
/// Events that are told apart, at most: more would be one grey.
const MOST_EVENTS: usize = 100;

/// Charts of load and of speed, for the runs that have them; none where no run has.
pub fn charts(subjects: &[Subject], time: &Unit, end: f64) -> Result<Vec<Chart>, ReadError> {
    let mut charts = Vec::new();
    for name in ["normal_force", "rotational_speed"] {
        let look = SeriesLook::of(name);
        let mut lines = Vec::new();
        let mut largest = 0.0_f64;
        for (number, subject) in subjects.iter().enumerate() {
            let Some(values) = subject.run.values(name)? else { continue };
            let times: Vec<f64> = subject.run.time().iter().map(|at| time.value(*at)).collect();
            let values: Vec<f64> = values.iter().map(|value| look.unit.value(*value)).collect();
            largest = values.iter().copied().fold(largest, f64::max);
            lines.push(Content::Line {
                points: Spans::FINEST.means(&times, &values),
                stroke: Stroke::of(number, subjects.len()),
            });
        }
        if lines.is_empty() {
            return Ok(Vec::new());
        }
        charts.push(Chart {
            title: String::new(),
            // The chart below them has the numbers.
            x: Axis::linear(0.0..=time.value(end), "").shared(),
            y: Axis::linear(up_from_zero(largest), look.unit.label(look.title)),
            contents: lines,
        });
    }
    Ok(charts)
}

/// Whether a run has a cycle: its ups and downs of load and speed are to be seen, so nothing is put together over longer spans.
pub fn has_cycle(subject: &Subject) -> bool {
    subject.run.series().iter().any(|series| series.name == "normal_force")
}

/// Values of a contact without those of moments in which nothing rubs: the pin is lifted then, or the disc stands still, and these are
/// of the last step before.
pub fn while_rubbing(run: &RunFile, mut values: Vec<f64>) -> Result<Vec<f64>, ReadError> {
    for name in ["normal_force", "rotational_speed"] {
        if let Some(operation) = run.values(name)? {
            values.iter_mut().zip(operation).filter(|(_, rate)| *rate == 0.0).for_each(|(value, _)| *value = f64::NAN);
        }
    }
    Ok(values)
}

/// Shades the events of a run in charts against time, below all that is in them; what the shade is, where there is any. Of several runs
/// nothing is shaded.
pub fn shade_events(subjects: &[Subject], time: &Unit, charts: &mut [Chart]) -> Result<Option<Meaning>, ReadError> {
    let [subject] = subjects else { return Ok(None) };
    let events = subject.run.events()?;
    let ends = |name| events.iter().find(|(quantity, _)| quantity.name == name).map(|(_, values)| values.as_slice());
    let (Some(starts), Some(ends)) = (ends("start"), ends("end")) else { return Ok(None) };
    if starts.is_empty() || starts.len() > MOST_EVENTS {
        return Ok(None);
    }
    for chart in charts {
        let (low, high) = (*chart.y.range.start(), *chart.y.range.end());
        let shade = |(start, end): (&f64, &f64)| Content::Band {
            spans: [start, end].map(|at| [time.value(*at), low, high]).to_vec(),
            colour: INK,
            opacity: SHADE,
        };
        let shades: Vec<Content> = starts.iter().zip(ends).map(shade).collect();
        chart.contents.splice(0..0, shades);
    }
    let colour = paler(INK, SHADE);
    Ok(Some(Meaning { colour, style: KeyStyle::Area, text: "events".to_owned() }))
}
