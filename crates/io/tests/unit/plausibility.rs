use super::*;

#[test]
fn numbers_have_four_digits_and_pressures_their_unit() {
    for (value, text) in [(0.0, "0"), (1.0, "1"), (2.94812, "2.948"), (123_456.0, "123500"), (5e-14, "5e-14")] {
        assert_eq!(number(value), text);
    }
    for (value, text) in [(0.5, "0.5 Pa"), (1e5, "100 kPa"), (1.4687e6, "1.469 MPa"), (1e11, "100 GPa")] {
        assert_eq!(pressure_in_words(value), text);
    }
    assert_eq!(pressure_in_words(2.5e16), "2.5e7 GPa");
}
