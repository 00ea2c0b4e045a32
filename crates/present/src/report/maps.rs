//! The recorded maps of a run as the page has them.

use plateau_core::observe::Map;
use plateau_io::run_file::{ReadError, RunFile};
use serde::Serialize;

use super::pack::{self, Fineness, Quantised};
use super::reduction::{Blocks, Coarse, Reduction};
use crate::quantity::{MapLook, RobustRange, Unit};
use plateau_io::number;

/// A map with no more values than this, of all times, is told apart in two bytes.
const FINE_VALUES: usize = 400_000;

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
    pub unit: Unit,
    /// Times, s.
    pub times: Vec<f64>,
    /// Blocks along columns and rows.
    pub shape: [usize; 2],
    /// Cells of a block along columns and rows.
    pub block: [usize; 2],
    /// Per time, what its values are told from, SI ([`MapLook::zero`]), with the sign that they are shown with.
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
        let step = number::significant(self.unit.difference(step), 2);
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
        let height = read.iter().find(|read| Some(read.map) == MapLook::of(map).above);
        read.push(Recorded::read(run, map, &times, reduction.cells, height)?);
    }
    let seconds: Vec<f64> = times.iter().map(|index| run.map_time()[*index]).collect();
    Ok(read.iter().map(|recorded| recorded.on_page(&read, &seconds)).collect())
}

/// A map as it was recorded, by blocks.
struct Recorded {
    map: Map,
    blocks: Blocks,
    /// What values are told from, as they were recorded.
    reference: Vec<f64>,
    /// Heights, with the sign that they are shown with, and pressures less the reference, SI, time by time.
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
                    let own = || MapLook::of(map).zero(&values);
                    let reference = height.map_or_else(own, |height| height.reference[at]);
                    let sign = MapLook::of(map).sign();
                    recorded.values.extend(values.iter().map(|value| sign * (value - reference)));
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
        let surface = |map: Map| MapLook::of(map).above.unwrap_or(map);
        let alike = |other: &&Self| surface(other.map) == surface(self.map);
        let range = pack::range(all.iter().filter(alike).flat_map(|other| &other.values));
        let fineness = if self.values.len() <= FINE_VALUES { Fineness::Word } else { Fineness::Byte };
        Quantised::within(range, &self.values, fineness)
    }

    fn on_page(&self, all: &[Self], times: &[f64]) -> PageMap {
        let (look, quantised) = (MapLook::of(self.map), self.quantised(all));
        let height = all.iter().find(|other| Some(other.map) == look.above);
        let before = height.map_or_else(Vec::new, |height| height.quantised(all).codes);
        let cells = self.blocks.count();
        PageMap {
            name: self.map.name(),
            title: look.title,
            on_disc: self.map.on_disc(),
            is_status: self.map.is_status(),
            unit: look.unit.clone(),
            times: times.to_vec(),
            shape: self.blocks.shape(),
            block: self.blocks.size,
            reference: self.reference.iter().map(|reference| look.sign() * reference).collect(),
            range: quantised.range,
            steps: quantised.fineness.steps(),
            colours: colours(look, &self.values),
            told_from: height.map(|height| height.map.name()),
            codes: quantised.packed(cells, before.get(..cells).unwrap_or_default()),
        }
    }
}

/// Range of the colours of a map.
fn colours(look: &MapLook, values: &[f64]) -> [f64; 2] {
    let mut range = RobustRange::default();
    let coloured: Vec<f64> = values.iter().copied().filter(|value| look.is_coloured(*value)).collect();
    range.add(coloured.into_iter());
    look.ends(&mut range)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_leave_out_the_few() {
        let mut values: Vec<f64> = (0..1000).map(f64::from).collect();
        values.push(f64::NAN);
        // Five of a thousand at either end.
        let [pin, pressure] = [Map::PinHeight, Map::Pressure].map(MapLook::of);
        assert_eq!(colours(pin, &values), [5.0, 994.0]);
        assert_eq!(colours(pin, &[3.0]), [3.0, 3.0]);
        assert_eq!(colours(pressure, &[0.0, 0.0, 2.0, 3.0]), [0.0, 3.0]);
        assert_eq!(colours(pressure, &[0.0]), [0.0, 0.0]);
    }
}
