use super::*;

#[test]
fn agrees_with_gnu_date() {
    // date -u -d @SECONDS +%FT%T.000Z
    for (seconds, text) in [
        (0, "1970-01-01T00:00:00.000Z"),
        (951_782_399, "2000-02-28T23:59:59.000Z"),
        (951_782_400, "2000-02-29T00:00:00.000Z"),
        (951_868_800, "2000-03-01T00:00:00.000Z"),
        (1_576_398_600, "2019-12-15T08:30:00.000Z"),
        (1_798_761_599, "2026-12-31T23:59:59.000Z"),
        (4_107_542_400, "2100-03-01T00:00:00.000Z"),
    ] {
        let time = UNIX_EPOCH + Duration::from_secs(seconds);
        assert_eq!(iso_8601(time), text);
        assert_eq!(from_iso_8601(text), Some(time));
    }
    // A clock may be wrong by any time.
    assert_eq!(iso_8601(UNIX_EPOCH - Duration::from_secs(1)), "1970-01-01T00:00:00.000Z");
    assert_eq!(iso_8601(UNIX_EPOCH + Duration::from_secs(283_824_000_000)), "9999-12-31T23:59:59.000Z");
}

#[test]
fn what_is_no_time_is_refused() {
    for text in [
        "",
        "2019-12-15",
        "2019-12-15T08:30:00Z",
        "2019-12-15T08:30:00.000",
        "2019-13-15T08:30:00.000Z",
        "1969-12-31T23:59:59.999Z",
    ] {
        assert_eq!(from_iso_8601(text), None, "{text}");
    }
    let time = UNIX_EPOCH + Duration::from_millis(1_576_398_600_123);
    assert_eq!(from_iso_8601("2019-12-15T08:30:00.123Z"), Some(time));
}

#[test]
fn day_month_and_year_without_anything_between() {
    // date -u -d @1576398600 +%d%m%Y%H%M
    assert_eq!(day_month_year(UNIX_EPOCH + Duration::from_secs(1_576_398_600)), "151220190830");
}
