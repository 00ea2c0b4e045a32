//! Which maps of which runs stand where on a page: rows of moments or runs.

use plateau_core::model::mesh::Mesh;
use plateau_core::observe::Map;
use plateau_io::run_file::ReadError;
use plotters::style::RGBColor;

use super::map_page::{MapBlock, MapGroup};
use super::map_pages::runs_across;
use super::map_section::MapSection;
use super::shape::Shape;
use super::{Figures, Subject};
use crate::figure::axes::Axis;

/// Moments in a block of maps, at most: of one run, and of several.
const MOST_MOMENTS: [usize; 2] = [3, 2];

/// The runs that have a map at any moment; of the others it is noted that they are left out.
pub fn having<'a>(
    figures: &mut Figures,
    what: &'static str,
    subjects: &'a [Subject<'a>],
    map: Map,
) -> Vec<&'a Subject<'a>> {
    let mut having = Vec::new();
    for subject in subjects {
        if !subject.run.has_map(map) {
            figures.leave_out(what, subject, &format!("no map {}", map.name()));
        } else if subject.run.map_time().is_empty() {
            figures.leave_out(what, subject, "no maps yet");
        } else {
            having.push(subject);
        }
    }
    having
}

/// The runs of any of the lists, in the order of all.
pub fn any_of<'a, const N: usize>(subjects: &'a [Subject<'a>], lists: [&[&'a Subject<'a>]; N]) -> Vec<&'a Subject<'a>> {
    let has = |subject: &Subject| lists.iter().any(|list| list.iter().any(|other| std::ptr::eq(*other, subject)));
    subjects.iter().filter(|subject| has(subject)).collect()
}

/// A map.
pub struct Painted {
    /// What it is, in a few words.
    pub title: String,
    /// What else is to know of it; may be empty.
    pub remark: String,
    /// Number of the colour of every cell.
    pub cells: Vec<u8>,
}

/// Moments of a run, as indices of its maps.
pub type Moments<'m> = dyn Fn(&Subject) -> Vec<usize> + 'm;

/// Blocks with a few runs and a few of their moments each. `groups` gives the maps of such runs at such moments.
pub fn blocks<'a>(
    shown: &[&'a Subject<'a>],
    moments: impl Fn(&Subject) -> Vec<usize>,
    mut groups: impl FnMut(&[&'a Subject<'a>], &Moments) -> Result<Vec<MapGroup<'a>>, ReadError>,
) -> Result<Vec<MapBlock<'a>>, ReadError> {
    let together = MOST_MOMENTS[usize::from(shown.len() > 1)];
    let mut blocks = Vec::new();
    for runs in shown.chunks(runs_across(shown.len())) {
        let most = runs.iter().map(|subject| moments(subject).len()).max().unwrap_or(0);
        for first in (0..most).step_by(together) {
            let some = |subject: &Subject| moments(subject).into_iter().skip(first).take(together).collect();
            let names = runs.iter().map(|subject| subject.label.clone()).collect();
            blocks.push(MapBlock { names, groups: groups(runs, &some)? });
        }
    }
    Ok(blocks)
}

/// Blocks with maps of the disc and, below, of the pin. `paint` gives the map of a run on a body, 0 is the disc, at a moment.
pub fn blocks_of_bodies<'a>(
    shown: &[&'a Subject<'a>],
    moments: impl Fn(&Subject) -> Vec<usize>,
    disc_shape: Shape,
    palette: &[RGBColor],
    scales: [Option<&Axis>; 2],
    paint: impl Fn(&Subject, usize, usize) -> Result<Option<Painted>, ReadError>,
) -> Result<Vec<MapBlock<'a>>, ReadError> {
    blocks(shown, moments, |runs, some| groups_of_bodies(runs, some, disc_shape, palette, scales, &paint))
}

fn groups_of_bodies<'a>(
    subjects: &[&'a Subject<'a>],
    moments: &Moments,
    disc_shape: Shape,
    palette: &[RGBColor],
    scales: [Option<&Axis>; 2],
    paint: impl Fn(&Subject, usize, usize) -> Result<Option<Painted>, ReadError>,
) -> Result<Vec<MapGroup<'a>>, ReadError> {
    let mut groups = Vec::new();
    for (body, scale) in scales.into_iter().enumerate() {
        let on_disc = body == 0;
        let shape = |mesh: &Mesh| if on_disc { disc_shape } else { Shape::of_pin(mesh) };
        let wide = on_disc && disc_shape == Shape::Unrolled;
        let rows = rows(subjects, shape, wide, moments, |subject, index| paint(subject, body, index))?;
        if rows.iter().flatten().any(Option::is_some) {
            groups.push(MapGroup { rows, palette: palette.to_vec(), scale: scale.cloned() });
        }
    }
    Ok(groups)
}

/// Rows of maps. The moments of a single run stand below each other if they are `wide`, else beside each other; those of
/// several runs stand below each other, the runs beside each other. `shape` tells how a body on a mesh is shown, `paint` gives the map of a run at a moment.
pub fn rows<'a>(
    subjects: &[&'a Subject<'a>],
    shape: impl Fn(&Mesh) -> Shape,
    wide: bool,
    moments: impl Fn(&Subject) -> Vec<usize>,
    mut paint: impl FnMut(&Subject, usize) -> Result<Option<Painted>, ReadError>,
) -> Result<Vec<Vec<Option<MapSection<'a>>>>, ReadError> {
    let mut columns = Vec::new();
    for subject in subjects {
        let mut column = Vec::new();
        for moment in moments(subject) {
            let mesh = subject.run.mesh();
            let section =
                |Painted { title, remark, cells }| MapSection { title, remark, mesh, shape: shape(mesh), cells };
            column.push(paint(subject, moment)?.map(section));
        }
        columns.push(column);
    }
    match &mut columns[..] {
        [one] if wide => Ok(std::mem::take(one).into_iter().map(|section| vec![section]).collect()),
        [one] => Ok(vec![std::mem::take(one)]),
        several => {
            let most = several.iter().map(Vec::len).max().unwrap_or(0);
            for column in several.iter_mut() {
                // The only map of a run stands beside the last maps of the others.
                column.splice(..0, vec![None; most - column.len()]);
            }
            let row = |moment: usize| several.iter_mut().map(|column| column[moment].take()).collect();
            Ok((0..most).map(row).collect())
        }
    }
}
