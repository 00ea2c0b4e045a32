//! What a fit to an experiment tells of the keys: the profile likelihood of each, the region of each pair.

use std::ops::RangeInclusive;

use plateau_study::fit::{FitResult, Pair, Profile};

use super::axes::Axis;
use super::canvas::LINE;
use super::chart::{COLUMN, Chart, Meaning, TWO_COLUMNS, page};
use super::contour::Field;
use super::effects::file_names;
use super::format::Figure;
use super::page::{Content, KeyStyle, Mark};
use super::stroke::{SOLID, Stroke};
use crate::colour::{DATA, DATA_AREA, DERIVED, FAINT, INK};
use crate::study::fit::{FittedKey, parts};
use plateau_io::number;

/// Height of a box, pixels.
const HEIGHT: f64 = 620.0;
/// Boxes beside each other, at most.
const MOST_ACROSS: usize = 3;
/// How far above the threshold profiles are shown, as multiples of it.
const ABOVE: f64 = 2.5;
/// Room below 0, as a part of that.
const BELOW: f64 = 0.05;
/// Whether one sees through what is shaded.
const OPACITY: f64 = 0.3;
/// Places between two places of a region for its lines.
const FINER: usize = 4;
/// What a value without end is taken for.
const HIGH: f64 = 1e6;

/// The figures of a fit: profiles, then a region for each pair. `runs` are the values of the keys of all runs, SI.
pub fn figures(result: &FitResult, keys: &[FittedKey], runs: &[Vec<f64>]) -> Vec<Figure> {
    let names = file_names(keys.iter().map(|key| key.name.as_str()));
    let regions = result.pairs.iter().map(|pair| {
        let [one, other] = pair.keys;
        region(result, pair, keys, runs, format!("region-{}-{}", names[one], names[other]))
    });
    std::iter::once(profiles(result, keys)).chain(regions).collect()
}

fn profiles(result: &FitResult, keys: &[FittedKey]) -> Figure {
    let across = keys.len().min(MOST_ACROSS);
    let width = if across == 1 { COLUMN } else { TWO_COLUMNS };
    let threshold = result.profiles.first().map_or(1.0, |profile| profile.threshold);
    let top = ABOVE * threshold;
    let chart = |(at, (key, profile)): (usize, (&FittedKey, &Profile))| {
        // A profile that is 0 all along is not hidden by the frame.
        let y = Axis::linear(-BELOW * top..=top, "rise of −2 ln L");
        Chart {
            title: String::new(),
            x: axis(key, &profile.values),
            y: if at % across == 0 { y } else { Axis { label: String::new(), ..y } },
            contents: profile_contents(key, profile, result.best[at], top),
        }
    };
    let charts = keys.iter().zip(&result.profiles).enumerate().map(chart).collect();
    let line = |colour, text: String| Meaning { colour, style: KeyStyle::Line(SOLID), text };
    let meanings = [
        line(DATA, "profile likelihood".to_owned()),
        line(DERIVED, format!("limit at {}: {}", level(result), number::rounded(threshold, 3))),
        Meaning { colour: DATA_AREA, style: KeyStyle::Area, text: format!("{} interval", level(result)) },
        line(FAINT, "most likely".to_owned()),
    ];
    Figure {
        name: "profiles".to_owned(),
        title: "Profile likelihood of the keys".to_owned(),
        caption: "How far −2 ln of the likelihood rises when a key is held at a value and all others are as likely as they can \
                  be. Values where it is below the line are in the interval, which is shaded; a profile that stays below it up to an end of the range is \
                  not determined there."
            .to_owned(),
        page: page(width, HEIGHT, across, charts, &meanings),
    }
}

fn profile_contents(key: &FittedKey, profile: &Profile, best: f64, top: f64) -> Vec<Content> {
    let ends = [profile.values.first(), profile.values.last()].map(|end| end.map_or(0.0, |end| key.on_axis(*end)));
    let line = |points: Vec<[f64; 2]>, colour, width| Content::Line { points, stroke: Stroke::solid(colour, width) };
    let best = key.on_axis(best);
    let place = |(value, rise): (&f64, &f64)| [key.on_axis(*value), *rise];
    let places: Vec<[f64; 2]> = profile.values.iter().zip(&profile.rises).map(place).collect();
    let shaded = parts(profile).into_iter().map(|piece| Content::Band {
        spans: spans(&places, piece.ends.map(|end| key.on_axis(end)), profile.threshold),
        colour: DATA,
        opacity: OPACITY,
    });
    let mut contents: Vec<Content> = shaded.collect();
    contents.extend([
        line(vec![[best, 0.0], [best, top]], FAINT, LINE),
        line(vec![[ends[0], profile.threshold], [ends[1], profile.threshold]], DERIVED, LINE + 1),
    ]);
    contents.extend(below(&places, top).into_iter().map(|points| line(points, DATA, LINE + 2)));
    contents
}

