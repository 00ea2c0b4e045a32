//! Maps at the moments that figures show: the first and the last that were recorded, or those that are asked for.

use plateau_core::observe::{Map, MapValues};
use plateau_io::run_file::{ReadError, RunFile, State};

use super::Subject;
use crate::figure::chart::Meaning;
use crate::figure::stroke::Stroke;
use crate::quantity::{MapLook, Unit};
use plateau_io::{brief, number};

/// Indices of the moments of the maps that are asked for; else of the first and the last, one of them if it is both.
pub fn shown_moments(subject: &Subject) -> Vec<usize> {
    match subject.run.map_time().len() {
        _ if !subject.chosen.is_empty() => subject.chosen.clone(),
        0 => Vec::new(),
        1 => vec![0],
        count => vec![0, count - 1],
    }
}

/// Indices of the moments after the start.
fn after_the_start(run: &RunFile) -> impl DoubleEndedIterator<Item = usize> + Clone + '_ {
    let times = run.map_time();
    (0..times.len()).filter(|index| times[*index] > 0.0)
}

/// Indices of the first and the last moment after the start in which any value of a map is that of a contact, one of them if it is both;
/// none where the pin is lifted in all.
pub fn ends_with_contact(subject: &Subject, map: Map, of_contact: fn(f64) -> bool) -> Result<Vec<usize>, ReadError> {
    let first_of = |moments: &mut dyn Iterator<Item = usize>| -> Result<Option<usize>, ReadError> {
        for index in moments {
            if floats(subject.run, map, index)?.into_iter().any(of_contact) {
                return Ok(Some(index));
            }
        }
        Ok(None)
    };
    let Some(first) = first_of(&mut after_the_start(subject.run))? else { return Ok(Vec::new()) };
    let last = first_of(&mut after_the_start(subject.run).rev())?.unwrap_or(first);
    Ok(if first == last { vec![last] } else { vec![first, last] })
}

/// Why a run has no map with a contact after the start, of a map of this name.
pub fn without_contact(subject: &Subject, name: &str) -> String {
    let run = subject.run;
    if !subject.chosen.is_empty() {
        let at = moments_in_words(run, &subject.chosen);
        return format!("no map {name} with a contact at {at}, the nearest times that were recorded");
    }
    let last = run.time().last().filter(|_| run.state() != State::Finished && after_the_start(run).next().is_none());
    match last {
        Some(time) => format!(
            "no map {name} after the start: the run has come to {}, and its first one is later",
            Unit::usual("s").with_symbol(&number::rounded(*time, 4))
        ),
        None => format!("no map {name} with a contact after the start"),
    }
}

/// What was chosen for a run, of those that are shown.
pub fn chosen_for(subject: &Subject, shown: &[&Subject], chosen: &[Vec<usize>]) -> Vec<usize> {
    let place = shown.iter().position(|one| std::ptr::eq(*one, subject));
    place.map_or_else(Vec::new, |place| chosen[place].clone())
}

/// What the lines of the moments are, with their time where all runs have the same; in the colour of the only run, else in words.
pub fn meanings(subjects: &[Subject], only: Option<Stroke>, has_first: bool) -> Vec<Meaning> {
    let is_chosen = subjects.iter().any(|subject| !subject.chosen.is_empty());
    let [last, first] = if is_chosen { ["last map shown", "earlier maps"] } else { ["last map", "first map"] };
    let last = last.to_owned() + &common_time(subjects, |moments| moments.last());
    // Of earlier ones there may be several.
    let first = first.to_owned() + &common_time(subjects, |moments| moments.first().filter(|_| moments.len() == 2));
    match only {
        Some(stroke) if has_first => vec![Meaning::of_line(stroke, &last), Meaning::of_line(stroke.paler(), &first)],
        Some(stroke) => vec![Meaning::of_line(stroke, &last)],
        None if has_first => vec![Meaning::in_words(&format!("{last}, paler: {first}"))],
        None => vec![Meaning::in_words(&last)],
    }
}

