//! Contact pressure on the pin (paper Fig. 13).

use plateau_core::observe::Map;
use plateau_io::run_file::ReadError;

use super::map_page::MapGroup;
use super::map_pages::{pages, width_of};
use super::map_rows::{Painted, blocks, having, rows};
use super::moments::{chosen_for, ends_with_contact, floats, leave_blank, moment, without_contact};
use super::shape::Shape;
use super::{Figures, Subject};
use crate::colour::{APART, COLOURS, GROUND, colour_index, colour_map};
use crate::figure::axes::{Axis, Scale};
use crate::figure::chart::Meaning;
use crate::figure::page::KeyStyle;
use crate::quantity::{BEYOND, MapLook, RobustRange, Unit};
use plateau_io::number;

const NAME: &str = "pressure";
/// Pressures that differ more than this many times are shown on a scale of equal ratios.
const MOST_LINEAR: f64 = 100.0;
/// Number of the colour of cells without contact.
const NO_CONTACT: u8 = COLOURS as u8;
/// Number of the colour of what is no cell.
const NO_CELL: u8 = NO_CONTACT + 1;

/// Adds the figure.
pub fn add(subjects: &[Subject], figures: &mut Figures) -> Result<(), ReadError> {
    let (mut shown, mut chosen) = (Vec::new(), Vec::new());
    for subject in having(figures, NAME, subjects, Map::Pressure) {
        // Before the first step nothing is pressed.
        let moments = moments(subject)?;
        if moments.is_empty() {
            figures.leave_out(NAME, subject, &without_contact(subject, "pressure"));
        } else {
            shown.push(subject);
            chosen.push(moments);
        }
    }
    if shown.is_empty() {
        return Ok(());
    }
    let (scale, unit) = scale(&shown, &chosen)?;
    let moments_of = |subject: &Subject| chosen_for(subject, &shown, &chosen);
    let palette: Vec<_> = colour_map().into_iter().chain([APART, GROUND]).collect();
    let blocks = blocks(&shown, moments_of, |together, moments| {
        let rows = rows(together, Shape::of_pin, false, moments, |subject, index| {
            let pressures = floats(subject.run, Map::Pressure, index)?;
            let look = MapLook::of(Map::Pressure);
            let colour = |pressure: &f64| match *pressure {
                pressure if look.is_coloured(pressure) => colour_index(scale.part(unit.value(pressure))),
                _ => NO_CONTACT,
            };
            let largest = number::rounded(unit.value(pressures.iter().copied().fold(0.0, f64::max)), 3);
            let title = format!("{}, {}", look.body(), moment(subject.run, index));
            let remark = format!("at most {}", unit.with_symbol(&largest));
            let mut cells: Vec<u8> = pressures.iter().map(colour).collect();
            leave_blank(subject.run, Map::Pressure, &mut cells, NO_CELL);
            Ok((!cells.is_empty()).then_some(Painted { title, remark, cells }))
        })?;
        Ok(vec![MapGroup { rows, palette: palette.clone(), scale: Some(scale.clone()) }])
    })?;
    let none = Meaning { colour: APART, style: KeyStyle::Area, text: "no contact".to_owned() };
    let width = figures.width(width_of(&blocks));
    figures.add_pages(
        NAME,
        "Contact pressure on the pin",
        "Contact pressure on the pin at the first recorded moment with a contact after the start and at the last. The colours span 99 % of \
         the pressures of cells in contact.",
        pages(width, &[none], &blocks),
    );
    Ok(())
}

/// The moments after the start that are asked for, else the first one and the last one in which the pin is not lifted; none where it is in
/// all of them.
fn moments(subject: &Subject) -> Result<Vec<usize>, ReadError> {
    let is_pressed = |pressure: f64| pressure > 0.0;
    if subject.chosen.is_empty() {
        return ends_with_contact(subject, Map::Pressure, is_pressed);
    }
    let times = subject.run.map_time();
    let chosen: Vec<usize> = subject.chosen.iter().copied().filter(|index| times[*index] > 0.0).collect();
    for index in &chosen {
        if floats(subject.run, Map::Pressure, *index)?.into_iter().any(is_pressed) {
            return Ok(chosen);
        }
    }
    Ok(Vec::new())
}

/// The scale that all maps share, and the unit that it is in.
fn scale(subjects: &[&Subject], moments: &[Vec<usize>]) -> Result<(Axis, Unit), ReadError> {
    let look = MapLook::of(Map::Pressure);
    let mut range = RobustRange::default();
    for (subject, moments) in subjects.iter().zip(moments) {
        for index in moments {
            let pressures = floats(subject.run, Map::Pressure, *index)?;
            range.add(
                pressures.into_iter().filter(|pressure| look.is_coloured(*pressure)).collect::<Vec<_>>().into_iter(),
            );
        }
    }
    let (low, high) = (range.quantile(BEYOND).unwrap_or(1.0), range.quantile(1.0 - BEYOND).unwrap_or(1.0));
    let unit = Unit::for_size("Pa", high);
    let label = unit.label(look.what);
    let scale = if high > MOST_LINEAR * low { Scale::Logarithmic } else { Scale::Linear };
    let range = match scale {
        Scale::Logarithmic => unit.value(low)..=unit.value(high),
        Scale::Linear => 0.0..=unit.value(high),
    };
    Ok((Axis { scale, ..Axis::linear(range, label) }, unit))
}

#[cfg(test)]
mod tests {
    use plateau_core::observe::MapValues;

    use super::*;
    use crate::figure::run::written::{CELLS, Written, notes};

    #[test]
    fn without_a_contact_there_is_no_figure() {
        let run = |title, pressures: [f64; 3]| {
            let maps = pressures.into_iter().map(|pressure| MapValues::Float(vec![pressure; CELLS]));
            Written::new(title, &[], |_, time| time).with_maps(Map::Pressure, maps)
        };
        let titles = |runs: &[Written]| {
            let figures = Written::figures(runs);
            let figure = figures.figures.iter().find(|figure| figure.name == NAME);
            let notes: Vec<String> = notes(&figures, NAME).into_iter().map(str::to_owned).collect();
            let texts =
                figure.map(|figure| figure.page.texts.iter().map(|words| words.text.clone()).collect::<Vec<_>>());
            (texts.map(|texts| texts.into_iter().filter(|text| text.starts_with("pin")).collect::<Vec<_>>()), notes)
        };
        let none = "no map pressure with a contact after the start";
        assert_eq!(titles(&[run("lifted", [5.0, 0.0, 0.0])]), (None, vec![none.to_owned()]));
        // Beside one that touches a lifted pin is left out alone; the last map with a contact is shown.
        let (shown, notes) = titles(&[run("lifted", [0.0; 3]), run("pressed", [0.0, 5.0, 0.0])]);
        assert_eq!((shown, notes), (Some(vec!["pin, 1 s".to_owned()]), vec![none.to_owned()]));
    }
}
