//! What a fit to an experiment tells, in words and in the units of the study.

use plateau_io::number;
use plateau_io::study::factor::{Factor, Values};
use plateau_study::fit::{Combination, FitResult, FittedResponse, Piece, Profile};

use super::reading::Reading;
use crate::quantity::{Unit, power_of_axis, printed_unit, with_power};

/// Probability below which a misfit is said.
const SIGNIFICANT: f64 = 0.05;
/// Parts of one that exponents are printed to.
const EXPONENT: f64 = 1e4;
/// Deviation of a single response, by its standard deviation, that is said where there are no degrees of freedom.
const FAR: f64 = 2.0;
/// Digits of values.
const DIGITS: usize = 4;

/// A key of a fit as people read it.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedKey {
    /// Its name.
    pub name: String,
    /// Whether equal steps of its range are equal ratios.
    pub logarithmic: bool,
    reading: Reading,
    /// Power of ten that the axes of figures have, so that their numbers are short.
    power: i32,
}

impl FittedKey {
    /// A factor of the study.
    pub fn of(factor: &Factor) -> Self {
        let (stated, logarithmic) = match &factor.values {
            // One end may be zero, which is so in any unit.
            Values::Range { low, high, logarithmic } => (vec![high, low], *logarithmic),
            Values::Levels(levels) => (levels.iter().collect(), false),
        };
        let numbers: Vec<f64> = stated.iter().filter_map(|level| level.number).collect();
        let reading = Reading::of_factor(factor, stated, false);
        let ends = [numbers.first(), numbers.last()].map(|end| end.map_or(0.0, |end| reading.value(*end)));
        let power = power_of_axis(ends, logarithmic);
        Self { name: factor.name.clone(), logarithmic, reading, power }
    }

    /// A value in the unit in which the study states the key.
    pub fn value(&self, si: f64) -> f64 {
        self.reading.value(si)
    }

    /// The unit; empty for plain numbers.
    pub fn unit(&self) -> &str {
        &self.reading.unit
    }

    /// A value as it lies on an axis.
    pub fn on_axis(&self, si: f64) -> f64 {
        self.value(si) / libm::pow(10.0, f64::from(self.power))
    }

    /// What an axis says.
    pub fn label(&self) -> String {
        match with_power(self.power, &printed_unit(self.unit())).as_str() {
            "" => self.name.clone(),
            unit => format!("{}, {unit}", self.name),
        }
    }

    /// A value with its unit.
    pub fn words(&self, si: f64) -> String {
        format!("{} {}", number::rounded(self.value(si), DIGITS), self.unit()).trim_end().to_owned()
    }

    /// An interval in words, with what the data do not determine of it.
    pub fn interval(&self, profile: &Profile) -> String {
        let number = |si: f64| number::rounded(self.value(si), DIGITS);
        let piece = |Piece { ends: [low, high], open }: &Piece| match open {
            [false, false] => format!("{} … {}", number(*low), self.words(*high)),
            [true, false] => format!("up to {}; the data set no lower limit", self.words(*high)),
            [false, true] => format!("from {} on; the data set no upper limit", self.words(*low)),
            [true, true] => {
                format!("not determined by these data: anywhere from {} to {}", number(*low), self.words(*high))
            }
        };
        parts(profile).iter().map(piece).collect::<Vec<_>>().join(" or ")
    }
}

/// The pieces of an interval, without the parts between two places of the profile where that is above the threshold.
pub fn parts(profile: &Profile) -> Vec<Piece> {
    let places: Vec<(f64, f64)> = profile.values.iter().copied().zip(profile.rises.iter().copied()).collect();
    let mut parts = Vec::new();
    for Piece { ends: [low, high], open } in &profile.pieces {
        let (mut begin, mut is_open) = (Some(*low), open[0]);
        let within = |value: f64| value > *low && value < *high;
        for pair in places.windows(2).filter(|pair| within(pair[0].0) || within(pair[1].0)) {
            let [(from, rise), (to, next)] = [pair[0], pair[1]];
            if (rise <= profile.threshold) == (next <= profile.threshold) {
                continue;
            }
            let share =
                if next.is_finite() && rise.is_finite() { (profile.threshold - rise) / (next - rise) } else { 0.5 };
            let crossing = from + share * (to - from);
            // The ends themselves are known better.
            if !within(from) && rise > profile.threshold || !within(to) && next > profile.threshold {
                continue;
            }
            match begin.take() {
                Some(low) if next > profile.threshold => {
                    parts.push(Piece { ends: [low, crossing], open: [is_open, false] });
                    is_open = false;
                }
                begun => begin = begun.or(Some(crossing)),
            }
        }
        parts.extend(begin.map(|low| Piece { ends: [low, *high], open: [is_open, open[1]] }));
    }
    parts
}

