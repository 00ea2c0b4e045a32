//! How friction, heat and emission of runs ended, where any of them has those parts (model sections 10 to 12).

use super::html::capital;
use super::outcome::Measure;
use super::series::Recorded;
use crate::quantity::{SeriesLook, Unit};

/// Numbers besides those of every run: the same ones in the same order for every run, and none that no run has.
pub fn measures(runs: &[Vec<Recorded>]) -> Vec<Vec<Measure>> {
    let all: Vec<Vec<Measure>> = runs.iter().map(|series| of_run(series)).collect();
    let is_known = |index: usize| all.iter().any(|run| run[index].value.is_some());
    let known = |run: &Vec<Measure>| {
        let known = run.iter().enumerate().filter(|(index, _)| is_known(*index));
        known.map(|(_, measure)| measure.clone()).collect()
    };
    all.iter().map(known).collect()
}

/// All of them, of which a run may have none.
fn of_run(series: &[Recorded]) -> Vec<Measure> {
    let find = |name: &str| series.iter().find(|series| series.name == name);
    let last = |name: &str| find(name).and_then(|series| series.last).filter(|value| value.is_finite());
    let largest = |name: &str| find(name).and_then(|series| series.largest).map(f64::abs);
    let measure = |name: String, unit: Unit, value| Measure { name, unit, value, error: None };
    let at_end = |name: &'static str| {
        let SeriesLook { title, unit, .. } = SeriesLook::of(name);
        measure(capital(title), unit, last(name))
    };
    let at_most = |name: &'static str| {
        let SeriesLook { title, unit, .. } = SeriesLook::of(name);
        measure(format!("Largest {title}"), unit, largest(name))
    };
    let way = last("road_distance").filter(|way| *way > 0.0);
    let for_each_kilometre = |name: &'static str, unit| {
        let value = last(name).zip(way).map(|(amount, way)| amount / way);
        measure("– for each kilometre of road, of the simulated pin".to_owned(), unit, value)
    };
    vec![
        at_end("friction_coefficient_mean"),
        at_end("friction_work"),
        at_most("contact_temperature"),
        at_most("contact_temperature_max"),
        at_end("disc_temperature"),
        at_end("pin_temperature"),
        at_end("heat_lost"),
        at_most("heat_residual"),
        at_end("emitted_mass"),
        at_end("pm10_mass"),
        for_each_kilometre("pm10_mass", Unit::MG_PER_KM),
        at_end("pm25_mass"),
        for_each_kilometre("pm25_mass", Unit::MG_PER_KM),
        at_end("particle_number"),
        for_each_kilometre("particle_number", Unit::PER_KM),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recorded(name: &str, values: &[f64]) -> Recorded {
        Recorded {
            name: name.to_owned(),
            long_name: String::new(),
            unit: Unit::NUMBER,
            last: values.last().copied(),
            largest: values.iter().copied().filter(|value| value.is_finite()).reduce(f64::max),
            at: (0..values.len()).collect(),
            values: values.to_vec(),
        }
    }

    #[test]
    fn runs_without_these_parts_have_no_rows_of_them() {
        let plain = vec![recorded("contact_area", &[1e-6])];
        assert_eq!(measures(&[plain.clone(), plain.clone()]), [[], []]);
        let friction = vec![recorded("friction_work", &[500.0, 1500.0])];
        let rows = measures(&[plain, friction]);
        assert_eq!(rows.iter().map(|run| run[0].text()).collect::<Vec<_>>(), ["–", "1.5000 kJ"]);
    }

    #[test]
    fn numbers_are_those_at_the_end_or_the_largest() {
        let run = vec![
            // Lifted at the end.
            recorded("contact_temperature", &[373.15, f64::NAN]),
            recorded("pm10_mass", &[0.0, 1e-6]),
            recorded("particle_number", &[0.0, 1e9]),
            recorded("road_distance", &[0.0, 500.0]),
        ];
        let shown: Vec<(String, String)> =
            measures(&[run])[0].iter().map(|measure| (measure.name.clone(), measure.text())).collect();
        // By hand: 1 mg and a thousand million particles in half a kilometre.
        let expected = [
            ("Largest temperature of the contact", "100.00 °C"),
            ("Mass airborne as PM10, of the simulated pin", "1000.0 µg"),
            ("– for each kilometre of road, of the simulated pin", "2.0000 mg/km"),
            ("Airborne particles of the simulated pin", "1.0000e9"),
            ("– for each kilometre of road, of the simulated pin", "2.0000e9 km⁻¹"),
        ];
        assert_eq!(shown, expected.map(|(name, text)| (name.to_owned(), text.to_owned())));
    }
}
