//! Predictions as a table in CSV: a line for each place, numbers in SI units as in results.csv.

use plateau_io::study::factor::Factor;
use plateau_io::study::imported::with_unit;
use plateau_io::study::level::Level;
use plateau_present::study::place::Place;
use plateau_study::surrogate::Forecast;

use super::analysed::Analysed;
use crate::csv_table::csv_table;
use crate::sweep::confirmation::Confirmed;

/// What stands behind the name of a response, for each of its columns.
const COLUMNS: [&str; 5] = ["", " mean low", " mean high", " run low", " run high"];
/// The same where extra runs were made; the number of runs has no unit.
const CONFIRMED: [&str; 3] = [" confirmed", " confirmed standard error", " confirmed runs"];

/// Head and lines. What extra runs gave is there for each place, or for none.
pub fn table(
    analysed: &Analysed,
    places: &[Place],
    forecasts: &[Vec<Option<Forecast>>],
    confirmed: &[Vec<Option<Confirmed>>],
) -> String {
    let (factors, responses) = (&analysed.plan.study().factors, &analysed.analysis.responses);
    let mut head: Vec<String> = factors.iter().map(|factor| with_unit(&factor.name, factor.unit())).collect();
    for response in responses {
        let named = |column: &&str| format!("{}{column}", response.name);
        head.extend(COLUMNS.iter().map(|column| with_unit(&named(column), response.unit)));
        if !confirmed.is_empty() {
            let [mean, error, runs] = CONFIRMED;
            head.extend([mean, error].iter().map(|column| with_unit(&named(column), response.unit)));
            head.push(named(&runs));
        }
    }
    head.push("beyond".to_owned());
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:?}"));
    let line = |(at, (place, forecasts)): (usize, (&Place, &Vec<Option<Forecast>>))| {
        let mut cells: Vec<String> = factors.iter().zip(&place.levels).map(cell).collect();
        for (response, forecast) in forecasts.iter().enumerate() {
            let of = |ends: fn(&Forecast) -> Option<[f64; 2]>| forecast.as_ref().and_then(ends);
            let (mean, run) = (of(|forecast| forecast.mean_interval), of(|forecast| forecast.run_interval));
            let ends = [mean, run].map(|interval| [interval.map(|ends| ends[0]), interval.map(|ends| ends[1])]);
            let values = [forecast.map(|forecast| forecast.value)].into_iter().chain(ends.into_iter().flatten());
            cells.extend(values.map(number));
            if let Some(confirmed) = confirmed.get(at) {
                let made = confirmed[response];
                cells.extend([made.map(|made| made.mean), made.and_then(|made| made.standard_error)].map(number));
                cells.push(made.map_or(0, |made| made.runs).to_string());
            }
        }
        cells.push(place.beyond.join("; "));
        cells
    };
    csv_table(std::iter::once(head).chain(places.iter().zip(forecasts).enumerate().map(line)))
}

/// A quantity as a number, all else as the study has it.
fn cell((factor, level): (&Factor, &Level)) -> String {
    let number = level.number.filter(|_| !["", "1"].contains(&factor.unit()));
    number.map_or_else(|| level.label.clone(), |number| format!("{number:?}"))
}
