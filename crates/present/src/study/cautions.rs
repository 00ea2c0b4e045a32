//! What a design cannot tell, or tells otherwise than one may think.

use plateau_io::brief;
use plateau_study::design::Setting;
use plateau_study::effects::FactorKind;

use super::analysis::Analysis;

/// Correlation of two factors over the runs above which they are said to change together.
const TOGETHER: f64 = 0.999;

/// Coded values that differ by less are the same.
const SAME: f64 = 1e-9;

/// Pairs of factors that change together in all runs: a sentence for each.
pub fn together(analysis: &Analysis) -> Vec<String> {
    let values: Vec<Vec<f64>> = (0..analysis.factors.len())
        .map(|factor| analysis.runs.iter().map(|(settings, _)| place(settings[factor])).collect())
        .collect();
    let name = |at: usize| &analysis.factors[at].factor.name;
    let pairs = (0..values.len()).flat_map(|one| (one + 1..values.len()).map(move |other| (one, other)));
    let alike = pairs.filter(|(one, other)| correlation(&values[*one], &values[*other]).abs() > TOGETHER);
    alike
        .map(|(one, other)| {
            format!(
                "{} and {} change together in all runs: what one of them does cannot be told from what the other does",
                name(one),
                name(other)
            )
        })
        .collect()
}

/// That parts of the variance of numbers with two levels and of ranges cannot be compared; none where there are not both.
pub fn levels_and_ranges(analysis: &Analysis) -> Option<String> {
    let of = |is: fn(&FactorKind) -> bool| {
        let names = analysis.factors.iter().filter(move |factor| is(&factor.factor.kind));
        brief::list(names.map(|factor| &factor.factor.name), ", ")
    };
    let levels = of(|kind| matches!(kind, FactorKind::Levels(values) if values.len() == 2));
    let ranges = of(|kind| matches!(kind, FactorKind::Range { .. }));
    (!levels.is_empty() && !ranges.is_empty()).then(|| {
        format!(
            "{levels}: numbers with two levels vary between these alone, which counts three times as much as an even variation \
             over a range, as of {ranges}; give all of them range = [lower, upper] to compare their parts"
        )
    })
}

/// Numbers of which the runs have two values alone.
pub fn with_two_values(analysis: &Analysis) -> Vec<usize> {
    let has_two = |at: &usize| {
        let factor = &analysis.factors[*at].factor;
        let coded = analysis.runs.iter().filter_map(|(settings, _)| factor.coded(settings[*at]));
        let mut coded: Vec<f64> = coded.collect();
        coded.sort_unstable_by(f64::total_cmp);
        coded.dedup_by(|one, other| (*one - *other).abs() < SAME);
        factor.is_numeric() && coded.len() == 2
    };
    (0..analysis.factors.len()).filter(has_two).collect()
}

/// Those of them between whose values one of these places lies.
pub fn between_two_values(analysis: &Analysis, places: &[&[Setting]]) -> Vec<usize> {
    let is_between = |at: &usize| {
        let coded = |settings: &&[Setting]| match settings[*at] {
            Setting::Coded(coded) => Some(coded),
            setting => analysis.factors[*at].factor.coded(setting),
        };
        places.iter().filter_map(coded).any(|coded| coded.abs() < 1.0 - SAME)
    };
    with_two_values(analysis).into_iter().filter(is_between).collect()
}

/// That the runs show no curve of these factors, which have two values, and what to do; none of no factors.
pub fn no_curve(analysis: &Analysis, factors: &[usize]) -> Option<String> {
    let names: Vec<&str> = factors.iter().map(|at| analysis.factors[*at].factor.name.as_str()).collect();
    let each = if names.len() == 1 { "it" } else { "each" };
    (!names.is_empty()).then(|| {
        format!(
            "{}: the runs have two values of {each}, so that they show no curve: between these, forecasts follow a straight line, and \
             their intervals do not know by how much the response bends; give a third value in the middle, such as with design = \
             \"central-composite\", and look with --confirm how far off a forecast is",
            brief::list(&names, ", ")
        )
    })
}

fn place(setting: Setting) -> f64 {
    match setting {
        Setting::Coded(coded) => coded,
        Setting::Level(level) => level as f64,
    }
}

/// 0 where one of them does not vary.
fn correlation(one: &[f64], other: &[f64]) -> f64 {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mean_one, mean_other) = (mean(one), mean(other));
    let (mut both, mut squares) = (0.0, [0.0; 2]);
    for (one, other) in one.iter().zip(other) {
        let (one, other) = (one - mean_one, other - mean_other);
        both += one * other;
        squares[0] += one * one;
        squares[1] += other * other;
    }
    let length = (squares[0] * squares[1]).sqrt();
    if length > 0.0 { both / length } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::correlation;

    #[test]
    fn correlations_by_hand() {
        assert!((correlation(&[0.0, 1.0, 2.0], &[5.0, 3.0, 1.0]) + 1.0).abs() < 1e-15);
        assert_eq!(correlation(&[-1.0, 1.0, -1.0, 1.0], &[-1.0, -1.0, 1.0, 1.0]), 0.0);
        assert_eq!(correlation(&[2.0, 2.0], &[0.0, 1.0]), 0.0);
        assert_eq!(correlation(&[], &[]), 0.0);
    }
}
