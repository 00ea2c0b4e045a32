use super::*;

fn cells(shape: Shape, given: &[(&str, f64)]) -> Result<Cells, Refused> {
    let length = |name: &str| Ok(given.iter().find(|(key, _)| *key == name).map(|(_, value)| *value));
    let count = |name: &str| Ok(length(name)?.map(|number| number as u64));
    Cells::read(shape, length, count, |key| Refused { key, message: "missing".to_owned() }, |refused| refused)
}

fn lengths(shape: Shape, [width, length, cell, mean]: [f64; 4]) -> Result<Mesh, Refused> {
    let given = [("pin_width", width), ("cell_size", cell), ("mean_radius", mean), ("pin_length", length)];
    cells(shape, &given[..if length > 0.0 { 4 } else { 3 }])?.mesh()
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
    let round = |pin_diameter: f64| {
        let ring = [("inner_radius", 20e-3), ("outer_radius", 24e-3), ("rows", 80.0), ("disc_columns", 2764.0)];
        let pin = [("pin_columns", 161.0), ("pin_diameter", pin_diameter)];
        let pin = &pin[..if pin_diameter > 0.0 { 2 } else { 1 }];
        cells(Shape::Disc, &[&ring, pin].concat())?.mesh()
    };
    assert_eq!(round(0.0).unwrap_err().key, "shape");
    assert!(round(4e-3).is_ok());
    assert!(round(4.1e-3).unwrap_err().message.contains("expected at most 4 mm"));
    assert_eq!(round(1e-6).unwrap_err().key, "pin_diameter");
}
