//! Points in time as text.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// The last second of the year 9999, after which a year has five digits.
const LAST: Duration = Duration::from_secs(253_402_300_799);

/// ISO 8601 in UTC to the millisecond, for instance `2019-12-15T08:30:00.000Z`; times before 1970 count as its start, and after 9999 as its
/// end.
pub(crate) fn iso_8601(time: SystemTime) -> String {
    humantime::format_rfc3339_millis(time.clamp(UNIX_EPOCH, UNIX_EPOCH + LAST)).to_string()
}

/// The time that a text of [`iso_8601`] stands for; none of a text in another form.
pub(crate) fn from_iso_8601(text: &str) -> Option<SystemTime> {
    humantime::parse_rfc3339(text).ok().filter(|time| iso_8601(*time) == text)
}

/// Day, month, year, hour and minute in UTC without anything between them, for instance `151220190830`.
pub(crate) fn day_month_year(time: SystemTime) -> String {
    let text = iso_8601(time);
    [8..10, 5..7, 0..4, 11..13, 14..16].map(|part| &text[part]).concat()
}

#[cfg(test)]
#[path = "../tests/unit/timestamp.rs"]
mod tests;
