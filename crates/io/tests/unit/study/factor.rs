use super::*;

#[test]
fn percent_and_the_minus_of_print_are_understood() {
    let fraction = Level::parse("pin.base.synthetic.fibre_fraction", "30%");
    assert_eq!((fraction.number, fraction.text.as_str()), (Some(0.3), "0.3"));
    assert_eq!(Level::parse("pin.base.synthetic.fibre_fraction", "30 %").number, Some(0.3));
    let rate = Level::parse("materials.pin_primary.specific_wear_rate", "5e\u{2212}14 1/Pa");
    assert_eq!(rate.number, Some(5e-14));
    // Without a key it is the unit in which the factor is stated.
    for text in ["30 %", "30%"] {
        let humidity = Level::parse("", text);
        assert_eq!((humidity.number, humidity.label.as_str()), (Some(30.0), "30 %"));
    }
    // Not of quantities: of what?
    assert_eq!(Level::parse("operation.normal_force", "30%").number, None);
}

fn factor(key: &str, ends: [&str; 2], logarithmic: bool) -> Factor {
    let level = |text: &str| Level::new(key, &format!("v = {text}").parse::<toml::Table>().unwrap()["v"]);
    let [low, high] = ends.map(level);
    let values = Values::Range { low, high, logarithmic };
    Factor { name: "f".into(), keys: vec![key.into()], stated_unit: String::new(), values }
}

/// A factor of a rig with these levels.
fn rig(levels: &[&str]) -> Factor {
    let level = |text: &&str| Level::new("", &toml::Value::String((*text).into()));
    let values = Values::Levels(levels.iter().map(level).collect());
    Factor { name: "f".into(), keys: Vec::new(), stated_unit: String::new(), values }
}

#[test]
fn values_between_are_in_the_unit_of_the_ends() {
    let load = factor("operation.normal_force", ["\"20 N\"", "\"60 N\""], false);
    let labels = [-1.0, 0.0, 0.5, 1.0].map(|coded| load.at(Setting::Coded(coded)).unwrap().label);
    assert_eq!(labels, ["20 N", "40 N", "50 N", "60 N"]);
    let fraction = factor("plateaus.captured_fraction", ["0.01", "1.0"], true);
    let middle = fraction.at(Setting::Coded(0.0)).unwrap();
    assert!((middle.number.unwrap() - 0.1).abs() < 1e-15);
    assert_eq!(load.at(Setting::Coded(0.5)).unwrap().number, Some(50.0));
}

#[test]
fn people_read_the_number_that_was_meant_and_runs_have_its_last_bit() {
    let fraction = factor("pin.base.synthetic.fibre_fraction", ["0.2", "0.4"], false);
    let middle = fraction.at(Setting::Coded(0.0)).unwrap();
    assert_eq!((middle.label.as_str(), middle.text.as_str()), ("0.3", "0.30000000000000004"));
    assert_eq!(middle.number, Some(0.2 + (0.4 - 0.2) * 0.5));
    let load = factor("operation.normal_force", ["\"0.2 kN\"", "\"0.4 kN\""], false);
    let middle = load.at(Setting::Coded(0.0)).unwrap();
    assert_eq!((middle.label.as_str(), middle.text.as_str()), ("0.3 kN", "\"0.30000000000000004 kN\""));
}

#[test]
fn a_factor_of_a_rig_has_the_unit_in_which_it_is_stated() {
    let level = |text: &str| Level::new("", &toml::Value::String(text.into()));
    let values = Values::Range { low: level("20 %RH"), high: level("60 %RH"), logarithmic: false };
    let humidity = Factor { name: "humidity".into(), keys: Vec::new(), stated_unit: "%RH".into(), values };
    assert_eq!(humidity.unit(), "%RH");
    let middle = humidity.at(Setting::Coded(0.0)).unwrap();
    assert_eq!((middle.label.as_str(), middle.number), ("40 %RH", Some(40.0)));
    assert_eq!(humidity.parse("30").label, "30 %RH");
    assert_eq!(humidity.parse("30 %RH").number, Some(30.0));
    assert_eq!(humidity.parse("30 g/kg").number, None);
    assert_eq!(Factor::in_another_unit(&[level("1 MPa"), level("2 MPa"), level("500 kPa")]), Some(&level("500 kPa")));
    assert_eq!(Factor::in_another_unit(&[level("supplier A"), level("supplier B")]), None);
}

