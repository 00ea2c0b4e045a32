//! Where the wear debris is: worn + returned = deposited + emitted + pool, stacked; and what of it is in the contact still, for most of
//! it is emitted.

use plateau_io::run_file::ReadError;
use plotters::style::RGBColor;

use super::map_pages::runs_across;
use super::{Figures, Subject};
use crate::colour::{DEBRIS, INK};
use crate::figure::axes::Axis;
use crate::figure::canvas::LINE;
use crate::figure::chart::{COLUMN, Chart, Meaning, TWO_COLUMNS, page_of_rows, up_from_zero};
use crate::figure::page::{Content, KeyStyle};
use crate::figure::pages::in_pages;
use crate::figure::stroke::{SOLID, Stroke};
use crate::quantity::{Unit, title};

const NAME: &str = "debris";
/// What debris becomes, from below in the stack.
const PARTS: [&str; 4] = ["deposited_disc", "deposited_pin", "emitted", "pool"];
/// Those of them that did not leave the contact.
const STAYED: [usize; 3] = [0, 1, 3];
/// What debris comes from.
const SOURCES: [&str; 4] = ["worn_pin", "worn_resin", "worn_disc", RETURNED];
const RETURNED: &str = "returned";
/// What the line of all of them is.
const SUPPLY: [&str; 2] = ["worn off", "worn off, or back from plateaus that broke away"];
/// Points along time, at most.
const MOST_POINTS: usize = 400;

/// One run's balance, m³.
struct Balance {
    times: Vec<f64>,
    parts: [Vec<f64>; 4],
    supply: Vec<f64>,
    /// Whether any plateau broke away.
    has_returned: bool,
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
    let time = Unit::for_size("s", end);
    let volume = Unit::for_size("m3", largest);
    let of_all = |(subject, balance): &(&Subject, Balance)| Chart {
        title: subject.label.clone(),
        x: Axis::linear(0.0..=time.value(end), time.label("time")),
        y: Axis::linear(up_from_zero(volume.value(largest)), volume.label("debris")),
        contents: stack(balance, &[0, 1, 2, 3], &time, &volume)
            .into_iter()
            .chain([supply(balance, &time, &volume)])
            .collect(),
    };
    let most = balances.iter().map(|(_, balance)| balance.most(&STAYED)).fold(0.0, f64::max);
    let kept = Unit::for_size("m3", most);
    let of_kept = |(subject, balance): &(&Subject, Balance)| Chart {
        title: format!("{}, not emitted", subject.label),
        x: Axis::linear(0.0..=time.value(end), time.label("time")),
        y: Axis::linear(up_from_zero(kept.value(most)), kept.label("laid down so far")),
        contents: stack(balance, &STAYED, &time, &kept),
    };
    let across = runs_across(balances.len());
    // The second chart of a run stands below its first one, also in a row that is not full.
    let rows = balances
        .chunks(across)
        .flat_map(|runs| [runs.iter().map(of_all).collect(), runs.iter().map(of_kept).collect()]);
    let rows: Vec<Vec<Chart>> = rows.collect();
    let meaning = |(colour, text): (RGBColor, &str)| Meaning { colour, style: KeyStyle::Area, text: text.to_owned() };
    // As they lie on each other, from the top.
    let is_there =
        |part: &usize| balances.iter().any(|(_, balance)| balance.parts[*part].iter().any(|volume| *volume > 0.0));
    let stacked = (0..PARTS.len()).rev().filter(is_there).map(|part| (DEBRIS[part], title(PARTS[part])));
    let mut meanings: Vec<Meaning> = stacked.map(meaning).collect();
    let supply = SUPPLY[usize::from(balances.iter().any(|(_, balance)| balance.has_returned))];
    meanings.insert(0, Meaning { colour: INK, style: KeyStyle::Line(SOLID), text: supply.to_owned() });
    let width = figures.width(if across == 1 { COLUMN } else { TWO_COLUMNS });
    figures.add_pages(
        NAME,
        "Debris balance",
        "Where the wear debris is, stacked: compacted on disc and pin, out of the contact, or loose in it. The line is what \
         was worn, and what plateaus that lost their support returned: the stack must reach it. Below, the same on an axis of its own \
         without what was emitted. All are sums since the start: debris that was laid down, worn off and laid down again counts twice, so \
         less of it is there at the end.",
        in_pages(rows.len() / 2, |pairs| {
            page_of_rows(width, 480.0, &rows, 2 * pairs.start..2 * pairs.end, &meanings)
        }),
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
    let mut has_returned = false;
    for name in SOURCES {
        let volumes = values(name)?;
        has_returned |= name == RETURNED && volumes.iter().any(|volume| *volume > 0.0);
        supply.iter_mut().zip(volumes).for_each(|(sum, value)| *sum += value);
    }
    // At the start nothing was worn.
    times.insert(0, 0.0);
    parts.iter_mut().chain([&mut supply]).for_each(|values| values.insert(0, 0.0));
    Ok(Balance { times, parts, supply, has_returned })
}

impl Balance {
    /// Numbers of the samples that are shown.
    fn chosen(&self) -> Vec<usize> {
        let every = self.times.len().div_ceil(MOST_POINTS).max(1);
        let last = self.times.len() - 1;
        (0..last).step_by(every).chain([last]).collect()
    }

