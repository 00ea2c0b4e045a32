use super::*;
use crate::model::mesh::Outline;

#[test]
fn a_column_crosses_with_its_status() {
    let mesh = Mesh::new(11, 9, 3, 1.0, 2.0).unwrap();
    let heights: Vec<f64> = (0..33).map(f64::from).collect();
    let base = vec![Base::Resin; 33];
    let needs = Needs { distinct: false, breaks: false, disc_wears: false, forms: true, pools: false, transport: None };
    let mut from = PinStrips::new(&mesh, 0..11, &heights, &base, needs);
    let mut to = from.clone();
    let plateau = |row: usize| row.is_multiple_of(3);
    from.height.set_column(1, &[7.0; 11]);
    for row in (0..11).filter(|row| plateau(*row)) {
        from.strip_mut(row / LANES, 1, 1).plateau[0] |= 1 << (row % LANES);
    }
    let mut words = Vec::new();
    from.write_crossing(1, &mut words);
    assert_eq!(words.len(), PinStrips::crossing_words(11));
    to.read_crossing(1, &words);
    assert!(to.height.column(1).eq([7.0; 11]));
    assert!(to.substrate().column(1).eq((11..22).map(f64::from)));
    let statuses: Vec<bool> =
        (0..11).map(|row| to.strip_mut(row / LANES, 1, 1).plateau[0] >> (row % LANES) & 1 == 1).collect();
    assert_eq!(statuses, (0..11).map(plateau).collect::<Vec<_>>());
}

#[test]
fn a_column_without_build_up_crosses_without_substrate() {
    let mesh = Mesh::new(11, 9, 3, 1.0, 2.0).unwrap();
    let needs = Needs { distinct: false, breaks: false, disc_wears: false, forms: true, pools: false, transport: None };
    let heights: Vec<f64> = (0..33).map(f64::from).collect();
    let mut from = PinStrips::new(&mesh, 0..11, &heights, &[Base::Primary; 33], needs);
    let mut to = from.clone();
    // Worn, and without debris since: b_p is not followed up.
    from.height.set_column(1, &[50.0; 11]);
    // Build-up in the second strip.
    from.height.strip_mut(1)[1].0[2] = 20.0;
    let mut words = Vec::new();
    from.write_crossing(1, &mut words);
    assert_eq!(words.len(), PinStrips::crossing_words(11) - LANES);
    to.read_crossing(1, &words);
    assert!(to.height.column(1).eq(from.height.column(1)));
    assert!(to.substrate_column(1).eq(from.substrate_column(1)));
    assert!(to.substrate_column(1).eq([[50.0; 10].as_slice(), &[21.0]].concat()));
}

#[test]
fn the_cells_are_those_of_the_mesh_in_every_band_of_rows() {
    let mesh = Mesh::new(29, 600, 30, 20e-3, 23e-3).unwrap();
    let mesh = mesh.with_outline(Outline::Disc { radius: 1.5e-3 }).unwrap();
    for own in [0..29, 0..16, 16..29] {
        let presence = Presence::of(&mesh, own.clone()).unwrap();
        for (row, of_mesh) in own.clone().enumerate() {
            for column in 0..30 {
                let is_there = mesh.is_present(column * 29 + of_mesh);
                assert_eq!(presence.has(row, column), is_there);
                let some = presence.extent(row / LANES, &(0..30));
                assert!(some.contains(&column) || !is_there);
            }
        }
        for strip in 0..strips(own.len()) {
            let (some, of_all) = (presence.extent(strip, &(4..25)), presence.extent(strip, &(0..30)));
            assert_eq!([some.start, some.end], [of_all.start, of_all.end].map(|column| column.clamp(4, 25) - 4));
        }
    }
}

#[test]
fn a_rectangle_has_none() {
    let mesh = Mesh::new(29, 600, 30, 20e-3, 23e-3).unwrap();
    assert_eq!(Presence::of(&mesh, 0..29), None);
}
