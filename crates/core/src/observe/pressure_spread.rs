//! How unevenly the load lies on the cells in contact.

use serde::{Deserialize, Serialize};

use crate::model::mesh::Mesh;

/// Spread of the pressures of the cells in contact, each counted with its area; of no cell NaN.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PressureSpread {
    /// Coefficient of variation: the standard deviation over the mean; 0 where all pressures are equal.
    pub variation: f64,
    /// Gini coefficient: the mean difference of the pressures of two pieces of the contact area over twice the mean pressure; 0
    /// where all are equal, nearly 1 where a small part carries nearly all.
    pub gini: f64,
}

impl PressureSpread {
    /// Of the pressures of every cell of the pin, Pa, column by column, 0 where there is no contact.
    pub fn of(mesh: &Mesh, pressures: &[f64]) -> Self {
        let cells = pressures.iter().zip(mesh.area().iter().cycle());
        let mut touching: Vec<(f64, f64)> =
            cells.filter(|(pressure, _)| **pressure > 0.0).map(|(pressure, area)| (*pressure, *area)).collect();
        touching.sort_by(|one, other| one.0.total_cmp(&other.0));
        let sum =
            |term: &dyn Fn(f64) -> f64| touching.iter().map(|(pressure, area)| term(*pressure) * area).sum::<f64>();
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
        Self { variation: variance.sqrt() / mean, gini: 1.0 - 2.0 * below / (area * force) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One row, so that all cells have the same area.
    fn spread(pressures: &[f64]) -> PressureSpread {
        let mesh = Mesh::new(1, 100, pressures.len(), 20e-3, 24e-3).unwrap();
        PressureSpread::of(&mesh, pressures)
    }

    #[test]
    fn equal_pressures_have_no_spread() {
        let equal = spread(&[3.0, 0.0, 3.0, 3.0]);
        assert!(equal.variation.abs() < 1e-15 && equal.gini.abs() < 1e-15, "{equal:?}");
        assert!(spread(&[0.0, 0.0]).gini.is_nan());
    }

    #[test]
    fn spreads_of_closed_form() {
        // 1 to n: variance (n² − 1)/12, mean (n + 1)/2, Gini (n² − 1)/(3 n (n + 1)) = (n − 1)/(3 n).
        let ramp: Vec<f64> = (1..=50).rev().map(f64::from).collect();
        let found = spread(&ramp);
        assert!((found.variation - (2499.0_f64 / 12.0).sqrt() / 25.5).abs() < 1e-14);
        assert!((found.gini - 49.0 / 150.0).abs() < 1e-14);
    }

    #[test]
    fn cells_count_with_their_area() {
        // Two rows of areas in the ratio 21 : 23, pressures 1 and 2. By hand: mean 67/44, variance 21·23/44², and for two
        // parts the Gini coefficient is the smaller part of the area less its part of the force, 21/44 − 21/67.
        let mesh = Mesh::new(2, 100, 1, 20e-3, 24e-3).unwrap();
        let found = PressureSpread::of(&mesh, &[1.0, 2.0]);
        assert!((found.variation - (21.0_f64 * 23.0).sqrt() / 67.0).abs() < 1e-14);
        assert!((found.gini - (21.0 / 44.0 - 21.0 / 67.0)).abs() < 1e-14);
    }
}
