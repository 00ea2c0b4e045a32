//! Settings of factors as the coordinates of a Gaussian process.

use std::collections::BTreeSet;

use super::kernel::Axis;
use crate::design::Setting;
use crate::effects::{EffectsError, Factor, FactorKind};

/// What the factors are to a Gaussian process: numbers from −1 to 1, and categories by the number of their level.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Inputs {
    factors: Vec<Factor>,
    pub axes: Vec<Axis>,
    /// Levels of each category that were observed; nothing of numbers.
    seen: Vec<BTreeSet<usize>>,
}

impl Inputs {
    /// Those of factors, of which nothing was observed yet.
    pub fn new(factors: &[Factor]) -> Self {
        let axis = |factor: &Factor| if factor.is_numeric() { Axis::Number } else { Axis::Category };
        let axes: Vec<Axis> = factors.iter().map(axis).collect();
        Self { factors: factors.to_vec(), seen: vec![BTreeSet::new(); axes.len()], axes }
    }

    /// The coordinates of settings that were observed.
    pub fn observe(&mut self, settings: &[Setting]) -> Result<Vec<f64>, EffectsError> {
        let point = self.coordinates(settings)?;
        for (at, coordinate) in point.iter().enumerate().filter(|(at, _)| self.axes[*at] == Axis::Category) {
            self.seen[at].insert(*coordinate as usize);
        }
        Ok(point)
    }

    /// The coordinates of settings to forecast.
    pub fn point(&self, settings: &[Setting]) -> Result<Vec<f64>, EffectsError> {
        let point = self.coordinates(settings)?;
        for (at, factor) in self.factors.iter().enumerate().filter(|(at, _)| self.axes[*at] == Axis::Category) {
            if !self.seen[at].contains(&(point[at] as usize)) {
                let problem = format!("was never observed at level number {}, counted from 0", point[at]);
                return Err(EffectsError::Setting { factor: factor.name.clone(), problem });
            }
        }
        Ok(point)
    }

    fn coordinates(&self, settings: &[Setting]) -> Result<Vec<f64>, EffectsError> {
        if settings.len() != self.factors.len() {
            return Err(EffectsError::Settings { found: settings.len(), expected: self.factors.len() });
        }
        self.factors.iter().zip(settings).map(|(factor, setting)| coordinate(factor, *setting)).collect()
    }
}

/// The coordinate of a setting. Numbers between the levels of a numeric factor are taken, too.
fn coordinate(factor: &Factor, setting: Setting) -> Result<f64, EffectsError> {
    let found = match (&factor.kind, setting) {
        (FactorKind::Categorical(labels), Setting::Level(level)) if level < labels.len() => Some(level as f64),
        (FactorKind::Categorical(labels), Setting::Coded(coded)) if labels.len() == 2 && coded.abs() == 1.0 => {
            Some(0.5 * (coded + 1.0))
        }
        (FactorKind::Categorical(_), _) => None,
        (_, Setting::Coded(coded)) => Some(coded).filter(|coded| coded.is_finite()),
        (_, Setting::Level(_)) => factor.coded(setting),
    };
    found.ok_or_else(|| {
        let problem = match setting {
            Setting::Level(level) => format!("has no level number {level}, counted from 0"),
            Setting::Coded(coded) => format!("has nothing at the coded value {coded}"),
        };
        EffectsError::Setting { factor: factor.name.clone(), problem }
    })
}
