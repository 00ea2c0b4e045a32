use super::*;

fn lengths(shape: Shape, [width, length, cell, mean]: [f64; 4]) -> Result<Mesh, Refused> {
    let pin_length = (length > 0.0).then_some(length);
    let size = Size::Lengths { pin_width: width, pin_length, cell_size: cell, mean_radius: mean };
    Geometry { size, shape }.cells()?.mesh()
}

#[test]
fn the_width_of_a_pin_is_kept_where_it_is_no_whole_number_of_cells() {
    let mesh = lengths(Shape::Rectangle, [4.02e-3, 8e-3, 50e-6, 22e-3]).unwrap();
    assert_eq!(mesh.rows(), 80);
    assert!((mesh.row_height() * 80.0 - 4.02e-3).abs() < 1e-17);
}

#[test]
fn what_does_not_fit_is_refused_in_the_words_of_its_keys() {
    let key = |shape, numbers| lengths(shape, numbers).unwrap_err().key;
    assert_eq!(key(Shape::Rectangle, [44e-3, 8e-3, 50e-6, 22e-3]), "pin_width");
    assert_eq!(key(Shape::Rectangle, [4e-3, 0.2, 50e-6, 22e-3]), "pin_length");
    assert_eq!(key(Shape::Rectangle, [4e-3, 0.0, 50e-6, 22e-3]), "pin_width");
    // Its arc at the inner radius goes round.
    assert_eq!(key(Shape::Disc, [43.9e-3, 0.0, 50e-6, 22e-3]), "pin_width");
    let size =
        Size::Cells { inner: 20e-3, outer: 24e-3, rows: 80, disc_columns: 2764, pin_columns: 161, pin_diameter: None };
    assert_eq!(Geometry { size, shape: Shape::Disc }.cells().unwrap_err().key, "shape");
    let round = |pin_diameter: f64| {
        let Size::Cells { inner, outer, rows, disc_columns, pin_columns, .. } = size else { unreachable!() };
        let size = Size::Cells { inner, outer, rows, disc_columns, pin_columns, pin_diameter: Some(pin_diameter) };
        Geometry { size, shape: Shape::Disc }.cells().unwrap().mesh()
    };
    assert!(round(4e-3).is_ok());
    assert!(round(4.1e-3).unwrap_err().message.contains("expected at most 4 mm"));
    assert_eq!(round(1e-6).unwrap_err().key, "pin_diameter");
}
