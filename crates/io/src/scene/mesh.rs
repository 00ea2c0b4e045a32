//! The mesh of a scene: in rows, columns and radii, or in lengths; the pin a rectangle or round.

use std::f64::consts::TAU;

use plateau_core::model::mesh::{Mesh, MeshError};
use plateau_core::model::outline::{Outline, columns_of_disc};
use plateau_core::surface::Length;

use super::schema::choices::Shape;
use crate::number;

/// Content of `[mesh]`, lengths in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Geometry {
    size: Size,
    shape: Shape,
}

/// The two ways of saying it, see [`super::schema::WAYS`].
#[derive(Debug, Clone, Copy, PartialEq)]
enum Size {
    Cells { inner: f64, outer: f64, rows: u64, disc_columns: u64, pin_columns: u64, pin_diameter: Option<f64> },
    Lengths { pin_width: f64, pin_length: Option<f64>, cell_size: f64, mean_radius: f64 },
}

/// Reason why it is no mesh: the name of the key in `[mesh]` and a message.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Refused {
    pub(crate) key: &'static str,
    pub(crate) message: String,
}

impl Refused {
    fn new(key: &'static str, message: String) -> Self {
        Self { key, message }
    }
}

/// Rows and columns, and where they are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Cells {
    /// Of rows, columns round the ring and columns under the pin.
    pub(crate) counts: [u64; 3],
    /// Inner and outer radius, m.
    radii: [f64; 2],
    outline: Outline,
}

