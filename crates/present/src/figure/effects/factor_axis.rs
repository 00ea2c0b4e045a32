//! The axis of a factor: the values of its range, or its levels, those that are numbers at their values.

use std::ops::RangeInclusive;

use plateau_study::design::Setting;
use plateau_study::effects::FactorKind;

use super::levels::{least_distance, named, places_of};
use crate::figure::axes::Axis;
use crate::figure::canvas::TEXT;
use crate::figure::font::{shortened, text_width};
use crate::quantity::{power_of_axis, printed_number, printed_unit, with_power};
use crate::study::analysed_factor::{AnalysedFactor, LOGARITHM};

/// Room beside the first and the last level, in distances of levels.
const BESIDE: f64 = 0.45;
/// Room beside the ends of a range, as a part of it.
const MARGIN: f64 = 0.06;
/// Room between the names of two levels, pixels.
const BETWEEN: f64 = 24.0;
/// Least length of the axis of a range, pixels.
const SHORTEST: f64 = 300.0;
/// Names longer than this are shortened, pixels.
const LONGEST_NAME: f64 = 440.0;

/// A factor as an axis.
#[derive(Debug, Clone)]
pub struct FactorAxis<'a> {
    /// The factor.
    pub factor: &'a AnalysedFactor,
    /// What its levels are called without the unit, in the order of the factor; none for ranges.
    pub names: Vec<String>,
    /// The unit that all levels have, or the unit of the range, as it is printed.
    pub unit: String,
    /// Power of ten that stands before the unit of a range, so that numbers on the axis are short.
    power: i32,
    /// Where levels stand, in the order of the factor, from 0 to one less than there are levels.
    places: Vec<f64>,
    /// Coded values of the least and the largest setting that was observed.
    ends: [f64; 2],
    /// How many different coded values were observed, at least as far as three tell more than two.
    values: usize,
}

impl<'a> FactorAxis<'a> {
    /// A factor with the settings that it had.
    pub fn new(factor: &'a AnalysedFactor, observed: impl Iterator<Item = Setting>) -> Self {
        let (names, unit) = named(&factor.labels);
        let places = match &factor.factor.kind {
            FactorKind::Levels(values) => places_of(values),
            _ => (0..factor.labels.len()).map(|level| level as f64).collect(),
        };
        let mut coded: Vec<f64> = observed.filter_map(|setting| factor.factor.coded(setting)).collect();
        coded.sort_unstable_by(f64::total_cmp);
        coded.dedup_by(|one, other| (*one - *other).abs() < 1e-9);
        let ends = [coded.first().map_or(-1.0, |low| low.min(-1.0)), coded.last().map_or(1.0, |high| high.max(1.0))];
        let unit = printed_unit(if names.is_empty() { &factor.reading.unit } else { &unit });
        let axis = Self { factor, names, unit, power: 0, places, ends, values: coded.len() };
        Self { power: axis.power_of_range(), ..axis }
    }

    /// The power of ten before the unit where the factor is a range.
    fn power_of_range(&self) -> i32 {
        if self.is_range() { power_of_axis(self.ends.map(|end| self.natural(end)), self.has_equal_ratios()) } else { 0 }
    }

    /// Whether it has values between its ends, so that lines are drawn from predictions.
    pub fn is_continuous(&self) -> bool {
        self.names.is_empty() && self.values > 2
    }

    /// Numeric levels as the range that they span, where a factor is also looked at between them.
    pub fn as_range(self) -> Self {
        let axis = Self { names: Vec::new(), ..self };
        Self { power: axis.power_of_range(), ..axis }
    }

    /// Whether it is a range.
    pub fn is_range(&self) -> bool {
        self.names.is_empty()
    }

    /// The value of a coded setting of a number, in the unit of the study.
    pub fn natural(&self, coded: f64) -> f64 {
        let value = self.analysed(coded);
        if self.factor.reading.is_logarithmic() { 10_f64.powf(value) } else { value }
    }

