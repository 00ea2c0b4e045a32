//! The fitted model as an equation, in coded units or in those of the factors.

use std::collections::BTreeMap;

use super::factor::FactorKind;
use super::regressors::Coding;
use super::result::Effects;

/// A sum that is smaller than this part of the sizes of what was added up is rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Most terms of an equation: longer ones nobody reads, and full models of many factors have millions.
const MOST_TERMS: usize = 4096;

/// A sum of products.
#[derive(Debug, Clone, PartialEq)]
pub struct Equation {
    /// The terms, the constant first, products of few variables before those of many.
    pub terms: Vec<EquationTerm>,
}

/// A product in it.
#[derive(Debug, Clone, PartialEq)]
pub struct EquationTerm {
    /// What the product of the variables is multiplied by.
    pub coefficient: f64,
    /// The variables; a square has one twice, the constant none.
    pub variables: Vec<Variable>,
}

/// What a term depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Variable {
    /// The value of a factor.
    Number {
        /// Which factor.
        factor: usize,
    },
    /// 1 where a factor has this level, else 0. Over the levels of a factor the coefficients add up to zero.
    Level {
        /// Which factor.
        factor: usize,
        /// Which level.
        level: usize,
    },
}

/// Terms while they are added up.
type Terms = BTreeMap<(usize, Vec<Variable>), Sum>;

/// A coefficient while it is added up.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    value: f64,
    /// Sum of the sizes of what was added.
    size: f64,
}

impl Sum {
    fn add(&mut self, value: f64) {
        self.value += value;
        self.size += value.abs();
    }

    /// The sum; 0 where that is all but rounding.
    fn coefficient(self) -> f64 {
        if self.value.abs() <= ROUNDING * self.size { 0.0 } else { self.value }
    }
}

impl Effects {
    /// The equation of the fit, averaged over blocks: in coded units, or where numeric factors have values between these ends,
    /// one pair for each factor (of others it does not matter). None if it has more than four thousand terms.
    pub fn equation(&self, ends: Option<&[[f64; 2]]>) -> Option<Equation> {
        let inner = &self.inner;
        let regressors = &inner.regressors;
        // What is smaller than the rounding of residuals is no coefficient.
        let fitted = |column: usize| {
            let coefficient = inner.fit.coefficient(column);
            if coefficient.abs() <= inner.rounding { 0.0 } else { coefficient }
        };
        let mut terms = Terms::new();
        let constant = inner.offset + inner.fit.coefficient(0);
        terms.entry((0, Vec::new())).or_default().add(if constant.abs() <= inner.rounding { 0.0 } else { constant });
        let widths = regressors.widths();
        let before = widths.len() - regressors.terms.len();
        let mut column: usize = widths[..before].iter().sum();
        for (parts, width) in regressors.terms.iter().zip(&widths[before..]) {
            let coefficients: Vec<f64> = (column..column + width).map(fitted).collect();
            column += width;
            let numbers: Vec<usize> = parts.iter().copied().filter(|factor| self.is_number(*factor)).collect();
            let classes: Vec<usize> = parts.iter().copied().filter(|factor| !self.is_number(*factor)).collect();
            for (levels, coefficient) in self.at_levels(&classes, &coefficients) {
                add(&mut terms, levels, &numbers, coefficient, ends);
                if terms.len() > MOST_TERMS {
                    return None;
                }
            }
        }
        let terms = terms.into_iter().map(|(key, sum)| (key, sum.coefficient()));
        let terms = terms.filter(|((count, _), coefficient)| *coefficient != 0.0 || *count == 0);
        let terms = terms.map(|((_, variables), coefficient)| EquationTerm { coefficient, variables });
        Some(Equation { terms: terms.collect() })
    }

    /// Whether a factor is a number in this model: a range, one between whose levels there are others, or two levels.
    fn is_number(&self, factor: usize) -> bool {
        match (&self.inner.regressors.codings()[factor], &self.inner.factors[factor].kind) {
            (Coding::Number, _) => true,
            (Coding::Classes(observed), FactorKind::Levels(values)) => observed.len() == 2 && values.len() == 2,
            _ => false,
        }
    }

    /// The coefficient at each combination of levels of some factors. Contrasts of the last factor vary fastest, as columns do.
    fn at_levels(&self, classes: &[usize], coefficients: &[f64]) -> Vec<(Vec<Variable>, f64)> {
        let mut found = vec![(Vec::new(), coefficients.to_vec())];
        for factor in classes {
            let Coding::Classes(levels) = &self.inner.regressors.codings()[*factor] else { continue };
            let contract = |(variables, coefficients): (Vec<Variable>, Vec<f64>)| {
                let inner = coefficients.len() / (levels.len() - 1).max(1);
                let of_level = move |level: &usize| {
                    let contrasts = Coding::contrasts(levels, *level).unwrap_or_default();
                    let sum = |at: usize| {
                        contrasts
                            .iter()
                            .enumerate()
                            .map(|(own, contrast)| contrast * coefficients[own * inner + at])
                            .sum()
                    };
                    let mut variables = variables.clone();
                    variables.push(Variable::Level { factor: *factor, level: *level });
                    (variables, (0..inner).map(sum).collect())
                };
                levels.iter().map(of_level).collect::<Vec<_>>()
            };
            found = found.into_iter().flat_map(contract).collect();
        }
        found.into_iter().filter_map(|(variables, coefficients)| Some((variables, *coefficients.first()?))).collect()
    }
}

/// Adds a product of numbers in coded units, or multiplied out in their own.
fn add(terms: &mut Terms, levels: Vec<Variable>, numbers: &[usize], coefficient: f64, ends: Option<&[[f64; 2]]>) {
    let mut products = vec![(levels, coefficient)];
    for factor in numbers {
        let number = Variable::Number { factor: *factor };
        // (v − middle)/half, with half of the range.
        let (slope, shift) = ends
            .and_then(|ends| ends.get(*factor))
            .map_or((1.0, 0.0), |[low, high]| (2.0 / (high - low), -(low + high) / (high - low)));
        let multiplied = |(variables, coefficient): (Vec<Variable>, f64)| {
            let with = [variables.as_slice(), &[number]].concat();
            [(with, coefficient * slope), (variables, coefficient * shift)]
        };
        products = products.into_iter().flat_map(multiplied).collect();
    }
    for (mut variables, coefficient) in products {
        variables.sort_unstable();
        terms.entry((variables.len(), variables)).or_default().add(coefficient);
    }
}
