use super::*;

fn read_text(text: &str) -> Result<CycleTable, String> {
    read_with(text, &[])
}

fn read_with(text: &str, headers: &[(&str, &str)]) -> Result<CycleTable, String> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("stops.csv");
    std::fs::write(&path, text).unwrap();
    read(&path, headers, limits::ROWS)
        .map_err(|error| error.to_string().replace(&format!("{}/", directory.path().display()), ""))
}

fn lines(table: &CycleTable) -> Vec<usize> {
    let line = |place: &Origin| if let Origin::Place { line, .. } = place { *line } else { 0 };
    table.places.iter().map(line).collect()
}

#[test]
fn columns_have_units_of_their_own() {
    let table =
        read_text("# a stop\nTime [min], Nominal pressure [MPa], sliding_speed [km/h]\n0,1.5,36\n1,0,0\n").unwrap();
    assert_eq!(table.times, [0.0, 60.0]);
    assert_eq!(table.loads, Some((Load::NominalPressure, vec![1.5e6, 0.0])));
    assert_eq!(table.speeds, Some((DiscSpeed::Sliding, vec![10.0, 0.0])));
    assert_eq!((table.road_speeds.as_ref(), lines(&table)), (None, vec![3, 4]));
}

#[test]
fn the_table_is_the_same_in_every_encoding() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("stops.csv");
    let text = "sep=\t\r\n# 20 °C\r\ntime [s]\tnormal_force [N]\r\n0\t47,5\r\n0,25\t1e1\r\n";
    let utf16: Vec<u8> = std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    let windows: Vec<u8> = text.chars().map(|letter| letter as u8).collect();
    for content in [text.as_bytes(), &utf16, &windows, text.replace("\r\n", "\r").as_bytes()] {
        std::fs::write(&path, content).unwrap();
        let table = read(&path, &[], limits::ROWS).unwrap();
        assert_eq!((&table.times, lines(&table)), (&vec![0.0, 0.25], vec![4, 5]));
        assert_eq!((table.loads, table.speeds), (Some((Load::Force, vec![47.5, 10.0])), None));
    }
}

#[test]
fn more_rows_than_are_read_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("stops.csv");
    std::fs::write(&path, "time [s]\n\n0\n1\n2\n3\n").unwrap();
    assert_eq!(read(&path, &[], 4).unwrap().times, [0.0, 1.0, 2.0, 3.0]);
    let error = read(&path, &[], 3).unwrap_err().to_string();
    assert!(error.ends_with("stops.csv:6:1: more rows, expected at most 3"), "{error}");
}

#[test]
fn every_column_has_a_key_for_its_header() {
    let keys = crate::scene::schema::CYCLE_COLUMNS.iter().map(|key| key.trim_start_matches("cycle.columns."));
    assert_eq!(keys.collect::<Vec<_>>(), COLUMNS.map(|(name, ..)| name));
}

#[test]
fn a_logger_has_headers_and_times_of_its_own() {
    let text = "Uhrzeit;Tempo (km/h);Druck;Temp [degC]\n12:00:05,5;36;0,5;kalt\n12:01:00;18;10;warm\n";
    let headers = [("time", "Uhrzeit"), ("road_speed", "Tempo"), ("brake_pressure", "Druck [bar]")];
    let table = read_with(text, &headers).unwrap();
    assert_eq!((&table.times, table.start), (&vec![0.0, 54.5], 43_205.5));
    assert_eq!(table.road_speeds, Some(vec![10.0, 5.0]));
    assert_eq!(table.loads, Some((Load::BrakePressure, vec![5e4, 1e6])));
    assert_eq!(table.speeds, None);

    // Of two columns of a name the whole header chooses.
    let twice = "t [s],v [rpm],v [km/h]\n0,1,36\n1,1,0\n";
    let chosen = read_with(twice, &[("time", "t"), ("road_speed", "v [km/h]")]).unwrap();
    assert_eq!(chosen.road_speeds, Some(vec![10.0, 0.0]));
}

#[test]
fn times_of_a_clock_have_hours_minutes_and_seconds() {
    let times = |rows: &str| read_text(&format!("time [h:mm:ss],normal_force [N]\n{rows}")).map(|table| table.times);
    assert_eq!(times("0:00:00,1\n0:01:30.25,1\n100:00:00,1\n"), Ok(vec![0.0, 90.25, 360_000.0]));
    for wrong in
        ["1e308:00:00", "1.5:00:00", "0:60:00", "0:00:60", "1:30", "0:-1:00", "0:00:nan", "a:00:00", "::", "90"]
    {
        let error = times(&format!("{wrong},1\n")).unwrap_err();
        assert!(error.contains("expected a header such as time [s], or times as h:mm:ss"), "{wrong}: {error}");
    }
}
