//! Sizes of effects against what they would be if they were nothing but error (Daniel 1959).

use plateau_study::effects::{Effects, HalfNormal};

use super::{ResponseFigures, Subject};
use crate::colour::{DATA, DATA_AREA, FAINT};
use crate::figure::axes::Axis;
use crate::figure::canvas::{LINE, TEXT};
use crate::figure::chart::{COLUMN, Chart, Meaning, about_zero, page};
use crate::figure::font::shortened;
use crate::figure::labels::{Labels, write_labels};
use crate::figure::page::{Content, KeyStyle, Mark};
use crate::figure::stroke::{SOLID, Stroke};

/// Height of the box, pixels.
const HEIGHT: f64 = 860.0;
/// Fewest effects of which the smaller ones show an error.
const FEWEST: usize = 3;
/// As many effects have a label each.
const FEW: usize = 8;
/// Effects of more that are labelled although they are not significant, where nothing tells which are.
const LABELLED: usize = 5;
/// Longest label, pixels.
const LABEL: f64 = 520.0;

/// Adds the figure.
pub fn add(subject: &Subject, figures: &mut ResponseFigures) {
    let effects = subject.effects;
    let shown = effects.half_normal();
    if shown.len() < FEWEST {
        figures.left_out.push(format!(
            "A half-normal plot needs at least {FEWEST} effects of one degree of freedom; there are {}.",
            shown.len()
        ));
        return;
    }
    let point = |effect: &HalfNormal| [effect.quantile, subject.unit.value(effect.size)];
    let largest = shown.iter().map(|effect| point(effect)[1]).fold(0.0, f64::max);
    let last = shown.iter().map(|effect| effect.quantile).fold(0.0, f64::max);
    let (significant, others): (Vec<&HalfNormal>, Vec<&HalfNormal>) =
        shown.iter().partition(|effect| effects.is_significant(&effects.terms[effect.term]) == Some(true));
    let (x, y) = (about_zero(1.06 * last), about_zero(1.06 * largest));
    let mut contents = Vec::new();
    let mut meanings = Vec::new();
    let slope = standard_error(effects).map(|error| subject.unit.value(error));
    if let Some(slope) = slope {
        // As far as it is in the box.
        let end = x.end().min(y.end() / slope);
        contents
            .push(Content::Line { points: vec![[0.0, 0.0], [end, slope * end]], stroke: Stroke::solid(FAINT, LINE) });
        let text = "pure chance, no effect".to_owned();
        meanings.push(Meaning { colour: FAINT, style: KeyStyle::Line(SOLID), text });
    }
    let confidence = subject.confidence();
    let groups = [
        (&significant, DATA, format!("significant at {confidence}")),
        (&others, DATA_AREA, "not significant".to_owned()),
    ];
    let is_told = shown.iter().any(|effect| effects.is_significant(&effects.terms[effect.term]).is_some());
    for (group, colour, text) in groups.into_iter().rev().filter(|(group, _, _)| !group.is_empty()) {
        contents.push(Content::Marks {
            points: group.iter().map(|effect| point(effect)).collect(),
            colour,
            mark: Mark::Dot,
        });
        if is_told {
            meanings.insert(0, Meaning { colour, style: KeyStyle::Mark(Mark::Dot), text });
        }
    }
    let chart = Chart {
        title: String::new(),
        x: Axis::linear(x, "half-normal quantile"),
        y: Axis::linear(
            y,
            shortened(&subject.unit.label(&format!("|effect| on {}", subject.response.title())), TEXT, HEIGHT),
        ),
        contents,
    };
    let mut page = page(COLUMN, HEIGHT, 1, vec![chart], &meanings);
    if let Some(axes) = page.panels.first().map(|panel| panel.axes.clone()) {
        let place = |effect: &HalfNormal| {
            let [x, y] = point(effect);
            axes.place_within(x, y)
        };
        let mut labels = Labels::new(axes.frame, shown.iter().map(place));
        if let Some(slope) = slope {
            let end = axes.x.range.end().min(axes.y.range.end() / slope);
            labels.avoid([axes.place(0.0, 0.0), axes.place(end, slope * end)]);
        }
        // The largest first: it is the one that must not be missed.
        let mut labelled = labelled(is_told, significant, &others);
        labelled.sort_by(|one, other| other.size.total_cmp(&one.size));
        let named = labelled
            .into_iter()
            .map(|effect| (shortened(&effects.terms[effect.term].label, TEXT, LABEL), place(effect)))
            .collect();
        write_labels(&mut page, 0, &labels, named);
    }
    let caption = format!(
        "Sizes of effects against half-normal quantiles: those that are nothing but error lie along a line through the \
         origin, those above it stand out.{}",
        if slope.is_some() { " The line has the standard error of an effect for its slope." } else { "" }
    );
    subject.add(figures, "half-normal", "Half-normal plot of the effects on", caption, page);
}

/// The effects that have labels: all where they are few, else the significant ones, or the largest where nothing tells which are.
fn labelled<'a>(is_told: bool, significant: Vec<&'a HalfNormal>, others: &[&'a HalfNormal]) -> Vec<&'a HalfNormal> {
    if significant.len() + others.len() <= FEW {
        [&significant, others].concat()
    } else if is_told {
        significant
    } else {
        others.iter().rev().take(LABELLED).copied().collect()
    }
}

/// The standard error of an effect: the median of all, which are equal in balanced designs, or that of Lenth's method.
fn standard_error(effects: &Effects) -> Option<f64> {
    let errors = effects.terms.iter().filter_map(|term| Some(term.estimate?.uncertainty?.standard_error));
    let mut errors: Vec<f64> = errors.filter(|error| *error > 0.0).collect();
    errors.sort_unstable_by(f64::total_cmp);
    errors.get(errors.len() / 2).copied().or(effects.lenth.map(|lenth| lenth.pseudo_standard_error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_effects_have_a_label_each() {
        let effects: Vec<HalfNormal> =
            (0..10).map(|term| HalfNormal { term, quantile: 0.1 * term as f64, size: term as f64 }).collect();
        let terms = |labelled: Vec<&HalfNormal>| labelled.into_iter().map(|effect| effect.term).collect::<Vec<_>>();
        let of = |count: usize, first: usize, is_told: bool| {
            let (others, significant): (Vec<_>, Vec<_>) =
                effects[..count].iter().partition(|effect| effect.term < first);
            terms(labelled(is_told, significant, &others))
        };
        assert_eq!(of(5, 2, true), [2, 3, 4, 0, 1]);
        assert_eq!(of(10, 8, true), [8, 9]);
        assert_eq!(of(10, 10, false), [9, 8, 7, 6, 5]);
    }
}
