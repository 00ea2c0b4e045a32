//! Regressors: settings as rows of a model matrix.

use nalgebra::DMatrix;

use super::error::EffectsError;
use super::factor::{Factor, FactorKind};
use super::model::{Model, Parts};
use super::observation::{Usable, count, key};
use crate::design::Setting;

/// How the settings of a factor become numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Coding {
    /// The levels that were observed, in ascending order. Contrasts sum to zero: the first has −1 in all of them, each
    /// other 1 in one of its own. So of two levels the first is −1 and the second 1.
    Classes(Vec<usize>),
    /// Coded units.
    Number,
}

impl Coding {
    fn new(factor: &Factor, observed: impl Iterator<Item = Setting>, model: Model) -> Self {
        let values = match &factor.kind {
            FactorKind::Categorical(_) => None,
            FactorKind::Range { .. } => return Coding::Number,
            FactorKind::Levels(_) if model == Model::Quadratic => return Coding::Number,
            FactorKind::Levels(values) => Some(values),
        };
        let mut levels: Vec<usize> = observed.map(|setting| key(setting) as usize).collect();
        levels.sort_unstable();
        levels.dedup();
        if let Some(values) = values {
            levels.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
        }
        Coding::Classes(levels)
    }

    fn width(&self) -> usize {
        match self {
            Coding::Classes(levels) => levels.len() - 1,
            Coding::Number => 1,
        }
    }

    /// The contrasts of a level; none if it was not observed.
    pub fn contrasts(levels: &[usize], level: usize) -> Option<Vec<f64>> {
        let position = levels.iter().position(|other| *other == level)?;
        let contrast = |own: usize| match position {
            0 => -1.0,
            _ => f64::from(u8::from(own == position)),
        };
        Some((1..levels.len()).map(contrast).collect())
    }
}

/// The regressors of a model.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Regressors {
    factors: Vec<Factor>,
    codings: Vec<Coding>,
    /// Contrasts of blocks.
    blocks: Option<Coding>,
    /// Terms but the mean and the blocks.
    pub terms: Vec<Parts>,
}

impl Regressors {
    /// Those of a model for these observations.
    pub fn new(factors: &[Factor], usable: &Usable, model: Model, blocks: bool) -> Result<Self, EffectsError> {
        let coding = |(index, factor): (usize, &Factor)| {
            Coding::new(factor, usable.settings.iter().map(|settings| settings[index]), model)
        };
        let codings: Vec<Coding> = factors.iter().enumerate().map(coding).collect();
        let widths: Vec<usize> = codings.iter().map(Coding::width).collect();
        let numeric: Vec<bool> = factors.iter().map(Factor::is_numeric).collect();
        let terms = model.terms(&widths, &numeric, usable.point_count())?;
        let count = count(&usable.blocks);
        let blocks = (blocks && count > 1).then(|| Coding::Classes((0..count).collect()));
        Ok(Self { factors: factors.to_vec(), codings, blocks, terms })
    }

    /// Keeps these terms; whether others were there.
    pub fn keep(&mut self, kept: &[Parts]) -> bool {
        let before = self.terms.len();
        self.terms.retain(|term| kept.contains(term));
        self.terms.len() < before
    }

    /// How the settings of each factor become numbers.
    pub fn codings(&self) -> &[Coding] {
        &self.codings
    }

    /// Whether there are blocks.
    pub fn has_blocks(&self) -> bool {
        self.blocks.is_some()
    }

    /// Whether interactions are all that a model without some of them leaves: no number has more than two values.
    pub fn leave_interactions_only(&self, usable: &Usable) -> bool {
        !(0..self.codings.len()).any(|factor| self.is_curved(factor, usable))
    }

    /// Whether a factor is a number here and was observed at more than two values, so that its square differs from the
    /// mean.
    pub fn is_curved(&self, factor: usize, usable: &Usable) -> bool {
        let mut keys: Vec<i64> = usable.settings.iter().map(|settings| key(settings[factor])).collect();
        keys.sort_unstable();
        keys.dedup();
        self.codings[factor] == Coding::Number && keys.len() > 2
    }

    /// Number of columns of the mean (1), of the blocks, if any, and of each term.
    pub fn widths(&self) -> Vec<usize> {
        let mut widths = vec![1];
        widths.extend(self.blocks.as_ref().map(Coding::width));
        let width = |parts: &Parts| parts.iter().map(|factor| self.codings[*factor].width()).product::<usize>();
        widths.extend(self.terms.iter().map(width));
        widths
    }

    /// The factors of a term of which more than one level was observed.
    pub fn varying(&self, parts: &Parts) -> Parts {
        parts.iter().copied().filter(|factor| self.codings[*factor].width() > 0).collect()
    }

