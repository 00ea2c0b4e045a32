//! Doubts about measured heights: another unit, a number that stands for no height, or too little to go by.

use super::heights::rms;
use super::{Body, Length, Patch};
use crate::model::mesh::Mesh;

/// Distances of points that are not wondered at, m: of atoms, and of what a coordinate measuring machine probes.
const PITCHES: [f64; 2] = [0.1e-9, 1e-3];
/// Rms heights that are not wondered at, m: of a polished mirror, and ten times that of a disc which is scored deeply.
const RMS_HEIGHTS: [f64; 2] = [5e-9, 1e-3];
/// Rms slope that is not wondered at: that of a surface which stands at 79 degrees.
const STEEPEST: f64 = 5.0;
/// Fewest points with one height that may stand for points without a height.
const FEWEST: usize = 5;
/// Heights that tell the quartiles of all, about.
const MOST_LOOKED_AT: usize = 100_000;
/// Times the interquartile range of all others that this height is from their quartiles at least.
const FAR: f64 = 10.0;
/// Times that range that the height 0 is from the nearest of the others at least: it most often stands for no height, and may be near.
const GAP_OF_ZERO: f64 = 2.0;

/// Signs of another unit in a measured surface: in its pitch along x and y, if it is known, its rms height, both m, or its slopes, for
/// heights in a wrong unit are steep as well. The heights are as of [`odd_slope`].
pub fn odd_units(heights: &[f64], rows: usize, pitch: Option<[f64; 2]>, rms: f64) -> impl Iterator<Item = String> {
    let distances = pitch.and_then(|pitch| odd_pitch(&pitch, None));
    let steep = || pitch.and_then(|pitch| odd_slope(heights, rows, pitch));
    distances.into_iter().chain(odd_rms(rms).or_else(steep))
}

/// Distances of points, m, that no measurement of a body so long has are in another unit.
pub fn odd_pitch(pitches: &[f64], longest: Option<(&str, f64)>) -> Option<String> {
    let (least, largest) = pitches
        .iter()
        .fold((f64::INFINITY, 0.0), |(least, largest): (f64, f64), pitch| (least.min(*pitch), largest.max(*pitch)));
    let too_long = longest.filter(|(_, length)| largest > *length);
    let (pitch, bound) = if let Some((name, length)) = too_long {
        (largest, format!("the whole {name} is {} long", Length(length)))
    } else if largest > PITCHES[1] {
        (largest, format!("expected at most {}", Length(PITCHES[1])))
    } else if least < PITCHES[0] {
        (least, format!("expected at least {}", Length(PITCHES[0])))
    } else {
        return None;
    };
    Some(format!(
        "the points are {} apart, {bound}: check the unit of pitch or pixel, or that of the file",
        Length(pitch)
    ))
}

/// An rms height, m, that no friction surface has is in another unit.
pub fn odd_rms(rms: f64) -> Option<String> {
    let [least, largest] = RMS_HEIGHTS;
    let bound = if rms > largest {
        format!("at most {}", Length(largest))
    } else if rms > 0.0 && rms < least {
        format!("at least {}", Length(least))
    } else {
        return None;
    };
    Some(format!(
        "the heights have an rms of {} about their mean, expected {bound}: check their unit (key unit)",
        Length(rms)
    ))
}

/// Slopes, in rms over neighbours along x and along y, that heights and distances of different units give. Heights are m, in columns of so
/// many rows, NaN where there is none; `pitch` along x and y, m.
pub fn odd_slope(heights: &[f64], rows: usize, pitch: [f64; 2]) -> Option<String> {
    let along = heights.iter().zip(heights.iter().skip(rows)).map(|(one, next)| (next - one) / pitch[0]);
    let columns = heights.chunks(rows.max(1));
    let across = columns.flat_map(|column| column.windows(2).map(|pair| (pair[1] - pair[0]) / pitch[1]));
    let rms = |slopes: &mut dyn Iterator<Item = f64>| {
        let (sum, count) = slopes
            .filter(|slope| slope.is_finite())
            .fold((0.0, 0), |(sum, count), slope| (sum + slope * slope, count + 1));
        if count == 0 { 0.0 } else { (sum / f64::from(count)).sqrt() }
    };
    let largest = rms(&mut along.into_iter()).max(rms(&mut across.into_iter()));
    (largest > STEEPEST).then(|| {
        format!(
            "heights of neighbours differ by {largest:.2} times their distance (rms), expected at most {STEEPEST}: check the units of distances and \
             heights, many instruments write mm beside um"
        )
    })
}

