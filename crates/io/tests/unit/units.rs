use proptest::prelude::*;

use super::Dimension::*;
use super::*;

#[test]
fn powers_of_ten_are_exact_and_other_factors_follow_their_definition() {
    // Expected: the literals, which rustc rounds to the nearest double.
    for (text, dimension, expected) in [
        ("50 um", Length, 5e-5),
        ("50 \u{b5}m", Length, 5e-5),
        ("50 \u{3bc}m", Length, 5e-5),
        ("0.3 um", Length, 3e-7),
        ("400um", Length, 4e-4),
        ("20 mm", Length, 0.02),
        ("7 nm", Length, 7e-9),
        ("-8 um", Length, -8e-6),
        ("47 N", Force, 47.0),
        ("0.047 kN", Force, 47.0),
        ("47000 mN", Force, 47.0),
        ("1e11 Pa", Pressure, 1e11),
        ("100 GPa", Pressure, 1e11),
        ("100 N/mm^2", Pressure, 1e8),
        ("1.5 bar", Pressure, 1.5e5),
        ("5e-14 1/Pa", SpecificWearRate, 5e-14),
        ("5e-14 m^2/N", SpecificWearRate, 5e-14),
        ("5e-14 m²/N", SpecificWearRate, 5e-14),
        ("5e-5 mm^3/(N m)", SpecificWearRate, 5e-14),
        ("5e-5 mm³/(N·m)", SpecificWearRate, 5e-14),
        ("5e-5 mm^3/N/m", SpecificWearRate, 5e-14),
        ("5e-5 mm3/Nm", SpecificWearRate, 5e-14),
        ("5e-5 mm^3 N^-1 m⁻¹", SpecificWearRate, 5e-14),
        ("0.05 1/TPa", SpecificWearRate, 5e-14),
        ("0 1/Pa", SpecificWearRate, 0.0),
        ("3000 s", Time, 3000.0),
        ("25.54 us", Time, 25.54e-6),
        ("2 m/s", Speed, 2.0),
        ("2e3 mm/s", Speed, 2.0),
        ("1E+2 rad/s", RotationalSpeed, 100.0),
        ("50 min", Time, 3000.0),
        ("2 h", Time, 7200.0),
        ("72 km/h", Speed, 20.0),
        ("850 rpm", RotationalSpeed, 850.0 * std::f64::consts::TAU / 60.0),
        ("850 rev/min", RotationalSpeed, 850.0 * std::f64::consts::TAU / 60.0),
        ("-90 deg", Angle, -std::f64::consts::FRAC_PI_2),
        ("0.25 rev", Angle, std::f64::consts::FRAC_PI_2),
        // An exponent beyond all doubles.
        ("1e-99999999999999999999 m", Length, 0.0),
    ] {
        assert_eq!(parse(text, dimension), Ok(expected), "{text}");
    }
    assert_eq!(parse("-0 m", Length).map(f64::to_bits), Ok(0));
}

#[test]
fn a_refusal_says_what_was_found_and_what_is_expected() {
    let of_force = ["47 mm", "47 kg", "47", "", "N", "nan N", "-inf N", "1e400 N", "1e99999999999999999999 N", "47 n"];
    let of_force = of_force.into_iter().chain(["47,5 N", "47 N/", "47 (N", "47 N)", "47 N^x", "1.2.3 N", "47 1"]);
    // Division takes one factor: this is mm³·m/N. A degree Celsius is no unit of anything else: 0 °C is no zero.
    let others =
        [("14 Hz", RotationalSpeed), ("5e-5 mm^3/N m", SpecificWearRate), ("1 W/degC", Cooling), ("23 J", Temperature)];
    let refused = of_force.map(|text| (text, Force)).chain(others);
    let said = refused.map(|(text, dimension)| parse(text, dimension).unwrap_err().to_string() + "\n");
    insta::assert_snapshot!(said.collect::<String>());
    let deep = format!("1 {}m", "(".repeat(1_000_000));
    assert!(parse(&deep, Length).unwrap_err().to_string().contains("this is not a unit"));
}

#[test]
fn temperatures_are_in_degrees_celsius_or_kelvins() {
    for (text, expected) in
        [("23 degC", 296.15), ("23 °C", 296.15), ("-40degC", 233.15), ("296.15 K", 296.15), ("1 mK", 1e-3)]
    {
        assert!((parse(text, Temperature).unwrap() - expected).abs() < 1e-13, "{text}");
    }
    for (text, dimension, expected) in [
        ("50 W/(m K)", ThermalConductivity, 50.0),
        ("0.5 W/(cm K)", ThermalConductivity, 50.0),
        ("7.2 g/cm^3", Density, 7200.0),
        ("500 J/(kg K)", SpecificHeat, 500.0),
        ("0.5 kJ/kg/K", SpecificHeat, 500.0),
        ("0.4 W/K", Cooling, 0.4),
        ("2 mJ/(K rad)", CoolingPerSpeed, 0.002),
        ("1e9 1/mg", NumberPerMass, 1e15),
    ] {
        assert!((parse(text, dimension).unwrap() / expected - 1.0).abs() < 1e-15, "{text}");
    }
}

#[test]
fn quantities_are_written_as_one_would() {
    for (value, unit, dimension, expected) in [
        (5e-5, "um", Length, "50 um"),
        (0.020300000000000002, "mm", Length, "20.300000000000002 mm"),
        (1e11, "Pa", Pressure, "1e11 Pa"),
        (5e-14, "1/Pa", SpecificWearRate, "5e-14 1/Pa"),
        (3000.0, "s", Time, "3000 s"),
        (0.001, "s", Time, "0.001 s"),
        (0.0, "um", Length, "0 um"),
        (-8e-6, "um", Length, "-8 um"),
        (850.0 * std::f64::consts::TAU / 60.0, "rpm", RotationalSpeed, "850 rpm"),
        (296.15, "degC", Temperature, "23 degC"),
        (273.15, "degC", Temperature, "0 degC"),
        (0.0031, "cm^2", Area, "31 cm^2"),
        (0.002, "J/(K rad)", CoolingPerSpeed, "0.002 J/(K rad)"),
    ] {
        assert_eq!(format(value, unit, dimension), expected);
    }
}

proptest! {
    #[test]
    fn what_is_written_reads_back_as_the_same_double(bits in any::<u64>(), which in 0_usize..10) {
        let value = f64::from_bits(bits);
        prop_assume!(value.is_finite());
        let (unit, dimension) = [
            ("um", Length), ("mm", Length), ("N", Force), ("GPa", Pressure), ("mm^3/(N m)", SpecificWearRate),
            ("min", Time), ("km/h", Speed), ("rpm", RotationalSpeed), ("degC", Temperature), ("1/kg", NumberPerMass),
        ][which];
        prop_assert_eq!(parse(&format(value, unit, dimension), dimension), Ok(value));
    }

    #[test]
    fn a_decimal_in_micrometres_is_the_literal(digits in 0_u64..1_000_000_000_000, places in 0_i32..12) {
        // Independent source: Rust's own correctly rounded reading of the same decimal, shifted by six places.
        let expected: f64 = format!("{digits}e{}", -places - 6).parse().unwrap();
        prop_assert_eq!(parse(&format!("{digits}e{} um", -places), Length), Ok(expected));
    }

    #[test]
    fn any_text_gets_an_answer(text in "\\PC*") {
        let _ = parse(&text, Length);
    }
}
