//! Heights of disc and pin at the first and the last moment (paper Figs. 5, 7, 8, 9 and 11).

use plateau_core::observe::Map;
use plateau_io::run_file::ReadError;

use super::map_pages::{pages, width_of};
use super::map_rows::{Painted, any_of, blocks_of_bodies, having};
use super::moments::{heights, leave_blank, moment, shown_moments};
use super::{Figures, Options, Subject};
use crate::colour::{COLOURS, GROUND, colour_index, colour_map};
use crate::figure::axes::Axis;
use crate::quantity::{BEYOND, MapLook, RobustRange};
use plateau_io::number;

const NAME: &str = "topography";

/// Adds the figure.
pub fn add(subjects: &[Subject], options: &Options, figures: &mut Figures) -> Result<(), ReadError> {
    let bodies = [Map::DiscHeight, Map::PinHeight];
    let disc_shape = options.disc_shape();
    let having = bodies.map(|map| having(figures, NAME, subjects, map));
    let shown = any_of(subjects, having.each_ref().map(|list| &list[..]));
    if shown.is_empty() {
        return Ok(());
    }
    let scales = [scale(&having[0], bodies[0])?, scale(&having[1], bodies[1])?];
    let palette: Vec<_> = colour_map().into_iter().chain([GROUND]).collect();
    let of_scales = scales.each_ref().map(Some);
    let blocks = blocks_of_bodies(&shown, shown_moments, disc_shape, &palette, of_scales, |subject, body, index| {
        painted(subject, bodies[body], index, &scales[body])
    })?;
    let width = figures.width(width_of(&blocks));
    figures.add_pages(
        NAME,
        "Topography of disc and pin",
        "Heights of disc and pin at the first and the last recorded moment, positive toward the other body: peaks have the highest. The \
         pin's are counted from their mean. The colours span 99 % of all heights of the body.",
        pages(width, &[], &blocks),
    );
    Ok(())
}

/// The scale that all maps of a body share.
fn scale(subjects: &[&Subject], map: Map) -> Result<Axis, ReadError> {
    let look = MapLook::of(map);
    let mut range = RobustRange::default();
    for subject in subjects {
        for index in shown_moments(subject) {
            let (heights, _) = heights(subject.run, map, index)?;
            range.add(heights.iter().map(|height| look.unit.value(*height)));
        }
    }
    Ok(Axis::linear(range.between(BEYOND, 1.0 - BEYOND), look.unit.label(look.what)))
}

fn painted(subject: &Subject, map: Map, index: usize, scale: &Axis) -> Result<Option<Painted>, ReadError> {
    let look = MapLook::of(map);
    let (heights, zero) = heights(subject.run, map, index)?;
    let colour = |height: &f64| colour_index(scale.part(look.unit.value(*height)));
    let mut cells: Vec<u8> = heights.iter().map(colour).collect();
    leave_blank(subject.run, map, &mut cells, COLOURS as u8);
    let zero = look.unit.with_symbol(&number::rounded(look.unit.value(zero), 4));
    Ok((!heights.is_empty()).then(|| Painted {
        title: format!("{}, {}", look.body(), moment(subject.run, index)),
        remark: if look.about_mean { format!("from its mean, z = {zero}") } else { String::new() },
        cells,
    }))
}
