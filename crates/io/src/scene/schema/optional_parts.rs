//! The keys of the parts of the model that a scene switches on with a table: friction, heat, emission.

use super::key::{Kind, Need};
use super::range::Range;
use super::table::{Table, length};
use crate::units::Dimension::{
    Area, Cooling, CoolingPerSpeed, Density, NumberPerMass, Pressure, SpecificHeat, Temperature, ThermalConductivity,
};
use Kind::Number;
use Need::{Computed, Default, Optional, Required};

/// Adds them all.
pub(super) fn add(table: &mut Table) {
    table.friction();
    table.thermal();
    table.emission();
}

impl Table {
    fn friction(&mut self) {
        self.section = "friction";
        let coefficient = Number(Range::NOT_NEGATIVE);
        let strength = Kind::Quantity { dimension: Pressure, unit: "MPa", range: Range::NOT_NEGATIVE };
        let (of_pressure, of_area) =
            ("shear stress per pressure: the coefficient at high pressure", "shear stress without pressure");
        self.key("pressure_coefficient", coefficient, Default("0"), of_pressure);
        self.key("shear_strength", strength, Default("\"0 MPa\""), of_area);
        self.key("maximum", Number(Range::POSITIVE), Optional, "the largest coefficient of friction");
        let same = "as above";
        self.key("secondary.pressure_coefficient", coefficient, Computed(same), of_pressure);
        self.key("secondary.shear_strength", strength, Computed(same), of_area);
        self.key("resin.pressure_coefficient", coefficient, Computed(same), of_pressure);
        self.key("resin.shear_strength", strength, Computed(same), of_area);
    }

    /// λ, ρ and c, under these names.
    fn substance(&mut self, names: [&'static str; 3]) {
        let quantity = |dimension, unit| Kind::Quantity { dimension, unit, range: Range::POSITIVE };
        self.key(names[0], quantity(ThermalConductivity, "W/(m K)"), Required, "thermal conductivity");
        self.key(names[1], quantity(Density, "kg/m^3"), Required, "density");
        self.key(names[2], quantity(SpecificHeat, "J/(kg K)"), Required, "specific heat");
    }

    fn thermal(&mut self) {
        self.section = "thermal";
        let temperature = Kind::Quantity { dimension: Temperature, unit: "degC", range: Range::POSITIVE };
        self.key("ambient", temperature, Required, "temperature of the air, and of all at the start");
        let wear = "factor of the wear rates of the pin's plateaus over the temperature of the contact";
        self.key("wear_rate_factor", Kind::Factor, Optional, wear);
        let friction = "factor of the coefficient of friction over the temperature of the contact";
        self.key("friction_factor", Kind::Factor, Optional, friction);

        let area = Kind::Quantity { dimension: Area, unit: "cm^2", range: Range::POSITIVE };
        let cooling = Kind::Quantity { dimension: Cooling, unit: "W/K", range: Range::NOT_NEGATIVE };
        let substance = ["conductivity", "density", "specific_heat"];
        self.section = "thermal.disc";
        self.substance(substance);
        self.key("area", area, Required, "area of the disc that takes heat and is cooled");
        self.key("thickness", length("mm", Range::POSITIVE), Required, "thickness of the disc");
        self.key("cooling", cooling, Default("\"0 W/K\""), "heat lost to the air per temperature above the ambient");
        let per_speed = Kind::Quantity { dimension: CoolingPerSpeed, unit: "J/(K rad)", range: Range::NOT_NEGATIVE };
        self.key(
            "cooling_per_speed",
            per_speed,
            Default("\"0 J/(K rad)\""),
            "the same per rotational speed, added to it",
        );
        let thickness = "thickness of the coating";
        self.key("coating.thickness", length("um", Range::NOT_NEGATIVE), Required, thickness);
        self.substance(["coating.conductivity", "coating.density", "coating.specific_heat"]);

        self.section = "thermal.pin";
        self.substance(substance);
        self.key("area", area, Required, "cross-section of the pin");
        self.key("length", length("mm", Range::POSITIVE), Required, "length of the pin up to its holder");
        self.key("cooling", cooling, Default("\"0 W/K\""), "heat lost to the holder per temperature above the ambient");
    }

    fn emission(&mut self) {
        self.section = "emission";
        let fraction = Number(Range::FRACTION);
        self.key("pm10_fraction", fraction, Default("0"), "fraction of the emitted mass that is airborne as PM10");
        self.key("pm25_fraction", fraction, Default("0"), "fraction of the emitted mass that is airborne as PM2.5");
        let number = Kind::Quantity { dimension: NumberPerMass, unit: "1/kg", range: Range::NOT_NEGATIVE };
        self.key("number_per_mass", number, Default("\"0 1/kg\""), "particles per mass of PM10");
        let density = Kind::Quantity { dimension: Density, unit: "kg/m^3", range: Range::POSITIVE };
        self.key("pin_density", density, Required, "density of what wears off the pin");
        self.key("disc_density", density, Required, "density of what wears off the disc");
        let factor = "factor of the number of particles over the temperature of the contact; needs [thermal]";
        self.key("number_factor", Kind::Factor, Optional, factor);
    }
}
