//! How unevenly the load lies on the cells in contact.

use super::extra::{Extra, Request};
use super::map::Map;
use super::quantity::Quantity;
use crate::model::mesh::Mesh;

/// The spread of the pressures with every sample.
pub const EXTRA: Extra = Extra {
    name: "pressure_spread",
    quantities: &[
        Quantity::extra(
            "pressure_variation",
            "1",
            "coefficient of variation of the pressure over the cells in contact",
        ),
        Quantity::extra("pressure_gini", "1", "Gini coefficient of the pressure over the cells in contact"),
    ],
    request: Some(Request {
        what: "spread of the pressure",
        meaning: "whether the coefficient of variation and the Gini coefficient of the pressure are written with every sample",
        maps: &[Map::Pressure],
        measure: |parameters, pressures| spread(&parameters.mesh, &pressures[0]).to_vec(),
    }),
    needs: "",
};

/// Coefficient of variation and Gini coefficient of the pressures (Pa) of the cells in contact, each counted with its area; of no
/// cell NaN. A cell that is not in contact has the pressure 0.
///
/// The first is the standard deviation over the mean, 0 where all pressures are equal. The second is the mean difference of the
/// pressures of two pieces of the contact area over twice the mean pressure: 0 where all are equal, nearly 1 where a small
/// part carries nearly all.
fn spread(mesh: &Mesh, pressures: &[f64]) -> [f64; 2] {
    let cells = pressures.iter().zip(mesh.area().iter().cycle());
    let mut touching: Vec<(f64, f64)> =
        cells.filter(|(pressure, _)| **pressure > 0.0).map(|(pressure, area)| (*pressure, *area)).collect();
    touching.sort_by(|one, other| one.0.total_cmp(&other.0));
    let sum = |term: &dyn Fn(f64) -> f64| touching.iter().map(|(pressure, area)| term(*pressure) * area).sum::<f64>();
    let (area, force) = (sum(&|_| 1.0), sum(&|pressure| pressure));
    let mean = force / area;
    let variance = sum(&|pressure| (pressure - mean) * (pressure - mean)) / area;
    // The area below the Lorenz curve: force of all that is pressed less, against area.
    let (mut carried, mut below) = (0.0, 0.0);
    for (pressure, cell) in &touching {
        let own = pressure * cell;
        below += (carried + 0.5 * own) * cell;
        carried += own;
    }
    [variance.sqrt() / mean, 1.0 - 2.0 * below / (area * force)]
}