#[test]
fn words_of_a_rig_are_words_whatever_they_look_like() {
    let level = |text: &str| Level::new("", &toml::Value::String(text.into()));
    let levels = ["nan", "inf", "1e3", "1000", "007", "7", "-", "=1+1", "30%", "\u{2212}5", "\"a\""];
    let grade = rig(&levels);
    assert_eq!(grade.unit(), "");
    for word in levels {
        assert_eq!(grade.parse(word), level(word));
        assert_eq!((level(word).label.as_str(), level(word).number), (word, None));
    }
    // Of a table, which has no quotes.
    let of_table = |text: &str| rig(&[]).parse(text).number;
    assert_eq!(["1e3", "-.5", "+2", "0", "0.5"].map(of_table), [1e3, -0.5, 2.0, 0.0, 0.5].map(Some));
    assert_eq!(["A", "inf", "nan", "1e400", "2b", "", "007", "-", "=1+1"].map(of_table), [None; 9]);
    assert_eq!(["1 N", "1e400 N", "07 N"].map(|text| level(text).number), [Some(1.0), None, None]);
}

#[test]
fn keys_that_hold_texts_have_no_numbers() {
    for (key, word) in [("disc.surface.file", "1e3"), ("title", "nan"), ("plateaus.debris", "007")] {
        let level = Level::parse(key, word);
        assert_eq!((level.text.as_str(), level.number), (format!("\"{word}\"").as_str(), None), "{key}");
        assert_eq!(Level::parse(key, &format!("\"{word}\"")), level);
    }
    assert_eq!(Level::parse("pin.base.synthetic.fibre_fraction", "nan").number, None);
}

#[test]
fn very_small_values_between_have_no_row_of_zeros() {
    let rate = factor("materials.pin_primary.specific_wear_rate", ["\"1e-14 1/Pa\"", "\"9e-14 1/Pa\""], false);
    assert_eq!(rate.at(Setting::Coded(0.0)).unwrap().label, "5e-14 1/Pa");
    assert_eq!(rate.at(Setting::Coded(0.0)).unwrap().number, Some(5e-14));
}

#[test]
fn settings_without_a_value_are_told_as_they_would_be_found() {
    let range = |ends, logarithmic| factor("contact.foundation_height", ends, logarithmic);
    for factor in [
        rig(&[]),
        rig(&["1 N"]),
        rig(&["1 N", "2 N"]),
        rig(&["1 N", "2 kN"]),
        rig(&["a", "b"]),
        rig(&["1 N", "2 N", "3 N"]),
        range(["\"50 um\"", "\"1 mm\""], false),
        range(["\"50 um\"", "\"60 um\""], true),
    ] {
        let has_value = factor.has_value();
        let coded = [-1.0, -0.5, 0.0, 1.0, 1.5].map(Setting::Coded);
        for setting in [0, 1, 2].map(Setting::Level).into_iter().chain(coded) {
            assert_eq!(has_value(setting), factor.at(setting).is_some(), "{factor} at {setting:?}");
        }
    }
}

#[test]
fn nothing_lies_between_two_units() {
    let height = factor("contact.foundation_height", ["\"50 um\"", "\"1 mm\""], false);
    assert_eq!(height.at(Setting::Coded(0.0)), None);
    assert_eq!(height.at(Setting::Coded(1.0)).unwrap().number, Some(1e-3));
    assert_eq!(height.unit(), "m");
}