    /// The value of a coded setting as it stands on the axis: with its power of ten left out.
    pub fn on_axis(&self, coded: f64) -> f64 {
        self.natural(coded) / libm::pow(10.0, f64::from(self.power))
    }

    /// The same as the analysis has it, which may be a logarithm.
    fn analysed(&self, coded: f64) -> f64 {
        let [low, high] = self.factor.factor.range().unwrap_or([-1.0, 1.0]);
        self.factor.reading.value(0.5 * ((1.0 - coded) * low + (1.0 + coded) * high))
    }

    /// Where a setting lies on a straight axis of what the analysis has: a logarithm for a range of equal ratios.
    pub fn straight_place(&self, setting: Setting) -> f64 {
        match setting {
            Setting::Coded(coded) => self.analysed(coded),
            Setting::Level(_) => self.place(setting),
        }
    }

    /// A place beside another one, by a part of the axis.
    pub fn beside(&self, place: f64, part: f64) -> f64 {
        let range = self.range();
        let (start, end) = (*range.start(), *range.end());
        if self.has_equal_ratios() { place * (end / start).powf(part) } else { place + part * (end - start) }
    }

    fn has_equal_ratios(&self) -> bool {
        self.is_range() && self.factor.reading.is_logarithmic()
    }

    /// What the study calls the factor.
    pub fn plain_name(&self) -> &str {
        let name = self.factor.factor.name.as_str();
        if self.has_equal_ratios() { name.strip_prefix(LOGARITHM).unwrap_or(name) } else { name }
    }

    /// An axis of a range between two values.
    pub fn between(&self, range: RangeInclusive<f64>, length: f64) -> Axis {
        let label = shortened(&self.label(), TEXT, length);
        if self.has_equal_ratios() { Axis::logarithmic(range, label) } else { Axis::linear(range, label) }
    }

    /// Where a setting lies on the axis.
    pub fn place(&self, setting: Setting) -> f64 {
        match setting {
            Setting::Level(level) => self.places.get(level).copied().unwrap_or(0.0),
            Setting::Coded(coded) => self.on_axis(coded),
        }
    }

    /// A setting in words.
    pub fn name(&self, setting: Setting) -> String {
        match setting {
            Setting::Level(level) => self.names.get(level).map_or_else(String::new, |name| self.with_unit(name)),
            Setting::Coded(coded) => self.with_unit(&printed_number(self.natural(coded), 3)),
        }
    }

    fn with_unit(&self, number: &str) -> String {
        format!("{number} {}", self.unit).trim_end().to_owned()
    }

    /// What the axis says: name and unit.
    pub fn label(&self) -> String {
        let name = self.plain_name();
        match with_power(self.power, &self.unit).as_str() {
            "" => name.to_owned(),
            unit => format!("{name}, {unit}"),
        }
    }

    /// Settings on the axis: all levels from the left, or so many values from end to end.
    pub fn settings(&self, values: usize) -> Vec<Setting> {
        if self.is_range() {
            let [low, high] = self.ends;
            let last = (values.max(2) - 1) as f64;
            return (0..values).map(|at| Setting::Coded(low + (high - low) * at as f64 / last)).collect();
        }
        let mut levels: Vec<usize> = (0..self.names.len()).collect();
        levels.sort_by(|one, other| self.places[*one].total_cmp(&self.places[*other]));
        levels.into_iter().map(Setting::Level).collect()
    }

    /// Values at the ends of the axis.
    pub fn range(&self) -> RangeInclusive<f64> {
        if !self.is_range() {
            return -BESIDE..=self.names.len() as f64 - 1.0 + BESIDE;
        }
        let margin = MARGIN * (self.ends[1] - self.ends[0]);
        self.on_axis(self.ends[0] - margin)..=self.on_axis(self.ends[1] + margin)
    }

