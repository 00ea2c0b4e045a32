//! How long the contact area takes to rise and fall once.

use crate::model::parameters::Parameters;
use crate::model::state::Base;
use crate::surface::fibre_fraction;

/// Time of one pulse of the contact area at constant load and speed, s, at least: T = h_m φ A/(κ F_N v). Resin that touches loses its
/// wear height h_m at once (model 4.2), and touches again when the fibres, of area φ A and specific wear rate κ, have worn as far.
/// Build-up beside the fibres has to wear as well, and makes it longer. `base` is that of the pin's cells.
///
/// None where load or speed change with time, where there is no resin, or nothing wears.
pub fn pulse_time(parameters: &Parameters, base: &[Base]) -> Option<f64> {
    if parameters.cycle.is_some() || !base.contains(&Base::Resin) {
        return None;
    }
    let (materials, mesh) = (&parameters.materials, &parameters.mesh);
    let fibre_area = fibre_fraction(base, mesh) * mesh.pin_area();
    let sliding_speed = parameters.angular_velocity * mesh.mean_radius();
    let worn_per_second = materials.pin_primary.specific_wear_rate * parameters.usual_load() * sliding_speed;
    let time = materials.wear_height * fibre_area / worn_per_second;
    (time > 0.0 && time.is_finite()).then_some(time)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::material::Materials;

    #[test]
    fn a_pulse_of_the_papers_pin_is_what_its_fibres_need_to_wear_as_far() {
        let parameters = Parameters::paper();
        let mesh = &parameters.mesh;
        // Whole columns of fibre: their area is that part of the pin's. By hand: 46 of 161 columns of 32.2 mm², 5 µm deep, are
        // worn at 5e-14 1/Pa · 47 N · 22 mm · 89.0 rad/s.
        let base: Vec<Base> = (0..mesh.pin_cells())
            .map(|cell| if cell / mesh.rows() < 46 { Base::Primary } else { Base::Resin })
            .collect();
        let expected =
            5e-6 * (46.0 / 161.0 * mesh.pin_area()) / (5e-14 * 47.0 * 0.022 * 850.0 / 60.0 * std::f64::consts::TAU);
        let found = pulse_time(&parameters, &base).unwrap();
        assert!((found / expected - 1.0).abs() < 1e-12 && (9.0..11.0).contains(&found), "{found}, expected {expected}");
        assert_eq!(pulse_time(&parameters, &vec![Base::Primary; mesh.pin_cells()]), None);
        let everlasting = Materials { pin_primary: parameters.materials.disc_primary, ..parameters.materials };
        assert_eq!(pulse_time(&Parameters { materials: everlasting, ..parameters }, &base), None);
    }
}
