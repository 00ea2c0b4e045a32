use super::*;

fn paper() -> Mesh {
    Mesh::new(80, 2764, 161, 20e-3, 24e-3).unwrap()
}

#[test]
fn cells_tile_the_annulus() {
    // Closed form: the cells add up to π (r_outer² − r_inner²), for the midpoint rule is exact for r dr.
    let mesh = paper();
    let annulus = std::f64::consts::PI * (24e-3_f64.powi(2) - 20e-3_f64.powi(2));
    assert!((mesh.disc_area() / annulus - 1.0).abs() < 1e-13);
    assert!((mesh.row_height() - 50e-6).abs() < 1e-18);
}

#[test]
fn a_disc_cell_enters_at_the_leading_edge_and_moves_toward_plus_j() {
    let mesh = paper();
    assert_eq!(mesh.disc_column(0, 0), 0);
    assert_eq!(mesh.disc_column(0, 1), 2763);
    for step in [0, 1, 160, 2763, 2764, 1_000_003] {
        for column in 0..160 {
            assert_eq!(mesh.disc_column(column, step), mesh.disc_column(column + 1, step + 1));
        }
    }
}

#[test]
fn a_round_pin_has_the_area_of_its_circle() {
    // π R² to the count of centres: in a convex shape it misses the area by less than the perimeter times half a cell's
    // diagonal. Arcs at their own radius keep areas: ∬ r dφ dr = ∬ ds dr.
    for (cells, radius) in [(20, 0.9e-3), (80, 2e-3), (160, 4e-3), (161, 3.99e-3)] {
        let columns = 4 * cells;
        let mesh = Mesh::new(cells, (columns as f64 * 17.0) as usize, columns, 18e-3, 26e-3).unwrap();
        let mesh = mesh.with_outline(Outline::Disc { radius }).unwrap();
        let diagonal = mesh.row_height().hypot(mesh.column_width() * 26.0 / 22.0);
        let error = (mesh.pin_area() - std::f64::consts::PI * radius * radius).abs();
        assert!(error < TAU * radius * 0.5 * diagonal, "{error}");
        // The same by the definition, cell by cell.
        let area: f64 = mesh.pin_areas().sum();
        assert!((area / mesh.pin_area() - 1.0).abs() < 1e-12);
        assert_eq!(mesh.pin_areas().filter(|area| *area > 0.0).count(), mesh.present_cells());
        assert_eq!(mesh.absent_cells().count() + mesh.present_cells(), mesh.pin_cells());
    }
}

#[test]
fn refuses_a_round_pin_that_does_not_fit() {
    let of = |pin_columns: usize, radius: f64| {
        let mesh = Mesh::new(80, 2764, pin_columns, 20e-3, 24e-3).unwrap();
        mesh.with_outline(Outline::Disc { radius }).map(|mesh| mesh.present_cells())
    };
    assert!(of(80, 2e-3).is_ok());
    assert!(matches!(of(78, 2e-3), Err(MeshError::RoundPinLongerThanColumns { pin_columns: 78, .. })));
    assert!(matches!(of(161, 2.001e-3), Err(MeshError::RoundPinWiderThanTrack { .. })));
    // Four centres lie nearest to the middle where both counts are even.
    assert_eq!(of(80, 36e-6), Ok(4));
    assert_eq!(of(80, 35e-6), Err(MeshError::RoundPinWithoutCells { diameter: 70e-6 }));
}

#[test]
fn refuses_what_is_no_ring() {
    assert!(matches!(Mesh::new(0, 10, 5, 1.0, 2.0), Err(MeshError::Empty { name: "rows" })));
    assert!(matches!(Mesh::new(1, 10, 11, 1.0, 2.0), Err(MeshError::PinWiderThanRing { .. })));
    assert!(matches!(Mesh::new(1, 10, 5, 2.0, 1.0), Err(MeshError::Radii { .. })));
    assert!(matches!(Mesh::new(1, 10, 5, f64::NAN, 1.0), Err(MeshError::Radii { .. })));
    assert!(matches!(Mesh::new((1 << 22) + 1, 10, 5, 1.0, 2.0), Err(MeshError::TooMany { name: "rows", .. })));
    assert!(matches!(Mesh::new(1, (1 << 24) + 1, 5, 1.0, 2.0), Err(MeshError::TooMany { name: "disc_columns", .. })));
}

#[test]
fn a_circle_has_as_many_columns_as_its_longest_arc() {
    // The longest arc by trying every radius, where the closed form is the function's own.
    for (radius, mean) in [(5e-3, 22e-3), (1e-3, 22e-3), (20e-3, 22e-3)] {
        let angle: f64 = 1e-4;
        let half = |r: f64| (radius * radius - (r - mean) * (r - mean)).max(0.0).sqrt() / r;
        let longest = (0..=100_000).map(|place| half(mean - radius + 2.0 * radius * f64::from(place) / 1e5));
        let longest = 2.0 * longest.fold(0.0, f64::max) / angle;
        let columns = columns_of_disc(radius, mean, angle).unwrap();
        assert!((columns - longest).abs() <= 0.5 + 1e-4 * longest, "{columns} of {longest}");
    }
    assert_eq!(columns_of_disc(22e-3, 22e-3, 1e-3), None);
}

#[test]
fn chords_are_symmetric_and_those_that_go_beyond_the_columns_are_none() {
    let disc = Outline::Disc { radius: 2.4 };
    // Columns of one metre at a radius of 1000 m: centres at ±0.5, ±1.5, ±2.5 or at 0, ±1, ±2, ±3 m.
    let chord = |columns, across| disc.chord(columns, 1e-3, 1e3, across);
    assert_eq!(chord(6, 0.0), Some(1..5));
    assert_eq!(chord(7, 0.0), Some(1..6));
    assert_eq!(chord(7, 2.3), Some(3..4));
    assert_eq!(chord(6, 2.39), Some(0..0));
    assert_eq!(chord(7, 2.5), Some(0..0));
    assert_eq!(chord(5, 0.0), Some(0..5));
    assert_eq!(chord(3, 0.0), None);
    assert_eq!(Outline::Rectangle.chord(3, 1e-3, 1e3, 0.0), Some(0..3));
}
