//! The fitted model as equations in words: in coded units and in those of the study.

use plateau_io::number;
use plateau_study::effects::{Effects, Equation, Variable};

use super::analysed_factor::AnalysedFactor;
use super::analysis::AnalysedResponse;
use crate::quantity::Unit;

/// Digits of coefficients: predictions with them have four at least.
const DIGITS: usize = 6;
/// Letters of a line.
const WIDTH: usize = 100;

/// The equation in coded units (−1 and 1 are the ends of a range), and in the units in which the study states its factors. None
/// where it is too long to be written.
pub fn equations(effects: &Effects, factors: &[AnalysedFactor]) -> Option<[Equation; 2]> {
    let ends = factors.iter().map(|factor| {
        let [low, high] = factor.factor.range().unwrap_or([-1.0, 1.0]);
        [low, high].map(|end| factor.reading.value(end))
    });
    let ends: Vec<[f64; 2]> = ends.collect();
    Some([effects.equation(None)?, effects.equation(Some(&ends))?])
}

/// What to say of both equations, and their lines, in the unit in which the response is shown.
pub fn paragraphs(
    response: &AnalysedResponse,
    effects: &Effects,
    factors: &[AnalysedFactor],
) -> Vec<(String, Vec<String>)> {
    let Some([coded, natural]) = equations(effects, factors) else { return Vec::new() };
    let unit = response.unit_shown(effects);
    let title = response.title();
    let title = if unit.symbol.is_empty() { title } else { format!("{title} [{}]", unit.symbol) };
    let is_level = |variable: &Variable| matches!(variable, Variable::Level { .. });
    let variables = || coded.terms.iter().flat_map(|term| &term.variables);
    let has_levels = variables().any(is_level);
    let levels = if has_levels { "; [factor level] is 1 at this level, else 0" } else { "" };
    let natural_lines = lines(&title, &natural, &unit, factors);
    if has_levels && variables().all(is_level) {
        // Levels have no units: both are the same.
        return vec![("by levels: [factor level] is 1 at this level, else 0".to_owned(), natural_lines)];
    }
    vec![
        (format!("in coded units, −1 to 1 over each range{levels}"), lines(&title, &coded, &unit, factors)),
        (format!("in the units of the study ({}){levels}", units(factors)), natural_lines),
    ]
}

/// The lines of an equation for what is called this; later lines are indented.
fn lines(title: &str, equation: &Equation, unit: &Unit, factors: &[AnalysedFactor]) -> Vec<String> {
    let mut lines = vec![format!("{title} =")];
    for (at, term) in equation.terms.iter().enumerate() {
        let sign = match (at, term.coefficient < 0.0) {
            (0, false) => "",
            (0, true) => "\u{2212}",
            (_, false) => "+ ",
            (_, true) => "\u{2212} ",
        };
        let coefficient = number::with_minus(&number::significant(unit.difference(term.coefficient).abs(), DIGITS));
        let product = product(&term.variables, factors);
        let piece = format!("{sign}{coefficient}{}{product}", if product.is_empty() { "" } else { " " });
        let last = lines.last_mut();
        match last.filter(|line| line.chars().count() + piece.chars().count() < WIDTH) {
            Some(line) => {
                line.push(' ');
                line.push_str(&piece);
            }
            None => lines.push(format!("  {piece}")),
        }
    }
    lines
}

/// What a coefficient is multiplied by, such as `load·speed`, `load²` or `load·[pool contact]`.
pub fn product(variables: &[Variable], factors: &[AnalysedFactor]) -> String {
    let mut parts: Vec<String> = Vec::new();
    for (at, variable) in variables.iter().enumerate() {
        if at > 0 && variables[at - 1] == *variable {
            if let Some(last) = parts.last_mut() {
                last.push('²');
            }
            continue;
        }
        parts.push(match *variable {
            Variable::Number { factor } => named(factors, factor),
            Variable::Level { factor, level } => {
                let label = factors.get(factor).and_then(|factor| factor.labels.get(level));
                format!("[{} {}]", named(factors, factor), label.map_or("", String::as_str))
            }
        });
    }
    parts.join("·")
}

fn named(factors: &[AnalysedFactor], factor: usize) -> String {
    factors.get(factor).map_or_else(String::new, |factor| factor.factor.name.clone())
}

/// What the numbers of the equation in the units of the study stand for: `load in N`.
fn units(factors: &[AnalysedFactor]) -> String {
    let numbers = factors.iter().filter(|factor| factor.factor.is_numeric()).map(|factor| {
        let unit = factor.reading.unit.as_str();
        if unit.is_empty() { factor.factor.name.clone() } else { format!("{} in {unit}", factor.factor.name) }
    });
    numbers.collect::<Vec<_>>().join(", ")
}
