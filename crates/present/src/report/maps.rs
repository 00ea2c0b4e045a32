//! The recorded maps of a run as the page has them.

use plateau_core::observe::Map;
use plateau_io::run_file::{ReadError, RunFile};
use serde::Serialize;

use super::coarsen::{Blocks, Coarse};
use super::quantise::{self, Fineness, Quantised};
use super::reduction::Reduction;
use super::unit::ReadingUnit;
use crate::number;

/// A map with no more values than this, of all times, is told apart in two bytes.
const FINE_VALUES: usize = 400_000;
/// Fractions of the values that may lie below and above the colours.
const BEYOND_COLOURS: f64 = 0.005;

/// One map of a run at several times.
#[derive(Debug, Clone, Serialize)]
pub struct PageMap {
    /// Name in a scene.
    pub name: &'static str,
    /// Name for people.
    pub title: &'static str,
    /// Whether it covers the disc ring; else it covers the pin.
    pub on_disc: bool,
    /// Whether the codes are statuses.
    pub is_status: bool,
    /// The unit in which its values are read.
    pub unit: ReadingUnit,
    /// Times, s.
    pub times: Vec<f64>,
    /// Blocks along columns and rows.
    pub shape: [usize; 2],
    /// Cells of a block along columns and rows.
    pub block: [usize; 2],
    /// Per time, what its values are told from, SI: the pin wears by far more than it is rough, so its heights are told
    /// from their median; all else from 0.
    pub reference: Vec<f64>,
    /// Lowest and highest value less the reference, SI.
    pub range: [f64; 2],
    /// Steps between them; the code above stands for what is no number.
    pub steps: u16,
    /// Values, less the reference, of the first and the last colour, SI.
    pub colours: [f64; 2],
    /// The map from whose codes those of the first time are told.
    pub told_from: Option<&'static str>,
    /// Codes, time by time, column by column, packed ([`Quantised::packed`]).
    pub codes: String,
}

impl PageMap {
    /// Bytes that it takes on the page, about.
    pub fn size(&self) -> usize {
        self.codes.len() + 20 * self.times.len() + 400
    }

    /// Its name with the step that its values are rounded to.
    pub fn step_note(&self) -> String {
        let step = (self.range[1] - self.range[0]) / f64::from(self.steps);
        if step == 0.0 {
            return format!("{} not at all, being alike everywhere", self.name);
        }
        let step = number::significant(step * self.unit.scale, 2);
        format!("{} in steps of {}", self.name, self.unit.with_symbol(&step))
    }
}

/// Every map that a run recorded; none if it has no complete times.
///
/// # Errors
/// [`ReadError::Damaged`].
pub fn maps(run: &RunFile, reduction: Reduction) -> Result<Vec<PageMap>, ReadError> {
    let times = reduction.times_of(run.map_time().len());
    if times.is_empty() {
        return Ok(Vec::new());
    }
    let mut read: Vec<Recorded> = Vec::new();
    for map in Map::ALL.into_iter().filter(|map| run.has_map(*map)) {
        let height = read.iter().find(|read| Some(read.map) == height_above(map));
        read.push(Recorded::read(run, map, &times, reduction.cells, height)?);
    }
    let seconds: Vec<f64> = times.iter().map(|index| run.map_time()[*index]).collect();
    Ok(read.iter().map(|recorded| recorded.on_page(&read, &seconds)).collect())
}

/// The surface of the body of which a map shows the substrate: wherever there is no debris the two are alike.
fn height_above(map: Map) -> Option<Map> {
    match map {
        Map::DiscSubstrate => Some(Map::DiscHeight),
        Map::PinSubstrate => Some(Map::PinHeight),
        _ => None,
    }
}

/// A map as it was recorded, by blocks.
struct Recorded {
    map: Map,
    blocks: Blocks,
    /// See [`PageMap::reference`].
    reference: Vec<f64>,
    /// Heights and pressures less the reference, SI, time by time.
    values: Vec<f64>,
    /// Statuses, time by time.
    statuses: Vec<u8>,
}

impl Recorded {
    /// Reads a map; that of a substrate has the reference of the height above.
    fn read(run: &RunFile, map: Map, times: &[usize], most: usize, height: Option<&Self>) -> Result<Self, ReadError> {
        let mesh = run.mesh();
        let columns = if map.on_disc() { mesh.disc_columns() } else { mesh.pin_columns() };
        let blocks = Blocks::at_most(most, [columns, mesh.rows()], [mesh.column_width(), mesh.row_height()]);
        let mut recorded = Self { map, blocks, reference: Vec::new(), values: Vec::new(), statuses: Vec::new() };
        for (at, index) in times.iter().enumerate() {
            match run.map(map, *index)?.map(|values| blocks.coarsen(&values)) {
                Some(Coarse::Float(values)) => {
                    let own = || if is_pin_height(map) { median(&values) } else { 0.0 };
                    let reference = height.map_or_else(own, |height| height.reference[at]);
                    recorded.values.extend(values.iter().map(|value| value - reference));
                    recorded.reference.push(reference);
                }
                Some(Coarse::Status(codes)) => recorded.statuses.extend(codes),
                None => {}
            }
        }
        Ok(recorded)
    }

