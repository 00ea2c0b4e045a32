//! Factors as an analysis sees them.

use super::error::EffectsError;
use crate::design::Setting;

/// A factor of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor {
    /// Its name, as labels of terms show it.
    pub name: String,
    /// What its settings are.
    pub kind: FactorKind,
}

/// What the settings of a factor are.
#[derive(Debug, Clone, PartialEq)]
pub enum FactorKind {
    /// Labels of levels that have no order.
    Categorical(Vec<String>),
    /// Values of levels. Their means are compared like those of categories, so any dependence on the value is seen;
    /// a quadratic model takes the numbers.
    Levels(Vec<f64>),
    /// A range of values, on which the response depends linearly or, in a quadratic model, quadratically.
    Range {
        /// The lower end, −1 in coded units.
        low: f64,
        /// The upper end, 1 in coded units.
        high: f64,
    },
}

impl Factor {
    /// Checks that levels differ, at least two of them, and that values are numbers.
    pub(super) fn check(&self) -> Result<(), EffectsError> {
        let has_two = |values: &[f64]| values.iter().any(|value| *value != values[0]);
        let problem = match &self.kind {
            FactorKind::Categorical(labels) if labels.len() < 2 => "at least two levels are needed",
            FactorKind::Levels(values) if !values.iter().all(|value| value.is_finite()) => "levels must be finite",
            FactorKind::Levels(values) if !has_two(values) => "at least two different levels are needed",
            FactorKind::Range { low, high } if !(low.is_finite() && high.is_finite()) => "the range must be finite",
            FactorKind::Range { low, high } if low >= high => "the range must begin below its end",
            _ => return Ok(()),
        };
        Err(EffectsError::Factor { factor: self.name.clone(), problem })
    }

    /// The setting as a level, or for a range as a coded value.
    pub(super) fn canonical(&self, setting: Setting) -> Result<Setting, EffectsError> {
        let levels = self.levels();
        match (levels, setting) {
            (Some(count), Setting::Level(level)) if level < count => Ok(setting),
            (Some(2), Setting::Coded(-1.0)) => Ok(Setting::Level(0)),
            (Some(2), Setting::Coded(1.0)) => Ok(Setting::Level(1)),
            (None, Setting::Coded(value)) if value.is_finite() => Ok(Setting::Coded(value)),
            (levels, setting) => {
                let has = levels.map_or("a range".to_owned(), |count| format!("{count} levels"));
                let found = match setting {
                    Setting::Level(level) => format!("level number {level}, counted from 0"),
                    Setting::Coded(value) => format!("the coded value {value}"),
                };
                let problem = format!("has {has}, not {found}");
                Err(EffectsError::Setting { factor: self.name.clone(), problem })
            }
        }
    }

    /// Number of levels; none for ranges.
    fn levels(&self) -> Option<usize> {
        match &self.kind {
            FactorKind::Categorical(labels) => Some(labels.len()),
            FactorKind::Levels(values) => Some(values.len()),
            FactorKind::Range { .. } => None,
        }
    }

    /// Whether settings are numbers.
    pub fn is_numeric(&self) -> bool {
        !matches!(self.kind, FactorKind::Categorical(_))
    }

    /// The lower and the upper end of a numeric factor's values.
    pub fn range(&self) -> Option<[f64; 2]> {
        match &self.kind {
            FactorKind::Categorical(_) => None,
            FactorKind::Levels(values) => {
                let low = values.iter().copied().fold(f64::INFINITY, f64::min);
                Some([low, values.iter().copied().fold(f64::NEG_INFINITY, f64::max)])
            }
            FactorKind::Range { low, high } => Some([*low, *high]),
        }
    }

    /// The value of a setting in the factor's own unit; none for categories and for settings that the factor does not
    /// have.
    pub fn value(&self, setting: Setting) -> Option<f64> {
        match (&self.kind, self.canonical(setting).ok()?) {
            (FactorKind::Levels(values), Setting::Level(level)) => values.get(level).copied(),
            (FactorKind::Range { low, high }, Setting::Coded(coded)) => {
                Some(0.5 * ((1.0 - coded) * low + (1.0 + coded) * high))
            }
            _ => None,
        }
    }

    /// The setting of a numeric factor in coded units: −1 at the least value, 1 at the largest.
    pub fn coded(&self, setting: Setting) -> Option<f64> {
        let [low, high] = self.range()?;
        match self.canonical(setting).ok()? {
            Setting::Coded(coded) => Some(coded),
            Setting::Level(_) => {
                let value = self.value(setting)?;
                Some(((value - low) - (high - value)) / (high - low))
            }
        }
    }
}