/// What lies between a profile and its threshold, from end to end of a piece.
fn spans(places: &[[f64; 2]], ends: [f64; 2], threshold: f64) -> Vec<[f64; 3]> {
    let at = |x: f64| {
        let pair = places.windows(2).find(|pair| pair[0][0] <= x && x <= pair[1][0] && pair[0][0] < pair[1][0]);
        let rise = pair.map_or(threshold, |pair| {
            let share = (x - pair[0][0]) / (pair[1][0] - pair[0][0]);
            pair[0][1].min(HIGH) + share * (pair[1][1].min(HIGH) - pair[0][1].min(HIGH))
        });
        [x, rise.min(threshold), threshold]
    };
    let inner = places.iter().filter(|[x, _]| *x > ends[0] && *x < ends[1]);
    let inner = inner.map(|[x, rise]| [*x, rise.min(threshold), threshold]);
    [at(ends[0])].into_iter().chain(inner).chain([at(ends[1])]).collect()
}

/// The parts of a line that lie below a value, cut where they cross it.
fn below(places: &[[f64; 2]], top: f64) -> Vec<Vec<[f64; 2]>> {
    let mut parts: Vec<Vec<[f64; 2]>> = Vec::new();
    let mut part: Vec<[f64; 2]> = places.first().filter(|[_, y]| *y <= top).copied().into_iter().collect();
    for pair in places.windows(2) {
        let [[x, y], [next_x, next_y]] = [pair[0], pair[1]].map(|[x, y]| [x, y.min(HIGH)]);
        let inside = [y <= top, next_y <= top];
        if inside[0] != inside[1] {
            let share = (top - y) / (next_y - y);
            part.push([x + share * (next_x - x), top]);
        }
        if inside[1] {
            part.push([next_x, next_y]);
        } else if !part.is_empty() {
            parts.push(std::mem::take(&mut part));
        }
    }
    parts.push(part);
    parts.into_iter().filter(|part| part.len() > 1).collect()
}

fn region(result: &FitResult, pair: &Pair, keys: &[FittedKey], runs: &[Vec<f64>], name: String) -> Figure {
    let own = pair.keys.map(|key| &keys[key]);
    let axes = [0, 1].map(|at| axis(own[at], &pair.values[at]));
    // Of two degrees of freedom, the half of all probability lies below −2 ln ½.
    let levels = [(pair.threshold, DATA, level(result)), (2.0 * std::f64::consts::LN_2, DATA_AREA, "50 %".to_owned())];
    let field = finer(pair);
    let rows = field.len().isqrt();
    let place = |[column, row]: [f64; 2]| {
        let at = |place: f64, which: usize| {
            let values = &pair.values[which];
            let place = place / FINER as f64;
            let index = (place as usize).min(values.len() - 2);
            let share = place - index as f64;
            let (from, to) = (own[which].on_axis(values[index]), own[which].on_axis(values[index + 1]));
            if own[which].logarithmic { from * libm::pow(to / from, share) } else { from + share * (to - from) }
        };
        [at(column, 0), at(row, 1)]
    };
    let mut contents = Vec::new();
    for (threshold, colour, _) in &levels {
        for line in (Field { values: &field, rows }).contours(*threshold) {
            let points = line.into_iter().map(place).collect();
            contents.push(Content::Line { points, stroke: Stroke::solid(*colour, LINE + 2) });
        }
    }
    let of_run = |run: &Vec<f64>| [0, 1].map(|at| own[at].on_axis(run[pair.keys[at]]));
    let mut points: Vec<[f64; 2]> = runs.iter().map(of_run).collect();
    points.dedup();
    let is_shown = |[x, y]: &[f64; 2]| axes[0].range.contains(x) && axes[1].range.contains(y);
    points.retain(is_shown);
    contents.push(Content::Marks { points, colour: FAINT, mark: Mark::Point });
    let best = [0, 1].map(|at| own[at].on_axis(result.best[pair.keys[at]]));
    contents.push(Content::Marks { points: vec![best], colour: INK, mark: Mark::Cross });
    let mut meanings: Vec<Meaning> = levels
        .into_iter()
        .map(|(_, colour, text)| Meaning { colour, style: KeyStyle::Line(SOLID), text: format!("region, {text}") })
        .collect();
    let mark = |colour, mark, text: &str| Meaning { colour, style: KeyStyle::Mark(mark), text: text.to_owned() };
    meanings.extend([mark(INK, Mark::Cross, "most likely"), mark(FAINT, Mark::Point, "runs")]);
    let [x, y] = axes;
    let chart = Chart { title: String::new(), x, y, contents };
    let [one, other] = own.map(|key| key.name.as_str());
    Figure {
        name,
        title: format!("Region of {one} and {other}"),
        caption: format!(
            "Values of {one} and {other} that the measurements allow, with all other keys as likely as they can be; the axes show \
             the part of the ranges about them. A region that reaches the edge goes on to the end of a range and beyond, as far \
             as these data tell; a long one is a ridge."
        ),
        page: page(COLUMN, 1.4 * HEIGHT, 1, vec![chart], &meanings),
    }
}

