//! The series of a run as the page has them: with no more points than there are to see.

use plateau_io::run_file::{ReadError, RunFile, Series};

use crate::envelope::thin;
use crate::quantity::{self, Unit};

/// Points of a series on the page, at most.
pub const MOST_POINTS: usize = 1500;

/// A series: what it says in numbers, and its points for a chart.
#[derive(Debug, Clone)]
pub struct Recorded {
    /// Name in the run file.
    pub name: String,
    /// What it is, in words.
    pub long_name: String,
    /// The unit in which people read it.
    pub unit: Unit,
    /// The last value, SI; none without samples.
    pub last: Option<f64>,
    /// The value farthest from 0, SI; none without finite values.
    pub largest: Option<f64>,
    /// Which samples are on the page, in order.
    pub at: Vec<usize>,
    /// Their values, SI.
    pub values: Vec<f64>,
}

/// Every series of a run, in the order in which run files report them, with any others behind.
///
/// # Errors
/// [`ReadError::Damaged`].
pub fn recorded(run: &RunFile) -> Result<Vec<Recorded>, ReadError> {
    run.series().iter().filter_map(|series| read(run, series).transpose()).collect()
}

fn read(run: &RunFile, series: &Series) -> Result<Option<Recorded>, ReadError> {
    let Some(values) = run.values(&series.name)? else { return Ok(None) };
    let at = thin(&values, MOST_POINTS);
    let finite = values.iter().copied().filter(|value| value.is_finite());
    Ok(Some(Recorded {
        name: series.name.clone(),
        long_name: if series.long_name.is_empty() { series.name.clone() } else { series.long_name.clone() },
        unit: quantity::unit(series),
        last: values.last().copied(),
        largest: finite.max_by(|one, other| one.abs().total_cmp(&other.abs())),
        values: at.iter().map(|index| values[*index]).collect(),
        at,
    }))
}
