//! The figures of studies: what the factors do to each response.
//!
//! | figure | where |
//! |---|---|
//! | means at the levels of each factor | [`main_effects`] |
//! | means at pairs of levels | [`interactions`] |
//! | how far effects are beyond their error, sorted | [`pareto`] |
//! | effects as if they were nothing but error | [`half_normal`] |
//! | the response over two factors | [`response_surface`] |
//! | what the model leaves | [`residuals`] |
//!
//! What they have in common: a factor as an axis in [`factor_axis`], its levels in [`levels`], a response as one in [`value_axis`], a map over two factors in
//! [`factor_map`].

use std::ops::RangeInclusive;

use plateau_io::study::bounds::Bounds;
use plateau_study::design::Setting;
use plateau_study::effects::{Effects, Model, Transform};

use super::format::Figure;
use super::page::Page;
use crate::quantity::Unit;
use crate::study::analysis::{AnalysedResponse, Analysis};
use plateau_io::number;

mod factor_axis;
pub(super) mod factor_map;
mod half_normal;
mod interactions;
mod levels;
mod line_numbers;
mod main_effects;
mod pareto;
mod residuals;
mod response_surface;
mod value_axis;

pub use factor_axis::FactorAxis;

/// The figures of one response.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ResponseFigures {
    /// The figures.
    pub figures: Vec<Figure>,
    /// Which figures there are not, and why, in sentences.
    pub left_out: Vec<String>,
}

/// The figures of every response that was analysed; none of the others.
pub fn figures(analysis: &Analysis) -> Vec<ResponseFigures> {
    let axes = axes(analysis);
    let names = file_names(analysis.responses.iter().map(|response| response.name.as_str()));
    let responses = analysis.responses.iter().zip(names).map(|(response, name)| {
        let mut figures = ResponseFigures::default();
        if let Ok(effects) = &response.effects {
            let unit = response.unit_shown(effects);
            let subject = Subject { analysis, response, effects, unit, axes: &axes, name };
            main_effects::add(&subject, &mut figures);
            interactions::add(&subject, &mut figures);
            pareto::add(&subject, &mut figures);
            half_normal::add(&subject, &mut figures);
            response_surface::add(&subject, &mut figures);
            residuals::add(&subject, &mut figures);
        }
        figures
    });
    responses.collect()
}

/// The factors of a study as axes.
pub fn axes(analysis: &Analysis) -> Vec<FactorAxis<'_>> {
    let axis = |(at, factor)| FactorAxis::new(factor, analysis.runs.iter().map(move |(settings, _)| settings[at]));
    analysis.factors.iter().enumerate().map(axis).collect()
}

/// A response that figures are made of.
struct Subject<'a> {
    analysis: &'a Analysis,
    response: &'a AnalysedResponse,
    effects: &'a Effects,
    unit: Unit,
    /// The factors.
    axes: &'a [FactorAxis<'a>],
    /// What its files begin with.
    name: String,
}

impl Subject<'_> {
    /// What an axis of the response says.
    fn label(&self) -> String {
        self.unit.label(&self.response.title())
    }

    /// What can be shown: what the response can be, and what a transform can.
    fn bounds(&self) -> Bounds {
        match self.response.scale.transform() {
            None => self.response.bounds,
            Some(Transform::SquareRoot) => Bounds { least: 0.0, ..Bounds::NONE },
            Some(Transform::Logarithm | Transform::Logit) => Bounds::NONE,
        }
    }

    /// What the factors that are not shown are at: ranges in their middle, and averages over levels.
    fn held(&self, shown: &[usize], at: &str) -> String {
        let others = self.axes.iter().enumerate().filter(|(factor, _)| !shown.contains(factor)).map(|(_, axis)| axis);
        let is_number = |axis: &&FactorAxis<'_>| {
            axis.is_range() || (self.effects.model == Model::Quadratic && axis.factor.factor.is_numeric())
        };
        let (numbers, words): (Vec<_>, Vec<_>) = others.partition(is_number);
        let middle = |axis: &FactorAxis<'_>| format!("{} {}", axis.plain_name(), axis.name(Setting::Coded(0.0)));
        let numbers: Vec<String> = numbers.into_iter().map(middle).collect();
        let words: Vec<&str> = words.into_iter().map(FactorAxis::plain_name).collect();
        let mut parts = Vec::new();
        parts.extend((!numbers.is_empty()).then(|| format!("{at}: {}", numbers.join(", "))));
        parts.extend((!words.is_empty()).then(|| format!("averaged over {}", words.join(", "))));
        parts.join("; ")
    }

    /// The confidence level in per cent.
    fn confidence(&self) -> String {
        number::confidence(self.effects.confidence)
    }

    /// Adds a figure; `title` is what it shows of the response.
    fn add(&self, figures: &mut ResponseFigures, figure: &str, title: &str, caption: String, page: Page) {
        self.add_pages(figures, figure, title, caption, vec![page]);
    }

    /// Adds a figure on one page or several.
    fn add_pages(&self, figures: &mut ResponseFigures, figure: &str, title: &str, caption: String, pages: Vec<Page>) {
        let (name, title) = (format!("{}-{figure}", self.name), format!("{title} {}", self.response.title()));
        figures.figures.extend(Figure::of_pages(&name, &title, &caption, pages));
    }
}

/// What a caption says of intervals with these ends, in a unit, of a response with these bounds: that they are cut, if one is.
pub(super) fn said_of_cuts(bounds: Bounds, unit: &Unit, mut ends: impl Iterator<Item = f64>) -> &'static str {
    let cuts = [bounds.least, bounds.most].map(|bound| unit.value(bound));
    if ends.any(|end| cuts.contains(&end)) {
        " They end where a response cannot be: below 0, and above 1 of a fraction."
    } else {
        ""
    }
}

/// A range with a little room round values; any where there are none.
pub(super) fn range_of(values: impl Iterator<Item = f64>) -> RangeInclusive<f64> {
    let (low, high) = values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    let room = match high - low {
        length if length > 0.0 => 0.07 * length,
        0.0 => (0.1 * low.abs()).max(f64::MIN_POSITIVE.sqrt()),
        _ => return 0.0..=1.0,
    };
    low - room..=high + room
}

/// Longest name, in letters: with what is added to it, and in any letters, it is one that file systems take.
const LONGEST: usize = 40;

/// A name for each response, fit for a file and different from all others: `contact area` becomes `contact-area`.
pub fn file_names<'a>(responses: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for response in responses {
        let plain = plain(response);
        let numbered = (2..).map(|number| format!("{plain}-{number}"));
        let name = std::iter::once(plain.clone()).chain(numbered).find(|name| !names.contains(name));
        names.push(name.unwrap_or(plain));
    }
    names
}

/// Small letters and digits, with a hyphen for everything between them.
fn plain(name: &str) -> String {
    let letters: String = name.to_lowercase().chars().map(|c| if c.is_alphanumeric() { c } else { ' ' }).collect();
    let plain = letters.split_whitespace().collect::<Vec<_>>().join("-");
    let plain: String = plain.chars().take(LONGEST).collect();
    if plain.is_empty() { "response".to_owned() } else { plain.trim_end_matches('-').to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_fit_for_files_and_differ() {
        let responses = ["Contact area", "contact_area", "../a/b", "µ (mean)", "<script>", "?"];
        let expected = ["contact-area", "contact-area-2", "a-b", "µ-mean", "script", "response"];
        assert_eq!(file_names(responses.into_iter()), expected);
        assert_eq!(file_names(["x y ".repeat(99).as_str()].into_iter())[0].len(), 39);
    }
}
