//! Temperature of every cell of the contact (model 11, contact temperature map).

use super::passing::Passing;
use crate::model::mesh::Mesh;

/// T_ij of every pin cell, K, column by column: T_ij = T_f + Σ_{l ≤ j} q_il w_{j−l} with w_l = U((l+1) Δt) − U(l Δt).
///
/// `pressure` (Pa) is that of the step, `flux_per_pressure` is χ μ ω r̄ (m/s), `face` T_f (K), `speed` ω (rad/s). The pressures
/// count as frozen while a cell passes, and nothing is conducted along the surface.
pub fn temperatures(
    passing: &Passing,
    mesh: &Mesh,
    pressure: &[f64],
    flux_per_pressure: f64,
    face: f64,
    speed: f64,
) -> Vec<f64> {
    let mut temperature = vec![face; pressure.len()];
    if flux_per_pressure == 0.0 || !face.is_finite() {
        return temperature;
    }
    let (columns, rows) = (mesh.pin_columns(), mesh.rows());
    let response: Vec<f64> =
        (0..=columns).map(|column| passing.response(column as f64 * (mesh.column_angle() / speed))).collect();
    let weights: Vec<f64> = response.windows(2).map(|pair| pair[1] - pair[0]).collect();
    for from in 0..columns {
        let pressure = &pressure[mesh.column(from)];
        if pressure.iter().all(|pressure| *pressure == 0.0) {
            continue;
        }
        for to in from..columns {
            let weight = flux_per_pressure * weights[to - from];
            let cells = &mut temperature[to * rows..(to + 1) * rows];
            cells.iter_mut().zip(pressure).for_each(|(cell, pressure)| *cell += weight * pressure);
        }
    }
    temperature
}
