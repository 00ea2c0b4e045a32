//! Warming of a disc cell while it passes under the pin: a half-space under a flux that starts when the cell enters (Carslaw and Jaeger);
//! with a coating the series of what its surface sees of every passage through it; and so the temperature of every cell of the contact
//! (model 11, passing under the pin, contact temperature map).

use std::f64::consts::PI;

use crate::model::mesh::Mesh;
use crate::model::thermal::{Coating, Disc, Substance};

/// Response of the surface of the disc to a flux.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passing {
    substrate: Substance,
    coating: Option<Coating>,
}

impl Passing {
    /// Response of a disc.
    pub fn of(disc: &Disc) -> Self {
        let coating = disc.coating.filter(|coating| coating.thickness > 0.0);
        Self { substrate: disc.substance, coating }
    }

    /// U(t), K m²/W: how much warmer the surface is after a time (s) under a unit flux.
    ///
    /// U = 2 √(t/π)/b; with a coating (c) on the substrate (s) U = (2 √t/b_c) [1/√π + 2 Σ Γᵏ ierfc(k d/√(a_c t))] with
    /// Γ = (b_c − b_s)/(b_c + b_s).
    pub fn response(&self, time: f64) -> f64 {
        if time == 0.0 {
            return 0.0;
        }
        let substrate = self.substrate.effusivity();
        let Some(Coating { thickness, substance }) = &self.coating else {
            return 2.0 * (time / PI).sqrt() / substrate;
        };
        let depth = thickness / (substance.diffusivity() * time).sqrt();
        2.0 * time.sqrt() / substance.effusivity() * reflections(substance.effusivity(), substrate, depth)
    }

    /// R_v, K/W: mean rise under the pin per power, where the disc moves on by one of so many columns in `column_time`
    /// (s) and the pin has this area (m²).
    pub fn moving_resistance(&self, columns: usize, column_time: f64, area: f64) -> f64 {
        let sum: f64 = (1..=columns).map(|column| self.response(column as f64 * column_time)).sum();
        sum / columns as f64 / area
    }

    /// R_v, K/W, under a pin that is no rectangle: `areas` (m²) are those of its cells that are the first, second, … of their
    /// row, counted from where the disc enters.
    pub fn moving_resistance_of_chords(&self, areas: &[f64], column_time: f64) -> f64 {
        let cells = areas.iter().zip(1..);
        let sum: f64 = cells.map(|(area, column)| area * self.response(f64::from(column) * column_time)).sum();
        let area: f64 = areas.iter().sum();
        sum / area / area
    }

    /// R, K/W, at a rotational speed (rad/s): 1/R² = 1/R_v² + 1/R₀² with R₀ = 0.479/(λ_d √ΣA) at rest.
    pub fn resistance(&self, columns: usize, column_angle: f64, area: f64, speed: f64) -> f64 {
        self.of_both(area, speed, || self.moving_resistance(columns, column_angle / speed, area))
    }

    /// R, K/W, under a pin that is no rectangle, see [`Passing::moving_resistance_of_chords`].
    pub fn resistance_of_chords(&self, areas: &[f64], column_angle: f64, speed: f64) -> f64 {
        self.of_both(areas.iter().sum(), speed, || self.moving_resistance_of_chords(areas, column_angle / speed))
    }

    /// R, K/W, of a pin of this area (m²) from R_v, if it moves.
    fn of_both(&self, area: f64, speed: f64, moving: impl Fn() -> f64) -> f64 {
        let at_rest = 0.479 / (self.substrate.conductivity * area.sqrt());
        if speed == 0.0 {
            return at_rest;
        }
        let moving = moving();
        if !moving.is_finite() {
            return at_rest;
        }
        // The same as in the text, without squares that leave the range of numbers.
        let ratio = moving / at_rest;
        moving / ratio.hypot(1.0)
    }
}

/// Terms up to which the series is added up one by one.
const MOST_TERMS: f64 = 1000.0;
/// Intervals of the trapezoidal rule for longer ones.
const INTERVALS: u32 = 1000;

/// 1/√π + 2 Σ_{k ≥ 1} Γᵏ ierfc(k ε), Γ = (b_c − b_s)/(b_c + b_s), with the effusivities of coating and substrate and
/// the depth ε = d/√(a_c t) of the coating.
fn reflections(coating: f64, substrate: f64, depth: f64) -> f64 {
    let reflection = (coating - substrate) / (coating + substrate);
    // λ = −ln |Γ| without the rounding of Γ near 1.
    let decay = 2.0 * libm::atanh((substrate / coating).min(coating / substrate));
    // Beyond, e^(−λk) or ierfc is below 1e-16.
    let terms = (37.0 / decay).min(6.0 / depth);
    if terms > MOST_TERMS {
        return if reflection > 0.0 { of_one_sign(decay, depth, terms) } else { alternating(decay, depth) };
    }
    let (mut sum, mut power) = (1.0 / PI.sqrt(), 1.0);
    let mut number = 0.0;
    loop {
        number += 1.0;
        power *= reflection;
        let term = 2.0 * power * ierfc(number * depth);
        sum += term;
        if term.abs() < 1e-16 * sum || number > 2.0 * MOST_TERMS {
            return sum;
        }
    }
}

/// The sum for Γ > 0 by the formula of Euler and Maclaurin, once with the terms and once with the trapezoidal rule for
/// the integral that both have in common.
fn of_one_sign(decay: f64, depth: f64, terms: f64) -> f64 {
    let width = terms / f64::from(INTERVALS);
    let term = |number: f64| libm::exp(-decay * number) * ierfc(number * depth);
    let [first, third, fifth] = derivatives(decay, depth);
    let inner: f64 = (1..=INTERVALS).map(|interval| term(f64::from(interval) * width)).sum();
    let start = 1.0 / PI.sqrt();
    let square = width * width;
    let sum = width * (start / 2.0 + inner) - start / 2.0 + (square - 1.0) * first / 12.0
        - (square * square - 1.0) * third / 720.0
        + (square * square * square - 1.0) * fifth / 30240.0;
    start + 2.0 * sum
}

/// The sum for Γ < 0 by the formula of Boole, of which 1/√π leaves only the derivatives.
fn alternating(decay: f64, depth: f64) -> f64 {
    let [first, third, fifth] = derivatives(decay, depth);
    -first / 2.0 + third / 24.0 - fifth / 240.0
}

/// First, third and fifth derivative of e^(−λk) ierfc(k ε) by k at k = 0.
fn derivatives(decay: f64, depth: f64) -> [f64; 3] {
    let root = PI.sqrt();
    // ierfc(x) = 1/√π − x + x²/√π − x⁴/(6 √π) + …
    let (square, fourth) = (depth * depth / root, -depth.powi(4) / (6.0 * root));
    let first = -decay / root - depth;
    let third = -decay.powi(3) / 6.0 / root - decay.powi(2) / 2.0 * depth - decay * square;
    let fifth =
        -decay.powi(5) / 120.0 / root - decay.powi(4) / 24.0 * depth - decay.powi(3) / 6.0 * square - decay * fourth;
    [first, 6.0 * third, 120.0 * fifth]
}

/// ierfc(x) = exp(−x²)/√π − x erfc(x).
fn ierfc(x: f64) -> f64 {
    (libm::exp(-x * x) / PI.sqrt() - x * libm::erfc(x)).max(0.0)
}

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

#[cfg(test)]
#[path = "../../../tests/unit/model/heat/passing.rs"]
mod tests;
