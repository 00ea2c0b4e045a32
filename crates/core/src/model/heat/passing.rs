//! Warming of a disc cell while it passes under the pin: a half-space under a flux that starts when the cell enters
//! (model 11; Carslaw and Jaeger).

use std::f64::consts::PI;

use super::{Coating, Disc, Substance, reflections};

/// How the surface of the disc answers a flux.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passing {
    substrate: Substance,
    coating: Option<Coating>,
}

impl Passing {
    /// The answer of a disc.
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
        2.0 * time.sqrt() / substance.effusivity() * reflections::sum(substance.effusivity(), substrate, depth)
    }

    /// R_v, K/W: mean rise under the pin per power, where the disc moves on by one of so many columns in `column_time`
    /// (s) and the pin has this area (m²).
    pub fn moving_resistance(&self, columns: usize, column_time: f64, area: f64) -> f64 {
        let sum: f64 = (1..=columns).map(|column| self.response(column as f64 * column_time)).sum();
        sum / columns as f64 / area
    }

    /// The same under a pin that is no rectangle: `areas` (m²) are those of its cells that are the first, second, … of their
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

    /// The same under a pin that is no rectangle, see [`Passing::moving_resistance_of_chords`].
    pub fn resistance_of_chords(&self, areas: &[f64], column_angle: f64, speed: f64) -> f64 {
        self.of_both(areas.iter().sum(), speed, || self.moving_resistance_of_chords(areas, column_angle / speed))
    }

    /// R of a pin of this area (m²) from R_v, if it moves.
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

#[cfg(test)]
mod tests {
    use super::*;

    const IRON: Substance = Substance { conductivity: 50.0, density: 7200.0, specific_heat: 500.0 };
    const CERMET: Substance = Substance { conductivity: 15.0, density: 13500.0, specific_heat: 250.0 };

    fn coated(thickness: f64) -> Passing {
        Passing { substrate: IRON, coating: Some(Coating { thickness, substance: CERMET }) }
    }

    const BARE: Passing = Passing { substrate: IRON, coating: None };

    #[test]
    fn short_times_see_the_coating_alone_and_long_ones_the_substrate_behind_it() {
        let (thick, thin) = (coated(60e-6), coated(60e-6));
        let coating = Passing { substrate: CERMET, coating: None };
        // Model section 12: U → 2 √(t/π)/b_c for short times.
        for time in [1e-9, 1e-7, 1e-5] {
            assert!((thick.response(time) / coating.response(time) - 1.0).abs() < 1e-14, "{time}");
        }
        // And 2 √(t/π)/b_s + (d/λ_c)(1 − b_c²/b_s²) for long ones; the next term falls as 1/√t.
        let ratio = CERMET.effusivity() / IRON.effusivity();
        for time in [1e2, 1e4, 1e6] {
            let limit = BARE.response(time) + 60e-6 / 15.0 * (1.0 - ratio * ratio);
            assert!((thin.response(time) / limit - 1.0).abs() < 1e-4 / time.sqrt(), "{time}");
        }
    }

    #[test]
    fn a_coating_of_the_same_substance_is_none_whatever_its_thickness() {
        for thickness in [1e-9, 60e-6, 1.0] {
            let same = Passing { substrate: IRON, coating: Some(Coating { thickness, substance: IRON }) };
            assert_eq!(same.response(1e-3), BARE.response(1e-3));
        }
    }

    #[test]
    fn a_coating_of_a_nanometre_is_as_none() {
        // (d/λ_c)(1 − b_c²/b_s²) is what it adds, by the limit for long times.
        let added = coated(1e-9).response(1e-3) - BARE.response(1e-3);
        assert!(added.abs() < 1e-9 / 15.0);
        assert_eq!(coated(1.0).response(1.0), Passing { substrate: CERMET, coating: None }.response(1.0));
    }

    #[test]
    fn the_mean_under_the_pin_is_two_thirds_of_the_trailing_edge() {
        // Jaeger's band at high Péclet number; the sum over columns comes to the integral as 1/columns.
        let mean = BARE.moving_resistance(100_000, 1e-8, 1.0);
        assert!((mean / (2.0 / 3.0 * BARE.response(1e-3)) - 1.0).abs() < 1e-5);
    }

    #[test]
    fn chords_of_different_lengths_take_part_with_their_areas() {
        // By hand: rows of 3 m² and 5 m² a cell, with one and three columns. Of the four cells, the first of both rows are
        // under the pin for one column time, and so on.
        let rises = [1.0, 2.0, 3.0].map(|time| coated(60e-6).response(time * 1e-4));
        let expected = (8.0 * rises[0] + 5.0 * rises[1] + 5.0 * rises[2]) / 18.0 / 18.0;
        let found = coated(60e-6).moving_resistance_of_chords(&[8.0, 5.0, 5.0], 1e-4);
        assert!((found / expected - 1.0).abs() < 1e-14);
        // Rows of equal chords are a rectangle.
        let rectangle = coated(60e-6).resistance(20, 2e-3, 4e-5, 90.0);
        let same = coated(60e-6).resistance_of_chords(&[2e-6; 20], 2e-3, 90.0);
        assert!((same / rectangle - 1.0).abs() < 1e-14);
    }

    #[test]
    fn the_resistance_goes_from_rest_to_fast() {
        let resistance = |speed| coated(60e-6).resistance(161, 2.27e-3, 3.2e-5, speed);
        let at_rest = 0.479 / (50.0 * 3.2e-5_f64.sqrt());
        assert_eq!(resistance(0.0), at_rest);
        assert!((resistance(1e-9) / at_rest - 1.0).abs() < 1e-3);
        assert!((resistance(1e12) / coated(60e-6).moving_resistance(161, 2.27e-15, 3.2e-5) - 1.0).abs() < 1e-6);
        let by_speed = [0.0, 1e-300, 1e-6, 1.0, 89.0, 1e6, 1e300].map(resistance);
        assert!(by_speed.is_sorted_by(|slower, faster| slower >= faster) && by_speed[6] > 0.0);
    }
}
