//! What is shown, each described once: its title, unit, sign and colours. Figures, pages and the terminal ask here.
//!
//! Heights are positive toward the other body wherever they are shown, so peaks are high on both bodies, as in ISO 25178-2 and as
//! `plateau surface` has them. The disc's are the model's z; the z of the pin grows away from the disc, so it is turned, and as the
//! pin wears by far more than it is rough, it is counted from its mean.

mod range;
mod unit;

use plateau_core::model::material::Status;
use plateau_core::observe::Map;
use plateau_core::surface::Body;
use plateau_io::run_file::Series;
use plotters::style::RGBColor;

use crate::colour::STATUSES;

pub use range::{BEYOND, RobustRange};
pub use unit::Unit;

/// A series as it is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct SeriesLook {
    /// Name in run files.
    pub name: &'static str,
    /// What it is, in a few words.
    pub title: &'static str,
    /// The unit in which numbers of it are given.
    pub unit: Unit,
}

/// The series that pages, figures or the terminal name, in the order in which they are told.
static SERIES: &[SeriesLook] = &[
    series("sliding_distance", "sliding distance", Unit::METRE),
    series("contact_area", "contact area", Unit::MM2),
    series("contact_area_mean", "contact area, mean of the last simulated revolution", Unit::MM2),
    series("contact_ratio", "contact area over the area of the pin", Unit::PERCENT),
    series("mean_pressure", "mean contact pressure", Unit::MEGAPASCAL),
    series("max_pressure", "largest contact pressure", Unit::MEGAPASCAL),
    series("filled_fraction", "disc filled", Unit::PERCENT),
    series("disc_secondary", "disc covered by secondary plateaus", Unit::PERCENT),
    series("pin_secondary", "pin covered by secondary plateaus", Unit::PERCENT),
    series("pin_primary", "pin covered by primary plateaus", Unit::PERCENT),
    series("pin_none", "pin without plateaus", Unit::PERCENT),
    series("worn_pin", "volume worn off plateaus of the simulated pin", Unit::MM3),
    series("worn_resin", "volume worn off the resin of the simulated pin", Unit::MM3),
    series("worn_whole_pin", "volume worn off the whole simulated pin, plateaus and resin", Unit::MM3),
    series("lost_pin", "volume that the whole simulated pin has lost, as a balance shows it", Unit::MM3),
    series("worn_disc", "volume worn off the disc by the simulated pin", Unit::MM3),
    series("emitted", "emitted debris of the simulated pin", Unit::MM3),
    series("deposited_pin", "debris deposited on the pin", Unit::MM3),
    series("deposited_disc", "debris deposited on the disc", Unit::MM3),
    series("pool", "debris in the pool", Unit::MM3),
    series("normal_force", "normal force on the simulated pin", Unit::NEWTON),
    series("rotational_speed", "rotational speed", Unit::RPM),
    series("contact_time", "time in contact", Unit::SECOND),
    series("road_distance", "distance of the vehicle", Unit::METRE),
    series("friction_coefficient", "coefficient of friction", Unit::NUMBER),
    series("friction_coefficient_mean", "coefficient of friction, mean of the last simulated revolution", Unit::NUMBER),
    series("friction_work", "work of friction of the simulated pin", Unit::KILOJOULE),
    series("contact_temperature", "temperature of the contact", Unit::CELSIUS),
    series("contact_temperature_heated", "temperature of the cells in contact, mean", Unit::CELSIUS),
    series("contact_temperature_max", "temperature of the hottest cell of the pin", Unit::CELSIUS),
    series("disc_temperature", "mean temperature of the disc", Unit::CELSIUS),
    series("pin_temperature", "mean temperature of the pin", Unit::CELSIUS),
    series("heat_lost", "heat of the simulated pin lost to air and holder", Unit::KILOJOULE),
    series("heat_residual", "relative residual of the energy balance", Unit::NUMBER),
    series("emitted_mass", "mass of the emitted debris of the simulated pin", Unit::MICROGRAM),
    series("pm10_mass", "mass airborne as PM10, of the simulated pin", Unit::MICROGRAM),
    series("pm25_mass", "mass airborne as PM2.5, of the simulated pin", Unit::MICROGRAM),
    series("particle_number", "airborne particles of the simulated pin", Unit::NUMBER),
];

const fn series(name: &'static str, title: &'static str, unit: Unit) -> SeriesLook {
    SeriesLook { name, title, unit }
}

impl SeriesLook {
    /// How a series of that name is shown; by its name where it has no title.
    pub fn of(name: &'static str) -> Self {
        Self::find(name).cloned().unwrap_or(series(name, name, Unit::NUMBER))
    }

    fn find(name: &str) -> Option<&'static Self> {
        SERIES.iter().find(|series| series.name == name)
    }

    /// A value, SI, with so many decimals and its unit.
    pub fn text(&self, value: f64, decimals: usize) -> String {
        self.unit.with_symbol(&format!("{:.decimals$}", self.unit.value(value)))
    }
}

/// What a series is called in a few words; by its name where it has no others.
pub fn title(name: &'static str) -> &'static str {
    SeriesLook::of(name).title
}

/// The unit in which a series of a run file is given.
pub fn unit(series: &Series) -> Unit {
    SeriesLook::find(&series.name).map_or_else(|| Unit::usual(&series.unit), |look| look.unit.clone())
}

/// A map as it is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct MapLook {
    /// The map.
    pub map: Map,
    /// What it is, with the body and the sign.
    pub title: &'static str,
    /// What its values are, in a few words.
    pub what: &'static str,
    /// The unit in which they are given.
    pub unit: Unit,
    /// How they are coloured.
    pub colours: Colours,
    /// Whether they are counted from their mean.
    pub about_mean: bool,
    /// The map of the surface above the one that this one shows: wherever there is no debris the two are alike.
    pub above: Option<Map>,
}

