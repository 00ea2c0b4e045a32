//! Fields that can be recorded as maps.

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
    /// T, K, of every pin cell (model 11): where `output.contact_temperature` asks for it.
    Temperature,
}

impl Map {
    /// Every map.
    pub const ALL: [Self; 8] = [
        Self::DiscHeight,
        Self::DiscSubstrate,
        Self::DiscStatus,
        Self::PinHeight,
        Self::PinSubstrate,
        Self::PinStatus,
        Self::Pressure,
        Self::Temperature,
    ];

    /// Maps that a scene chooses among: all but the one that a series on request brings.
    pub const CHOICES: [Self; 7] = {
        let [choices @ .., _] = Self::ALL;
        choices
    };

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
            Self::Temperature => "temperature",
        }
    }

    /// Tells whether the map covers the disc ring; else it covers the pin.
    pub fn on_disc(self) -> bool {
        matches!(self, Self::DiscHeight | Self::DiscSubstrate | Self::DiscStatus)
    }

    /// Tells whether the values are statuses; else they are floating-point numbers.
    pub fn is_status(self) -> bool {
        matches!(self, Self::DiscStatus | Self::PinStatus)
    }
}

/// Status and base of a cell beyond the pin's outline in maps and files; in scenes whose pin is a rectangle there is none.
pub const ABSENT: u8 = 3;

/// The values of one map, column by column; disc columns in the disc's own frame.
#[derive(Debug, Clone, PartialEq)]
pub enum MapValues {
    /// Heights, m, pressures, Pa, or temperatures, K.
    Float(Vec<f64>),
    /// Statuses, as the discriminants of [`crate::model::material::Status`], or [`ABSENT`].
    Status(Vec<u8>),
}

impl MapValues {
    /// Returns all of them as numbers.
    pub fn into_numbers(self) -> Vec<f64> {
        match self {
            Self::Float(values) => values,
            Self::Status(statuses) => statuses.into_iter().map(f64::from).collect(),
        }
    }
}

/// The maps of one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// t, s.
    pub time: f64,
    /// The maps that were asked for.
    pub maps: Vec<(Map, MapValues)>,
}
