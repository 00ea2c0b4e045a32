//! What the model leaves: against what it fits, in the order of the runs, and against normal quantiles.

use plateau_study::effects::normal_quantiles;

use super::{ResponseFigures, Subject, range_of};
use crate::colour::{DATA, FAINT};
use crate::figure::axes::Axis;
use crate::figure::canvas::{LINE, TEXT};
use crate::figure::chart::{Chart, TWO_COLUMNS, page};
use crate::figure::font::shortened;
use crate::figure::labels::{Labels, write_labels};
use crate::figure::page::{Content, Mark, Page};
use crate::figure::stroke::Stroke;

/// Height of a box, pixels.
const HEIGHT: f64 = 640.0;
/// Residuals that are more than so many of their standard deviations have the number of their run.
const UNUSUAL: f64 = 2.5;
/// Most runs that are named: the largest.
const NAMED: usize = 6;

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
    let places: [Vec<[f64; 2]>; 3] = [
        values.iter().zip(&residuals).map(|(x, y)| [*x, *y]).collect(),
        order.iter().zip(&residuals).map(|(x, y)| [*x, *y]).collect(),
        on_quantiles(&standardised),
    ];
    let charts = vec![
        scatter(
            Axis::linear(range_of(values.into_iter()), label(&format!("fitted {}", subject.response.title()))),
            &y,
            &places[0],
        ),
        scatter(Axis::linear(range_of(order.into_iter()), "run order"), &y, &places[1]),
        normal(&places[2]),
    ];
    let mut page = page(TWO_COLUMNS, HEIGHT, 3, charts, &[]);
    let unusual = unusual(&standardised);
    for (panel, places) in places.iter().enumerate() {
        let named = unusual.iter().map(|at| ((fitted[*at].observation + 1).to_string(), places[*at]));
        name_runs(&mut page, panel, places, named.collect());
    }
    let whose = if unusual.is_empty() {
        String::new()
    } else {
        format!(" Runs beyond {UNUSUAL} standard deviations have their number in residuals.csv.")
    };
    let caption = format!(
        "Residuals: against what the model fits (a funnel asks for a transform, a bend for squares), in the order in which \
         the runs are made (a drift), and standardised (divided by their standard deviations) against normal quantiles (along the line if errors \
         are normal; what lies far off is an outlier).{whose}"
    );
    subject.add(figures, "residuals", "Residuals of", caption, page);
}

/// The residuals that are unusually large, the largest first.
fn unusual(standardised: &[f64]) -> Vec<usize> {
    let mut unusual: Vec<usize> = (0..standardised.len()).filter(|at| standardised[*at].abs() > UNUSUAL).collect();
    unusual.sort_by(|one, other| standardised[*other].abs().total_cmp(&standardised[*one].abs()));
    unusual.truncate(NAMED);
    unusual
}

/// Writes names beside some of the points of a panel.
fn name_runs(page: &mut Page, panel: usize, places: &[[f64; 2]], named: Vec<(String, [f64; 2])>) {
    let Some(axes) = page.panels.get(panel).map(|panel| panel.axes.clone()) else { return };
    let place = |[x, y]: [f64; 2]| axes.place_within(x, y);
    let labels = Labels::new(axes.frame, places.iter().filter(|[_, y]| y.is_finite()).map(|point| place(*point)));
    let named = named.into_iter().map(|(name, point)| (name, place(point))).collect();
    write_labels(page, panel, &labels, named);
}

/// Residuals over something else, about a line at 0.
fn scatter(x: Axis, y: &Axis, points: &[[f64; 2]]) -> Chart {
    let zero = vec![[*x.range.start(), 0.0], [*x.range.end(), 0.0]];
    let contents = vec![
        Content::Line { points: zero, stroke: Stroke::solid(FAINT, LINE) },
        Content::Marks { points: points.to_vec(), colour: DATA, mark: Mark::Point },
    ];
    Chart { title: String::new(), x, y: y.clone(), contents }
}

/// Standardised residuals with the normal quantiles of their ranks, in the order of the residuals; NaN for those that are none.
fn on_quantiles(standardised: &[f64]) -> Vec<[f64; 2]> {
    let mut ranked: Vec<usize> = (0..standardised.len()).filter(|at| standardised[*at].is_finite()).collect();
    ranked.sort_by(|one, other| standardised[*one].total_cmp(&standardised[*other]));
    let mut places = vec![[f64::NAN; 2]; standardised.len()];
    for (at, quantile) in ranked.iter().zip(normal_quantiles(ranked.len())) {
        places[*at] = [quantile, standardised[*at]];
    }
    places
}

/// The same as a chart, with the line along which normal errors lie.
fn normal(places: &[[f64; 2]]) -> Chart {
    let points: Vec<[f64; 2]> = places.iter().copied().filter(|[_, residual]| residual.is_finite()).collect();
    let range = range_of(points.iter().flatten().copied());
    let ends = [*range.start(), *range.end()];
    Chart {
        title: String::new(),
        x: Axis::linear(range.clone(), "normal quantile"),
        y: Axis::linear(range, "standardised residual"),
        contents: vec![
            Content::Line { points: ends.map(|end| [end, end]).to_vec(), stroke: Stroke::solid(FAINT, LINE) },
            Content::Marks { points, colour: DATA, mark: Mark::Point },
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::{on_quantiles, unusual};

    #[test]
    fn the_largest_residuals_come_first_and_what_is_none_has_no_place() {
        let standardised = [0.1, -3.0, f64::NAN, 2.6, -0.2];
        assert_eq!(unusual(&standardised), [1, 3]);
        let places = on_quantiles(&standardised);
        assert!(places[2][0].is_nan() && places[1][0] < places[4][0] && places[4][0] < places[0][0]);
        // Of four ranks the two in the middle lie on either side of 0, as far away.
        assert!((places[4][0] + places[0][0]).abs() < 1e-12 && places[3][1] == 2.6);
    }
}
