//! Points in time as text.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// ISO 8601 in UTC to the millisecond, for instance `2019-12-15T08:30:00.000Z`; times before 1970 count as its start.
pub(crate) fn iso_8601(time: SystemTime) -> String {
    let since = since_1970(time);
    let seconds = since.as_secs();
    let (year, month, day) = civil_date(seconds / 86_400);
    let (hour, minute, second) = (seconds / 3600 % 24, seconds / 60 % 60, seconds % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{:03}Z", since.subsec_millis())
}

/// The time that a text of [`iso_8601`] stands for.
pub(crate) fn from_iso_8601(text: &str) -> Option<SystemTime> {
    let (date, time) = text.strip_suffix('Z')?.split_once('T')?;
    let [year, month, day] = numbers(date, '-')?;
    let (time, milliseconds) = time.split_once('.')?;
    let [hour, minute, second] = numbers(time, ':')?;
    if !(1..=12).contains(&month) || !(1..=31).contains(&day) || !(1970..10_000).contains(&year) {
        return None;
    }
    let seconds = days_since_1970(year, month, day) * 86_400 + hour * 3600 + minute * 60 + second;
    Some(
        UNIX_EPOCH + Duration::from_secs(seconds) + Duration::from_millis(u64::from(milliseconds.parse::<u16>().ok()?)),
    )
}

/// Three numbers with a mark between them.
fn numbers(text: &str, mark: char) -> Option<[u64; 3]> {
    let numbers: Option<Vec<u64>> = text.split(mark).map(|part| Some(u64::from(part.parse::<u16>().ok()?))).collect();
    numbers?.try_into().ok()
}

/// Day, month, year, hour and minute in UTC without anything between them, for instance `151220190830`.
pub(crate) fn day_month_year(time: SystemTime) -> String {
    let seconds = since_1970(time).as_secs();
    let (year, month, day) = civil_date(seconds / 86_400);
    format!("{day:02}{month:02}{year:04}{:02}{:02}", seconds / 3600 % 24, seconds / 60 % 60)
}

fn since_1970(time: SystemTime) -> Duration {
    time.duration_since(UNIX_EPOCH).unwrap_or(Duration::ZERO)
}

/// Year, month and day, `days` after 1970-01-01 in the Gregorian calendar.
///
/// Years are counted from 1 March, so that the leap day is the last of its year and the months before it have the
/// fixed lengths 31 30 31 30 31 | 31 30 31 30 31 | 31 (five months are 153 days).
fn civil_date(days: u64) -> (u64, u64, u64) {
    const DAYS_IN_400_YEARS: u64 = 146_097;
    let since_march_0 = days + 719_468; // days from 0000-03-01 to 1970-01-01
    let era = since_march_0 / DAYS_IN_400_YEARS;
    let day_of_era = since_march_0 % DAYS_IN_400_YEARS;
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    (400 * era + year_of_era + u64::from(month <= 2), month, day)
}

/// Days from 1970-01-01 to a date in the Gregorian calendar, as [`civil_date`] counts years and months.
fn days_since_1970(year: u64, month: u64, day: u64) -> u64 {
    let year = year - u64::from(month <= 2);
    let (era, year_of_era) = (year / 400, year % 400);
    let day_of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    let day_of_era = year_of_era * 365 + year_of_era / 4 - year_of_era / 100 + day_of_year;
    era * 146_097 + day_of_era - 719_468
}

#[cfg(test)]
#[path = "../tests/unit/timestamp.rs"]
mod tests;