    /// Its codes: a substrate and the height above it have equal codes for equal heights.
    fn quantised(&self, all: &[Self]) -> Quantised {
        if self.map.is_status() {
            return Quantised::statuses(&self.statuses);
        }
        let surface = |map: Map| height_above(map).unwrap_or(map);
        let alike = |other: &&Self| surface(other.map) == surface(self.map);
        let range = quantise::range(all.iter().filter(alike).flat_map(|other| &other.values));
        let fineness = if self.values.len() <= FINE_VALUES { Fineness::Word } else { Fineness::Byte };
        Quantised::within(range, &self.values, fineness)
    }

    fn on_page(&self, all: &[Self], times: &[f64]) -> PageMap {
        let quantised = self.quantised(all);
        let height = all.iter().find(|other| Some(other.map) == height_above(self.map));
        let before = height.map_or_else(Vec::new, |height| height.quantised(all).codes);
        let cells = self.blocks.count();
        PageMap {
            name: self.map.name(),
            title: title(self.map),
            on_disc: self.map.on_disc(),
            is_status: self.map.is_status(),
            unit: unit(self.map),
            times: times.to_vec(),
            shape: self.blocks.shape(),
            block: self.blocks.size,
            reference: self.reference.clone(),
            range: quantised.range,
            steps: quantised.fineness.steps(),
            colours: colours(self.map, self.values.clone()),
            told_from: height.map(|height| height.map.name()),
            codes: quantised.packed(cells, before.get(..cells).unwrap_or_default()),
        }
    }
}

fn is_pin_height(map: Map) -> bool {
    matches!(map, Map::PinHeight | Map::PinSubstrate)
}

/// The value in the middle of those that are finite; 0 if there is none.
fn median(values: &[f64]) -> f64 {
    let mut finite: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    let middle = finite.len() / 2;
    if finite.is_empty() { 0.0 } else { *finite.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

/// Range of the colours: without the few values at both ends that would leave one colour for all others.
///
/// Pressures begin at 0, and the many cells without contact do not count.
fn colours(map: Map, mut values: Vec<f64>) -> [f64; 2] {
    let pressure = map == Map::Pressure;
    values.retain(|value| value.is_finite() && !(pressure && *value <= 0.0));
    if values.is_empty() {
        return [0.0; 2];
    }
    let beyond = (values.len() as f64 * BEYOND_COLOURS) as usize;
    let last = values.len() - 1;
    let mut order = |index: usize| *values.select_nth_unstable_by(index, f64::total_cmp).1;
    [if pressure { 0.0 } else { order(beyond) }, order(last - beyond)]
}

fn title(map: Map) -> &'static str {
    match map {
        Map::DiscHeight => "Disc: height, positive toward the pin",
        Map::DiscSubstrate => "Disc: height below the debris",
        Map::DiscStatus => "Disc: status",
        Map::PinHeight => "Pin: height, positive away from the disc",
        Map::PinSubstrate => "Pin: height below the debris, positive away from the disc",
        Map::PinStatus => "Pin: status",
        Map::Pressure => "Pin: contact pressure",
    }
}

fn unit(map: Map) -> ReadingUnit {
    match map {
        Map::DiscStatus | Map::PinStatus => ReadingUnit::NUMBER,
        Map::Pressure => ReadingUnit::PRESSURE,
        _ => ReadingUnit::HEIGHT,
    }
}

#[cfg(test)]
mod tests {
    use plateau_core::observe::Map;

    use super::{colours, median};

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!(median(&[9.0, f64::NAN, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[f64::INFINITY]), 0.0);
    }

    #[test]
    fn colours_leave_out_the_few() {
        let mut values: Vec<f64> = (0..1000).map(f64::from).collect();
        values.push(f64::NAN);
        // Five of a thousand at either end.
        assert_eq!(colours(Map::PinHeight, values.clone()), [5.0, 994.0]);
        assert_eq!(colours(Map::PinHeight, vec![3.0]), [3.0, 3.0]);
        assert_eq!(colours(Map::Pressure, vec![0.0, 0.0, 2.0, 3.0]), [0.0, 3.0]);
        assert_eq!(colours(Map::Pressure, vec![0.0]), [0.0, 0.0]);
    }
}
