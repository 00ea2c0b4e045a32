//! The mesh of a scene: in rows, columns and radii, or in lengths; the pin a rectangle or round.

use std::f64::consts::TAU;

use plateau_core::model::mesh::{Mesh, MeshError, Outline, columns_of_disc};
use plateau_core::surface::Length;

use super::schema::choices::Shape;
use crate::number;

/// Reason why it is no mesh: the name of the key in `[mesh]` and a message.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Refused {
    pub(crate) key: &'static str,
    pub(crate) message: String,
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

impl Cells {
    /// Reads them with functions that give a length (m) and a count by the name of the key, `None` where it is not given: in one of the two
    /// ways of saying it, see [`super::schema::WAYS`].
    pub(crate) fn read<E>(
        shape: Shape,
        length: impl Fn(&'static str) -> Result<Option<f64>, E>,
        count: impl Fn(&'static str) -> Result<Option<u64>, E>,
        missing: impl Fn(&'static str) -> E,
        refused: impl Fn(Refused) -> E,
    ) -> Result<Self, E> {
        let needed = |name| length(name)?.ok_or_else(|| missing(name));
        if let Some(cell_size) = length("cell_size")? {
            let (pin_width, pin_length) = (needed("pin_width")?, length("pin_length")?);
            return Self::divided(shape, pin_width, pin_length, cell_size, needed("mean_radius")?).map_err(refused);
        }
        let counted = |name| count(name)?.ok_or_else(|| missing(name));
        let counts = [counted("rows")?, counted("disc_columns")?, counted("pin_columns")?];
        let radii = [needed("inner_radius")?, needed("outer_radius")?];
        let outline = outline(shape, length("pin_diameter")?).map_err(refused)?;
        Ok(Self { counts, radii, outline })
    }

    /// Rows, ring and pin in cells of this size: the width is met exactly, the ring to half a column, the pin too.
    fn divided(
        shape: Shape,
        pin_width: f64,
        pin_length: Option<f64>,
        cell_size: f64,
        mean_radius: f64,
    ) -> Result<Self, Refused> {
        if pin_width >= 2.0 * mean_radius {
            let message = format!(
                "a pin of {} does not fit a ring of the mean radius {}, whose inner radius would not be above 0: expected \
                 less than {}",
                Length(pin_width),
                Length(mean_radius),
                Length(2.0 * mean_radius)
            );
            return Err(Refused { key: "pin_width", message });
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
            Err(Refused { key, message })
        };
        let (pin_columns, outline) = match (shape, pin_length) {
            (Shape::Rectangle, Some(length)) if length > circumference => {
                return too_long("pin_length", format!("a pin of {}", Length(length)));
            }
            (Shape::Rectangle, Some(length)) => {
                (whole(length / (mean_radius * column_angle)).min(disc_columns), Outline::Rectangle)
            }
            (Shape::Rectangle, None) => {
                let message = "a rectangle needs its pin_length, too".to_owned();
                return Err(Refused { key: "pin_width", message });
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
        let radii =
            [mean_radius - 0.5 * pin_width, mean_radius + 0.5 * pin_width].map(|radius| number::to_digits(radius, 15));
        let counts = [whole(pin_width / cell_size), disc_columns, pin_columns];
        // Casts saturate: what is too large for memory is refused as such.
        Ok(Self { counts: counts.map(|count| count as u64), radii, outline })
    }

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
            Refused { key, message }
        })
    }
}

/// The outline where the mesh is given in rows and columns.
fn outline(shape: Shape, pin_diameter: Option<f64>) -> Result<Outline, Refused> {
    let (key, message) = match (shape, pin_diameter) {
        (Shape::Rectangle, None) => return Ok(Outline::Rectangle),
        (Shape::Disc, Some(diameter)) => return Ok(Outline::Disc { radius: 0.5 * diameter }),
        (Shape::Rectangle, Some(_)) => (
            "pin_diameter",
            "this key has a meaning only beside shape = \"disc\", which is not given; a rectangle has pin_columns and all rows",
        ),
        (Shape::Disc, None) => (
            "shape",
            "rows and columns do not say how large a round pin is: give pin_diameter, or the mesh by pin_width, cell_size \
             and mean_radius",
        ),
    };
    Err(Refused { key, message: message.to_owned() })
}

/// The nearest whole number that is a count of cells.
fn whole(number: f64) -> f64 {
    number.round().max(1.0)
}

#[cfg(test)]
#[path = "../../tests/unit/scene/mesh.rs"]
mod tests;
