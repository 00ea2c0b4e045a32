//! Predictions as a table in CSV: a line for each place, numbers in SI units as in results.csv.

use plateau_io::study::factor::{Factor, Level};
use plateau_present::study::place::Place;
use plateau_study::surrogate::Forecast;

use super::analysed::Analysed;
use crate::csv_table::csv_table;

/// What stands behind the name of a response, for each of its columns.
const COLUMNS: [&str; 5] = ["", " mean low", " mean high", " run low", " run high"];

/// Head and lines.
pub fn table(analysed: &Analysed, places: &[Place], forecasts: &[Vec<Option<Forecast>>]) -> String {
    let (factors, responses) = (&analysed.plan.study().factors, &analysed.analysis.responses);
    let with_unit = |name: String, unit: &str| match unit {
        "" | "1" => name,
        unit => format!("{name} [{unit}]"),
    };
    let mut head: Vec<String> = factors.iter().map(|factor| with_unit(factor.name.clone(), factor.unit())).collect();
    for response in responses {
        head.extend(COLUMNS.iter().map(|column| with_unit(format!("{}{column}", response.name), response.unit)));
    }
    head.push("beyond".to_owned());
    let line = |(place, forecasts): (&Place, &Vec<Option<Forecast>>)| {
        let mut cells: Vec<String> = factors.iter().zip(&place.levels).map(cell).collect();
        for forecast in forecasts {
            let of = |ends: fn(&Forecast) -> Option<[f64; 2]>| forecast.as_ref().and_then(ends);
            let (mean, run) = (of(|forecast| forecast.mean_interval), of(|forecast| forecast.run_interval));
            let ends = [mean, run].map(|interval| [interval.map(|ends| ends[0]), interval.map(|ends| ends[1])]);
            let values = [forecast.map(|forecast| forecast.value)].into_iter().chain(ends.into_iter().flatten());
            cells.extend(values.map(|value| value.map_or_else(String::new, |value| format!("{value:?}"))));
        }
        cells.push(place.beyond.join("; "));
        cells
    };
    csv_table(std::iter::once(head).chain(places.iter().zip(forecasts).map(line)))
}

/// A quantity as a number, all else as the study has it.
fn cell((factor, level): (&Factor, &Level)) -> String {
    let number = level.number.filter(|_| !["", "1"].contains(&factor.unit()));
    number.map_or_else(|| level.label.clone(), |number| format!("{number:?}"))
}
