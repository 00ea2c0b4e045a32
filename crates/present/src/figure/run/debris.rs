//! Where the wear debris is: worn + returned = deposited + emitted + pool, stacked.

use plateau_io::run_file::ReadError;
use plotters::style::RGBColor;

use super::{Figures, Subject};
use crate::colour::{DEBRIS, INK};
use crate::figure::axes::Axis;
use crate::figure::canvas::LINE;
use crate::figure::chart::{COLUMN, Chart, Meaning, TWO_COLUMNS, page, up_from_zero};
use crate::figure::page::{Content, KeyStyle};
use crate::quantity::{Unit, title};

const NAME: &str = "debris";
/// What debris becomes, from below in the stack.
const PARTS: [&str; 4] = ["deposited_disc", "deposited_pin", "emitted", "pool"];
/// What debris comes from.
const SOURCES: [&str; 4] = ["worn_pin", "worn_resin", "worn_disc", "returned"];
/// Points along time, at most.
const MOST_POINTS: usize = 400;

/// One run's balance, m³.
struct Balance {
    times: Vec<f64>,
    parts: [Vec<f64>; 4],
    supply: Vec<f64>,
}

/// Adds the figure.
pub fn add(subjects: &[Subject], figures: &mut Figures) -> Result<(), ReadError> {
    let needed: Vec<&str> = PARTS.into_iter().chain(SOURCES).collect();
    let mut balances = Vec::new();
    for (_, subject) in figures.with_series(NAME, subjects, &needed) {
        balances.push((subject, read(subject)?));
    }
    if balances.is_empty() {
        return Ok(());
    }
    let largest = balances.iter().flat_map(|(_, balance)| &balance.supply).copied().fold(0.0, f64::max);
    let end = balances.iter().filter_map(|(_, balance)| balance.times.last()).copied().fold(0.0, f64::max);
    let (volume, time) = (Unit::for_size("m3", largest), Unit::for_size("s", end));
    let chart = |(subject, balance): &(&Subject, Balance)| Chart {
        title: subject.label.clone(),
        x: Axis::linear(0.0..=time.value(end), time.label("time")),
        y: Axis::linear(up_from_zero(volume.value(largest)), volume.label("debris")),
        contents: stack(balance, &time, &volume),
    };
    let charts: Vec<Chart> = balances.iter().map(chart).collect();
    let meaning = |(colour, text): (RGBColor, &str)| Meaning { colour, style: KeyStyle::Area, text: text.to_owned() };
    // As they lie on each other, from the top.
    let stacked = DEBRIS.into_iter().zip(PARTS.map(title)).rev();
    let mut meanings: Vec<Meaning> = stacked.map(meaning).collect();
    meanings.insert(0, Meaning { colour: INK, style: KeyStyle::Line, text: "worn + returned".to_owned() });
    let (width, across) = match charts.len() {
        1 => (COLUMN, 1),
        2 => (TWO_COLUMNS, 2),
        _ => (TWO_COLUMNS, 3),
    };
    figures.add(
        NAME,
        "Debris balance",
        "Where the wear debris is, stacked: compacted on disc and pin, out of the contact, or loose in it. The line is what \
         was worn, and what plateaus that lost their support returned: the stack must reach it.",
        page(width, 640.0, across, charts, &meanings),
    );
    Ok(())
}

fn read(subject: &Subject) -> Result<Balance, ReadError> {
    let values = |name: &str| Ok(subject.run.values(name)?.unwrap_or_default());
    let mut parts: [Vec<f64>; 4] = Default::default();
    for (part, name) in parts.iter_mut().zip(PARTS) {
        *part = values(name)?;
    }
    let mut times = subject.run.time().to_vec();
    let mut supply = vec![0.0; times.len()];
    for name in SOURCES {
        supply.iter_mut().zip(values(name)?).for_each(|(sum, value)| *sum += value);
    }
    // At the start nothing was worn.
    times.insert(0, 0.0);
    parts.iter_mut().chain([&mut supply]).for_each(|values| values.insert(0, 0.0));
    Ok(Balance { times, parts, supply })
}

/// Bands on each other, and the line that they must reach.
fn stack(balance: &Balance, time: &Unit, volume: &Unit) -> Vec<Content> {
    let every = balance.times.len().div_ceil(MOST_POINTS).max(1);
    let last = balance.times.len() - 1;
    let chosen: Vec<usize> = (0..last).step_by(every).chain([last]).collect();
    let mut floor = vec![0.0; chosen.len()];
    let mut contents = Vec::new();
    for (values, colour) in balance.parts.iter().zip(DEBRIS) {
        let mut spans = Vec::with_capacity(chosen.len());
        for (index, floor) in chosen.iter().zip(&mut floor) {
            let low = *floor;
            *floor += volume.value(values[*index]);
            spans.push([time.value(balance.times[*index]), low, *floor]);
        }
        contents.push(Content::Band { spans, colour, opacity: 1.0 });
    }
    let point = |index: &usize| [time.value(balance.times[*index]), volume.value(balance.supply[*index])];
    contents.push(Content::Line { points: chosen.iter().map(point).collect(), colour: INK, width: LINE + 2 });
    contents
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_balance_that_holds_reaches_its_line() {
        // By hand: 1 + 2 + 3 + 4 = 10 at the second of two times.
        let balance = Balance {
            times: vec![1.0, 2.0],
            parts: [1.0, 2.0, 3.0, 4.0].map(|value| vec![0.0, value]),
            supply: vec![0.0, 10.0],
        };
        let contents = stack(&balance, &Unit::NUMBER, &Unit::NUMBER);
        let Content::Band { spans, .. } = &contents[3] else { panic!("a band") };
        assert_eq!(spans, &[[1.0, 0.0, 0.0], [2.0, 6.0, 10.0]]);
        let Content::Line { points, .. } = &contents[4] else { panic!("a line") };
        assert_eq!(points, &[[1.0, 0.0], [2.0, 10.0]]);
    }
}
