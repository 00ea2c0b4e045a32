//! Temperature of the pin's cells (model section 11), in runs that record it.

use plateau_core::observe::Map;
use plateau_io::run_file::ReadError;

use super::map_page::MapGroup;
use super::map_pages::{pages, width_of};
use super::map_rows::{Painted, blocks, having, rows};
use super::moments::{chosen_for, ends_with_contact, floats, leave_blank, moment, without_contact};
use super::shape::Shape;
use super::{Figures, Subject};
use crate::colour::{APART, COLOURS, GROUND, colour_index, colour_map};
use crate::figure::axes::Axis;
use crate::figure::chart::Meaning;
use crate::figure::page::KeyStyle;
use crate::quantity::{BEYOND, MapLook, RobustRange};
use plateau_io::number;

const NAME: &str = "contact-temperature";
/// Number of the colour of cells without a temperature.
const NONE: u8 = COLOURS as u8;
/// Number of the colour of what is no cell.
const NO_CELL: u8 = NONE + 1;

/// Adds the figure.
pub fn add(subjects: &[Subject], figures: &mut Figures) -> Result<(), ReadError> {
    if !subjects.iter().any(|subject| subject.run.has_map(Map::Temperature)) {
        return Ok(());
    }
    let (mut shown, mut chosen) = (Vec::new(), Vec::new());
    for subject in having(figures, NAME, subjects, Map::Temperature) {
        let moments = moments(subject)?;
        if moments.is_empty() {
            figures.leave_out(NAME, subject, &without_contact(subject, "temperature"));
        } else {
            shown.push(subject);
            chosen.push(moments);
        }
    }
    if shown.is_empty() {
        return Ok(());
    }
    let look = MapLook::of(Map::Temperature);
    let scale = scale(&shown, &chosen)?;
    let moments_of = |subject: &Subject| chosen_for(subject, &shown, &chosen);
    let palette: Vec<_> = colour_map().into_iter().chain([APART, GROUND]).collect();
    let mut has_none = false;
    let blocks = blocks(&shown, moments_of, |together, moments| {
        let rows = rows(together, Shape::of_pin, false, moments, |subject, index| {
            let temperatures = floats(subject.run, Map::Temperature, index)?;
            let colour = |temperature: &f64| match *temperature {
                temperature if temperature.is_finite() => colour_index(scale.part(look.unit.value(temperature))),
                _ => NONE,
            };
            let largest = number::rounded(look.unit.value(temperatures.iter().copied().fold(0.0, f64::max)), 3);
            let title = format!("{}, {}", look.body(), moment(subject.run, index));
            let remark = format!("at most {}", look.unit.with_symbol(&largest));
            let mut cells: Vec<u8> = temperatures.iter().map(colour).collect();
            leave_blank(subject.run, Map::Temperature, &mut cells, NO_CELL);
            has_none |= cells.contains(&NONE);
            Ok((!cells.is_empty()).then_some(Painted { title, remark, cells }))
        })?;
        Ok(vec![MapGroup { rows, palette: palette.clone(), scale: Some(scale.clone()) }])
    })?;
    let none = Meaning { colour: APART, style: KeyStyle::Area, text: "no temperature".to_owned() };
    let width = figures.width(width_of(&blocks));
    figures.add_pages(
        NAME,
        "Contact temperature of the pin",
        "Temperature of the pin's cells at the first recorded moment with a contact after the start and at the last. The \
         colours span 99 % of all cells. Pressures count as frozen during a pass, and there is no conduction along the \
         surface: on rough discs the hottest cells may be half of their rise too low.",
        pages(width, if has_none { std::slice::from_ref(&none) } else { &[] }, &blocks),
    );
    Ok(())
}

/// The moments that are asked for, else the first one after the start in which cells have a temperature, and the last one: a lifted pin has
/// none.
fn moments(subject: &Subject) -> Result<Vec<usize>, ReadError> {
    if !subject.chosen.is_empty() {
        return Ok(subject.chosen.clone());
    }
    ends_with_contact(subject, Map::Temperature, f64::is_finite)
}

/// The scale that all maps share.
fn scale(subjects: &[&Subject], moments: &[Vec<usize>]) -> Result<Axis, ReadError> {
    let look = MapLook::of(Map::Temperature);
    let mut range = RobustRange::default();
    for (subject, moments) in subjects.iter().zip(moments) {
        for index in moments {
            let temperatures = floats(subject.run, Map::Temperature, *index)?;
            range.add(temperatures.iter().map(|temperature| look.unit.value(*temperature)));
        }
    }
    Ok(Axis::linear(range.between(BEYOND, 1.0 - BEYOND), look.unit.label(look.what)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::page::Content;
    use crate::figure::run::written::{CELLS, Written, notes};

    /// Maps at 0 s, 1 s, … in which every cell is 1 K warmer than the one before; no contact where the first has none.
    fn run(title: &'static str, first: &[f64]) -> Written {
        let map = |first: &f64| (0..CELLS).map(|cell| first + cell as f64).collect();
        Written::new(title, &[], |_, time| time).with_temperatures(first.iter().map(map))
    }

    #[test]
    fn shows_the_first_and_the_last_moment_with_a_contact() {
        let figures = Written::figures(&[run("one", &[296.0, f64::NAN, 300.0, 400.0, f64::NAN])]);
        let figure = figures.figures.iter().find(|figure| figure.name == NAME).unwrap();
        let picture = |panel: &crate::figure::page::Panel| match &panel.contents[..] {
            [Content::Map(picture)] => picture.indices.clone(),
            other => panic!("{other:?}"),
        };
        let [first, last] = &figure.page.panels[..] else { panic!("two maps") };
        let [bar] = &figure.page.colour_bars[..] else { panic!("a colour bar") };
        assert_eq!(bar.axis.label, "temperature, °C");
        // By hand: from 300 K to 419 K with 20 cells; the upper left point is the fourth cell of the first column.
        assert!((bar.axis.range.start() - 26.85).abs() < 1e-9 && (bar.axis.range.end() - 145.85).abs() < 1e-9);
        assert_eq!(picture(first)[0], colour_index(3.0 / 119.0));
        assert_eq!(picture(last)[0], colour_index(103.0 / 119.0));
        let says = |text: &str| figure.page.texts.iter().any(|words| words.text == text);
        assert!(says("pin, 2 s") && says("pin, 3 s") && says("at most 45.9 °C") && says("at most 146 °C"));
        assert!(figure.page.keys.is_empty() && notes(&figures, NAME).is_empty());
    }

    #[test]
    fn runs_that_have_no_such_map_are_told_beside_one_that_has() {
        let figures = Written::figures(&[run("one", &[296.0, 300.0]), run("off", &[]), run("up", &[296.0, f64::NAN])]);
        let figure = figures.figures.iter().find(|figure| figure.name == NAME).unwrap();
        assert_eq!(figure.page.panels.len(), 1);
        let none = "no map temperature with a contact after the start";
        assert_eq!(notes(&figures, NAME), ["no map temperature", none]);
    }
}
