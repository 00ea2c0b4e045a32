//! What is kept of a run: how it ended and its series.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::read::{DeflateDecoder, DeflateEncoder};
use plateau_core::observe::event::event_quantity;
use plateau_core::observe::{EXTRAS, quantities};
use serde::{Deserialize, Serialize};
use std::io::Read;

use super::identity::Identity;
use crate::limits;

/// A run that has ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// What was run: the name of [`of`](Self::of).
    pub identity: String,
    /// The same in parts, by which it can be told why another run is not this one.
    #[serde(default)]
    pub of: Identity,
    /// Number of the run in the study, from 1; for people.
    pub run: usize,
    /// How it ended.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// Wall time, s.
    pub wall_time: f64,
    /// The machine.
    pub host: String,
    /// When it ended.
    pub end_time: String,
}

/// How a run ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "state", rename_all = "lowercase")]
pub enum Outcome {
    /// All steps were taken.
    Finished {
        /// How many.
        steps: u64,
        /// The time, s, until which it was to go on: the last step ends there, or less than a step before or behind it.
        #[serde(default)]
        until: f64,
        /// The series.
        series: Packed,
        /// What is reported of the events of its cycle, one value for each event.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        events: Option<Packed>,
        /// Time of a pulse of its contact area, s, at least; none where nothing pulses at constant load and speed.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pulse_time: Option<f64>,
    },
    /// It could not begin or go on.
    Failed {
        /// Why.
        error: String,
    },
}

impl Outcome {
    /// The series of a run that has finished; none of one that failed, and none where it does not hold what it says.
    pub fn series(&self) -> Option<Series> {
        let Self::Finished { until, series, events, pulse_time, .. } = self else { return None };
        let series = Series { pulse_time: *pulse_time, ..series.unpack()?.that_ended(*until) };
        match events {
            Some(events) => Some(series.with_events(events.unpack()?)),
            None => Some(series),
        }
    }
}

/// Name of a column of [`Series`] that is none of the run file: simulated revolutions since t = 0.
pub const REVOLUTIONS: &str = "simulated_revolutions";

/// Name of the series of the time in contact, which runs with a cycle have.
pub const CONTACT_TIME: &str = "contact_time";

/// The series of a run: equally long columns, time being the first.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Series {
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
    /// Quantities of the events of the run, by their names.
    events: Vec<(String, Vec<f64>)>,
    /// The time, s, until which the run was to go on; 0 where nobody has said.
    until: f64,
    /// Time of a pulse of its contact area, s, at least, if that is known.
    pulse_time: Option<f64>,
}

/// How the dataset of a quantity of events begins, as against that of a series.
pub const EVENT: &str = "event/";

/// SI unit of a series, or of a quantity of events.
pub fn unit_of(series: &str) -> &'static str {
    if let Some(name) = series.strip_prefix(EVENT) {
        return event_quantity(name).map_or("1", |quantity| quantity.unit);
    }
    quantities(EXTRAS).find(|quantity| quantity.name == series).map_or("1", |quantity| quantity.unit)
}

impl Series {
    /// Columns and their names, `time` first.
    pub fn new(names: Vec<String>, columns: Vec<Vec<f64>>) -> Self {
        Self { names, columns, ..Self::default() }
    }

    /// Times of the samples, s.
    pub fn time(&self) -> &[f64] {
        self.columns.first().map_or(&[], Vec::as_slice)
    }

    /// A series.
    pub fn values(&self, name: &str) -> Option<&[f64]> {
        let column = self.names.iter().position(|known| known == name)?;
        self.columns.get(column).map(Vec::as_slice)
    }

    /// The same with what is reported of the events of the run: equally long columns of another length.
    pub fn with_events(self, events: Self) -> Self {
        Self { events: events.names.into_iter().zip(events.columns).collect(), ..self }
    }

    /// The same of a run that was to go on until a time, s.
    pub fn that_ended(self, until: f64) -> Self {
        Self { until, ..self }
    }

