//! Fibre and resin under the pin's cells: synthetic fibre maps, and what follows from a map for the surface.

use std::f64::consts::PI;
use std::ops::Range;

use thiserror::Error;

use super::random::{Random, Stream};
use super::{Body, Length};
use crate::model::mesh::Mesh;
use crate::model::state::Base;

/// Area fraction of the pin that is fibre.
pub fn fibre_fraction(base: &[Base], mesh: &Mesh) -> f64 {
    let fibre: f64 =
        base.iter().zip(mesh.pin_areas()).filter(|(base, _)| **base == Base::Primary).map(|(_, area)| area).sum();
    fibre / mesh.pin_area()
}

/// Sets the resin of a pin back from its fibres by `recess`, m: the pin's z grows away from the disc.
pub fn set_back_resin(heights: &mut [f64], base: &[Base], recess: f64) {
    let resin = heights.iter_mut().zip(base).filter(|(_, base)| **base == Base::Resin);
    resin.for_each(|(height, _)| *height += recess);
}

/// All points within `radius` of a straight segment.
struct Capsule {
    centre: (f64, f64),
    direction: (f64, f64),
    half_segment: f64,
    radius: f64,
}

impl Capsule {
    fn contains(&self, x: f64, y: f64) -> bool {
        let (x, y) = (x - self.centre.0, y - self.centre.1);
        let along = x * self.direction.0 + y * self.direction.1;
        let across = y * self.direction.0 - x * self.direction.1;
        let beyond = (along.abs() - self.half_segment).max(0.0);
        beyond * beyond + across * across <= self.radius * self.radius
    }

    /// Columns and rows of the pin in which the capsule may be.
    fn reach(&self, mesh: &Mesh) -> [Range<usize>; 2] {
        let reach_x = self.half_segment * self.direction.0.abs() + self.radius;
        let reach_y = self.half_segment * self.direction.1.abs() + self.radius;
        [
            span(self.centre.0, reach_x, mesh.column_width(), mesh.pin_columns()),
            span(self.centre.1, reach_y, mesh.row_height(), mesh.rows()),
        ]
    }

    /// Cells of the pin whose centres lie in the capsule.
    fn cells(&self, mesh: &Mesh) -> impl Iterator<Item = usize> {
        let (width, height, rows) = (mesh.column_width(), mesh.row_height(), mesh.rows());
        let [columns, row_range] = self.reach(mesh);
        columns
            .flat_map(move |column| row_range.clone().map(move |row| (column, row)))
            .filter(move |(column, row)| self.contains((*column as f64 + 0.5) * width, (*row as f64 + 0.5) * height))
            .map(move |(column, row)| column * rows + row)
    }
}

/// Indices of the cells that reach into centre ± reach. The cast saturates at 0.
fn span(centre: f64, reach: f64, cell: f64, count: usize) -> Range<usize> {
    let first = (((centre - reach) / cell) as usize).min(count);
    let last = libm::ceil((centre + reach) / cell) as usize;
    first..last.min(count)
}

/// Fibres as capsules (rectangles with round ends) at random places and angles, up to a given area fraction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FibreSynthesis {
    /// Seed of the random stream.
    pub seed: u64,
    /// Area fraction of the pin, within its outline, that is fibre.
    pub fibre_fraction: f64,
    /// Length of a fibre from end to end, m.
    pub fibre_length: f64,
    /// Width of a fibre, m; a fibre as long as wide is a disc.
    pub fibre_width: f64,
}

/// Error of a fibre map that cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs)] // The messages say what they mean.
pub enum FibreError {
    #[error("fibre_fraction is {found}, expected 0 to 1")]
    Fraction { found: f64 },
    #[error("fibre_width is {found} m, expected more than 0 and finite")]
    Width { found: f64 },
    #[error("fibre_length is {}, expected at least the fibre_width of {} and finite", Length(*length), Length(*width))]
    ShorterThanWide { length: f64, width: f64 },
    #[error(
        "after {placed} fibres only {reached:.3e} of the pin is covered, expected {wanted}: fibres of {} by {} \
         are too small or too long for this pin",
        Length(*length), Length(*width)
    )]
    TooMany { placed: u32, reached: f64, wanted: f64, length: f64, width: f64 },
    #[error(
        "about {fibres:.0e} fibres of {} by {} would be needed, and {cells:.0e} cells looked at for them, expected at most \
         {MOST_FIBRES:.0e} and {MOST_CELLS:.0e}: they are too small or too long for this pin",
        Length(*length), Length(*width)
    )]
    OutOfReach { fibres: f64, cells: f64, length: f64, width: f64 },
}

/// Fibres after which the map is given up.
const MOST_FIBRES: u32 = 20_000_000;
/// Cells looked at after which it is given up, too: fibres far longer than the pin mostly miss it, and each is looked for in all of it. A
/// map takes about as many as the pin has cells, times the length of a fibre over its width.
const MOST_CELLS: u64 = 20_000_000_000;

