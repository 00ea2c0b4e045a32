//! What the factors do to a response: table of variances, quality of the fit, figures.

use plateau_study::design::Setting;
use plateau_study::effects::{Effects, Nature, Squares, Term, Test};

use crate::figure::effects::FactorAxis;
use crate::quantity::Unit;
use crate::report::html::{self, capital};
use crate::report::picture::{Picture, Pictures};
use crate::study::analysed_factor::AnalysedFactor;
use crate::study::analysis::AnalysedResponse;
use crate::study::equation;
use crate::study::model::lack_of_fit;
use crate::study::words::{box_cox, curvature, fit, quality, selected};
use plateau_io::number;

/// Digits of numbers.
const DIGITS: usize = 4;
/// Probabilities below this are said to be less.
const LEAST_PROBABILITY: f64 = 1e-4;
/// Figures are made for two columns of a journal; here a wide one fills the page, and letters are as large in all.
const ENLARGED: f64 = 1.7;
/// Width, mm, from which on a figure is scrolled sideways on narrow screens.
const WIDE: f64 = 100.0;

const HINT: &str = "<p class=\"hint\">An effect is the change of the response from the lower to the upper end or level; of a \
    product, half the difference between one factor's effects at the ends of the other. The share is that of the sum of \
    squares. F compares a term with the error, and p is the probability of a larger F if there were no effect.</p>\n";

/// The section about a response.
pub fn html(response: &AnalysedResponse, axes: &[FactorAxis], pictures: &Pictures) -> String {
    let effects = match &response.effects {
        Ok(effects) => effects,
        Err(error) => return format!("<p class=\"notice\">{}</p>\n", html::escape(&capital(&error.to_string()))),
    };
    let unit = response.unit_shown(effects);
    let caption = format!("Analysis of variance of {}", response.title());
    let paragraph = |text: &str| format!("<p>{}.</p>\n", html::escape(&capital(text)));
    let mut text =
        paragraph(&fit(effects)) + &paragraph(&quality(effects, |value| unit.with_symbol(&rounded(unit.value(value)))));
    if response.scale.transform().is_some() {
        text.push_str(&paragraph(&format!("all results are those of {}", response.title())));
    }
    text.push_str(&paragraph(&response.model_words()));
    text.extend([selected(response), box_cox(response)].into_iter().flatten().map(|note| paragraph(&note)));
    if let Some(misfit) = &response.misfit {
        let misfit = capital(&lack_of_fit(misfit, effects.r_squared));
        text.push_str(&format!("<p class=\"notice\">{}.</p>\n", html::escape(&misfit)));
    }
    let curved = curvature(response, effects.confidence, |value| unit.with_symbol(&rounded(unit.difference(value))));
    text.extend(curved.map(|note| paragraph(&note)));
    text.push_str(&html::number_table(&caption, &heads(effects, &unit), &rows(effects, &unit)));
    text.push_str(HINT);
    let aliased = effects.rows().filter(|term| !term.aliased_with.is_empty());
    let aliased: Vec<String> =
        aliased.map(|term| format!("{} cannot be told from {}", term.label, term.aliased_with.join(", "))).collect();
    if !aliased.is_empty() {
        text.push_str(&html::list(&aliased));
    }
    text.push_str(&equations(response, effects, axes));
    if let Some(stationary) = stationary(effects, axes, &unit) {
        text.push_str(&format!("<p>{}</p>\n", html::escape(&stationary)));
    }
    text + &pictures.pictures.iter().map(figure).collect::<String>()
}

/// The fitted model in coded units and in those of the study.
fn equations(response: &AnalysedResponse, effects: &Effects, axes: &[FactorAxis]) -> String {
    let factors: Vec<AnalysedFactor> = axes.iter().map(|axis| axis.factor.clone()).collect();
    let title = response.scale.unit.label(&response.name);
    equation::paragraphs(response, effects, &factors)
        .into_iter()
        .map(|(heading, lines)| {
            let lines: Vec<String> = lines.iter().map(|line| html::escape(line)).collect();
            format!(
                "<p>{} {}:</p>\n<pre>{}</pre>\n",
                html::escape(&capital(&title)),
                html::escape(&heading),
                lines.join("\n")
            )
        })
        .collect()
}

