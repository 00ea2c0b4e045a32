//! Effects sorted by how far they are beyond their error.
//!
//! | what is known | the length of a bar | where it is significant |
//! |---|---|---|
//! | an error | the root of F, which for one degree of freedom is abs(t) | the root of the quantile of F |
//! | none, but Lenth's margins | the size of the effect | the margin of error, and the simultaneous one |
//! | neither | the share of the sum of squares | not known |

use plateau_study::effects::{Effects, Term};
use plotters::style::RGBColor;

use super::{ResponseFigures, Subject};
use crate::colour::{DATA, DATA_AREA, DERIVED, FAINT, INK};
use crate::figure::axes::Axis;
use crate::figure::canvas::{LINE, TEXT};
use crate::figure::chart::{COLUMN, Chart, Meaning, note, page, up_from_zero};
use crate::figure::font::shortened;
use crate::figure::page::{Content, KeyStyle};
use crate::figure::stroke::{SOLID, Stroke};
use plateau_io::number;

/// Bars, at most.
const MOST_BARS: usize = 30;
/// Height of a bar with the room between two of them, pixels, and the part of it that is bar.
const BAR: f64 = 56.0;
const PART: f64 = 0.7;
/// Least height of the box, pixels.
const LEAST_HEIGHT: f64 = 120.0;
/// Room for names of terms, pixels.
const NAMES: f64 = 560.0;

/// What stands behind the name of a term that cannot be told from others.
const ASTERISK: &str = " *";

/// A bar.
#[derive(Debug, Clone, PartialEq)]
struct Bar {
    name: String,
    length: f64,
    /// Where it would be significant.
    limit: Option<f64>,
}

/// Which measure all bars have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Measure {
    /// The root of F.
    RootOfF,
    /// The size of the effect.
    Size,
    /// The share of the sum of squares.
    Share,
}

impl Measure {
    fn of(effects: &Effects) -> Self {
        let mut shown = effects.terms.iter().filter(|term| term.freedom > 0);
        if effects.residual_standard_deviation.is_some() {
            Self::RootOfF
        } else if shown.all(|term| term.estimate.is_some()) {
            Self::Size
        } else {
            Self::Share
        }
    }
}

/// Adds the figure.
pub fn add(subject: &Subject, figures: &mut ResponseFigures) {
    let effects = subject.effects;
    let measure = Measure::of(effects);
    let mut bars: Vec<Bar> = effects.terms.iter().filter_map(|term| bar(subject, term, measure)).collect();
    bars.sort_by(|one, other| other.length.total_cmp(&one.length));
    let all = bars.len();
    bars.truncate(MOST_BARS);
    if bars.is_empty() {
        figures.left_out.push("No term has an estimate of its own, so there is no chart of effects.".to_owned());
        return;
    }
    let several = effects.terms.iter().any(|term| term.freedom > 1);
    let x_label = match measure {
        Measure::RootOfF if several => "√F".to_owned(),
        Measure::RootOfF => "|t|".to_owned(),
        Measure::Size => subject.unit.label("|effect|"),
        Measure::Share => "share of the sum of squares, %".to_owned(),
    };
    let count = bars.len() as f64;
    let height = (BAR * count).max(LEAST_HEIGHT);
    let simultaneous = effects.lenth.filter(|_| measure == Measure::Size);
    let simultaneous = simultaneous.map(|lenth| subject.unit.value(lenth.simultaneous_margin));
    let limits = bars.iter().filter_map(|bar| bar.limit).chain(simultaneous);
    let longest = bars.iter().map(|bar| bar.length).chain(limits).fold(0.0, f64::max);
    let names = bars.iter().enumerate().map(|(at, bar)| (count - 0.5 - at as f64, shortened(&bar.name, TEXT, NAMES)));
    let chart = Chart {
        title: format!("effects on {}", subject.response.title()),
        x: Axis::linear(up_from_zero(longest), x_label),
        y: Axis::marked(0.0..=count, "", names.collect()),
        contents: contents(&bars, simultaneous),
    };
    let has_asterisks = bars.iter().any(|bar| bar.name.ends_with(ASTERISK));
    let mut page = page(COLUMN, height, 1, vec![chart], &meanings(subject, measure, &bars, simultaneous));
    let standardised = match measure {
        Measure::RootOfF if several => "√F is |t| = |effect| / standard error where a term has one degree of freedom",
        Measure::RootOfF => "|t| = |effect| / standard error",
        _ => "",
    };
    note(&mut page, standardised);
    note(&mut page, if has_asterisks { "* cannot be told from other effects, which the table names" } else { "" });
    note(&mut page, &if all > MOST_BARS { format!("the {MOST_BARS} largest effects of {all}") } else { String::new() });
    subject.add(figures, "pareto", "Sizes of effects on", caption(subject, measure, all), page);
}

/// The bar of a term; none where other terms have the estimate.
fn bar(subject: &Subject, term: &Term, measure: Measure) -> Option<Bar> {
    let effects = subject.effects;
    if term.freedom == 0 {
        return None;
    }
    let (length, limit) = match measure {
        Measure::RootOfF => (term.test?.f.sqrt(), effects.critical_f(term.freedom).map(f64::sqrt)),
        Measure::Size => {
            let margin = effects.lenth.map(|lenth| subject.unit.value(lenth.margin));
            (subject.unit.value(term.estimate?.effect.abs()), margin)
        }
        Measure::Share => (100.0 * term.share, None),
    };
    let mark = if term.aliased_with.is_empty() { "" } else { ASTERISK };
    Some(Bar { name: format!("{}{mark}", term.label), length, limit })
}