impl FibreSynthesis {
    /// Base of every pin cell: fibre where the cell's centre lies in a capsule, x being the arc length at the mean
    /// radius and y the radius. The last capsule stays only if that brings the area fraction nearer to the target.
    ///
    /// # Errors
    /// [`FibreError`] when [`check`](Self::check) refuses the parameters or the target is out of reach.
    pub fn base(&self, mesh: &Mesh) -> Result<Vec<Base>, FibreError> {
        self.check()?;
        if self.fibre_fraction == 1.0 {
            return Ok(vec![Base::Primary; mesh.pin_cells()]);
        }
        let mut base = vec![Base::Resin; mesh.pin_cells()];
        if self.fibre_fraction == 0.0 {
            return Ok(base);
        }
        let (width, height) = (Body::Pin.length(mesh), mesh.rows() as f64 * mesh.row_height());
        self.refuse_out_of_reach(mesh, width, height)?;
        let (area, total) = (mesh.area(), mesh.pin_area());
        let mut random = Random::new(self.seed, Stream::PinBase);
        let mut covered = 0.0;
        let mut open_cells = mesh.present_cells();
        let (mut placed, mut looked) = (0, 0);
        while placed < MOST_FIBRES && looked < MOST_CELLS {
            let capsule = self.draw(&mut random, width, height);
            placed += 1;
            let [columns, rows] = capsule.reach(mesh);
            looked += columns.len() as u64 * rows.len() as u64;
            let is_new = |cell: &usize| base[*cell] == Base::Resin && mesh.is_present(*cell);
            let new_cells: Vec<usize> = capsule.cells(mesh).filter(is_new).collect();
            let before = covered / total;
            covered += new_cells.iter().map(|cell| area[cell % mesh.rows()]).sum::<f64>();
            let after = covered / total;
            if after >= self.fibre_fraction && after - self.fibre_fraction >= self.fibre_fraction - before {
                return Ok(base);
            }
            new_cells.iter().for_each(|cell| base[*cell] = Base::Primary);
            open_cells -= new_cells.len();
            // With no cell left the sum may still miss a fraction close to 1 by its rounding.
            if after >= self.fibre_fraction || open_cells == 0 {
                return Ok(base);
            }
        }
        Err(FibreError::TooMany {
            placed,
            reached: covered / total,
            wanted: self.fibre_fraction,
            length: self.fibre_length,
            width: self.fibre_width,
        })
    }

    /// Refuses at once what would be given up after a long time.
    ///
    /// Capsules of area `A` with centres anywhere in an area `E` leave the fraction `exp(−n A/E)` free after `n` of them, and each
    /// is looked for in the part `B/E` of the cells, `B` being the mean area of the rectangle around it.
    fn refuse_out_of_reach(&self, mesh: &Mesh, width: f64, height: f64) -> Result<(), FibreError> {
        let (segment, diameter) = (self.fibre_length - self.fibre_width, self.fibre_width);
        // Without units: lengths near the ends of doubles have no squares.
        let slenderness = segment / diameter;
        let extent = ((width + self.fibre_length) / diameter) * ((height + self.fibre_length) / diameter);
        let (capsule, around) = (slenderness + PI / 4.0, slenderness * slenderness / PI + 4.0 / PI * slenderness + 1.0);
        // A map is complete, too, when the last cell is covered.
        let coverings = (-libm::log1p(-self.fibre_fraction)).min(libm::log(mesh.present_cells() as f64) + 1.0);
        // What no double holds is out of reach as well.
        let number = |value: f64| if value.is_nan() { f64::INFINITY } else { value };
        let fibres = number(coverings * extent / capsule);
        let cells = number(coverings * mesh.pin_cells() as f64 * around / capsule);
        if fibres <= f64::from(MOST_FIBRES) && cells <= MOST_CELLS as f64 {
            return Ok(());
        }
        Err(FibreError::OutOfReach { fibres, cells, length: self.fibre_length, width: self.fibre_width })
    }

    /// A capsule anywhere in the pin's rectangle or up to half a length outside it, so that the edges are as dense as
    /// the middle.
    fn draw(&self, random: &mut Random, width: f64, height: f64) -> Capsule {
        let mut place = |size: f64| (size + self.fibre_length) * random.uniform() - 0.5 * self.fibre_length;
        let centre = (place(width), place(height));
        let angle = PI * random.uniform();
        let (direction, radius) = ((libm::cos(angle), libm::sin(angle)), 0.5 * self.fibre_width);
        Capsule { centre, direction, half_segment: 0.5 * (self.fibre_length - self.fibre_width), radius }
    }

    /// Refuses what is no fibre map.
    ///
    /// # Errors
    /// [`FibreError`] when the fraction lies outside 0 to 1, the width is not positive or the length is below it.
    pub fn check(&self) -> Result<(), FibreError> {
        if !(0.0..=1.0).contains(&self.fibre_fraction) {
            return Err(FibreError::Fraction { found: self.fibre_fraction });
        }
        if !(self.fibre_width > 0.0 && self.fibre_width.is_finite()) {
            return Err(FibreError::Width { found: self.fibre_width });
        }
        if !(self.fibre_length >= self.fibre_width && self.fibre_length.is_finite()) {
            return Err(FibreError::ShorterThanWide { length: self.fibre_length, width: self.fibre_width });
        }
        Ok(())
    }
}
