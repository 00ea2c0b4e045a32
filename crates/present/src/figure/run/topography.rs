//! Heights of disc and pin at the first and the last moment (paper Figs. 5, 7, 8, 9 and 11).

use plateau_core::observe::Map;
use plateau_io::run_file::ReadError;

use super::bodies::{Painted, any_of, having, rows};
use super::map_page::{MOST_ACROSS, MapBlock, MapGroup, page};
use super::moments::{ends, floats, mean, moment};
use super::robust_range::RobustRange;
use super::shape::Shape;
use super::{Figures, Options, Subject};
use crate::figure::axes::Axis;
use crate::figure::colour::{GROUND, colour_index, colour_map};
use crate::figure::unit::AxisUnit;
use crate::number;

const NAME: &str = "topography";

/// Adds the figure.
pub fn add(subjects: &[Subject], options: &Options, figures: &mut Figures) -> Result<(), ReadError> {
    let discs = having(figures, NAME, subjects, Map::DiscHeight);
    let pins = having(figures, NAME, subjects, Map::PinHeight);
    let shown = any_of(subjects, [&discs, &pins]);
    if shown.is_empty() {
        return Ok(());
    }
    let disc_scale = scale(&discs, disc_heights)?;
    let pin_scale = scale(&pins, |subject, index| Ok(pin_heights(subject, index)?.0))?;
    let palette: Vec<_> = colour_map().into_iter().chain([GROUND]).collect();
    let disc_shape = options.disc_shape();
    let mut blocks = Vec::new();
    for together in shown.chunks(MOST_ACROSS) {
        let disc_rows = rows(
            together,
            disc_shape,
            disc_shape == Shape::Unrolled,
            |subject| ends(subject.run),
            |subject, index| {
                let heights = disc_heights(subject, index)?;
                let title = format!("disc, {}", moment(subject.run, index));
                Ok(painted(&heights, &disc_scale, title, String::new()))
            },
        )?;
        let pin_rows = rows(
            together,
            Shape::Unrolled,
            false,
            |subject| ends(subject.run),
            |subject, index| {
                let (heights, mean) = pin_heights(subject, index)?;
                let title = format!("pin, {}", moment(subject.run, index));
                let remark =
                    format!("about its mean, z = {} µm", number::rounded(mean * AxisUnit::MICROMETRE.per_metre, 4));
                Ok(painted(&heights, &pin_scale, title, remark))
            },
        )?;
        let group = |rows, scale: &Axis| MapGroup { rows, palette: palette.clone(), scale: Some(scale.clone()) };
        blocks.push(MapBlock {
            names: together.iter().map(|subject| subject.label.clone()).collect(),
            groups: [(disc_rows, &disc_scale), (pin_rows, &pin_scale)]
                .into_iter()
                .filter(|(rows, _)| rows.iter().flatten().any(Option::is_some))
                .map(|(rows, scale)| group(rows, scale))
                .collect(),
        });
    }
    figures.add(
        NAME,
        "Topography of disc and pin",
        "Heights of disc and pin at the first and the last recorded moment. The disc's are the model's z; the pin's are \
         counted from its mean, positive toward the disc. The colours span 99 % of all heights of the body.",
        page(&[], &blocks),
    );
    Ok(())
}

/// Heights of the disc, m.
fn disc_heights(subject: &Subject, index: usize) -> Result<Vec<f64>, ReadError> {
    floats(subject.run, Map::DiscHeight, index)
}

/// Heights of the pin about their mean, positive toward the disc, and that mean as the model counts it, m.
fn pin_heights(subject: &Subject, index: usize) -> Result<(Vec<f64>, f64), ReadError> {
    let mut heights = floats(subject.run, Map::PinHeight, index)?;
    let mean = mean(&heights);
    heights.iter_mut().for_each(|height| *height = mean - *height);
    Ok((heights, mean))
}

/// The scale that all maps of a body share.
fn scale(
    subjects: &[&Subject],
    heights: impl Fn(&Subject, usize) -> Result<Vec<f64>, ReadError>,
) -> Result<Axis, ReadError> {
    let mut range = RobustRange::default();
    for subject in subjects {
        for index in ends(subject.run) {
            let heights = heights(subject, index)?;
            range.add(heights.iter().map(|height| height * AxisUnit::MICROMETRE.per_metre));
        }
    }
    Ok(Axis::linear(range.range(), "height, µm"))
}

fn painted(heights: &[f64], scale: &Axis, title: String, remark: String) -> Option<Painted> {
    let colour = |height: &f64| colour_index(scale.part(height * AxisUnit::MICROMETRE.per_metre));
    (!heights.is_empty()).then(|| Painted { title, remark, cells: heights.iter().map(colour).collect() })
}
