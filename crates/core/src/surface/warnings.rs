//! What of a patch can hardly be meant, or is too little to go by.

use super::implausible::{odd_pitch, odd_rms, odd_slope};
use super::level::rms;
use super::{Body, Length, Patch};
use crate::model::mesh::Mesh;

/// Fewest points that are not warned of: of so many the rms height is known to 7 % at best.
const FEW: usize = 100;
/// Heights that differ by less than this part of the largest differ by rounding.
const ROUNDING: f64 = 1e-12;

/// How many times the rms height before the filling it may be afterwards: a membrane is smooth, so gaps that it fills take rms away.
const MOST_BY_FILLING: f64 = 1.2;

/// What a patch that is to become heights of `body`, times `scale`, is warned of; `missing` of its points had no height before they were
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

#[cfg(test)]
mod tests {
    use super::*;

    fn patch(columns: usize, rows: usize, pitch: f64) -> Patch {
        Patch { columns, rows, column_pitch: pitch, row_pitch: pitch, heights: vec![0.0; columns * rows] }
    }

    /// A ring of 138.2 mm by 4 mm with a pin of 8 mm.
    fn of(patch: &Patch, missing: usize, body: Body) -> Vec<String> {
        let mesh = Mesh::new(80, 2765, 160, 20e-3, 24e-3).unwrap();
        warnings(patch, missing, 1.0, body, &mesh)
    }

    #[test]
    fn few_points_are_warned_of_with_the_error_that_they_leave() {
        assert_eq!(of(&patch(10, 10, 1e-6), 0, Body::Disc), [""; 0]);
        // 1/√(2·4) = 0.354.
        let warnings = of(&patch(2, 2, 1e-6), 0, Body::Disc);
        assert_eq!(warnings.len(), 1);
        assert!(
            warnings[0]
                .starts_with("warning: the patch has 2 x 2 points, which tell its rms height to no better than 35 %")
        );
        // Of 120 points 20 are left: 1/√40 = 0.158.
        let warnings = of(&patch(12, 10, 1e-6), 100, Body::Disc);
        assert!(warnings[0].contains("20 of them with a height") && warnings[0].contains("16 %"), "{warnings:?}");
    }

    #[test]
    fn a_pitch_of_another_unit_is_warned_of() {
        for (pitch, body, bound) in [
            (0.2, Body::Disc, "the points are 200 mm apart, the whole ring is 138.2 mm long"),
            (10e-3, Body::Pin, "the points are 10 mm apart, the whole pin is 7.999 mm long"),
            (2e-3, Body::Disc, "the points are 2 mm apart, expected at most 1 mm"),
            (5e-11, Body::Disc, "the points are 0.05 nm apart, expected at least 0.1 nm"),
        ] {
            let warnings = of(&patch(20, 20, pitch), 0, body);
            assert!(warnings[0].contains(bound), "{warnings:?}");
        }
        // The one column of a profile is as long as the ring.
        let profile = Patch { column_pitch: 0.1382, ..patch(1, 200, 1e-6) };
        assert_eq!(of(&profile, 0, Body::Disc), [""; 0]);
    }

    #[test]
    fn heights_of_another_unit_are_warned_of() {
        // Heights of 2 m and of 2 µm, up and down.
        for (height, count) in [(2.0, 1), (2e-6, 0)] {
            let mut patch = patch(20, 20, 1e-6);
            patch.heights.iter_mut().step_by(2).for_each(|value| *value = height);
            patch.heights.iter_mut().skip(1).step_by(2).for_each(|value| *value = -height);
            let warnings = of(&patch, 0, Body::Disc);
            assert_eq!(warnings.len(), count, "{warnings:?}");
            assert!(warnings.iter().all(|text| text.contains("an rms of 2 m about their mean, expected at most 1 mm")));
        }
    }

    #[test]
    fn gaps_that_are_filled_from_spikes_are_warned_of() {
        assert_eq!(rougher_by_filling(1e-6, 1.1e-6, false), None);
        let warning = rougher_by_filling(8.7e-6, 24.5e-6, false).unwrap();
        assert!(warning.contains("rms 8.7 um -> 24.5 um") && warning.ends_with("outliers = 6"), "{warning}");
        assert!(rougher_by_filling(1e-6, 2e-6, true).unwrap().contains("a smaller outliers"));
    }

    #[test]
    fn heights_that_differ_by_rounding_are_flat() {
        let patch = patch(2, 2, 1e-6);
        assert!(
            flat(&[1e-17, -1e-17], 1e-3, &patch, Body::Disc)
                .unwrap()
                .starts_with("warning: all heights of the ring are equal")
        );
        assert_eq!(flat(&[1e-9, -1e-9], 1e-3, &patch, Body::Disc), None);
        assert!(flat(&[0.0, 0.0], 0.0, &patch, Body::Disc).is_some());
    }
}
