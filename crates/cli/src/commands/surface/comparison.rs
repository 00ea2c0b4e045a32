//! What a scene makes of a patch beside the patch itself.

use std::f64::consts::{FRAC_PI_2, PI};

use plateau_core::model::mesh::Mesh;
use plateau_core::surface::describe::{Description, Grid, PARAMETERS, Parameter, Unit, sampling_errors};
use plateau_core::surface::{Body, Level, Patch, level};

use super::describe::describe;
use super::figure_data::FigureData;
use crate::failure::Failure;

/// A prepared patch, described at its own pitch and averaged over cells of the mesh, as the heights of the body are.
pub struct Comparison {
    /// Parameters of the patch.
    pub patch: Description,
    /// Those of its averages over cells; none if no cell lies in it.
    pub cells: Option<Cells>,
}

/// A patch averaged over cells.
pub struct Cells {
    /// Columns and rows.
    pub counts: [usize; 2],
    /// Size of a cell, m.
    pub size: [f64; 2],
    /// Parameters.
    pub description: Description,
    /// Standard error of each, in the order of the parameters.
    pub errors: Vec<f64>,
}

impl Comparison {
    /// Describes the patch of a body, peaks positive; none if it has no heights.
    ///
    /// # Errors
    /// [`Failure`] where that needs more memory than there is.
    pub fn of(
        body: Body,
        name: &str,
        mut patch: Patch,
        mesh: &Mesh,
        form: Level,
        figures: Option<&mut FigureData>,
    ) -> Result<Option<Self>, Failure> {
        body.turn(&mut patch.heights);
        level(&mut patch.heights, patch.rows, form, false);
        let grid = Grid::of(&patch);
        let Some(description) = describe(name, &grid)? else { return Ok(None) };
        if let Some(figures) = figures {
            figures.add(&format!("{name} patch"), Some(body), &grid, &description)?;
        }
        // There are fewer of them than points of the patch.
        let cells = patch.cell_averages(mesh).and_then(|cells| {
            let grid = Grid::of(&cells);
            Some(Cells {
                counts: [cells.columns, cells.rows],
                size: [cells.column_pitch, cells.row_pitch],
                description: Description::of(&grid)?,
                errors: sampling_errors(&grid),
            })
        });
        Ok(Some(Self { patch: description, cells }))
    }

    /// The values of every parameter, SI units, NaN where there is none.
    pub fn rows<'a>(&'a self, body: &'a Description) -> impl Iterator<Item = Row> + 'a {
        PARAMETERS.iter().enumerate().map(move |(place, parameter)| {
            let value = |description: &Description| (parameter.value)(description).unwrap_or(f64::NAN);
            let cells = self.cells.as_ref().map_or(f64::NAN, |cells| value(&cells.description));
            let error = self.cells.as_ref().and_then(|cells| cells.errors.get(place)).copied().unwrap_or(f64::NAN);
            let body = value(body);
            let mut difference = body - cells;
            if parameter.unit == Unit::Angle && difference.abs() > FRAC_PI_2 {
                // A direction and its opposite are the same.
                difference -= PI.copysign(difference);
            }
            Row { parameter, patch: value(&self.patch), cells, error, body, difference }
        })
    }
}

/// A parameter of a patch and of what was made of it.
pub struct Row {
    /// Which.
    pub parameter: &'static Parameter,
    /// Of the patch as it was measured and prepared.
    pub patch: f64,
    /// Of its averages over cells.
    pub cells: f64,
    /// Standard error of that: what it varies by from one such patch to another.
    pub error: f64,
    /// Of disc or pin.
    pub body: f64,
    /// Of disc or pin less that of the averages.
    pub difference: f64,
}
