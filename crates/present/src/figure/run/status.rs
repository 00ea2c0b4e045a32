//! Status of the cells of disc and pin at the first and the last moment (paper Figs. 10 and 12). Any debris makes a cell secondary, so
//! thick build-up and thin films have colours of their own.

use plateau_core::model::material::Status;
use plateau_core::model::mesh::Mesh;
use plateau_core::observe::Map;
use plateau_io::run_file::ReadError;

use super::map_pages::{pages, width_of};
use super::map_rows::{Painted, any_of, blocks_of_bodies, having};
use super::moments::{leave_blank, moment, shown_moments, statuses};
use super::thickness::{BODIES, thickness};
use super::{Figures, Options, Subject};
use crate::colour::{GROUND, paler};
use crate::figure::chart::Meaning;
use crate::figure::page::KeyStyle;
use crate::quantity::{MapLook, STATUS_LOOKS, StatusLook, Unit};
use plateau_io::number;

const NAME: &str = "status";
/// A film is thinner than this, m: as thin as what a scan of a disc calls flat. The same for all runs, or what is said of one would depend
/// on those beside it.
const THIN: f64 = 0.1e-6;
/// Number of the colour of thin films.
const FILM: u8 = STATUS_LOOKS.len() as u8;
/// Number of the colour of what is no cell.
const NO_CELL: u8 = FILM + 1;

/// Adds the figure.
pub fn add(subjects: &[Subject], options: &Options, figures: &mut Figures) -> Result<(), ReadError> {
    let discs = having(figures, NAME, subjects, Map::DiscStatus);
    let pins = having(figures, NAME, subjects, Map::PinStatus);
    let shown = any_of(subjects, [&discs, &pins]);
    if shown.is_empty() {
        return Ok(());
    }
    let film = paler(STATUS_LOOKS[Status::Secondary as usize].colour, 0.45);
    let palette: Vec<_> = STATUS_LOOKS.iter().map(|look| look.colour).chain([film, GROUND]).collect();
    let disc_shape = options.disc_shape();
    let blocks = blocks_of_bodies(&shown, shown_moments, disc_shape, &palette, [None; 2], |subject, body, index| {
        painted(subject, [Map::DiscStatus, Map::PinStatus][body], index)
    })?;
    let meaning = |look: &StatusLook| Meaning {
        colour: look.colour,
        style: KeyStyle::Area,
        text: format!("{}: {}", look.name, look.made_of),
    };
    let tells = |subject: &&Subject| BODIES.iter().any(|body| body.iter().all(|map| subject.run.has_map(*map)));
    let films = shown.iter().any(tells).then(|| Meaning {
        colour: film,
        style: KeyStyle::Area,
        text: format!(
            "the same, thinner than {}",
            Unit::MICROMETRE.with_symbol(&number::rounded(Unit::MICROMETRE.value(THIN), 1))
        ),
    });
    let meanings: Vec<Meaning> = STATUS_LOOKS.iter().map(meaning).chain(films).collect();
    let width = figures.width(width_of(&blocks));
    figures.add_pages(
        NAME,
        "Status of disc and pin",
        "What the cells of disc and pin are at the first and the last recorded moment, with the parts of the area. Any debris makes a cell \
         secondary; where it is thinner than 0.1 um, its colour is paler.",
        pages(width, &meanings, &blocks),
    );
    Ok(())
}

fn painted(subject: &Subject, map: Map, index: usize) -> Result<Option<Painted>, ReadError> {
    let mut cells = statuses(subject.run, map, index)?;
    if cells.is_empty() {
        return Ok(None);
    }
    // Cells beyond the outline have no part in the area.
    leave_blank(subject.run, map, &mut cells, NO_CELL);
    let [none, primary, secondary, _] = area_fractions(subject.run.mesh(), &cells).map(percent);
    let mut title = format!("{}, {}", MapLook::of(map).body(), moment(subject.run, index));
    let remark = format!("none {none}, primary {primary}, secondary {secondary} %");
    let thickness = thickness(subject.run, if map.on_disc() { BODIES[0] } else { BODIES[1] }, index)?;
    if !thickness.is_empty() {
        let is_film = |(cell, thickness): (&u8, &f64)| *cell == Status::Secondary as u8 && *thickness < THIN;
        let films: Vec<bool> = cells.iter().zip(&thickness).map(is_film).collect();
        cells.iter_mut().zip(films).filter(|(_, film)| *film).for_each(|(cell, _)| *cell = FILM);
        let thick = percent(area_fractions(subject.run.mesh(), &cells)[Status::Secondary as usize]);
        title = format!("{title}, thick build-up {thick} %");
    }
    Ok(Some(Painted { title, remark, cells }))
}

/// Parts of the area that are none, primary, secondary and thin film; cells beyond the pin's outline do not count.
fn area_fractions(mesh: &Mesh, cells: &[u8]) -> [f64; 4] {
    let mut areas = [0.0; 4];
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
    use plateau_core::observe::{ABSENT, MapValues};

    use super::*;
    use crate::figure::run::written::{CELLS, Written};

    #[test]
    fn parts_are_of_what_is_there_of_a_round_pin() {
        // By hand: of 5 columns the middle one is there, with rows at 20.5 mm to 23.5 mm, together 88.
        let mut cells = vec![ABSENT; CELLS];
        cells[8..12].copy_from_slice(&[0, 1, 2, 2]);
        let run = Written::new("round", &[], |_, time| time).round();
        let run = run.with_maps(Map::PinStatus, std::iter::once(MapValues::Status(cells)));
        let figures = Written::figures(&[run]);
        let figure = figures.figures.iter().find(|figure| figure.name == NAME).unwrap();
        let text = figure.page.texts.iter().find(|words| words.text.starts_with("none ")).unwrap();
        assert_eq!(text.text, "none 23.3, primary 24.4, secondary 52.3 %");
    }

    #[test]
    fn fractions_are_of_the_area() {
        // By hand: rows at r = 1.5 and 2.5, two columns; 1.5 + 1.5 + 2.5 + 2.5 = 8.
        let mesh = Mesh::new(2, 10, 2, 1.0, 3.0).unwrap();
        let [none, primary, secondary, _] = area_fractions(&mesh, &[0, 2, 1, 2]);
        assert_eq!(area_fractions(&mesh, &[0, NO_CELL, NO_CELL, NO_CELL]), [1.0, 0.0, 0.0, 0.0]);
        for (fraction, expected) in [(none, 1.5 / 8.0), (primary, 1.5 / 8.0), (secondary, 5.0 / 8.0)] {
            assert!((fraction - expected).abs() < 1e-15);
        }
        assert_eq!([0.0, 1.0, 0.123_456, 1e-6].map(percent), ["0", "100", "12.3", "0"]);
    }
}
