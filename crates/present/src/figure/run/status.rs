//! Status of the cells of disc and pin at the first and the last moment (paper Figs. 10 and 12).

use plateau_core::model::mesh::Mesh;
use plateau_core::observe::Map;
use plateau_io::run_file::ReadError;

use super::map_page::{MOST_ACROSS, MapBlock, MapGroup, Painted, any_of, having, page, rows};
use super::moments::{ends, leave_blank, moment, statuses};
use super::shape::Shape;
use super::{Figures, Options, Subject};
use crate::colour::GROUND;
use crate::figure::chart::Meaning;
use crate::figure::page::KeyStyle;
use crate::quantity::{MapLook, STATUS_LOOKS, StatusLook};
use plateau_io::number;

const NAME: &str = "status";

/// Adds the figure.
pub fn add(subjects: &[Subject], options: &Options, figures: &mut Figures) -> Result<(), ReadError> {
    let discs = having(figures, NAME, subjects, Map::DiscStatus);
    let pins = having(figures, NAME, subjects, Map::PinStatus);
    let shown = any_of(subjects, [&discs, &pins]);
    if shown.is_empty() {
        return Ok(());
    }
    let palette: Vec<_> = STATUS_LOOKS.iter().map(|look| look.colour).chain([GROUND]).collect();
    let disc_shape = options.disc_shape();
    let mut blocks = Vec::new();
    for together in shown.chunks(MOST_ACROSS) {
        let moments = |subject: &Subject| ends(subject.run);
        let disc_rows = rows(
            together,
            |_| disc_shape,
            disc_shape == Shape::Unrolled,
            moments,
            |subject, index| painted(subject, Map::DiscStatus, index),
        )?;
        let pin_rows =
            rows(together, Shape::of_pin, false, moments, |subject, index| painted(subject, Map::PinStatus, index))?;
        let has_any = |rows: &Vec<Vec<Option<_>>>| rows.iter().flatten().any(Option::is_some);
        blocks.push(MapBlock {
            names: together.iter().map(|subject| subject.label.clone()).collect(),
            groups: [disc_rows, pin_rows]
                .into_iter()
                .filter(has_any)
                .map(|rows| MapGroup { rows, palette: palette.clone(), scale: None })
                .collect(),
        });
    }
    let meaning = |look: &StatusLook| Meaning {
        colour: look.colour,
        style: KeyStyle::Area,
        text: format!("{}: {}", look.name, look.made_of),
    };
    let meanings: Vec<Meaning> = STATUS_LOOKS.iter().map(meaning).collect();
    figures.add(
        NAME,
        "Status of disc and pin",
        "What the cells of disc and pin are at the first and the last recorded moment, with the parts of the area.",
        page(&meanings, &blocks),
    );
    Ok(())
}

fn painted(subject: &Subject, map: Map, index: usize) -> Result<Option<Painted>, ReadError> {
    let mut cells = statuses(subject.run, map, index)?;
    if cells.is_empty() {
        return Ok(None);
    }
    let [none, primary, secondary] = area_fractions(subject.run.mesh(), &cells).map(percent);
    let title = format!("{}, {}", MapLook::of(map).body(), moment(subject.run, index));
    let remark = format!("none {none}, primary {primary}, secondary {secondary} %");
    leave_blank(subject.run, map, &mut cells, STATUS_LOOKS.len() as u8);
    Ok(Some(Painted { title, remark, cells }))
}

/// Parts of the area that are none, primary and secondary; cells beyond the pin's outline do not count.
fn area_fractions(mesh: &Mesh, cells: &[u8]) -> [f64; 3] {
    let mut areas = [0.0; 3];
    for column in cells.chunks(mesh.rows()) {
        for (status, area) in column.iter().zip(mesh.area()) {
            if let Some(sum) = areas.get_mut(usize::from(*status)) {
                *sum += area;
            }
        }
    }
    let all: f64 = areas.iter().sum();
    areas.map(|area| area / all)
}

fn percent(fraction: f64) -> String {
    number::rounded(if fraction < 5e-5 { 0.0 } else { 100.0 * fraction }, 3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_are_of_the_area() {
        // By hand: rows at r = 1.5 and 2.5, two columns; 1.5 + 1.5 + 2.5 + 2.5 = 8.
        let mesh = Mesh::new(2, 10, 2, 1.0, 3.0).unwrap();
        let [none, primary, secondary] = area_fractions(&mesh, &[0, 2, 1, 2]);
        assert_eq!(area_fractions(&mesh, &[0, 3, 3, 3]), [1.0, 0.0, 0.0]);
        for (fraction, expected) in [(none, 1.5 / 8.0), (primary, 1.5 / 8.0), (secondary, 5.0 / 8.0)] {
            assert!((fraction - expected).abs() < 1e-15);
        }
        assert_eq!([0.0, 1.0, 0.123_456, 1e-6].map(percent), ["0", "100", "12.3", "0"]);
    }
}
