//! From checked keys to friction, heat and emission, and what of them does not go together (docs/friction-heat.md).

use std::sync::Arc;

use plateau_core::model::emission::Emission;
use plateau_core::model::friction::{Friction, FrictionLaw};
use plateau_core::model::heat::{Coating, Disc, Pin, Substance, Thermal};
use plateau_core::model::parameters::Parameters;

use super::error::{Origin, Problem};
use super::settings::Settings;

/// Puts the parts that a scene asks for into its parameters.
pub(super) fn add(settings: &Settings, parameters: &mut Parameters) -> Result<(), Problem> {
    parameters.friction = if settings.has_table("friction") { Some(friction(settings)?) } else { None };
    parameters.thermal = if settings.has_table("thermal") { Some(Arc::new(thermal(settings)?)) } else { None };
    parameters.emission = if settings.has_table("emission") { Some(emission(settings)?) } else { None };
    let problem = |key: &str, message: &str| Err(Problem::new(&settings.origin(key), key, message));
    if parameters.thermal.is_some() && parameters.friction.is_none() {
        return problem(
            "thermal.ambient",
            "heat comes of friction, and there is no [friction]: give it, or leave [thermal] out",
        );
    }
    if parameters.thermal.is_none() {
        if settings.get("emission.number_factor").is_some() {
            return problem(
                "emission.number_factor",
                "there is no [thermal], so the temperature of the contact is not known: give it, or leave this key out",
            );
        }
        if settings.get("output.contact_temperature").is_some() && settings.bool("output.contact_temperature")? {
            return problem(
                "output.contact_temperature",
                "there is no [thermal], so no temperature is reckoned: give it, or leave this key out",
            );
        }
    }
    Ok(())
}

fn friction(settings: &Settings) -> Result<Friction, Problem> {
    let law = |table: &str| {
        let number = |key: &str| settings.number(&format!("{table}.{key}"));
        let [pressure_coefficient, shear_strength] = ["pressure_coefficient", "shear_strength"].map(number);
        Ok::<_, Problem>(FrictionLaw { pressure_coefficient: pressure_coefficient?, shear_strength: shear_strength? })
    };
    let primary = law("friction")?;
    let is_given = |table: &str| {
        ["pressure_coefficient", "shear_strength"]
            .iter()
            .any(|key| settings.origin(&format!("{table}.{key}")) != Origin::Default)
    };
    if !["friction", "friction.secondary", "friction.resin"].into_iter().any(is_given) {
        let message = "this table gives no coefficient of friction: expected pressure_coefficient = 0.33, \
                       shear_strength = \"0.75 MPa\" or both, for example; or leave [friction] out";
        return Err(Problem::new(&settings.origin("friction"), "friction", message));
    }
    let other = |table: &str| if settings.has_table(table) { law(table) } else { Ok(primary) };
    Ok(Friction {
        primary,
        secondary: other("friction.secondary")?,
        resin: other("friction.resin")?,
        maximum: settings.optional_number("friction.maximum")?.unwrap_or(f64::INFINITY),
    })
}

fn thermal(settings: &Settings) -> Result<Thermal, Problem> {
    let number = |key: &str| settings.number(key);
    let substance = |table: &str| {
        let [conductivity, density, specific_heat] =
            ["conductivity", "density", "specific_heat"].map(|key| settings.number(&format!("{table}.{key}")));
        Ok::<_, Problem>(Substance { conductivity: conductivity?, density: density?, specific_heat: specific_heat? })
    };
    let coating = |table: &str| {
        Ok::<_, Problem>(Coating { thickness: number(&format!("{table}.thickness"))?, substance: substance(table)? })
    };
    let table = "thermal.disc.coating";
    Ok(Thermal {
        ambient: number("thermal.ambient")?,
        disc: Disc {
            substance: substance("thermal.disc")?,
            area: number("thermal.disc.area")?,
            thickness: number("thermal.disc.thickness")?,
            cooling: number("thermal.disc.cooling")?,
            cooling_per_speed: number("thermal.disc.cooling_per_speed")?,
            coating: settings.has_table(table).then(|| coating(table)).transpose()?,
        },
        pin: Pin {
            substance: substance("thermal.pin")?,
            area: number("thermal.pin.area")?,
            length: number("thermal.pin.length")?,
            cooling: number("thermal.pin.cooling")?,
        },
        wear_rate_factor: settings.factor("thermal.wear_rate_factor")?,
        friction_factor: settings.factor("thermal.friction_factor")?,
    })
}

fn emission(settings: &Settings) -> Result<Emission, Problem> {
    let number = |key: &str| settings.number(&format!("emission.{key}"));
    let (pm10_fraction, pm25_fraction) = (number("pm10_fraction")?, number("pm25_fraction")?);
    if pm25_fraction > pm10_fraction {
        let key = "emission.pm25_fraction";
        let message = format!("{pm25_fraction} is more than pm10_fraction = {pm10_fraction}, of which it is a part");
        return Err(Problem::new(&settings.origin(key), key, message));
    }
    Ok(Emission {
        pm10_fraction,
        pm25_fraction,
        number_per_mass: number("number_per_mass")?,
        pin_density: number("pin_density")?,
        disc_density: number("disc_density")?,
        number_factor: settings.factor("emission.number_factor")?,
    })
}
