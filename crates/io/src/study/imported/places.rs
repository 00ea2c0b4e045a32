//! The runs of a study by their points: which of them a line of a table is of.
//!
//! Tables and designs may have a hundred thousand lines with as many different numbers, so that nothing here looks at all levels or
//! all runs for a single line.

use std::collections::{BTreeSet, HashMap};

use crate::study::level::Level;
use crate::study::plan::Plan;

/// Numbers of a table and of the design are the same if they differ by less than this part of the factor's largest one: tables
/// are rounded by those who write them.
const ROUNDED: f64 = 1e-6;

/// What tells the runs of a study apart: the place of each factor's level among all its levels, and the replicate, if it is
/// given.
pub(super) type Key = (Vec<usize>, Option<usize>);

/// The runs of a study by their points, in the order of the design.
pub(super) struct Places {
    factors: Vec<Levels>,
    points: HashMap<Vec<usize>, Runs>,
}

impl Places {
    pub fn new(plan: &Plan) -> Self {
        let mut factors = vec![Vec::new(); plan.study().factors.len()];
        let mut points: HashMap<Vec<usize>, Runs> = HashMap::new();
        let mut known: Vec<HashMap<String, usize>> = vec![HashMap::new(); factors.len()];
        for place in 0..plan.runs() {
            let run = plan.run(place + 1);
            let mut key = Vec::new();
            for (factor, level) in run.levels.into_iter().enumerate() {
                let levels: &mut Vec<Level> = &mut factors[factor];
                key.push(*known[factor].entry(level.text.clone()).or_insert_with(|| {
                    levels.push(level);
                    levels.len() - 1
                }));
            }
            points.entry(key).or_default().add(place, run.replicate);
        }
        Self { factors: factors.into_iter().map(Levels::new).collect(), points }
    }

    /// Different levels of a factor, in the order in which the design has them.
    pub fn levels(&self, factor: usize) -> &[Level] {
        &self.factors[factor].all
    }

    /// The place of a level among those of its factor; none where it has no such level.
    pub fn find(&self, factor: usize, level: &Level) -> Option<usize> {
        self.factors[factor].find(level)
    }

    /// Whether any run is of a point.
    pub fn has(&self, point: &[usize]) -> bool {
        self.points.contains_key(point)
    }

    /// The first run of a point that no line is of so far.
    pub fn take(&mut self, key: &Key) -> Option<usize> {
        self.points.get_mut(&key.0)?.take(key.1)
    }

    /// How many runs are of a point.
    pub fn count(&self, key: &Key) -> usize {
        self.points.get(&key.0).map_or(0, |runs| runs.count)
    }
}

/// The runs of one point.
#[derive(Default)]
struct Runs {
    /// Those that no line is of so far, with their replicates.
    free: BTreeSet<(usize, usize)>,
    /// The same, by replicate.
    by_replicate: BTreeSet<(usize, usize)>,
    count: usize,
}

impl Runs {
    fn add(&mut self, place: usize, replicate: usize) {
        self.free.insert((place, replicate));
        self.by_replicate.insert((replicate, place));
        self.count += 1;
    }

    /// The first that is free, of a replicate where one is given.
    fn take(&mut self, wanted: Option<usize>) -> Option<usize> {
        let (place, replicate) = match wanted {
            None => *self.free.first()?,
            Some(wanted) => {
                let (replicate, place) = *self.by_replicate.range((wanted, 0)..=(wanted, usize::MAX)).next()?;
                (place, replicate)
            }
        };
        self.free.remove(&(place, replicate));
        self.by_replicate.remove(&(replicate, place));
        Some(place)
    }
}

/// The different levels of a factor.
struct Levels {
    all: Vec<Level>,
    /// Numbers in ascending order, each once, with the first place that has it.
    numbers: Vec<(f64, usize)>,
    /// The first place of each label.
    words: HashMap<String, usize>,
    /// The largest number, without its sign.
    largest: f64,
}

