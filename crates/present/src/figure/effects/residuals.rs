//! What the model leaves: against what it fits, in the order of the runs, and against normal quantiles.

use plateau_study::effects::normal_quantiles;

use super::{ResponseFigures, Subject, range_of};
use crate::colour::{DATA, FAINT};
use crate::figure::axes::Axis;
use crate::figure::canvas::{LINE, TEXT};
use crate::figure::chart::{Chart, TWO_COLUMNS, page};
use crate::figure::font::shortened;
use crate::figure::page::{Content, Mark};
use crate::figure::stroke::Stroke;

/// Height of a box, pixels.
const HEIGHT: f64 = 640.0;

/// Adds the figure.
pub fn add(subject: &Subject, figures: &mut ResponseFigures) {
    let Some(standardised) = subject.effects.standardised_residuals() else {
        figures.left_out.push(format!("There are no residuals to show; the error is {}.", subject.effects.error));
        return;
    };
    let fitted = &subject.effects.fitted;
    let unit = &subject.unit;
    let residuals: Vec<f64> = fitted.iter().map(|each| unit.value(each.residual)).collect();
    let values: Vec<f64> = fitted.iter().map(|each| unit.value(each.fitted)).collect();
    let order: Vec<f64> =
        fitted.iter().map(|each| subject.analysis.order.get(each.observation).map_or(0.0, |run| *run as f64)).collect();
    let label = |what: &str| shortened(&unit.label(what), TEXT, HEIGHT);
    let y = Axis::linear(range_of(residuals.iter().copied().chain([0.0])), label("residual"));
    let charts = vec![
        scatter(
            Axis::linear(range_of(values.iter().copied()), label(&format!("fitted {}", subject.response.title()))),
            &y,
            &values,
            &residuals,
        ),
        scatter(
            Axis::linear(range_of(order.iter().copied()), "run, in the order in which they are made"),
            &y,
            &order,
            &residuals,
        ),
        normal(&standardised),
    ];
    let caption = "Residuals: against what the model fits (a funnel asks for a transform, a bend for squares), in the order in which \
                   the runs are made (a drift), and by their standard deviations against normal quantiles (along the line if errors \
                   are normal; what lies far off is an outlier)."
        .to_owned();
    subject.add(figures, "residuals", "Residuals of", caption, page(TWO_COLUMNS, HEIGHT, 3, charts, &[]));
}

/// Residuals over something else, about a line at 0.
fn scatter(x: Axis, y: &Axis, places: &[f64], residuals: &[f64]) -> Chart {
    let zero = vec![[*x.range.start(), 0.0], [*x.range.end(), 0.0]];
    let points = places.iter().zip(residuals).map(|(place, residual)| [*place, *residual]).collect();
    let contents = vec![
        Content::Line { points: zero, stroke: Stroke::solid(FAINT, LINE) },
        Content::Marks { points, colour: DATA, mark: Mark::Point },
    ];
    Chart { title: String::new(), x, y: y.clone(), contents }
}

/// Standardised residuals over the normal quantiles of their ranks; those that are none are left out.
fn normal(standardised: &[f64]) -> Chart {
    let mut sorted: Vec<f64> = standardised.iter().copied().filter(|residual| residual.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let quantiles = normal_quantiles(sorted.len());
    let range = range_of(sorted.iter().chain(&quantiles).copied());
    let ends = [*range.start(), *range.end()];
    let points = quantiles.iter().zip(&sorted).map(|(quantile, residual)| [*quantile, *residual]).collect();
    Chart {
        title: String::new(),
        x: Axis::linear(range.clone(), "normal quantile"),
        y: Axis::linear(range, "residual by its standard deviation"),
        contents: vec![
            Content::Line { points: ends.map(|end| [end, end]).to_vec(), stroke: Stroke::solid(FAINT, LINE) },
            Content::Marks { points, colour: DATA, mark: Mark::Point },
        ],
    }
}
