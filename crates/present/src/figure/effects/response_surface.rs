//! The response that a quadratic model predicts over two factors.

use plateau_study::design::Setting;
use plateau_study::effects::Model;

use super::factor_map::FactorMap;
use super::{FactorAxis, ResponseFigures, Subject};

/// Adds the figure.
pub fn add(subject: &Subject, figures: &mut ResponseFigures) {
    if subject.effects.model != Model::Quadratic {
        return;
    }
    let Some(factors) = factors(subject) else {
        figures.left_out.push("A response surface needs two factors that are numbers.".to_owned());
        return;
    };
    let value = |coded| predicted(subject, factors, coded).map(|value| subject.unit.value(value));
    let map = FactorMap::new(subject.analysis, factors, factors.map(|factor| &subject.axes[factor]), value);
    if !map.varies() {
        figures
            .left_out
            .push("The response surface is not drawn: the model does not vary over its factors.".to_owned());
        return;
    }
    let stationary = stationary(subject, factors);
    let within = stationary.filter(|(coded, _)| map.is_within(*coded));
    let mark = within.map(|(coded, nature)| (coded, format!("{nature} of the surface")));
    let scale = |range, length| subject.value_axis(range, length);
    let held: Vec<Option<Setting>> =
        subject.axes.iter().map(|axis| axis.factor.factor.is_numeric().then_some(Setting::Coded(0.0))).collect();
    let runs = map.runs(subject.analysis, &held);
    let notes = [subject.held(&factors, "held"), runs.note(), said_of_impossible(subject, &map)];
    let page = map.page(scale, "no prediction", &[], &runs, mark, &notes);
    let caption = caption(subject, &map, stationary);
    subject.add(figures, "surface", "Response surface of", caption, page);
}

/// What is said of a surface that goes where the response cannot be.
fn said_of_impossible(subject: &Subject, map: &FactorMap) -> String {
    subject.note_of_impossible(map.range().into_iter()).trim_start_matches("grey: ").to_owned()
}

/// The two numeric factors that have the largest share in the differences between runs, in the order of the study.
fn factors(subject: &Subject) -> Option<[usize; 2]> {
    let effects = subject.effects;
    let mut numeric: Vec<(usize, f64)> = (0..subject.axes.len())
        .filter(|factor| subject.axes[*factor].factor.factor.is_numeric())
        .map(|factor| {
            let own = effects.terms.iter().filter(|term| term.factors.contains(&factor));
            (factor, own.map(|term| term.sum_of_squares).sum())
        })
        .collect();
    numeric.sort_by(|one, other| other.1.total_cmp(&one.1));
    match numeric[..] {
        [(one, _), (other, _), ..] => Some([one.min(other), one.max(other)]),
        _ => None,
    }
}

/// The predicted response where two factors have these coded values, in SI units.
fn predicted(subject: &Subject, factors: [usize; 2], coded: [f64; 2]) -> Option<f64> {
    let given = [0, 1].map(|at| (factors[at], Setting::Coded(coded[at])));
    subject.effects.predict_at(&given).ok().map(|prediction| prediction.value)
}

/// Where the response over two factors is level, in coded values, and what it is there.
fn stationary(subject: &Subject, factors: [usize; 2]) -> Option<([f64; 2], &'static str)> {
    level_point(|x, y| predicted(subject, factors, [x, y]))
}

/// Where a polynomial of second degree is level, and what it is there: six of its values tell it.
fn level_point(at: impl Fn(f64, f64) -> Option<f64>) -> Option<([f64; 2], &'static str)> {
    let centre = at(0.0, 0.0)?;
    let (left, right, below, above) = (at(-1.0, 0.0)?, at(1.0, 0.0)?, at(0.0, -1.0)?, at(0.0, 1.0)?);
    let slopes = [0.5 * (right - left), 0.5 * (above - below)];
    let squares = [0.5 * (right + left) - centre, 0.5 * (above + below) - centre];
    let product = at(1.0, 1.0)? - centre - slopes[0] - slopes[1] - squares[0] - squares[1];
    // 2·B·x = −b, with B = [[b11, b12/2], [b12/2, b22]].
    let determinant = 4.0 * squares[0] * squares[1] - product * product;
    let size = (2.0 * squares[0]).powi(2) + (2.0 * squares[1]).powi(2) + product * product;
    if determinant.abs() <= 1e-9 * size {
        return None;
    }
    let x = (product * slopes[1] - 2.0 * squares[1] * slopes[0]) / determinant;
    let y = (product * slopes[0] - 2.0 * squares[0] * slopes[1]) / determinant;
    let nature = match (determinant > 0.0, squares[0] > 0.0) {
        (true, true) => "minimum",
        (true, false) => "maximum",
        (false, _) => "saddle",
    };
    Some(([x, y], nature))
}

fn caption(subject: &Subject, map: &FactorMap, stationary: Option<([f64; 2], &'static str)>) -> String {
    let mut caption =
        "Response that the quadratic model predicts, with lines of equal response and their values, as far as there are runs.".to_owned();
    let others = subject.axes.iter().enumerate().filter(|(factor, _)| !map.factors.contains(factor));
    let (numbers, words): (Vec<_>, Vec<_>) =
        others.map(|(_, axis)| axis).partition(|axis| axis.factor.factor.is_numeric());
    if !numbers.is_empty() {
        let middle = |axis: &&FactorAxis| format!("{} = {}", axis.plain_name(), axis.name(Setting::Coded(0.0)));
        caption.push_str(&format!(
            " Shown are the two factors with the largest share; the others are at 0 in coded units, the middle of their \
             range: {}.",
            numbers.iter().map(middle).collect::<Vec<_>>().join(", ")
        ));
    }
    if !words.is_empty() {
        let words: Vec<&str> = words.iter().map(|axis| axis.plain_name()).collect();
        caption.push_str(&format!(" It is averaged over the levels of {}.", words.join(", ")));
    }
    match stationary {
        None => caption.push_str(" The surface is a ridge: it has no single stationary point."),
        Some((coded, nature)) => {
            let place = |at: usize| {
                let axis = map.axes[at];
                format!("{} = {}", axis.plain_name(), axis.name(Setting::Coded(coded[at])))
            };
            let beyond = if map.is_within(coded) { "" } else { ", beyond the map" };
            caption.push_str(&format!(" It is level at {}, {}: a {nature}{beyond}.", place(0), place(1)));
        }
    }
    caption
}

#[cfg(test)]
mod tests {
    use super::level_point;

    #[test]
    fn the_level_point_of_a_polynomial() {
        // By hand: slopes 2·(x − 0.5) + (y + 0.25) and (x − 0.5) − 4·(y + 0.25) are zero there; 2·(−4) − 1 < 0: a saddle.
        let saddle = |x: f64, y: f64| {
            let (x, y) = (x - 0.5, y + 0.25);
            Some(7.0 + x * x + x * y - 2.0 * y * y)
        };
        let ([x, y], nature) = level_point(saddle).unwrap();
        assert!((x - 0.5).abs() < 1e-12 && (y + 0.25).abs() < 1e-12 && nature == "saddle");
        let bowl = |sign: f64| level_point(move |x, y| Some(sign * (x * x + x * y + y * y))).unwrap().1;
        assert_eq!([bowl(1.0), bowl(-1.0)], ["minimum", "maximum"]);
        assert_eq!(level_point(|x, y| Some((x + y) * (x + y) + x)), None);
        assert_eq!(level_point(|x, _| Some(x)), None);
    }
}
