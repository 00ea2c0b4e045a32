//! A factor as the analysis sees it: along a range, its logarithm, or level by level.

use plateau_io::study::factor::{Factor, Values};
use plateau_io::study::level::Level;
use plateau_study::design::Setting;
use plateau_study::effects::{self, FactorKind};

use super::reading::Reading;

/// Values up to which a number of a design has levels; with more it has a range.
const MOST_LEVELS: usize = 10;

/// What stands before the name of a factor whose logarithm is analysed.
pub const LOGARITHM: &str = "log₁₀ ";

/// A factor of an analysis.
#[derive(Debug, Clone, PartialEq)]
pub struct AnalysedFactor {
    /// As the analysis has it.
    pub factor: effects::Factor,
    /// Labels of its levels; empty for ranges.
    pub labels: Vec<String>,
    /// The unit in which the study states it.
    pub reading: Reading,
}

impl AnalysedFactor {
    /// As the levels of the study, and those that the runs have, make it.
    pub(super) fn of(factor: &Factor, found: &[Level]) -> Self {
        let stated: Vec<&Level> = match &factor.values {
            // One end may be zero, which is so in any unit.
            Values::Range { low, high, .. } => vec![high, low],
            Values::Levels(levels) => levels.iter().chain(found).collect(),
        };
        let logarithmic = matches!(factor.values, Values::Range { logarithmic: true, .. });
        let reading = Reading::of_factor(factor, stated, logarithmic);
        let range = |name: String, low: f64, high: f64| AnalysedFactor {
            factor: effects::Factor { name, kind: FactorKind::Range { low, high } },
            labels: Vec::new(),
            reading: reading.clone(),
        };
        let numbers = |levels: &[Level]| levels.iter().map(|level| level.number).collect::<Option<Vec<f64>>>();
        let is_table = matches!(&factor.values, Values::Levels(levels) if levels.is_empty());
        let listed = match &factor.values {
            Values::Range { low, high, logarithmic } => {
                let (low, high) = (low.number.unwrap_or(-1.0), high.number.unwrap_or(1.0));
                if *logarithmic {
                    return range(format!("{LOGARITHM}{}", factor.name), libm::log10(low), libm::log10(high));
                }
                return range(factor.name.clone(), low, high);
            }
            // What a table of one's own has.
            Values::Levels(levels) if levels.is_empty() => found,
            Values::Levels(levels) => levels,
        };
        let kind = match numbers(listed) {
            // Between two levels there are points of a response surface.
            Some(numbers) if numbers.len() == 2 && found.len() > 2 => {
                return range(factor.name.clone(), numbers[0], numbers[1]);
            }
            // A table has values where they are, such as the middle at centre points alone: compared one by one, levels could not be
            // told from those of other factors.
            Some(numbers) if numbers.len() > MOST_LEVELS || is_table && numbers.len() > 2 => {
                let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
                return range(factor.name.clone(), least, numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max));
            }
            Some(numbers) => FactorKind::Levels(numbers),
            None => FactorKind::Categorical(listed.iter().map(|level| level.label.clone()).collect()),
        };
        let labels = listed.iter().map(|level| level.label.clone()).collect();
        AnalysedFactor { factor: effects::Factor { name: factor.name.clone(), kind }, labels, reading }
    }

    /// Where a level of the study's factor lies along this one.
    pub(super) fn setting(&self, factor: &Factor, level: &Level) -> Setting {
        match self.factor.kind {
            FactorKind::Range { low, high } => {
                let coded = factor.coded(level);
                let of_table = || level.number.map(|value| (2.0 * value - (low + high)) / (high - low));
                Setting::Coded(coded.or_else(of_table).unwrap_or(0.0))
            }
            FactorKind::Levels(ref values) => {
                let labelled = self.labels.iter().position(|label| *label == level.label);
                Setting::Level(
                    labelled.or_else(|| values.iter().position(|value| Some(*value) == level.number)).unwrap_or(0),
                )
            }
            FactorKind::Categorical(_) => {
                Setting::Level(self.labels.iter().position(|label| *label == level.label).unwrap_or(0))
            }
        }
    }
}
