//! What a simulation reports: samples of its quantities and maps of its fields (model section 5).

pub mod plateau_size;
pub mod pressure_spread;
pub mod roughness;
pub mod schedule;
pub mod window_mean;

use serde::{Deserialize, Serialize};

use crate::observe::pressure_spread::PressureSpread;
use crate::observe::roughness::BothRoughness;

/// The reported quantities at the end of one step, in SI units.
///
/// Displacement, contact area and pressures are those of that step's load balance, everything else is the state after
/// the step.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
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
    /// Build-up of unsupported plateaus that went back to the pool, m³, cumulative.
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
    /// (worn + returned − deposited − emitted − pool) / worn; 0 if nothing is worn.
    pub balance_residual: f64,
    /// Acceleration that the run chose itself, if it does so.
    pub acceleration: Option<ChosenAcceleration>,
    /// Roughness of disc and pin, if it was asked for.
    pub roughness: Option<BothRoughness>,
    /// Spread of the pressures, if it was asked for.
    pub pressure_spread: Option<PressureSpread>,
}

/// Acceleration at the end of a step, in a run that chooses it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ChosenAcceleration {
    /// m.
    pub acceleration: f64,
    /// Estimate of the relative error of the contact area.
    pub error: f64,
}

/// Name, unit and meaning of one reported quantity, and where a [`Sample`] keeps it.
#[derive(Debug, Clone, Copy)]
pub struct Quantity {
    /// Name of the series in a run file.
    pub name: &'static str,
    /// SI unit as UDUNITS writes it.
    pub unit: &'static str,
    /// What it is, in words.
    pub long_name: &'static str,
    /// The value in a sample.
    pub value: fn(&Sample) -> f64,
}

macro_rules! quantities {
    ($($field:ident, $unit:literal, $long_name:literal;)*) => {
        &[$(Quantity {
            name: stringify!($field),
            unit: $unit,
            long_name: $long_name,
            value: |sample| sample.$field,
        }),*]
    };
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
    worn_pin, "m3", "volume worn off plateaus of the pin";
    worn_resin, "m3", "volume worn off the resin of the pin";
    worn_disc, "m3", "volume worn off the disc";
    pool, "m3", "wear debris in the contact, not compacted";
    emitted, "m3", "wear debris that left the contact";
    deposited_pin, "m3", "wear debris compacted on the pin";
    deposited_disc, "m3", "wear debris compacted on the disc";
    returned, "m3", "build-up of unsupported plateaus returned to the pool";
    pin_primary, "1", "area fraction of the pin that is primary plateau";
    pin_secondary, "1", "area fraction of the pin that is secondary plateau";
    pin_none, "1", "area fraction of the pin that is no plateau";
    disc_secondary, "1", "area fraction of the disc ring that is secondary plateau";
    filled_fraction, "1", "fraction of the initial volume below the highest disc height that is filled";
    load_residual, "1", "relative residual of the load balance";
    balance_residual, "1", "relative residual of the debris balance";
};

macro_rules! optional_quantities {
    ($part:ident: $($name:literal, $($field:ident).+, $unit:literal, $long_name:literal;)*) => {
        &[$(Quantity {
            name: $name,
            unit: $unit,
            long_name: $long_name,
            value: |sample| sample.$part.map_or(f64::NAN, |part| part.$($field).+),
        }),*]
    };
}

/// The series that a run file has besides if roughness is asked for; NaN in a sample without it.
pub const ROUGHNESS_QUANTITIES: &[Quantity] = optional_quantities! { roughness:
    "disc_sa", disc.arithmetical_mean_height, "m", "arithmetical mean height Sa of the disc";
    "disc_sq", disc.root_mean_square_height, "m", "root-mean-square height Sq of the disc";
    "disc_ssk", disc.skewness, "1", "skewness Ssk of the disc heights";
    "disc_sku", disc.kurtosis, "1", "kurtosis Sku of the disc heights";
    "pin_sa", pin.arithmetical_mean_height, "m", "arithmetical mean height Sa of the pin";
    "pin_sq", pin.root_mean_square_height, "m", "root-mean-square height Sq of the pin";
    "pin_ssk", pin.skewness, "1", "skewness Ssk of the pin heights, peaks toward the disc";
    "pin_sku", pin.kurtosis, "1", "kurtosis Sku of the pin heights";
};

