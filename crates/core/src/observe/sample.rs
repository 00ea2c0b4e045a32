//! Quantities that every run reports at the end of a step: their names and units, and their places in a sample.

use serde::{Deserialize, Serialize};

use crate::model::accounts::AccountsReport;

/// The reported quantities at the end of one step, in SI units.
///
/// Displacement, contact area and pressures are those of that step's load balance, everything else is the state after
/// the step.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Sample {
    /// Steps done.
    pub step: u64,
    /// t, s.
    pub time: f64,
    /// δ, m: displacement of the rigid pin.
    pub displacement: f64,
    /// Σ A over cells in contact, m².
    pub contact_area: f64,
    /// Mean of the contact area over the last simulated revolution, m²; over all steps so far before the first is done.
    pub contact_area_mean: f64,
    /// Σ contact area · m Δt since t = 0, m² s.
    pub contact_area_integral: f64,
    /// Distance slid at the mean radius in the physical time, m.
    pub sliding_distance: f64,
    /// Contact area over the area of the pin.
    pub contact_ratio: f64,
    /// Σ p A / Σ A over cells in contact, Pa.
    pub mean_pressure: f64,
    /// Largest pressure of any cell, Pa.
    pub max_pressure: f64,
    /// Volume worn off plateaus of the pin, m³, cumulative.
    pub worn_pin: f64,
    /// Volume worn off resin, m³, cumulative.
    pub worn_resin: f64,
    /// Volume worn off the disc, m³, cumulative.
    pub worn_disc: f64,
    /// M, m³: debris in the contact that is not compacted (the sum over tracks where each has its own pool).
    pub pool: f64,
    /// Debris that left the contact, m³, cumulative.
    pub emitted: f64,
    /// Debris compacted on the pin, m³, cumulative.
    pub deposited_pin: f64,
    /// Debris compacted on the disc, m³, cumulative.
    pub deposited_disc: f64,
    /// Build-up of the pin that lost its support or broke away, m³, cumulative.
    pub returned: f64,
    /// Area fraction of the pin that is primary plateau.
    pub pin_primary: f64,
    /// Area fraction of the pin that is secondary plateau.
    pub pin_secondary: f64,
    /// Area fraction of the pin that is no plateau.
    pub pin_none: f64,
    /// Area fraction of the whole ring that is secondary plateau.
    pub disc_secondary: f64,
    /// 1 − V(t)/V(0), V = Σ A (z_ref − z_d)₊ with z_ref the highest initial disc height.
    pub filled_fraction: f64,
    /// |Σ k A u − F_N| / F_N.
    pub load_residual: f64,
    /// Missing share of the worn volume, 1, see [`Totals`](crate::model::totals::Totals::balance_residual); 0 if nothing is worn.
    pub balance_residual: f64,
    /// Friction, heat and emission, where the scene asks for them.
    pub accounts: AccountsReport,
    /// Quantities that not every run has, by their names; none in a checkpoint.
    #[serde(skip)]
    pub extras: Vec<(&'static str, f64)>,
}

impl Sample {
    /// Volume worn off the whole pin, plateaus and resin, m³, cumulative.
    pub fn worn_whole_pin(&self) -> f64 {
        self.worn_pin + self.worn_resin
    }

    /// Volume that the whole pin has lost, m³: what a balance tells. Build-up is weighed with the pin, and wears as plateaus do, so
    /// that what was deposited and worn off again was not lost by the pin.
    pub fn lost_pin(&self) -> f64 {
        self.worn_whole_pin() + self.returned - self.deposited_pin
    }
}

/// Takes a quantity from a sample; none where the scene does not ask for it.
type Field = fn(&Sample) -> Option<f64>;

/// Name, unit and meaning of one reported quantity.
#[derive(Debug, Clone, Copy)]
pub struct Quantity {
    /// Name of the series in a run file.
    pub name: &'static str,
    /// SI unit as UDUNITS writes it.
    pub unit: &'static str,
    /// Meaning, in words.
    pub long_name: &'static str,
    /// Place in a sample; none if it is among the extras.
    field: Option<Field>,
}

