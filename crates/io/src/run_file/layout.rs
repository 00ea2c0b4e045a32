//! The layout of a run file: where its datasets are, their units and long names.

use plateau_core::observe::Map;

/// `format_version` of the files written here.
pub(super) const FORMAT_VERSION: i32 = 1;
/// The conventions that the files follow.
pub(crate) const CONVENTIONS: &str = "CF-1.11";

/// Path of the datasets that say how much of a file is complete.
pub(super) const TIME: &str = "time";
/// A link to [`TIME`] among the series of a run that has ended, which by themselves are a dataset of xarray with its coordinate.
///
/// It is soft: a dataset with two equal names would be known by either, and the scale of the series by the wrong one. While a run
/// goes on there is none: of a dataset that is open twice, readers that follow it see no new values (`H5Drefresh`).
pub(super) const TIME_OF_SERIES: &str = "series/time";
/// See [`TIME`].
pub(super) const MAP_TIME: &str = "map_time";

/// Attribute of the root: what the time acceleration that a run chose was like, as JSON.
pub(super) const ACCELERATION: &str = "time_acceleration";

/// Path of the base of the pin's cells.
pub(super) const PIN_BASE: &str = "pin/base";

/// The type of statuses. No variable has its name: xarray writes a type into the group of the variable that has it.
pub(super) const STATUS_TYPE: &str = "cell_status";

/// The group of what is reported of each event of a cycle.
pub(super) const EVENT_GROUP: &str = "event";
/// Path of the numbers of the events.
pub(super) const EVENT: &str = "event/event";

/// Path of a quantity of the events.
pub(super) fn event_path(name: &str) -> String {
    format!("{EVENT_GROUP}/{name}")
}

/// Path of a series.
pub(super) fn series_path(name: &str) -> String {
    format!("series/{name}")
}

/// Path of a map.
pub fn map_path(map: Map) -> &'static str {
    match map {
        Map::DiscHeight => "disc/height",
        Map::DiscSubstrate => "disc/substrate",
        Map::DiscStatus => "disc/status",
        Map::PinHeight => "pin/height",
        Map::PinSubstrate => "pin/substrate",
        Map::PinStatus => "pin/status",
        Map::Pressure => "pin/pressure",
        Map::Temperature => "pin/temperature",
    }
}

/// SI unit of a map.
pub(crate) fn map_unit(map: Map) -> &'static str {
    match map {
        Map::DiscStatus | Map::PinStatus => "1",
        Map::Pressure => "Pa",
        Map::Temperature => "K",
        _ => "m",
    }
}

/// What a map is, in words.
pub(super) fn map_long_name(map: Map) -> &'static str {
    match map {
        Map::DiscHeight => "surface height of the disc, positive toward the pin",
        Map::DiscSubstrate => "height of the disc below any compacted debris",
        Map::DiscStatus => "status of the disc cells",
        Map::PinHeight => "surface height of the pin, positive away from the disc",
        Map::PinSubstrate => "height of the pin below any compacted debris, positive away from the disc",
        Map::PinStatus => "status of the pin cells",
        Map::Pressure => "contact pressure",
        Map::Temperature => "temperature of the contact, pressures frozen during the pass",
    }
}