/// The series that a run file has besides if the spread of the pressures is asked for; NaN in a sample without it.
pub const PRESSURE_SPREAD_QUANTITIES: &[Quantity] = optional_quantities! { pressure_spread:
    "pressure_variation", variation, "1", "coefficient of variation of the pressure over the cells in contact";
    "pressure_gini", gini, "1", "Gini coefficient of the pressure over the cells in contact";
};

/// The series that a run file has besides if the run chooses its acceleration; NaN in a sample without it.
pub const ACCELERATION_QUANTITIES: &[Quantity] = optional_quantities! { acceleration:
    "time_acceleration", acceleration, "1", "revolutions that one simulated revolution stands for";
    "acceleration_error", error, "1", "estimate of the relative error of the contact area that the time acceleration causes";
};

/// Series that not every run file has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Extras {
    /// Those of the roughness.
    pub roughness: bool,
    /// Those of the spread of the pressures.
    pub pressure_spread: bool,
    /// Those of an acceleration that the run chooses.
    pub acceleration: bool,
}

impl Extras {
    /// All of them.
    pub const ALL: Self = Self { roughness: true, pressure_spread: true, acceleration: true };
}

/// The series of a run file but the time.
pub fn quantities(extras: Extras) -> impl Iterator<Item = &'static Quantity> {
    let roughness = if extras.roughness { ROUGHNESS_QUANTITIES } else { &[] };
    let acceleration = if extras.acceleration { ACCELERATION_QUANTITIES } else { &[] };
    let pressure_spread = if extras.pressure_spread { PRESSURE_SPREAD_QUANTITIES } else { &[] };
    QUANTITIES.iter().chain(roughness).chain(pressure_spread).chain(acceleration)
}

/// A field that can be recorded as a map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Map {
    /// z_d, m.
    DiscHeight,
    /// b_d, m.
    DiscSubstrate,
    /// Status of every disc cell.
    DiscStatus,
    /// z_p, m.
    PinHeight,
    /// b_p, m.
    PinSubstrate,
    /// Status of every pin cell.
    PinStatus,
    /// p, Pa, of the step that ends there.
    Pressure,
}

impl Map {
    /// Every map.
    pub const ALL: [Self; 7] = [
        Self::DiscHeight,
        Self::DiscSubstrate,
        Self::DiscStatus,
        Self::PinHeight,
        Self::PinSubstrate,
        Self::PinStatus,
        Self::Pressure,
    ];

    /// Name in a scene.
    pub fn name(self) -> &'static str {
        match self {
            Self::DiscHeight => "disc_height",
            Self::DiscSubstrate => "disc_substrate",
            Self::DiscStatus => "disc_status",
            Self::PinHeight => "pin_height",
            Self::PinSubstrate => "pin_substrate",
            Self::PinStatus => "pin_status",
            Self::Pressure => "pressure",
        }
    }

    /// Whether the map covers the disc ring; else it covers the pin.
    pub fn on_disc(self) -> bool {
        matches!(self, Self::DiscHeight | Self::DiscSubstrate | Self::DiscStatus)
    }

    /// Whether the values are statuses; else they are floating-point numbers.
    pub fn is_status(self) -> bool {
        matches!(self, Self::DiscStatus | Self::PinStatus)
    }
}

/// The values of one map, column by column; disc columns in the disc's own frame.
#[derive(Debug, Clone, PartialEq)]
pub enum MapValues {
    /// Heights or pressures.
    Float(Vec<f64>),
    /// Statuses, as the discriminants of [`crate::model::material::Status`].
    Status(Vec<u8>),
}

/// The maps of one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// t, s.
    pub time: f64,
    /// The maps that were asked for.
    pub maps: Vec<(Map, MapValues)>,
}