/// Many points with one height far from all others, m: programs write a number such as -9999 where there is no height.
///
/// The others are told by their quartiles, so that neither a tilt nor spikes count.
pub fn stand_in(heights: &[f64]) -> Option<String> {
    let ends = heights.iter().filter(|height| height.is_finite()).fold(None, |ends: Option<[f64; 2]>, height| {
        let [low, high] = ends.unwrap_or([*height; 2]);
        Some([low.min(*height), high.max(*height)])
    })?;
    ends.into_iter().find_map(|end| {
        let count = heights.iter().filter(|height| **height == end).count();
        if count < FEWEST {
            return None;
        }
        // Quartiles of a part of them are near enough, and take no memory to speak of.
        let others = heights.iter().copied().filter(|height| height.is_finite() && *height != end);
        let mut others: Vec<f64> = others.step_by(heights.len() / MOST_LOOKED_AT + 1).collect();
        if others.len() < FEWEST {
            return None;
        }
        let quarter = others.len() / 4;
        let mut at = |place: usize| *others.select_nth_unstable_by(place, f64::total_cmp).1;
        let [low, high] = [at(quarter), at(3 * quarter)];
        let width = high - low;
        let gap = || {
            let others = heights.iter().filter(|height| height.is_finite() && **height != end);
            others.fold(f64::INFINITY, |gap, height| gap.min((height - end).abs()))
        };
        let is_far = (low - end).max(end - high) > FAR * width || end == 0.0 && gap() > GAP_OF_ZERO * width;
        (is_far && width > 0.0).then(|| {
            format!(
                "{count} points have the height {}, far from all others, of which half are {} to {}: if it stands for points \
                 without a height, write NaN in its place",
                Length(end),
                Length(low),
                Length(high)
            )
        })
    })
}

/// Fewest points that are not warned of: of so many the rms height is known to 7 % at best.
const FEW: usize = 100;
/// Heights that differ by less than this part of the largest differ by rounding.
const ROUNDING: f64 = 1e-12;

/// Largest rms height after the filling over that before it: a membrane is smooth, so gaps that it fills take rms away.
const MOST_BY_FILLING: f64 = 1.2;

/// Warnings about a patch that is to become heights of `body`, times `scale`; `missing` of its points had no height before they were
/// filled.
pub(super) fn warnings(patch: &Patch, missing: usize, scale: f64, body: Body, mesh: &Mesh) -> Vec<String> {
    let few = few_points(patch, missing);
    // Of a line of points the pitch across it is nobody's measure.
    let axes = [(patch.columns, patch.column_pitch), (patch.rows, patch.row_pitch)];
    let pitch = [patch.column_pitch, patch.row_pitch].map(|pitch| pitch / scale.abs());
    // Heights in a wrong unit are steep as well.
    let steep = || odd_slope(&patch.heights, patch.rows, pitch);
    let pitches: Vec<f64> = axes.into_iter().filter(|(points, _)| *points > 1).map(|(_, pitch)| pitch).collect();
    odd_pitch(&pitches, Some((body.name(), body.length(mesh))))
        .into_iter()
        .chain(odd_rms(rms(&patch.heights) * scale.abs()).or_else(steep))
        .chain(few)
        .map(|warning| format!("warning: {warning}"))
        .collect()
}

/// The rms height of N unrelated normal heights has the relative standard error 1/√(2N); related ones tell less.
fn few_points(patch: &Patch, missing: usize) -> Option<String> {
    let points = patch.heights.len() - missing;
    let size = format!("{} x {} points", patch.columns, patch.rows);
    let measured = if missing > 0 { format!("{size}, {points} of them with a height") } else { size };
    let error = 100.0 / (2.0 * points as f64).sqrt();
    (points < FEW).then(|| {
        format!(
            "the patch has {measured}, which tell its rms height to no better than {error:.0} %: expected {FEW} or more"
        )
    })
}

/// Warns of points that were filled from spikes: the rms height is then larger than that of what was measured.
pub(super) fn rougher_by_filling(before: f64, after: f64, without_outliers: bool) -> Option<String> {
    let advice = if without_outliers {
        "take out more of them: a smaller outliers, or outlier_slope"
    } else {
        "take those out first: outliers = 6"
    };
    (after > MOST_BY_FILLING * before).then(|| {
        format!(
            "warning: filling makes the surface rougher, rms {} -> {}: the missing points lie beside spikes, whose heights they \
             get; {advice}",
            Length(before),
            Length(after)
        )
    })
}

/// Warns of heights of the body that are all equal, but for rounding of heights as large as `largest`, m.
pub(super) fn flat(heights: &[f64], largest: f64, patch: &Patch, body: Body) -> Option<String> {
    let (lowest, highest) = heights
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| (low.min(*height), high.max(*height)));
    (highest - lowest <= ROUNDING * largest).then(|| {
        format!(
            "warning: all heights of the {} are equal, it is flat: the patch of {} x {} points has nothing else after the steps \
             above",
            body.name(),
            patch.columns,
            patch.rows
        )
    })
}