    /// Length that the axis needs to be read, pixels.
    pub fn room(&self) -> f64 {
        let widest = self.names.iter().map(|name| text_width(name, TEXT)).fold(0.0, f64::max);
        let levels = if self.is_range() { SHORTEST } else { (widest + BETWEEN) * self.distances() };
        levels.max(text_width(&self.label(), TEXT).min(LONGEST_NAME))
    }

    /// The axis where it is so long, pixels.
    pub fn axis(&self, length: f64) -> Axis {
        if self.is_range() {
            return self.between(self.range(), length);
        }
        let label = shortened(&self.label(), TEXT, length);
        let names = if self.factor.factor.is_numeric() { self.numbers(length) } else { self.words(length) };
        Axis::marked(self.range(), label, self.places.iter().copied().zip(names).collect())
    }

    /// The names of levels, as much of each as there is room for on an axis of this length.
    fn words(&self, length: f64) -> Vec<String> {
        let room = length / self.distances() - 0.5 * BETWEEN;
        self.names.iter().map(|name| shortened(name, TEXT, room)).collect()
    }

    /// The numbers of levels, whole; nothing in place of those that have no room beside others, the least and the largest of which come first.
    fn numbers(&self, length: f64) -> Vec<String> {
        let distance = length / (self.names.len() as f64 - 1.0 + 2.0 * BESIDE).max(1.0);
        let width = |level: usize| text_width(&self.names[level], TEXT);
        let are_apart = |one: usize, other: usize| {
            let apart = distance * (self.places[one] - self.places[other]).abs();
            apart >= 0.5 * (width(one) + width(other) + BETWEEN)
        };
        let mut levels: Vec<usize> = (0..self.names.len()).collect();
        levels.sort_by(|one, other| self.places[*one].total_cmp(&self.places[*other]));
        if let Some(last) = levels.pop() {
            levels.insert(1.min(levels.len()), last);
        }
        let mut names = vec![String::new(); self.names.len()];
        let mut kept: Vec<usize> = Vec::new();
        for level in levels {
            if kept.iter().all(|other| are_apart(level, *other)) {
                names[level].clone_from(&self.names[level]);
                kept.push(level);
            }
        }
        names
    }