fn rounded(value: f64) -> String {
    number::rounded(value, DIGITS)
}

fn heads(effects: &Effects, unit: &Unit) -> Vec<String> {
    let squared = if unit.symbol.is_empty() { String::new() } else { format!(", ({})²", unit.symbol) };
    let interval = format!("{} interval", number::confidence(effects.confidence));
    let mut heads = vec!["term".to_owned(), unit.label("effect"), unit.label(&interval)];
    heads.extend(["share", "F", "p", "degrees of freedom"].map(str::to_owned));
    heads.extend(["sum of squares", "mean square"].map(|what| format!("{what}{squared}")));
    heads
}

fn rows(effects: &Effects, unit: &Unit) -> Vec<Vec<String>> {
    let sizes = effects.rows().filter_map(|term| Some(unit.value(term.estimate?.effect).abs()));
    let decimals = decimals(sizes.fold(0.0, f64::max));
    let mut rows: Vec<Vec<String>> = effects.rows().map(|term| row(term, unit, decimals)).collect();
    let residual = &effects.residual;
    let mut others = vec![("residual", residual.squares, None)];
    if let Some(parts) = residual.parts.filter(|parts| parts.lack_of_fit.freedom > 0) {
        others.push(("lack of fit", parts.lack_of_fit, parts.test));
        others.push(("pure error", parts.pure_error, None));
    }
    others.push(("total", effects.total, None));
    rows.extend(others.into_iter().map(|(name, squares, test)| {
        let share = squares.sum / effects.total.sum;
        [vec![name.to_owned(), String::new(), String::new()], of_squares(squares, share, test, unit)].concat()
    }));
    rows
}

/// Decimals with which the largest of some numbers has enough digits, and much smaller ones still have some.
fn decimals(largest: f64) -> usize {
    if largest > 0.0 { (DIGITS as i32 - largest.log10().floor() as i32).clamp(0, 9) as usize } else { 0 }
}

fn row(term: &Term, unit: &Unit, decimals: usize) -> Vec<String> {
    let rounded = |value: f64| number::with_minus(&format!("{value:.decimals$}"));
    let estimate = term.estimate;
    let effect = estimate.map_or_else(String::new, |estimate| rounded(unit.value(estimate.effect)));
    let interval = estimate.and_then(|estimate| estimate.uncertainty).map_or_else(String::new, |uncertainty| {
        let [low, high] = uncertainty.interval.map(|end| rounded(unit.value(end)));
        format!("{low} … {high}")
    });
    let squares = Squares { freedom: term.freedom, sum: term.sum_of_squares };
    [vec![term.label.clone(), effect, interval], of_squares(squares, term.share, term.test, unit)].concat()
}

/// Share, F, p, degrees of freedom, sum of squares, mean square.
fn of_squares(squares: Squares, share: f64, test: Option<Test>, unit: &Unit) -> Vec<String> {
    let square = |value: f64| rounded(unit.value(unit.value(value)));
    vec![
        format!("{:.1} %", 100.0 * share),
        test.map_or_else(String::new, |test| number::rounded(test.f, 3)),
        test.map_or_else(String::new, |test| probability(test.p)),
        squares.freedom.to_string(),
        square(squares.sum),
        squares.mean().map_or_else(String::new, square),
    ]
}

fn probability(p: f64) -> String {
    if p < LEAST_PROBABILITY { format!("< {LEAST_PROBABILITY}") } else { number::rounded(p, 2) }
}