/// Rises column by column on a finer grid, by cubic convolution, which gives every polynomial of second degree as it is. R. G.
/// Keys, IEEE Trans. Acoust. Speech Signal Process. 29(6), 1153–1160 (1981), doi:10.1109/TASSP.1981.1163711.
fn finer(pair: &Pair) -> Vec<f64> {
    let columns = pair.values[0].len();
    let rows = pair.values[1].len();
    let value = |column: usize, row: usize| pair.rises[row * columns + column].min(HIGH);
    // First along the columns, then along the rows.
    let along: Vec<Vec<f64>> =
        (0..rows).map(|row| convolved(&(0..columns).map(|column| value(column, row)).collect::<Vec<_>>())).collect();
    let wide = (columns - 1) * FINER + 1;
    let column = |column: usize| convolved(&along.iter().map(|row| row[column]).collect::<Vec<_>>());
    (0..wide).flat_map(column).map(|rise| rise.max(0.0)).collect()
}

/// Values between values.
fn convolved(values: &[f64]) -> Vec<f64> {
    let at = |index: isize| match usize::try_from(index) {
        // Beyond the ends the parabola through the last three.
        Err(_) => 3.0 * values[0] - 3.0 * values[1] + values[2],
        Ok(index) if index < values.len() => values[index],
        Ok(_) => {
            let last = values.len() - 1;
            3.0 * values[last] - 3.0 * values[last - 1] + values[last - 2]
        }
    };
    let fine = |place: usize| {
        let index = (place / FINER).min(values.len() - 2);
        let t = (place - index * FINER) as f64 / FINER as f64;
        let index = index as isize;
        let [a, b, c, d] = [at(index - 1), at(index), at(index + 1), at(index + 2)];
        b + 0.5 * t * ((c - a) + t * ((2.0 * a - 5.0 * b + 4.0 * c - d) + t * (3.0 * (b - c) + d - a)))
    };
    (0..=(values.len() - 1) * FINER).map(fine).collect()
}

/// A key as an axis over its range.
fn axis(key: &FittedKey, values: &[f64]) -> Axis {
    let ends = [values.first(), values.last()].map(|end| end.map_or(0.0, |end| key.on_axis(*end)));
    let range: RangeInclusive<f64> = ends[0]..=ends[1];
    if key.logarithmic { Axis::logarithmic(range, key.label()) } else { Axis::linear(range, key.label()) }
}

fn level(result: &FitResult) -> String {
    number::confidence(result.confidence)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_shaded_is_below_the_limit() {
        let places = [[0.0, 9.0], [1.0, 1.0], [2.0, 0.0], [3.0, 8.0]];
        let found = spans(&places, [0.625, 2.5], 4.0);
        assert_eq!(found, [[0.625, 4.0, 4.0], [1.0, 1.0, 4.0], [2.0, 0.0, 4.0], [2.5, 4.0, 4.0]]);
        assert!(found.iter().all(|[_, low, high]| low <= high));
    }

    #[test]
    fn lines_are_cut_where_they_leave_the_box() {
        let places = [[0.0, 4.0], [1.0, 0.0], [2.0, 1.0], [3.0, f64::INFINITY], [4.0, 1.0], [5.0, 1.5]];
        let parts = below(&places, 2.0);
        assert_eq!(parts.len(), 2);
        assert_eq!(parts[0][..3], [[0.5, 2.0], [1.0, 0.0], [2.0, 1.0]]);
        assert_eq!(parts[1][1..], [[4.0, 1.0], [5.0, 1.5]]);
    }

    #[test]
    fn a_finer_region_has_the_places_it_was_given() {
        // (x − y)² + y², a polynomial of second degree.
        let values = [vec![0.0, 1.0, 2.0], vec![0.0, 1.0, 2.0]];
        let rise = |x: f64, y: f64| (x - y).powi(2) + y * y;
        let rises = (0..9).map(|at| rise(f64::from(at % 3), f64::from(at / 3))).collect();
        let pair = Pair { keys: [0, 1], values, rises, threshold: 5.99 };
        let field = finer(&pair);
        let side = 2 * FINER + 1;
        assert_eq!(field.len(), side * side);
        for (at, value) in field.iter().enumerate() {
            let (x, y) = ((at / side) as f64 / FINER as f64, (at % side) as f64 / FINER as f64);
            assert!((value - rise(x, y)).abs() < 1e-9);
        }
    }
}