    /// Length of the axis in the least distance of two levels.
    fn distances(&self) -> f64 {
        (self.names.len() as f64 - 1.0 + 2.0 * BESIDE).max(1.0) / least_distance(&self.places).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use plateau_study::effects::Factor;

    use super::*;
    use crate::study::reading::Reading;

    fn factor(name: &str, kind: FactorKind, labels: &[&str]) -> AnalysedFactor {
        let labels = labels.iter().map(|label| (*label).to_owned()).collect();
        AnalysedFactor { factor: Factor { name: name.into(), kind }, labels, reading: Reading::of([], false) }
    }

    #[test]
    fn levels_stand_at_their_values_with_their_unit_beside() {
        let load = factor("load", FactorKind::Levels(vec![20.0, 5.0, 10.0]), &["20 N", "5 N", "10 N"]);
        let axis = FactorAxis::new(&load, (0..3).map(Setting::Level));
        assert_eq!(axis.label(), "load, N");
        let marks = axis.axis(600.0).marks.unwrap();
        // By hand: 10 N are a third of the way from 5 N to 20 N.
        assert_eq!(marks, [(2.0, "20".to_owned()), (0.0, "5".to_owned()), (2.0 / 3.0, "10".to_owned())]);
        assert_eq!(axis.settings(9), [1, 2, 0].map(Setting::Level));
        assert_eq!(axis.name(Setting::Level(0)), "20 N");
    }

    #[test]
    fn levels_that_are_looked_at_between_lie_as_far_apart_as_their_values() {
        let sulphur = factor("sulphur", FactorKind::Levels(vec![1.0, 2.0, 6.0]), &["1 g", "2 g", "6 g"]);
        let axis = FactorAxis::new(&sulphur, (0..3).map(Setting::Level)).as_range();
        assert_eq!(axis.label(), "sulphur, g");
        let places: Vec<f64> = axis.settings(3).into_iter().map(|setting| axis.place(setting)).collect();
        assert_eq!(places, [1.0, 3.5, 6.0]);
        assert!(axis.axis(600.0).marks.is_none());
    }

    #[test]
    fn names_that_have_no_room_are_shortened() {
        let words =
            factor("words", FactorKind::Categorical(vec![String::new(); 2]), &["a long name", "another long name"]);
        let axis = FactorAxis::new(&words, (0..2).map(Setting::Level));
        assert!(axis.axis(axis.room()).marks.unwrap().iter().all(|(_, name)| !name.contains('\u{2026}')));
        let marks = axis.axis(300.0).marks.unwrap();
        assert!(marks.iter().all(|(_, name)| text_width(name, TEXT) <= 300.0 / 1.9));
    }

    #[test]
    fn numbers_that_have_no_room_are_left_out() {
        let labels = ["400 rpm", "700 rpm", "800 rpm", "850 rpm"];
        let speed = factor("speed", FactorKind::Levels(vec![400.0, 700.0, 800.0, 850.0]), &labels);
        let axis = FactorAxis::new(&speed, (0..4).map(Setting::Level));
        let said = |length: f64| axis.axis(length).marks.unwrap().into_iter().map(|(_, name)| name).collect::<Vec<_>>();
        assert_eq!(said(axis.room()), ["400", "700", "800", "850"]);
        // By hand: 850 is a ninth of 3 distances of levels from 800, and a third of them from 700. The axis is 3.9 distances long, so these are
        // 0.085 and 0.256 of it; a number of three digits and what is beside it need about 90 pixels.
        assert_eq!(said(700.0), ["400", "700", "", "850"]);
        assert_eq!(said(250.0), ["400", "", "", "850"]);
    }

    #[test]
    fn small_numbers_have_a_power_of_ten_beside_the_unit() {
        let name = format!("{LOGARITHM}wear rate");
        let levels = ["2e-14 1/Pa", "1e-13 1/Pa"].map(|text| {
            plateau_io::study::level::Level::new(
                "materials.pin_primary.specific_wear_rate",
                &toml::Value::String(text.into()),
            )
        });
        let [low, high] = [0, 1].map(|at| libm::log10(levels[at].number.unwrap()));
        let factor = AnalysedFactor {
            factor: Factor { name, kind: FactorKind::Range { low, high } },
            labels: Vec::new(),
            reading: Reading::of(&levels, true),
        };
        let axis = FactorAxis::new(&factor, [-1.0, 0.0, 1.0].into_iter().map(Setting::Coded));
        assert_eq!(axis.label(), "wear rate, 10⁻¹⁴ 1/Pa");
        assert_eq!(axis.name(Setting::Coded(0.0)), "4.47·10⁻¹⁴ 1/Pa");
        let ticks: Vec<String> = axis.axis(400.0).ticks(4).into_iter().map(|(_, tick)| tick).collect();
        assert_eq!(ticks, ["2", "5", "10"]);
        assert!((axis.place(Setting::Coded(-1.0)) - 2.0).abs() < 1e-9);
    }

    #[test]
    fn ranges_reach_as_far_as_their_points() {
        let load = factor("load", FactorKind::Range { low: 10.0, high: 20.0 }, &[]);
        let axis = FactorAxis::new(&load, [-1.5, -1.0, 0.0, 1.0, 1.5].into_iter().map(Setting::Coded));
        assert!(axis.is_continuous());
        let [first, last] = [0, 1].map(|at| axis.place(axis.settings(2)[at]));
        assert_eq!([first, last], [7.5, 22.5]);
        assert!(*axis.range().start() < first && *axis.range().end() > last);
    }
}
