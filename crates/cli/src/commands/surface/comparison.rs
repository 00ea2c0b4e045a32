//! A surface beside the patch from which it was made.

use plateau_core::surface::Patch;
use plateau_core::surface::describe::{Description, Grid, PARAMETERS, Parameter, sampling_errors};
use serde::ser::{Serialize, SerializeMap as _, Serializer};

use super::document::scale;
use crate::number;

/// The parameters that are compared.
const COMPARED: [&str; 8] = ["Sa", "Sq", "Ssk", "Sku", "Sk", "Sdq", "Sal", "Str"];

/// Parameters of a patch in cells of the mesh, and of what was made of it; with the scatter of cut-outs of the patch's size out of
/// that.
#[derive(Debug)]
pub struct Comparison {
    /// Cells of the patch along and across sliding.
    cells: [usize; 2],
    lines: Vec<Line>,
}

/// A parameter, in SI units.
#[derive(Debug)]
struct Line {
    parameter: &'static Parameter,
    patch: f64,
    error: f64,
    made: f64,
}

impl Comparison {
    /// Of a patch in cells with a surface; none where the patch has no whole cell.
    pub fn of(patch: &Patch, made: &Description, surface: &Grid) -> Option<Self> {
        let description = Description::of(&Grid::of(patch))?;
        let errors = sampling_errors(surface, [patch.columns, patch.rows]);
        let line = |(parameter, error): (&'static Parameter, f64)| {
            let patch = (parameter.value)(&description)?;
            let made = (parameter.value)(made)?;
            Some(Line { parameter, patch, error, made })
        };
        let lines = PARAMETERS.iter().zip(errors).filter(|(parameter, _)| COMPARED.contains(&parameter.symbol));
        Some(Self { cells: [patch.columns, patch.rows], lines: lines.filter_map(line).collect() })
    }

    /// A table for people.
    pub fn text(&self) -> String {
        let [columns, rows] = self.cells;
        let mut text =
            format!("  against its patch in {columns} x {rows} cells (± what cut-outs of that size scatter):\n");
        for Line { parameter, patch, error, made } in &self.lines {
            let (unit, factor) = scale(parameter);
            let show = |value: f64, digits| {
                if value.is_nan() { "-".to_owned() } else { number::significant(value * factor, digits) }
            };
            text.push_str(&format!(
                "    {:4} {unit:3}  {:>10} ± {:<8}  {:>10}  {:>+8.1} %\n",
                parameter.symbol,
                show(*patch, 4),
                show(*error, 2),
                show(*made, 4),
                100.0 * (made / patch - 1.0),
            ));
        }
        text
    }
}

impl Serialize for Comparison {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("cells", &self.cells)?;
        for Line { parameter, patch, error, .. } in &self.lines {
            let (_, factor) = scale(parameter);
            map.serialize_entry(parameter.symbol, &(patch * factor))?;
            map.serialize_entry(&format!("{}_error", parameter.symbol), &(error * factor))?;
        }
        map.end()
    }
}
