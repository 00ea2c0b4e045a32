//! What happened in the events of runs with a cycle, as tables.

use plateau_io::number;
use plateau_io::run_file::{ReadError, RunFile};

use super::html;
use crate::quantity::Unit;

/// A table for every run that has events; nothing where none has.
pub fn tables(runs: &[RunFile], labels: &[String]) -> Result<String, ReadError> {
    let mut text = String::new();
    for (run, label) in runs.iter().zip(labels) {
        let events = run.events()?;
        let count = events.first().map_or(0, |(_, values)| values.len());
        if count == 0 {
            continue;
        }
        let mut heads = vec!["Event".to_owned()];
        let mut columns = Vec::new();
        for (quantity, values) in &events {
            let largest = values.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::max);
            let unit = if quantity.unit == "rad s-1" { Unit::RPM } else { Unit::readable(quantity.unit, largest) };
            heads.push(html::capital(&unit.label(&words(quantity.name))));
            columns.push(values.iter().map(|value| number::short(unit.value(*value))).collect::<Vec<_>>());
        }
        let row = |event: usize| {
            let cells = columns.iter().map(|column| column[event].clone());
            std::iter::once((event + 1).to_string()).chain(cells).collect()
        };
        let rows: Vec<Vec<String>> = (0..count).map(row).collect();
        let label = format!("{label}: volumes, work, mass and particles are of the simulated pin");
        text.push_str(&html::number_table(&label, &heads, &rows));
    }
    Ok(text)
}

/// The name of a quantity of the events in words.
fn words(name: &str) -> String {
    name.replace('_', " ").replace("pm10", "PM10")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_are_called_as_people_call_them() {
        let heads = [("temperature_peak", "K", 420.0), ("work", "J", 1.2e3), ("pm10_mass", "kg", 3e-9)]
            .map(|(name, unit, largest)| html::capital(&Unit::readable(unit, largest).label(&words(name))));
        assert_eq!(heads, ["Temperature peak, °C", "Work, kJ", "PM10 mass, µg"]);
    }
}