/// The unit in which a response and its deviations are read.
pub fn unit(si: &str, response: &FittedResponse) -> Unit {
    Unit::readable_with_differences(si, response.measurement.value.abs().max(response.forecast.abs()))
}

/// What is determined where single keys are not; none where there is nothing to say.
pub fn determined(result: &FitResult, keys: &[FittedKey]) -> Option<String> {
    let Some(combinations) = &result.combinations else { return better_known(result, keys) };
    let is_closed = |profile: &Profile| profile.pieces.iter().all(|piece| piece.open == [false; 2]);
    if combinations.is_empty() {
        // The curvature at one place and the profiles need not agree: what has an interval is determined.
        if result.profiles.iter().any(is_closed) {
            return None;
        }
        return Some("Near the most likely values these data determine none of the keys.".to_owned());
    }
    // Single keys have their intervals.
    if combinations.iter().all(|combination| combination.powers.len() < 2) {
        return None;
    }
    let words: Vec<String> = combinations.iter().map(|combination| told(combination, result, keys)).collect();
    let verb = if words.len() == 1 { "is" } else { "are" };
    Some(format!("Only {} {verb} determined by these data, near the most likely values.", words.join(" and ")))
}

/// What is known better than the keys where these are determined, too.
fn better_known(result: &FitResult, keys: &[FittedKey]) -> Option<String> {
    let words: Vec<String> = result.better_known.iter().map(|combination| told(combination, result, keys)).collect();
    let verb = if words.len() == 1 { "is" } else { "are" };
    let said =
        format!("{} {verb} known far better than the keys in it, near the most likely values.", words.join(" and "));
    (!words.is_empty()).then_some(said)
}

/// A product with its value, interval and unit.
fn told(combination: &Combination, result: &FitResult, keys: &[FittedKey]) -> String {
    // With the exponents as they are printed, so that who multiplies gets this number.
    let power = |(key, exponent): &(usize, f64)| libm::pow(keys[*key].value(result.best[*key]), printed(*exponent));
    let value: f64 = combination.powers.iter().map(power).product();
    let [value, low, high] =
        [value, value / combination.factor, value * combination.factor].map(|value| number::rounded(value, DIGITS));
    let units = combination.powers.iter().map(|(key, _)| keys[*key].unit()).filter(|unit| !unit.is_empty());
    let units: Vec<&str> = units.collect();
    let units = if units.is_empty() { String::new() } else { format!(", with {}", units.join(" and ")) };
    format!("{} = {value} ({low} … {high}{units})", product(combination, keys))
}

/// An exponent with as many digits as are printed. A key such as 7·10⁻¹⁴ makes much of a small difference.
fn printed(exponent: f64) -> f64 {
    (exponent * EXPONENT).round() / EXPONENT
}

/// A product of powers.
fn product(combination: &Combination, keys: &[FittedKey]) -> String {
    let power = |(key, exponent): &(usize, f64)| {
        let name = &keys[*key].name;
        match printed(*exponent) {
            1.0 => name.clone(),
            exponent => format!("{name}^{}", number::with_minus(&exponent.to_string())),
        }
    };
    combination.powers.iter().map(power).collect::<Vec<_>>().join(" × ")
}