fn contents(bars: &[Bar], simultaneous: Option<f64>) -> Vec<Content> {
    let count = bars.len() as f64;
    let mut contents = Vec::new();
    // One line through all bars, with a step where a term has other degrees of freedom than the one above it.
    let mut points: Vec<[f64; 2]> = Vec::new();
    for (at, limit) in bars.iter().enumerate().filter_map(|(at, bar)| Some((at, bar.limit?))) {
        let ends = [count - at as f64, count - at as f64 - 1.0];
        match points.last_mut() {
            Some(last) if last[0] == limit && last[1] == ends[0] => last[1] = ends[1],
            _ => points.extend(ends.map(|y| [limit, y])),
        }
    }
    if !points.is_empty() {
        contents.push(Content::Line { points, stroke: Stroke::solid(DERIVED, LINE + 1) });
    }
    contents.extend(simultaneous.map(|margin| Content::Line {
        points: vec![[margin, 0.0], [margin, count]],
        stroke: Stroke::solid(INK, LINE + 1),
    }));
    // Bars lie on the lines: one that is beyond a limit covers it, one that is not ends before it.
    for (at, bar) in bars.iter().enumerate() {
        let middle = count - 0.5 - at as f64;
        let ends = [middle - 0.5 * PART, middle + 0.5 * PART];
        let spans = [0.0, bar.length].map(|x| [x, ends[0], ends[1]]).to_vec();
        contents.push(Content::Band { spans, colour: colour(bar), opacity: 1.0 });
    }
    contents
}

fn colour(bar: &Bar) -> RGBColor {
    match bar.limit {
        Some(limit) if bar.length > limit => DATA,
        Some(_) => DATA_AREA,
        None => FAINT,
    }
}

fn meanings(subject: &Subject, measure: Measure, bars: &[Bar], simultaneous: Option<f64>) -> Vec<Meaning> {
    let Some(first) = bars.iter().find_map(|bar| bar.limit) else { return Vec::new() };
    let confidence = subject.confidence();
    let is_common = bars.iter().all(|bar| bar.limit == Some(first));
    let ends = bars
        .iter()
        .filter_map(|bar| bar.limit)
        .fold([first; 2], |[low, high], limit| [low.min(limit), high.max(limit)]);
    let size = |value: f64| subject.unit.with_symbol(&number::rounded(value, 3));
    let at = if is_common {
        format!(": {}", if measure == Measure::Size { size(first) } else { number::rounded(first, 3) })
    } else {
        format!(": {} by degrees of freedom", ends.map(|end| number::rounded(end, 3)).join(" to "))
    };
    let limit = match measure {
        Measure::Size => format!("margin of error (Lenth, {confidence}){at}"),
        _ => format!("limit at {confidence}{at}"),
    };
    let is_beyond = |beyond: bool| bars.iter().any(|bar| bar.limit.is_some_and(|limit| (bar.length > limit) == beyond));
    let areas = [(DATA, "significant", true), (DATA_AREA, "not significant", false)];
    let areas = areas.into_iter().filter(|(_, _, beyond)| is_beyond(*beyond));
    let areas = areas.map(|(colour, text, _)| Meaning { colour, style: KeyStyle::Area, text: text.to_owned() });
    let limit = Meaning { colour: DERIVED, style: KeyStyle::Line(SOLID), text: limit };
    let simultaneous = simultaneous.map(|margin| Meaning {
        colour: INK,
        style: KeyStyle::Line(SOLID),
        text: format!("simultaneous margin: {}", size(margin)),
    });
    areas.chain([limit]).chain(simultaneous).collect()
}

fn caption(subject: &Subject, measure: Measure, all: usize) -> String {
    let effects = subject.effects;
    let confidence = subject.confidence();
    let mut caption = match measure {
        Measure::RootOfF => format!(
            "How many times its standard error each effect is, the root of F; bars beyond the line are significant at \
             {confidence}. The error: {}.",
            effects.error
        ),
        Measure::Size if effects.lenth.is_some() => format!(
            "Sizes of effects. Nothing tells the error ({}), so bars are compared with Lenth's margins of error at \
             {confidence}, which take most effects to be none: an effect that is looked at alone is likely one beyond the \
             margin, one that is picked from all beyond the simultaneous margin.",
            effects.error
        ),
        Measure::Size => format!("Sizes of effects. Nothing tells the error: {}.", effects.error),
        Measure::Share => {
            format!("Shares of terms in the sum of squares. Nothing tells the error: {}.", effects.error)
        }
    };
    if all > MOST_BARS {
        caption.push_str(&format!(" Shown are the {MOST_BARS} largest of {all}."));
    }
    if effects.terms.iter().any(|term| !term.aliased_with.is_empty()) {
        caption.push_str(" Terms with * cannot be told from others, which the table names.");
    }
    caption
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_lie_on_the_limits() {
        let bar = |length| Bar { name: String::new(), length, limit: Some(2.0) };
        let contents = contents(&[bar(2.1), bar(1.9)], Some(3.0));
        let is_line = |content: &Content| matches!(content, Content::Line { .. });
        assert_eq!(contents.iter().map(is_line).collect::<Vec<_>>(), [true, true, false, false]);
    }
}
