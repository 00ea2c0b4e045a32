//! Maps at the moments that figures show: the first and the last that were recorded, or those that are asked for.

use plateau_core::observe::{Map, MapValues};
use plateau_io::run_file::{ReadError, RunFile};

use super::Subject;
use crate::colour::INK;
use crate::figure::canvas::LINE;
use crate::figure::chart::Meaning;
use crate::figure::stroke::Stroke;
use crate::quantity::{MapLook, Unit};
use plateau_io::number;

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
pub fn after_the_start(run: &RunFile) -> impl DoubleEndedIterator<Item = usize> + Clone + '_ {
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

/// What was chosen for a run, of those that are shown.
pub fn chosen_for(subject: &Subject, shown: &[&Subject], chosen: &[Vec<usize>]) -> Vec<usize> {
    let place = shown.iter().position(|one| std::ptr::eq(*one, subject));
    place.map_or_else(Vec::new, |place| chosen[place].clone())
}

/// What the lines of the moments of all runs are; nothing where there are only those of the last.
pub fn meanings(subjects: &[Subject], has_first: bool) -> Vec<Meaning> {
    if !has_first {
        return Vec::new();
    }
    let is_chosen = subjects.iter().any(|subject| !subject.chosen.is_empty());
    let words = if is_chosen { ["last map shown", "earlier maps"] } else { ["last map", "first map"] };
    let last = Stroke::solid(INK, LINE);
    vec![Meaning::of_line(last, words[0]), Meaning::of_line(last.paler(), words[1])]
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

/// Heights of a map as they are shown, and what they are counted from, m.
pub fn heights(run: &RunFile, map: Map, index: usize) -> Result<(Vec<f64>, f64), ReadError> {
    let mut heights = floats(run, map, index)?;
    let zero = MapLook::of(map).zero(&heights);
    heights.iter_mut().for_each(|height| *height -= zero);
    Ok((heights, zero))
}