    /// The most that these parts are together at any time, m³.
    fn most(&self, parts: &[usize]) -> f64 {
        let sum = |at: usize| parts.iter().map(|part| self.parts[*part][at]).sum::<f64>();
        (0..self.times.len()).map(sum).fold(0.0, f64::max)
    }
}

/// Bands of these parts on each other.
fn stack(balance: &Balance, parts: &[usize], time: &Unit, volume: &Unit) -> Vec<Content> {
    let chosen = balance.chosen();
    let mut floor = vec![0.0; chosen.len()];
    let mut contents = Vec::new();
    for part in parts {
        let (values, colour) = (&balance.parts[*part], DEBRIS[*part]);
        let mut spans = Vec::with_capacity(chosen.len());
        for (index, floor) in chosen.iter().zip(&mut floor) {
            let low = *floor;
            *floor += volume.value(values[*index]);
            spans.push([time.value(balance.times[*index]), low, *floor]);
        }
        // A pool that is always empty, as with local debris, would be a hair on top.
        if values.iter().any(|volume| *volume > 0.0) {
            contents.push(Content::Band { spans, colour, opacity: 1.0 });
        }
    }
    contents
}

/// The line that all bands together must reach.
fn supply(balance: &Balance, time: &Unit, volume: &Unit) -> Content {
    let point = |index: &usize| [time.value(balance.times[*index]), volume.value(balance.supply[*index])];
    Content::Line { points: balance.chosen().iter().map(point).collect(), stroke: Stroke::solid(INK, LINE + 2) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::run::written::Written;

    #[test]
    fn a_balance_that_holds_reaches_its_line() {
        // By hand: 1 + 2 + 3 + 4 = 10 at the second of two times.
        let balance = Balance {
            has_returned: false,
            times: vec![1.0, 2.0],
            parts: [1.0, 2.0, 3.0, 4.0].map(|value| vec![0.0, value]),
            supply: vec![0.0, 10.0],
        };
        let all = stack(&balance, &[0, 1, 2, 3], &Unit::NUMBER, &Unit::NUMBER);
        let Content::Band { spans, .. } = &all[3] else { panic!("a band") };
        assert_eq!(spans, &[[1.0, 0.0, 0.0], [2.0, 6.0, 10.0]]);
        let Content::Line { points, .. } = supply(&balance, &Unit::NUMBER, &Unit::NUMBER) else { panic!("a line") };
        assert_eq!(points, [[1.0, 0.0], [2.0, 10.0]]);
        // Without the third part: 1 + 2 + 4.
        let stayed = stack(&balance, &STAYED, &Unit::NUMBER, &Unit::NUMBER);
        let Content::Band { spans, .. } = &stayed[2] else { panic!("a band") };
        assert_eq!((spans[1], balance.most(&STAYED)), ([2.0, 3.0, 7.0], 7.0));
    }

    #[test]
    fn the_second_chart_of_every_run_stands_below_its_first() {
        let run = |title| Written::new(title, &[], |_, time| time);
        // The last page has one of seven runs, in a box of the same size.
        let names = ["a", "b", "c", "d", "e", "f", "g"];
        let figures = Written::figures(&names.map(run)).figures;
        let page = |name: &str| &figures.iter().find(|figure| figure.name == name).unwrap().page;
        let (first, last) = (page(NAME), page("debris-2"));
        for name in names {
            let place = |text: &str| {
                let page = if name == "g" { last } else { first };
                page.texts.iter().find(|words| words.text == text).unwrap().place
            };
            let (first, second) = (place(name), place(&format!("{name}, not emitted")));
            assert!(first.0 == second.0 && first.1 < second.1, "{name}: {first:?} {second:?}");
        }
        assert_eq!(first.panels[0].axes.frame, last.panels[0].axes.frame);
        let said: Vec<&str> = figures.iter().map(|figure| figure.title.as_str()).collect();
        assert_eq!(said.iter().filter(|title| title.starts_with("Debris balance, page ")).count(), 2, "{said:?}");
    }
}
