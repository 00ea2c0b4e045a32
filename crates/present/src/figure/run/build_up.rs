//! Thickness of what has built up on disc and pin at the last moment: height less substrate.

use plateau_core::model::mesh::Mesh;
use plateau_io::number;
use plateau_io::run_file::ReadError;

use super::map_pages::{pages, width_of};
use super::map_rows::{Painted, any_of, blocks_of_bodies, having};
use super::moments::{leave_blank, moment};
use super::thickness::{BODIES, Body, largest, moments_of_thickness, thickness};
use super::{Figures, Options, Subject};
use crate::colour::{APART, COLOURS, GROUND, colour_index, colour_map};
use crate::figure::axes::Axis;
use crate::figure::chart::Meaning;
use crate::figure::page::KeyStyle;
use crate::quantity::MapLook;

const NAME: &str = "build-up";

/// Number of the colour of cells on which nothing lies.
const NOTHING: u8 = COLOURS as u8;
/// Number of the colour of what is no cell.
const NO_CELL: u8 = NOTHING + 1;

/// Adds the figure.
pub fn add(subjects: &[Subject], options: &Options, figures: &mut Figures) -> Result<(), ReadError> {
    let having = BODIES.map(|[height, substrate]| {
        let list = having(figures, NAME, subjects, substrate);
        list.into_iter().filter(|subject| subject.run.has_map(height)).collect::<Vec<_>>()
    });
    let shown = any_of(subjects, having.each_ref().map(|list| &list[..]));
    if shown.is_empty() {
        return Ok(());
    }
    let palette: Vec<_> = colour_map().into_iter().chain([APART, GROUND]).collect();
    let scales = [scale(&having[0], BODIES[0])?, scale(&having[1], BODIES[1])?];
    let disc_shape = options.disc_shape();
    let of_scales = scales.each_ref().map(Some);
    let blocks =
        blocks_of_bodies(&shown, moments_of_thickness, disc_shape, &palette, of_scales, |subject, body, index| {
            painted(subject, BODIES[body], index, &scales[body])
        })?;
    let nothing = Meaning { colour: APART, style: KeyStyle::Area, text: "nothing has built up".to_owned() };
    let width = figures.width(width_of(&blocks));
    figures.add_pages(
        NAME,
        "Build-up on disc and pin",
        "Thickness of the compacted debris on disc and pin at the last recorded moment: height less what lies below. The colours \
         go from none to the thickness that 99.5 % of the covered cells of the body are below.",
        pages(width, &[nothing], &blocks),
    );
    Ok(())
}

/// The scale that all maps of a body share.
fn scale(subjects: &[&Subject], body: Body) -> Result<Axis, ReadError> {
    let unit = &MapLook::of(body[0]).unit;
    let largest = largest(subjects, body)?.map_or(1.0, |largest| unit.value(largest));
    Ok(Axis::linear(0.0..=largest, unit.label("thickness")))
}

fn painted(subject: &Subject, body: Body, index: usize, scale: &Axis) -> Result<Option<Painted>, ReadError> {
    let look = MapLook::of(body[0]);
    let thickness = thickness(subject.run, body, index)?;
    let colour = |thickness: &f64| match *thickness {
        thickness if thickness > 0.0 => colour_index(scale.part(look.unit.value(thickness))),
        _ => NOTHING,
    };
    let mut cells: Vec<u8> = thickness.iter().map(colour).collect();
    leave_blank(subject.run, body[0], &mut cells, NO_CELL);
    let [covered, mean] = means(subject.run.mesh(), &thickness);
    let mean = look.unit.with_symbol(&number::rounded(look.unit.value(mean), 3));
    Ok((!cells.is_empty()).then(|| Painted {
        title: format!("{}, {}", look.body(), moment(subject.run, index)),
        remark: format!("on {} % of the area, {mean} in the mean of all", number::rounded(100.0 * covered, 3)),
        cells,
    }))
}

/// Part of the area that is covered, and the mean thickness over all of it, m; cells beyond the pin's outline do not count.
fn means(mesh: &Mesh, thickness: &[f64]) -> [f64; 2] {
    let (mut area, mut covered, mut volume) = (0.0, 0.0, 0.0);
    for column in thickness.chunks(mesh.rows()) {
        for (thickness, cell) in column.iter().zip(mesh.area()).filter(|(thickness, _)| thickness.is_finite()) {
            area += cell;
            covered += if *thickness > 0.0 { *cell } else { 0.0 };
            volume += thickness * cell;
        }
    }
    [covered, volume].map(|sum| sum / area)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_count_areas() {
        // Rows at 1.5 and 2.5 m in the mean radius: areas as 3 to 5. One inner cell of two is covered, 4 m thick.
        let mesh = Mesh::new(2, 4, 1, 1.0, 3.0).unwrap();
        let [covered, mean] = means(&mesh, &[4.0, 0.0, 0.0, f64::NAN]);
        assert!((covered - 3.0 / 11.0).abs() < 1e-15 && (mean - 12.0 / 11.0).abs() < 1e-14, "{covered} {mean}");
    }
}