/// How a map is coloured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colours {
    /// By the colour map, from nearly the least to nearly the greatest value.
    Span,
    /// By the colour map from zero on; what is not above zero has none of its colours.
    FromZero,
    /// By what the cells are ([`STATUS_LOOKS`]).
    Statuses,
}

static MAPS: [MapLook; 8] = [
    height(Map::DiscHeight, "Disc: height, positive toward the pin", None),
    height(Map::DiscSubstrate, "Disc: height below the debris", Some(Map::DiscHeight)),
    status(Map::DiscStatus, "Disc: status"),
    height(Map::PinHeight, "Pin: height, positive toward the disc", None),
    height(Map::PinSubstrate, "Pin: height below the debris, positive toward the disc", Some(Map::PinHeight)),
    status(Map::PinStatus, "Pin: status"),
    MapLook {
        map: Map::Pressure,
        title: "Pin: contact pressure",
        what: "pressure",
        unit: Unit::MEGAPASCAL,
        colours: Colours::FromZero,
        about_mean: false,
        above: None,
    },
    MapLook {
        map: Map::Temperature,
        title: "Pin: contact temperature",
        what: "temperature",
        unit: Unit::CELSIUS,
        colours: Colours::Span,
        about_mean: false,
        above: None,
    },
];

const fn height(map: Map, title: &'static str, above: Option<Map>) -> MapLook {
    let about_mean = matches!(map, Map::PinHeight | Map::PinSubstrate);
    let what = if about_mean { "height toward the disc" } else { "height" };
    MapLook { map, title, what, unit: Unit::MICROMETRE, colours: Colours::Span, about_mean, above }
}

const fn status(map: Map, title: &'static str) -> MapLook {
    MapLook {
        map,
        title,
        what: "status",
        unit: Unit::NUMBER,
        colours: Colours::Statuses,
        about_mean: false,
        above: None,
    }
}

impl MapLook {
    /// How a map is shown.
    pub fn of(map: Map) -> &'static Self {
        // Every map has a place; a test says so.
        MAPS.iter().find(|look| look.map == map).unwrap_or(&MAPS[0])
    }

    /// The body that the map covers.
    pub fn body(&self) -> &'static str {
        if self.map.on_disc() { "disc" } else { "pin" }
    }

    /// The sign with which values are shown: peaks of heights are to be high.
    pub fn sign(&self) -> f64 {
        if matches!(self.map, Map::PinHeight | Map::PinSubstrate) { Body::Pin.peak_sign() } else { 1.0 }
    }

    /// What the values of a moment are counted from.
    pub fn zero(&self, values: &[f64]) -> f64 {
        if self.about_mean { mean(values) } else { 0.0 }
    }

    /// Whether a value has one of the colours of the colour map.
    pub fn is_coloured(&self, value: f64) -> bool {
        self.colours != Colours::FromZero || value > 0.0
    }

    /// What the first and the last colour stand for, of such values as are coloured; zeros without values.
    pub fn ends(&self, values: &mut RobustRange) -> [f64; 2] {
        let mut end = |part: f64| values.quantile(part).unwrap_or(0.0);
        let low = if self.colours == Colours::FromZero { 0.0 } else { end(BEYOND) };
        [low, end(1.0 - BEYOND)]
    }
}

/// Mean of the values that are numbers; 0 without any.
fn mean(values: &[f64]) -> f64 {
    let numbers = values.iter().filter(|value| value.is_finite());
    numbers.clone().sum::<f64>() / numbers.count().max(1) as f64
}

/// A status as it is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct StatusLook {
    /// The status.
    pub status: Status,
    /// What it is called.
    pub name: &'static str,
    /// What such cells are made of.
    pub made_of: &'static str,
    /// Its colour.
    pub colour: RGBColor,
}

/// The statuses, by their numbers.
pub const STATUS_LOOKS: [StatusLook; 3] = [
    StatusLook { status: Status::Resin, name: "none", made_of: "resin", colour: STATUSES[0] },
    StatusLook { status: Status::Primary, name: "primary plateau", made_of: "fibre, or coating", colour: STATUSES[1] },
    StatusLook {
        status: Status::Secondary,
        name: "secondary plateau",
        made_of: "compacted debris",
        colour: STATUSES[2],
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_map_and_status_has_its_own_look() {
        assert!(Map::ALL.into_iter().all(|map| MapLook::of(map).map == map));
        assert!(STATUS_LOOKS.iter().enumerate().all(|(code, look)| look.status as usize == code));
    }

    #[test]
    fn series_are_those_of_run_files() {
        use plateau_core::observe::{EXTRAS, quantities};
        let known: Vec<&str> = quantities(EXTRAS).map(|quantity| quantity.name).collect();
        assert!(SERIES.iter().all(|look| known.contains(&look.name)));
        // What a reader could take for that of a brake says whose it is wherever it is shown.
        for quantity in quantities(EXTRAS).filter(|quantity| quantity.long_name.contains("simulated pin")) {
            assert!(title(quantity.name).contains("simulated pin"), "{}", quantity.name);
        }
    }
}
