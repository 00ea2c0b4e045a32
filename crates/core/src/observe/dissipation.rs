//! Series of friction, heat and emission, in runs whose scene asks for them (model 10 to 12).

use super::extra::{Extra, Request};
use super::map::Map;
use super::quantity::Quantity;
use crate::model::parameters::Parameters;

/// A quantity of one of the accounts; none in a run without it.
macro_rules! of {
    ($part:ident . $field:ident, $name:literal, $unit:literal, $long_name:literal) => {
        Quantity::of($name, $unit, $long_name, |sample| sample.accounts.$part.map(|part| part.$field))
    };
}

/// With `[friction]`.
pub const FRICTION: Extra = Extra {
    name: "friction",
    quantities: &[
        of!(friction.coefficient, "friction_coefficient", "1", "coefficient of friction"),
        of!(
            friction.coefficient_mean,
            "friction_coefficient_mean",
            "1",
            "coefficient of friction, mean over the last simulated revolution, weighted by load"
        ),
        of!(friction.work, "friction_work", "J", "work of friction of the simulated pin"),
    ],
    request: None,
    needs: "a law of friction, table [friction]",
};

/// With `[thermal]`.
pub const HEAT: Extra = Extra {
    name: "heat",
    quantities: &[
        of!(heat.contact, "contact_temperature", "K", "temperature of the contact"),
        of!(heat.disc, "disc_temperature", "K", "mean temperature of the disc"),
        of!(heat.pin, "pin_temperature", "K", "mean temperature of the pin"),
        of!(heat.lost, "heat_lost", "J", "heat lost to the air and the holder of the simulated pin"),
        of!(heat.residual, "heat_residual", "1", "relative residual of the energy balance"),
    ],
    request: None,
    needs: "heat, table [thermal]",
};

/// With `[emission]`.
pub const EMISSION: Extra = Extra {
    name: "emission",
    quantities: &[
        of!(emission.mass, "emitted_mass", "kg", "mass of the debris that left the contact of the simulated pin"),
        of!(emission.pm10, "pm10_mass", "kg", "mass of it that is airborne as PM10, of the simulated pin"),
        of!(emission.pm25, "pm25_mass", "kg", "mass of it that is airborne as PM2.5, of the simulated pin"),
        of!(emission.number, "particle_number", "1", "number of airborne particles of the simulated pin"),
    ],
    request: None,
    needs: "airborne emission, table [emission]",
};

/// Over the contact temperature map, which is written, too.
pub const CONTACT_TEMPERATURE: Extra = Extra {
    name: "contact_temperature",
    quantities: &[
        Quantity::extra(
            "contact_temperature_heated",
            "K",
            "temperature of the cells in contact, mean over their area, pressures frozen during the pass",
        ),
        Quantity::extra(
            "contact_temperature_max",
            "K",
            "largest temperature of any pin cell, pressures frozen during the pass",
        ),
    ],
    request: Some(Request {
        what: "contact temperatures and their map",
        meaning: "whether the temperature of every cell of the contact is reckoned with every sample, and written with the maps; needs [thermal]",
        maps: &[Map::Pressure, Map::Temperature],
        measure: heated_and_largest,
    }),
    needs: "heat, table [thermal]",
};

/// Mean over the area of the cells in contact, and the largest of all, K; no number where nothing touches.
fn heated_and_largest(parameters: &Parameters, fields: &[Vec<f64>]) -> Vec<f64> {
    let [pressure, temperature] = fields else { return vec![f64::NAN; 2] };
    let cells = pressure.iter().zip(temperature).zip(parameters.mesh.area().iter().cycle());
    let (mut heat, mut area_in_contact) = (0.0, 0.0);
    for ((_, temperature), area) in cells.filter(|((pressure, _), _)| **pressure > 0.0) {
        heat += temperature * area;
        area_in_contact += area;
    }
    let largest = temperature.iter().copied().fold(f64::NAN, f64::max);
    vec![heat / area_in_contact, largest]
}