impl Quantity {
    /// Quantity that not every run has, but whose place in a sample is known.
    pub const fn of(name: &'static str, unit: &'static str, long_name: &'static str, field: Field) -> Self {
        Self { name, unit, long_name, field: Some(field) }
    }

    /// Quantity that not every run has, among the extras.
    pub const fn extra(name: &'static str, unit: &'static str, long_name: &'static str) -> Self {
        Self { name, unit, long_name, field: None }
    }

    /// Tells whether a sample has it, be it as no number.
    pub fn is_of(&self, sample: &Sample) -> bool {
        self.found(sample).is_some()
    }

    /// The value in a sample; NaN in one without it.
    pub fn value(&self, sample: &Sample) -> f64 {
        self.found(sample).unwrap_or(f64::NAN)
    }

    fn found(&self, sample: &Sample) -> Option<f64> {
        match self.field {
            Some(field) => field(sample),
            None => sample.extras.iter().find(|(name, _)| *name == self.name).map(|(_, value)| *value),
        }
    }
}

/// A line is a field of a sample, or `name = value`, with the value a function of a sample.
macro_rules! quantities {
    ($($name:ident $(= $value:expr)?, $unit:literal, $long_name:literal;)*) => {
        &[$(Quantity::of(stringify!($name), $unit, $long_name, quantities!(@field $name $($value)?))),*]
    };
    (@field $name:ident $value:expr) => { |sample| Some($value(sample)) };
    (@field $name:ident) => { |sample| Some(sample.$name) };
}

/// Every series that each run file has, but the time, in the order in which they are reported.
pub const QUANTITIES: &[Quantity] = quantities! {
    displacement, "m", "displacement of the rigid pin";
    contact_area, "m2", "contact area";
    contact_area_mean, "m2", "contact area, mean over the last simulated revolution";
    contact_area_integral, "m2 s", "contact area, integral over time";
    sliding_distance, "m", "sliding distance at the mean radius";
    contact_ratio, "1", "contact area over the area of the pin";
    mean_pressure, "Pa", "mean pressure over the cells in contact";
    max_pressure, "Pa", "largest pressure of any cell";
    worn_pin, "m3", "volume worn off plateaus of the simulated pin";
    worn_resin, "m3", "volume worn off the resin of the simulated pin";
    worn_whole_pin = Sample::worn_whole_pin, "m3", "volume worn off the whole simulated pin, plateaus and resin";
    lost_pin = Sample::lost_pin, "m3", "volume that the whole simulated pin has lost, as a balance shows it: worn off, less build-up deposited on it";
    worn_disc, "m3", "volume worn off the disc by the simulated pin";
    pool, "m3", "wear debris in the contact, not compacted";
    emitted, "m3", "wear debris that left the contact of the simulated pin";
    deposited_pin, "m3", "wear debris compacted on the pin";
    deposited_disc, "m3", "wear debris compacted on the disc";
    returned, "m3", "build-up of the pin that lost its support (to the pool) or broke away (emitted)";
    pin_primary, "1", "area fraction of the pin that is primary plateau";
    pin_secondary, "1", "area fraction of the pin that is secondary plateau";
    pin_none, "1", "area fraction of the pin that is no plateau";
    disc_secondary, "1", "area fraction of the disc ring that is secondary plateau";
    filled_fraction, "1", "fraction of the initial volume below the highest disc height that is filled";
    load_residual, "1", "relative residual of the load balance";
    balance_residual, "1", "relative residual of the debris balance";
};

/// Series that are totals since the start of a run: they only grow, and their mean over a time says nothing.
pub const TOTALS: &[&str] = &[
    "contact_area_integral",
    "sliding_distance",
    "contact_time",
    "road_distance",
    "worn_pin",
    "worn_resin",
    "worn_whole_pin",
    "lost_pin",
    "worn_disc",
    "emitted",
    "deposited_pin",
    "deposited_disc",
    "returned",
    "friction_work",
    "heat_lost",
    "emitted_mass",
    "pm10_mass",
    "pm25_mass",
    "particle_number",
    "pad_wear",
    "brake_emitted_mass",
    "brake_pm10_mass",
    "brake_pm25_mass",
    "brake_particle_number",
];