/// Where a quadratic surface is level, in words; none where there are categories, each of which has its own.
fn stationary(effects: &Effects, axes: &[FactorAxis], unit: &Unit) -> Option<String> {
    if !axes.iter().all(|axis| axis.factor.factor.is_numeric()) {
        return None;
    }
    let surface = effects.surface(&vec![Setting::Coded(0.0); axes.len()]).ok()?;
    let Some(point) = &surface.stationary else {
        return Some("The fitted surface is a ridge: it has no single stationary point.".to_owned());
    };
    let nature = match surface.nature {
        Nature::Maximum => "a maximum",
        Nature::Minimum => "a minimum",
        Nature::Saddle => "a saddle",
        Nature::Ridge => "a ridge",
    };
    let place = |(factor, coded): (&usize, &f64)| {
        let axis = &axes[*factor];
        let value = rounded(axis.natural(*coded));
        format!("{} = {}", axis.plain_name(), format!("{value} {}", axis.factor.reading.unit).trim_end())
    };
    if !point.within_ranges {
        // Far away the numbers of a fit mean nothing: where to go is all that they tell.
        let beyond = surface.factors.iter().zip(&point.coded).filter(|(_, coded)| coded.abs() > 1.0);
        let directions: Vec<String> = beyond
            .map(|(factor, coded)| {
                format!("{} the range of {}", if *coded > 0.0 { "above" } else { "below" }, axes[*factor].plain_name())
            })
            .collect();
        return Some(format!(
            "The fitted surface has no stationary point within the ranges of the study; the one beyond them, {nature}, lies {}.",
            directions.join(", ")
        ));
    }
    let places: Vec<String> = surface.factors.iter().zip(&point.coded).map(place).collect();
    let value = unit.with_symbol(&rounded(unit.value(point.response.value)));
    Some(format!("The fitted surface has {nature} of {value} at {}.", places.join(", ")))
}

/// A figure with its caption; the drawing stands in the page itself.
fn figure(picture: &Picture) -> String {
    let (width, inner) = width(&picture.svg);
    let label = html::escape(&picture.caption);
    let (enlarged, least) = (ENLARGED * width, if width > WIDE { "44rem" } else { "0" });
    format!(
        "<figure>\n<div class=\"drawing\" tabindex=\"0\" role=\"region\" aria-label=\"{name}\">\n\
         <svg role=\"img\" aria-label=\"{label}\" style=\"width:{enlarged:.1}mm;min-width:{least}\" {inner}</div>\n\
         <figcaption>{label}</figcaption>\n</figure>\n",
        name = html::escape(&picture.name),
    )
}

/// The width of a drawing, mm, and the drawing without its beginning and its size.
fn width(svg: &str) -> (f64, &str) {
    let after = |text: &str| svg.find(text).map(|at| at + text.len());
    let width = after("width=\"").and_then(|at| svg[at..].split_once("mm").and_then(|(number, _)| number.parse().ok()));
    let inner = svg.find("viewBox=").map_or(svg, |at| &svg[at..]);
    (width.unwrap_or(WIDE), inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawings_keep_their_proportions() {
        let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"85mm\" height=\"40mm\" viewBox=\"0 0 1360 640\">\n<g/></svg>";
        assert_eq!(width(svg), (85.0, "viewBox=\"0 0 1360 640\">\n<g/></svg>"));
        let picture = Picture { name: "<n>".into(), caption: "a \"b\"".into(), svg: svg.into() };
        let html = figure(&picture);
        assert!(
            html.contains("&lt;n&gt;") && html.contains("a &quot;b&quot;") && html.contains("width:144.5mm"),
            "{html}"
        );
        assert!(!html.contains("http"));
    }

    #[test]
    fn a_column_of_effects_has_as_many_decimals_as_its_largest_needs() {
        assert_eq!([0.2313, 25.0, 1234.5, 1e9, 0.0, 1e-30].map(decimals), [5, 3, 1, 0, 0, 9]);
    }

    #[test]
    fn small_probabilities_have_no_needless_digits() {
        assert_eq!([0.0321, 0.5, 1e-4, 9e-5, 0.0].map(probability), ["0.032", "0.5", "0.0001", "< 0.0001", "< 0.0001"]);
    }
}