/// The time of one of the moments that are shown, in words behind a comma; empty where runs differ in it or have none.
fn common_time(subjects: &[Subject], of: impl Fn(&[usize]) -> Option<&usize>) -> String {
    let mut times = subjects.iter().map(|subject| of(&shown_moments(subject)).map(|index| moment(subject.run, *index)));
    match times.next().flatten() {
        Some(time) if times.all(|other| other.as_ref() == Some(&time)) => format!(", {time}"),
        _ => String::new(),
    }
}

/// Indices of the maps that were recorded nearest to some times (s), in their order, each once.
pub fn nearest(run: &RunFile, times: &[f64]) -> Vec<usize> {
    let recorded = run.map_time();
    let distance = |index: &usize, time: f64| (recorded[*index] - time).abs();
    let nearest =
        |time: &f64| (0..recorded.len()).min_by(|one, other| distance(one, *time).total_cmp(&distance(other, *time)));
    let mut indices: Vec<usize> = times.iter().filter_map(nearest).collect();
    indices.sort_unstable();
    indices.dedup();
    indices
}

/// The moment, in words.
pub fn moment(run: &RunFile, index: usize) -> String {
    let seconds = run.map_time().get(index).copied().unwrap_or(f64::NAN);
    let unit = if seconds > 0.0 { Unit::for_size("s", seconds) } else { Unit::usual("s") };
    unit.with_symbol(&number::rounded(unit.value(seconds), 4))
}

/// Several of them, in words.
pub fn moments_in_words(run: &RunFile, indices: &[usize]) -> String {
    brief::list(indices.iter().map(|index| moment(run, *index)), ", ")
}

/// Heights or pressures of a map, column by column; nothing if there are none.
pub fn floats(run: &RunFile, map: Map, index: usize) -> Result<Vec<f64>, ReadError> {
    match run.map(map, index)? {
        Some(MapValues::Float(values)) => Ok(values),
        _ => Ok(Vec::new()),
    }
}

/// Gives the cells beyond the pin's outline the colour of what is no cell.
pub fn leave_blank(run: &RunFile, map: Map, cells: &mut [u8], ground: u8) {
    if !map.on_disc() && cells.len() == run.mesh().pin_cells() {
        run.mesh().absent_cells().for_each(|cell| cells[cell] = ground);
    }
}

/// Statuses of a map, column by column; nothing if there are none.
pub fn statuses(run: &RunFile, map: Map, index: usize) -> Result<Vec<u8>, ReadError> {
    match run.map(map, index)? {
        Some(MapValues::Status(values)) => Ok(values),
        _ => Ok(Vec::new()),
    }
}

/// Heights of a map as they are shown, positive toward the other body, and the z that they are counted from, m.
pub fn heights(run: &RunFile, map: Map, index: usize) -> Result<(Vec<f64>, f64), ReadError> {
    let mut heights = floats(run, map, index)?;
    let look = MapLook::of(map);
    let zero = look.zero(&heights);
    heights.iter_mut().for_each(|height| *height = look.sign() * (*height - zero));
    Ok((heights, zero))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::run::written::{CELLS, Written};

    #[test]
    fn what_reaches_toward_the_other_body_is_high() {
        // The z of the pin grows away from the disc: the cell of the least z is its peak.
        let z = |cell: usize| 1e-6 * (cell as f64 + 10.0);
        for (map, expected) in [(Map::PinHeight, [9.5e-6, -9.5e-6]), (Map::DiscHeight, [10e-6, 249e-6])] {
            let cells = if map.on_disc() { 240 } else { CELLS };
            let values = std::iter::once(MapValues::Float((0..cells).map(z).collect()));
            let run = Written::new("one", &[], |_, time| time).with_maps(map, values);
            let (shown, _) = run.opened(|run| heights(run, map, 0).unwrap());
            let ends = [shown[0], shown[cells - 1]];
            assert!(ends.iter().zip(expected).all(|(end, expected)| (end - expected).abs() < 1e-15), "{ends:?}");
        }
    }
}