impl Geometry {
    /// Reads it with functions that give a length (m) and a count by the name of the key, `None` where it is not given.
    pub(crate) fn read<E>(
        shape: Shape,
        length: impl Fn(&'static str) -> Result<Option<f64>, E>,
        count: impl Fn(&'static str) -> Result<Option<u64>, E>,
        missing: impl Fn(&'static str) -> E,
    ) -> Result<Self, E> {
        let needed = |name| length(name)?.ok_or_else(|| missing(name));
        let size = match length("cell_size")? {
            Some(cell_size) => Size::Lengths {
                pin_width: needed("pin_width")?,
                pin_length: length("pin_length")?,
                cell_size,
                mean_radius: needed("mean_radius")?,
            },
            None => {
                let counted = |name| count(name)?.ok_or_else(|| missing(name));
                Size::Cells {
                    rows: counted("rows")?,
                    disc_columns: counted("disc_columns")?,
                    pin_columns: counted("pin_columns")?,
                    inner: needed("inner_radius")?,
                    outer: needed("outer_radius")?,
                    pin_diameter: length("pin_diameter")?,
                }
            }
        };
        Ok(Self { size, shape })
    }

    /// Its rows and columns.
    pub(crate) fn cells(&self) -> Result<Cells, Refused> {
        match self.size {
            Size::Cells { inner, outer, rows, disc_columns, pin_columns, pin_diameter } => Ok(Cells {
                counts: [rows, disc_columns, pin_columns],
                radii: [inner, outer],
                outline: self.outline(pin_diameter)?,
            }),
            Size::Lengths { pin_width, pin_length, cell_size, mean_radius } => {
                self.divided(pin_width, pin_length, cell_size, mean_radius)
            }
        }
    }

    /// The outline where the mesh is given in rows and columns.
    fn outline(&self, pin_diameter: Option<f64>) -> Result<Outline, Refused> {
        match (self.shape, pin_diameter) {
            (Shape::Rectangle, None) => Ok(Outline::Rectangle),
            (Shape::Disc, Some(diameter)) => Ok(Outline::Disc { radius: 0.5 * diameter }),
            (Shape::Rectangle, Some(_)) => Err(Refused::new(
                "pin_diameter",
                "this key has a meaning only beside shape = \"disc\", which is not given; a rectangle has pin_columns and all rows"
                    .to_owned(),
            )),
            (Shape::Disc, None) => Err(Refused::new(
                "shape",
                "rows and columns do not say how large a round pin is: give pin_diameter, or the mesh by pin_width, cell_size \
                 and mean_radius"
                    .to_owned(),
            )),
        }
    }

    /// Rows, ring and pin in cells of this size: the width is met exactly, the ring to half a column, the pin too.
    fn divided(
        &self,
        pin_width: f64,
        pin_length: Option<f64>,
        cell_size: f64,
        mean_radius: f64,
    ) -> Result<Cells, Refused> {
        if pin_width >= 2.0 * mean_radius {
            let message = format!(
                "a pin of {} does not fit a ring of the mean radius {}, whose inner radius would not be above 0: expected \
                 less than {}",
                Length(pin_width),
                Length(mean_radius),
                Length(2.0 * mean_radius)
            );
            return Err(Refused::new("pin_width", message));
        }
        let circumference = TAU * mean_radius;
        let disc_columns = whole(circumference / cell_size);
        let column_angle = TAU / disc_columns;
        let too_long = |key, found: String| {
            let message = format!(
                "{found} does not fit the ring, which is {} round at the mean radius {}: a larger mean_radius or a smaller \
                 pin helps",
                Length(circumference),
                Length(mean_radius)
            );
            Err(Refused::new(key, message))
        };
        let (pin_columns, outline) = match (self.shape, pin_length) {
            (Shape::Rectangle, Some(length)) if length > circumference => {
                return too_long("pin_length", format!("a pin of {}", Length(length)));
            }
            (Shape::Rectangle, Some(length)) => {
                (whole(length / (mean_radius * column_angle)).min(disc_columns), Outline::Rectangle)
            }
            (Shape::Rectangle, None) => {
                return Err(Refused::new("pin_width", "a rectangle needs its pin_length, too".to_owned()));
            }
            (Shape::Disc, _) => {
                let radius = 0.5 * pin_width;
                match columns_of_disc(radius, mean_radius, column_angle).filter(|columns| *columns <= disc_columns) {
                    Some(columns) => (columns, Outline::Disc { radius }),
                    None => return too_long("pin_width", format!("a round pin of {} in diameter", Length(pin_width))),
                }
            }
        };
        // To as many digits as lengths are given with: 22 mm less 2 mm are 20 mm.
        let radii = [mean_radius - 0.5 * pin_width, mean_radius + 0.5 * pin_width].map(number::to_fifteen_digits);
        let counts = [whole(pin_width / cell_size), disc_columns, pin_columns];
        // Casts saturate: what is too large for memory is refused as such.
        Ok(Cells { counts: counts.map(|count| count as u64), radii, outline })
    }
}

impl Cells {
    /// Makes the mesh, which takes memory.
    pub(crate) fn mesh(&self) -> Result<Mesh, Refused> {
        // What is too large for this machine's addresses is too many cells.
        let [rows, disc_columns, pin_columns] = self.counts.map(|count| usize::try_from(count).unwrap_or(usize::MAX));
        let mesh = Mesh::new(rows, disc_columns, pin_columns, self.radii[0], self.radii[1]);
        mesh.and_then(|mesh| mesh.with_outline(self.outline)).map_err(|error| {
            let (key, message) = match error {
                MeshError::PinWiderThanRing { .. } => ("pin_columns", error.to_string()),
                MeshError::Radii { .. } => ("outer_radius", error.to_string()),
                MeshError::Empty { name } | MeshError::TooMany { name, .. } => (name, error.to_string()),
                MeshError::RoundPinWiderThanTrack { diameter, track } => {
                    let [diameter, track] = [diameter, track].map(Length);
                    ("pin_diameter", format!("{diameter} are more than the width of the track: expected at most {track}"))
                }
                MeshError::RoundPinLongerThanColumns { diameter, pin_columns, radius } => {
                    let [diameter, radius] = [diameter, radius].map(Length);
                    let message = format!(
                        "a round pin of {diameter} goes beyond its {pin_columns} columns at the radius {radius}: a smaller \
                         pin_diameter or more pin_columns help"
                    );
                    ("pin_diameter", message)
                }
                MeshError::RoundPinWithoutCells { diameter } => {
                    let diameter = Length(diameter);
                    let message = format!(
                        "no cell has its centre in a circle of {diameter} about the middle of the track: a larger pin or \
                         smaller cells help"
                    );
                    ("pin_diameter", message)
                }
            };
            Refused::new(key, message)
        })
    }
}

/// The nearest whole number that is a count of cells.
fn whole(number: f64) -> f64 {
    number.round().max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lengths(shape: Shape, [width, length, cell, mean]: [f64; 4]) -> Result<Mesh, Refused> {
        let pin_length = (length > 0.0).then_some(length);
        let size = Size::Lengths { pin_width: width, pin_length, cell_size: cell, mean_radius: mean };
        Geometry { size, shape }.cells()?.mesh()
    }

    #[test]
    fn the_ring_of_the_paper_in_millimetres_is_that_in_rows_and_columns() {
        // Table 2: 50 µm, 4 by 8 mm, 20 to 24 mm. By hand: 2π · 22 mm/50 µm = 2764.6, so 2765 columns of 49.99 µm, of which
        // 8 mm take 160.02.
        let mesh = lengths(Shape::Rectangle, [4e-3, 8e-3, 50e-6, 22e-3]).unwrap();
        assert_eq!(mesh, Mesh::new(80, 2765, 160, 20e-3, 24e-3).unwrap());
        // Half a cell more or less does not change the width of the pin.
        let mesh = lengths(Shape::Rectangle, [4.02e-3, 8e-3, 50e-6, 22e-3]).unwrap();
        assert_eq!(mesh.rows(), 80);
        assert!((mesh.row_height() * 80.0 - 4.02e-3).abs() < 1e-17);
    }

    #[test]
    fn a_round_pin_has_the_columns_of_its_longest_arc() {
        let mesh = lengths(Shape::Disc, [10e-3, 0.0, 50e-6, 22e-3]).unwrap();
        // The longest arc by hand: R/√(r̄² − R²) on either side, 0.233 39 rad; in columns of 2π/2765: 205.4.
        assert_eq!([mesh.rows(), mesh.disc_columns(), mesh.pin_columns()], [200, 2765, 205]);
        assert_eq!(mesh.outline(), Outline::Disc { radius: 5e-3 });
        assert!((mesh.pin_area() / 78.54e-6 - 1.0).abs() < 1e-3);
    }

    #[test]
    fn what_does_not_fit_is_refused_in_the_words_of_its_keys() {
        let key = |shape, numbers| lengths(shape, numbers).unwrap_err().key;
        assert_eq!(key(Shape::Rectangle, [44e-3, 8e-3, 50e-6, 22e-3]), "pin_width");
        assert_eq!(key(Shape::Rectangle, [4e-3, 0.2, 50e-6, 22e-3]), "pin_length");
        assert_eq!(key(Shape::Rectangle, [4e-3, 0.0, 50e-6, 22e-3]), "pin_width");
        // Its arc at the inner radius goes round.
        assert_eq!(key(Shape::Disc, [43.9e-3, 0.0, 50e-6, 22e-3]), "pin_width");
        let size = Size::Cells {
            inner: 20e-3,
            outer: 24e-3,
            rows: 80,
            disc_columns: 2764,
            pin_columns: 161,
            pin_diameter: None,
        };
        assert_eq!(Geometry { size, shape: Shape::Disc }.cells().unwrap_err().key, "shape");
        let round = |pin_diameter: f64| {
            let Size::Cells { inner, outer, rows, disc_columns, pin_columns, .. } = size else { unreachable!() };
            let size = Size::Cells { inner, outer, rows, disc_columns, pin_columns, pin_diameter: Some(pin_diameter) };
            Geometry { size, shape: Shape::Disc }.cells().unwrap().mesh()
        };
        assert!(round(4e-3).is_ok());
        assert!(round(4.1e-3).unwrap_err().message.contains("expected at most 4 mm"));
        assert_eq!(round(1e-6).unwrap_err().key, "pin_diameter");
    }
}
