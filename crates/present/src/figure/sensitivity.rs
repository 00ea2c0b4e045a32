//! Parts of a response's variation: Sobol's indices as bars, elementary effects as points.

use plateau_study::sensitivity::{ElementaryEffect, SobolIndices};

use super::axes::Axis;
use super::canvas::{LINE, TEXT};
use super::chart::{COLUMN, Chart, Meaning, about_zero, page, up_from_zero};
use super::font::shortened;
use super::format::Figure;
use super::labels::{Labels, write_labels};
use super::page::{Content, KeyStyle, Mark};
use super::stroke::{SOLID, Stroke};
use crate::colour::{DATA, DATA_AREA, FAINT, INK};
use crate::quantity::Unit;

/// Height of the two bars of a factor with the room between factors, pixels.
const FACTOR: f64 = 84.0;
/// Least height of the box, pixels.
const LEAST_HEIGHT: f64 = 170.0;
/// Room for names of factors, pixels.
const NAMES: f64 = 560.0;
/// Parts of the room of a factor: ends of the bar of the total index, and of that of first order.
const TOTAL: [f64; 2] = [0.04, 0.40];
const FIRST: [f64; 2] = [-0.40, -0.04];
/// Least length of an interval that is drawn, as a part of the variance.
const SHORTEST: f64 = 1e-3;
/// Height of the box of elementary effects, pixels.
const HEIGHT: f64 = 800.0;

/// Indices of a response as bars, the largest total first. `file` is what the figure's name begins with.
pub fn indices(response: &str, file: &str, factors: &[&str], indices: &SobolIndices, confidence: &str) -> Figure {
    let mut order: Vec<usize> = (0..factors.len()).collect();
    order.sort_by(|one, other| indices.total[*other].value.total_cmp(&indices.total[*one].value));
    let count = order.len() as f64;
    let middle = |at: usize| count - 0.5 - at as f64;
    let mut contents = Vec::new();
    let mut longest = 0.0_f64;
    for (at, factor) in order.iter().enumerate() {
        for (index, part, colour) in
            [(&indices.total[*factor], TOTAL, DATA_AREA), (&indices.first[*factor], FIRST, DATA)]
        {
            let index = index.possible();
            let ends = part.map(|part| middle(at) + part);
            let spans = [0.0, index.value].map(|x| [x, ends[0], ends[1]]).to_vec();
            contents.push(Content::Band { spans, colour, opacity: 1.0 });
            longest = longest.max(index.value);
            if let Some([low, high]) = index.interval.filter(|[low, high]| high - low > SHORTEST) {
                let y = 0.5 * (ends[0] + ends[1]);
                let points = vec![[low, y], [high, y]];
                contents.push(Content::Line { points, stroke: Stroke::solid(INK, LINE) });
                longest = longest.max(high);
            }
        }
    }
    let names = order.iter().enumerate().map(|(at, factor)| (middle(at), shortened(factors[*factor], TEXT, NAMES)));
    let chart = Chart {
        title: response.to_owned(),
        x: Axis::linear(up_from_zero(longest.max(0.1)), "part of the variance"),
        y: Axis::marked(0.0..=count, "", names.collect()),
        contents,
    };
    let area = |colour, text: &str| Meaning { colour, style: KeyStyle::Area, text: text.to_owned() };
    let interval =
        Meaning { colour: INK, style: KeyStyle::Line(SOLID), text: format!("{confidence} interval of the sample") };
    let meanings = [area(DATA_AREA, "total: with all interactions"), area(DATA, "first order: alone"), interval];
    Figure {
        name: format!("{file}-indices"),
        title: format!("Sobol's indices of {response}"),
        caption: format!(
            "Parts of the variance of {response} when all factors vary evenly over their ranges: alone, and together with all \
             others."
        ),
        page: page(COLUMN, (FACTOR * count).max(LEAST_HEIGHT), 1, vec![chart], &meanings),
    }
}

/// Elementary effects of a response: how large they are, and how much they differ from place to place.
pub fn effects(response: &str, file: &str, factors: &[&str], effects: &[ElementaryEffect], unit: &Unit) -> Figure {
    let place = |effect: &ElementaryEffect| [effect.mean_size, effect.deviation].map(|value| unit.difference(value));
    let points: Vec<[f64; 2]> = effects.iter().map(place).filter(|place| place.iter().all(|x| x.is_finite())).collect();
    let largest = |axis: usize| points.iter().map(|point| point[axis]).fold(0.0, f64::max);
    let (x, y) = (about_zero(1.06 * largest(0)), about_zero(1.06 * largest(1)));
    let end = x.end().min(*y.end());
    let contents = vec![
        Content::Line { points: vec![[0.0, 0.0], [end, end]], stroke: Stroke::solid(FAINT, LINE) },
        Content::Marks { points: points.clone(), colour: DATA, mark: Mark::Dot },
    ];
    let chart = Chart {
        title: format!("elementary effects on {response}"),
        x: Axis::linear(x, unit.label("mean size μ* of the effects")),
        y: Axis::linear(y, unit.label("standard deviation σ")),
        contents,
    };
    let line = Meaning { colour: FAINT, style: KeyStyle::Line(SOLID), text: "σ = μ*".to_owned() };
    let mut page = page(COLUMN, HEIGHT, 1, vec![chart], &[line]);
    if let Some(axes) = page.panels.first().map(|panel| panel.axes.clone()) {
        let spot = |point: &[f64; 2]| axes.place_within(point[0], point[1]);
        let mut labels = Labels::new(axes.frame, points.iter().map(spot));
        let named = effects.iter().zip(factors).filter(|(effect, _)| place(effect).iter().all(|x| x.is_finite()));
        labels.avoid([axes.place(0.0, 0.0), axes.place(end, end)]);
        let named = named.map(|(effect, name)| ((*name).to_owned(), spot(&place(effect)))).collect();
        write_labels(&mut page, 0, &labels, named);
    }
    Figure {
        name: format!("{file}-effects"),
        title: format!("Elementary effects on {response}"),
        caption: format!(
            "Mean size of the change of {response} over the whole range of each factor, and how much it differs from place to \
             place. Near or above the line, a factor acts on a curve or together with others."
        ),
        page,
    }
}