impl Levels {
    fn new(all: Vec<Level>) -> Self {
        let mut words = HashMap::with_capacity(all.len());
        for (place, level) in all.iter().enumerate() {
            words.entry(level.label.clone()).or_insert(place);
        }
        let mut numbers: Vec<(f64, usize)> =
            all.iter().enumerate().filter_map(|(place, level)| Some((level.number?, place))).collect();
        // Stable, so that of equal numbers the first comes first and is kept.
        numbers.sort_by(|one, other| one.0.total_cmp(&other.0));
        numbers.dedup_by(|later, kept| later.0 == kept.0);
        let largest = numbers.iter().fold(0.0_f64, |largest, (number, _)| largest.max(number.abs()));
        Self { all, numbers, words, largest }
    }

    /// The place of a level: of the nearest number, or of the same word.
    fn find(&self, level: &Level) -> Option<usize> {
        let Some(number) = level.number else { return self.words.get(&level.label).copied() };
        let above = self.numbers.partition_point(|(own, _)| *own < number);
        let beside = &self.numbers[above.saturating_sub(1)..self.numbers.len().min(above + 1)];
        let distance = |own: f64| (own - number).abs();
        let by_distance = |one: &&(f64, usize), other: &&(f64, usize)| {
            distance(one.0).total_cmp(&distance(other.0)).then(one.1.cmp(&other.1))
        };
        let nearest = beside.iter().min_by(by_distance)?;
        (distance(nearest.0) <= ROUNDED * self.largest).then_some(nearest.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(label: &str, number: f64) -> Level {
        Level { text: label.into(), label: label.into(), number: Some(number) }
    }

    fn word(label: &str) -> Level {
        Level { text: label.into(), label: label.into(), number: None }
    }

    #[test]
    fn the_nearest_number_is_found_if_it_is_the_same_but_for_rounding() {
        let levels = Levels::new(vec![
            number("5 N", 5.0),
            number("12 N", 12.0),
            number("5.0 N", 5.0),
            number("-3 N", -3.0),
            number("12.000004 N", 12.000004),
        ]);
        let find = |value: f64| levels.find(&number("", value));
        assert_eq!([5.0, 12.0, -3.0, 12.000004].map(find), [Some(0), Some(1), Some(3), Some(4)]);
        // A millionth of 12 to either side, and beyond that and both ends nothing.
        assert_eq!([5.000011, 4.999989, 12.000015, -3.000011].map(find), [Some(0), Some(0), Some(4), Some(3)]);
        assert_eq!([5.000013, 4.0, 12.1, -4.0].map(find), [None; 4]);
        // Halfway the first of the design is taken.
        assert_eq!(Levels::new(vec![number("b", 1.0000005), number("a", 1.0)]).find(&number("", 1.00000025)), Some(0));
        assert_eq!(levels.find(&word("5.0 N")), Some(2));
        assert_eq!((levels.find(&word("dry")), Levels::new(Vec::new()).find(&number("", 1.0))), (None, None));
    }

    #[test]
    fn runs_of_a_point_are_taken_in_their_order() {
        let mut runs = Runs::default();
        // Two lines of a table with two replicates each.
        [(3, 0), (4, 1), (7, 0), (8, 1)].into_iter().for_each(|(place, replicate)| runs.add(place, replicate));
        let taken = [Some(1), None, None, Some(0), Some(1)].map(|replicate| runs.take(replicate));
        assert_eq!(taken, [Some(4), Some(3), Some(7), None, Some(8)]);
        assert_eq!((runs.take(None), runs.count), (None, 4));
    }

    #[test]
    fn a_hundred_thousand_levels_and_runs_are_no_matter_of_minutes() {
        let count = 100_000;
        let levels = Levels::new((0..count).map(|at| number(&format!("{at} N"), at as f64)).collect());
        let mut runs = Runs::default();
        (0..count).for_each(|place| runs.add(place, place % 3));
        for at in 0..count {
            assert_eq!(levels.find(&number("", at as f64)), Some(at));
            assert_eq!(runs.take(None), Some(at));
        }
    }
}