/// What is to be known before the intervals are trusted: misfit, scatter between seeds, want of runs, and where further runs
/// would have changed little, why.
pub fn notes(result: &FitResult, names: &[&str], of_series: &[&str], has_no_gain: bool) -> Vec<String> {
    let mut notes = Vec::new();
    if let Some(p) = result.p.filter(|p| *p < SIGNIFICANT) {
        notes.push(format!(
            "No values within these ranges give all that was measured: misfit χ² = {} with {}, p = {}. The intervals are those \
             of a model that does not fit.",
            number::rounded(result.misfit, 3),
            number::count(result.freedom, "degree") + " of freedom",
            number::significant(p, 2)
        ));
    }
    if result.responses.iter().any(|response| response.scatter.is_none()) {
        notes.push(
            "Each point was run with one set of surfaces, so what differs from one to the next is not known; a process may take it for \
             shape, and an interval may be too short. [replicates] with several seeds tells it."
                .to_owned(),
        );
    }
    for (response, name) in result.responses.iter().zip(names) {
        let fixed =
            response.measurement.uncertainty.hypot(response.seeds_deviation).hypot(response.surrogate_deviation);
        let far = (response.forecast - response.measurement.value).abs() / fixed;
        if result.freedom == 0 && far > FAR {
            notes.push(format!(
                "At the most likely values runs give a {name} that is {} standard deviations away from what was measured: no values \
                 within these ranges give all that was measured.",
                number::rounded(far, 2)
            ));
        }
        if response.scatter.is_some_and(|scatter| scatter > response.measurement.uncertainty) {
            notes.push(format!(
                "Runs with other seeds scatter in {name} by more than the uncertainty of the measurement. Specimens may do the \
                 same: unless the measurement is a mean of many specimens, add that scatter to its uncertainty."
            ));
        }
        if response.seeds_deviation > 0.5 * response.measurement.uncertainty {
            notes.push(format!(
                "The mean of {name} over the seeds is known no better than to half the uncertainty of the measurement: more \
                 seeds in [replicates] make the intervals shorter."
            ));
        }
    }
    let share = match result.surrogate_share {
        share if share < 2.0 => number::percent(share) + " of",
        share => number::rounded(share, 2) + " times",
    };
    let known = format!(
        "The forecasts are not exact: near the most likely values their variance is up to {share} that of a measurement"
    );
    if let Some(worst) = result.worst.filter(|_| has_no_gain) {
        let name = if worst.is_series { of_series[worst.number] } else { names[worst.number] };
        notes.push(format!(
            "{known}, and all runs that [fit] allows besides would hardly lessen it: runs miss what the others forecast of {name} by {} \
             times the uncertainty of the measurement, as they do where they scatter from one surface, or one place, to the next. \
             More sets of seeds in [replicates] lessen that; if a single specimen was measured, add its scatter to the uncertainty.",
            number::rounded(worst.missed, 2)
        ));
    } else if !result.settled {
        notes.push(format!("{known}: more runs in [fit] make the intervals shorter."));
    }
    notes
}

#[cfg(test)]
mod tests {
    use super::*;
    use plateau_io::study::level::Level;

    fn key(name: &str, ends: [&str; 2]) -> FittedKey {
        let level = |text: &str| Level::new("operation.normal_force", &toml::Value::String(text.to_owned()));
        let [low, high] = ends.map(level);
        let values = Values::Range { low, high, logarithmic: false };
        FittedKey::of(&Factor {
            name: name.into(),
            keys: vec!["operation.normal_force".into()],
            stated_unit: String::new(),
            values,
        })
    }

    #[test]
    fn intervals_say_what_is_not_determined() {
        let load = key("load", ["1 kN", "2 kN"]);
        let profile = |ends: [f64; 2], open: [bool; 2]| Profile {
            values: Vec::new(),
            rises: Vec::new(),
            threshold: 3.84,
            pieces: vec![Piece { ends, open }],
        };
        let words = |ends, open| load.interval(&profile(ends, open));
        assert_eq!(words([1200.0, 1500.0], [false, false]), "1.2 … 1.5 kN");
        assert_eq!(words([1000.0, 1500.0], [true, false]), "up to 1.5 kN; the data set no lower limit");
        assert_eq!(words([1200.0, 2000.0], [false, true]), "from 1.2 kN on; the data set no upper limit");
        assert_eq!(words([1000.0, 2000.0], [true, true]), "not determined by these data: anywhere from 1 to 2 kN");
    }

    #[test]
    fn a_stretch_above_the_limit_is_in_no_interval() {
        let profile = Profile {
            values: vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
            rises: vec![8.0, 0.0, 1.0, 9.0, 3.0, 0.0],
            threshold: 4.0,
            pieces: vec![Piece { ends: [1.4, 6.0], open: [false, true] }],
        };
        let found = parts(&profile);
        // By hand: 1 + 3/8 of the way from 3 to 4, and 5/6 of that from 4 to 5.
        let ends: Vec<[f64; 2]> = found.iter().map(|piece| piece.ends).collect();
        assert!((ends[0][1] - 3.375).abs() < 1e-12 && (ends[1][0] - 4.833_333).abs() < 1e-5, "{ends:?}");
        assert_eq!((ends.len(), ends[0][0], ends[1][1]), (2, 1.4, 6.0));
        assert_eq!(found.iter().map(|piece| piece.open).collect::<Vec<_>>(), [[false, false], [false, true]]);
        let whole = Profile { rises: vec![8.0, 0.0, 1.0, 2.0, 3.0, 0.0], ..profile };
        assert_eq!(parts(&whole), whole.pieces);
        // All of it below, from end to end.
        let open = vec![Piece { ends: [1.0, 6.0], open: [true, true] }];
        let flat = Profile { rises: vec![0.0; 6], pieces: open, ..whole };
        assert_eq!(parts(&flat), flat.pieces);
    }

    #[test]
    fn a_ridge_in_words() {
        let keys = [key("captured fraction", ["1 N", "2 N"]), key("load", ["1 N", "2 N"])];
        let combination = Combination { powers: vec![(0, 1.0), (1, 0.9)], factor: 1.1 };
        assert_eq!(product(&combination, &keys), "captured fraction × load^0.9");
    }
}