    /// The label of a term.
    pub fn label(&self, parts: &Parts) -> String {
        let name = |factor: &usize| self.factors[*factor].name.as_str();
        match parts.as_slice() {
            [first, second] if first == second => format!("{}²", name(first)),
            parts => parts.iter().map(name).collect::<Vec<_>>().join(" × "),
        }
    }

    /// The numbers of a factor at a setting.
    fn numbers(&self, factor: usize, setting: Setting) -> Result<Vec<f64>, EffectsError> {
        let numbers = match (&self.codings[factor], setting) {
            (Coding::Number, Setting::Coded(coded)) if coded.is_finite() => Some(vec![coded]),
            (Coding::Number, _) => {
                self.factors[factor].coded(self.factors[factor].canonical(setting)?).map(|x| vec![x])
            }
            // Between two levels that are numbers the model is straight.
            (Coding::Classes(levels), Setting::Coded(coded)) if levels.len() == 2 && self.is_between(factor, coded) => {
                Some(vec![coded])
            }
            (Coding::Classes(levels), _) => {
                let canonical = self.factors[factor].canonical(setting)?;
                Coding::contrasts(levels, key(canonical) as usize)
            }
        };
        numbers.ok_or_else(|| EffectsError::Setting {
            factor: self.factors[factor].name.clone(),
            problem: "has no observation at this level".to_owned(),
        })
    }

    /// Whether a coded value is none of the two levels of a number.
    fn is_between(&self, factor: usize, coded: f64) -> bool {
        let has_two = matches!(&self.factors[factor].kind, FactorKind::Levels(values) if values.len() == 2);
        has_two && coded.is_finite() && coded.abs() != 1.0
    }

    /// The numbers of all factors, or 1 for numeric factors if their values do not matter.
    fn all_numbers(&self, settings: &[Setting], with_values: bool) -> Result<Vec<Vec<f64>>, EffectsError> {
        if settings.len() != self.factors.len() {
            return Err(EffectsError::Settings { found: settings.len(), expected: self.factors.len() });
        }
        let numbers = settings.iter().enumerate().map(|(factor, setting)| match self.codings[factor] {
            Coding::Number if !with_values => Ok(vec![1.0]),
            _ => self.numbers(factor, *setting),
        });
        numbers.collect()
    }

    /// The row of the model matrix at settings; without a block, that of the mean of all blocks.
    pub fn row(&self, settings: &[Setting], block: Option<usize>) -> Result<Vec<f64>, EffectsError> {
        Ok(self.products(&self.all_numbers(settings, true)?, block))
    }

    /// The row at settings of some factors. The others are at the mean of their levels, where all contrasts are zero, or
    /// at the middle of their range.
    pub fn row_at(&self, settings: &[Option<Setting>]) -> Result<Vec<f64>, EffectsError> {
        let numbers = settings.iter().enumerate().map(|(factor, setting)| match setting {
            Some(setting) => self.numbers(factor, *setting),
            None => Ok(vec![0.0; self.codings[factor].width()]),
        });
        Ok(self.products(&numbers.collect::<Result<Vec<_>, _>>()?, None))
    }

    /// The row with the numeric factors as 1: what the coefficients of their products are multiplied with at the
    /// categories of `settings`.
    pub fn row_of_categories(&self, settings: &[Setting]) -> Result<Vec<f64>, EffectsError> {
        Ok(self.products(&self.all_numbers(settings, false)?, None))
    }

    fn products(&self, numbers: &[Vec<f64>], block: Option<usize>) -> Vec<f64> {
        let mut row = vec![1.0];
        if let Some(Coding::Classes(levels)) = &self.blocks {
            let contrasts = block.and_then(|block| Coding::contrasts(levels, block));
            row.extend(contrasts.unwrap_or_else(|| vec![0.0; levels.len() - 1]));
        }
        for parts in &self.terms {
            let mut products = vec![1.0];
            for factor in parts {
                let own = &numbers[*factor];
                products = products.iter().flat_map(|product| own.iter().map(move |number| product * number)).collect();
            }
            row.extend(products);
        }
        row
    }

    /// The model matrix, one row for each observation.
    pub fn matrix(&self, usable: &Usable) -> Result<DMatrix<f64>, EffectsError> {
        let columns = self.widths().iter().sum();
        let mut matrix = DMatrix::zeros(usable.responses.len(), columns);
        for (index, (settings, block)) in usable.settings.iter().zip(&usable.blocks).enumerate() {
            let row = self.row(settings, Some(*block))?;
            matrix.row_mut(index).iter_mut().zip(row).for_each(|(entry, value)| *entry = value);
        }
        Ok(matrix)
    }
}