    /// The time, s, until which the run was to go on; 0 where nobody has said.
    pub fn until(&self) -> f64 {
        self.until
    }

    /// Time of a pulse of its contact area, s, at least, if that is known.
    pub fn pulse_time(&self) -> Option<f64> {
        self.pulse_time
    }

    /// A quantity of the events, one value for each.
    pub fn of_events(&self, name: &str) -> Option<&[f64]> {
        self.events.iter().find(|(known, _)| known == name).map(|(_, values)| values.as_slice())
    }

    /// Names of the columns, `time` first.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Packs the columns: every bit is kept.
    pub fn pack(&self) -> Packed {
        let values: Vec<[u8; 8]> = self.columns.iter().flatten().map(|value| value.to_le_bytes()).collect();
        // Bytes of equal weight side by side are more alike.
        let shuffled: Vec<u8> = (0..8).flat_map(|byte| values.iter().map(move |value| value[byte])).collect();
        let mut packed = Vec::new();
        // Reading from memory cannot fail.
        let _ = DeflateEncoder::new(shuffled.as_slice(), Compression::fast()).read_to_end(&mut packed);
        Packed { columns: self.names.clone(), samples: self.time().len(), data: STANDARD.encode(packed) }
    }
}

/// Series as they stand in a journal: all columns one after the other, the bytes of equal weight of all numbers (IEEE 754
/// binary64, the least first) side by side, deflated, in Base64.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Packed {
    columns: Vec<String>,
    samples: usize,
    data: String,
}

impl Packed {
    /// Names of the columns.
    pub fn names(&self) -> &[String] {
        &self.columns
    }

    /// The series; none if the text is not what [`Series::pack`] made.
    pub fn unpack(&self) -> Option<Series> {
        let count = self.columns.len().checked_mul(self.samples).filter(|count| *count <= limits::RECORD_NUMBERS)?;
        let bytes = count.checked_mul(8)?;
        let mut shuffled = Vec::new();
        let packed = STANDARD.decode(&self.data).ok()?;
        DeflateDecoder::new(packed.as_slice()).take(bytes as u64 + 1).read_to_end(&mut shuffled).ok()?;
        if shuffled.len() != bytes {
            return None;
        }
        let value = |at: usize| f64::from_le_bytes(std::array::from_fn(|byte| shuffled[byte * count + at]));
        let column = |column: usize| (0..self.samples).map(|sample| value(column * self.samples + sample)).collect();
        Some(Series::new(self.columns.clone(), (0..self.columns.len()).map(column).collect()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_comes_back() {
        let columns = vec![vec![1.0, 2.0, 3.0], vec![f64::NAN, -0.0, 1e-300]];
        let series = Series::new(vec!["time".into(), "pool".into()], columns);
        let back = series.pack().unpack().unwrap();
        let bits =
            |series: &Series| -> Vec<u64> { series.columns.iter().flatten().map(|value| value.to_bits()).collect() };
        assert_eq!(bits(&back), bits(&series));
        assert_eq!(back.names(), series.names());
    }

    #[test]
    fn a_record_tells_the_time_of_a_pulse() {
        let series = Series::new(vec!["time".into()], vec![vec![1.0]]).pack();
        let outcome = Outcome::Finished { steps: 1, until: 1.0, series, events: None, pulse_time: Some(24.9) };
        let back: Outcome = serde_json::from_str(&serde_json::to_string(&outcome).unwrap()).unwrap();
        assert_eq!(back.series().unwrap().pulse_time(), Some(24.9));
    }

    #[test]
    fn a_count_that_is_wrong_is_no_series() {
        let mut packed = Series::new(vec!["time".into()], vec![vec![1.0, 2.0]]).pack();
        packed.samples = 3;
        assert_eq!(packed.unpack(), None);
        packed.samples = usize::MAX;
        assert_eq!(packed.unpack(), None);
    }
}
