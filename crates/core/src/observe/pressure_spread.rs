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

#[cfg(test)]
mod tests {
    use super::*;

    /// One row, so that all cells have the same area.
    fn of_one_row(pressures: &[f64]) -> [f64; 2] {
        let mesh = Mesh::new(1, 100, pressures.len(), 20e-3, 24e-3).unwrap();
        spread(&mesh, pressures)
    }

    #[test]
    fn equal_pressures_have_no_spread() {
        let equal = of_one_row(&[3.0, 0.0, 3.0, 3.0]);
        assert!(equal.iter().all(|spread| spread.abs() < 1e-15), "{equal:?}");
        assert!(of_one_row(&[0.0, 0.0])[1].is_nan());
    }

    #[test]
    fn spreads_of_closed_form() {
        // 1 to n: variance (n² − 1)/12, mean (n + 1)/2, Gini (n² − 1)/(3 n (n + 1)) = (n − 1)/(3 n).
        let ramp: Vec<f64> = (1..=50).rev().map(f64::from).collect();
        let [variation, gini] = of_one_row(&ramp);
        assert!((variation - (2499.0_f64 / 12.0).sqrt() / 25.5).abs() < 1e-14);
        assert!((gini - 49.0 / 150.0).abs() < 1e-14);
    }

    #[test]
    fn cells_count_with_their_area() {
        // Two rows of areas in the ratio 21 : 23, pressures 1 and 2. By hand: mean 67/44, variance 21·23/44², and for two
        // parts the Gini coefficient is the smaller part of the area less its part of the force, 21/44 − 21/67.
        let mesh = Mesh::new(2, 100, 1, 20e-3, 24e-3).unwrap();
        let [variation, gini] = spread(&mesh, &[1.0, 2.0]);
        assert!((variation - (21.0_f64 * 23.0).sqrt() / 67.0).abs() < 1e-14);
        assert!((gini - (21.0 / 44.0 - 21.0 / 67.0)).abs() < 1e-14);
    }
}
