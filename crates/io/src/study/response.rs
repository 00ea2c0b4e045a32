//! Responses: one number that a run gives for each question of a study.

use std::sync::Arc;

use plateau_core::observe::event::EVENT_QUANTITIES;
use plateau_core::observe::window_mean::{Cumulative, WindowMean, last_tenth};
use plateau_core::observe::{EXTRAS, quantities};

use plateau_study::effects::Transform;

use super::measured_series::SeriesFile;
use super::record::{EVENT, REVOLUTIONS, Series};

/// A question to the series of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Response {
    /// Its name.
    pub name: String,
    /// The series that is asked, by its name in a run file; for a quantity of events with `event/` before it.
    pub series: String,
    /// What of it.
    pub question: Question,
    /// What is done to the answers before a model is fitted to them, if anything.
    pub transform: Option<Transform>,
    /// The unit that the study gives an answer from elsewhere, which people fill in; it measures the same as the SI unit.
    pub stated_unit: Option<String>,
}

/// What is asked of a series.
#[derive(Debug, Clone, PartialEq)]
pub enum Question {
    /// The last value.
    End,
    /// The value at a time, s, linear between samples.
    At(f64),
    /// The mean between two times, s.
    Mean(f64, f64),
    /// The mean over the last tenth of the run: see [`last_tenth`].
    MeanOfLastTenth,
    /// The value of an event.
    Event(WhichEvent),
    /// Nothing: the answers come from elsewhere, by `plateau sweep import`, in this SI unit.
    Imported(&'static str),
    /// The time, s, at which the series first comes to this fraction of its last value; from above, to the last value over
    /// the fraction.
    Reaches(f64),
    /// How far it is from a series that was measured: [`plateau_study::fit::MeasuredSeries::distance`].
    Measured(Arc<SeriesFile>),
}

/// Which of the events of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WhichEvent {
    /// The one with this number, from 1.
    Number(usize),
    /// The last.
    Last,
    /// All of them: the mean of those that have a value.
    Mean,
}

impl Response {
    /// The answer of a run, in the unit of the series (s for [`Question::Reaches`]); none where the run does not reach the
    /// times that are asked for, or has no such series.
    pub fn of(&self, run: &Series) -> Option<f64> {
        if let Question::Event(which) = self.question {
            return of_event(run.of_events(self.series.strip_prefix(EVENT)?)?, which);
        }
        let (time, values) = (run.time(), run.values(&self.series)?);
        match self.question {
            Question::End => values.last().copied(),
            Question::At(at) => value_at(time, values, at),
            Question::Mean(..) | Question::MeanOfLastTenth
                if self.is_of_contact_area() && self.integral(run).is_some() =>
            {
                Some(self.mean_of_contact_area(run)?.mean)
            }
            Question::Mean(..) | Question::MeanOfLastTenth => {
                let (from, to) = self.window(run)?;
                mean(time, values, from, to)
            }
            Question::Reaches(fraction) => reaches(time, values, fraction),
            Question::Measured(ref file) => Some(file.series.distance(&self.at_measured_times(run)?)),
            Question::Event(_) | Question::Imported(_) => None,
        }
    }

    /// What a run has at the times of a measured series, linear between samples; none where it ends before the last of them,
    /// or nothing was measured at times.
    pub fn at_measured_times(&self, run: &Series) -> Option<Vec<f64>> {
        let Question::Measured(file) = &self.question else { return None };
        let values = run.values(&self.series)?;
        file.series.times().iter().map(|at| value_at(run.time(), values, *at)).collect()
    }

    /// The series that was measured, if one was.
    pub fn measured_series(&self) -> Option<&SeriesFile> {
        if let Question::Measured(file) = &self.question { Some(file) } else { None }
    }

    /// Whether the answer is known with a standard error: a mean of the contact area.
    pub fn has_error(&self) -> bool {
        self.is_of_contact_area() && matches!(self.question, Question::Mean(..) | Question::MeanOfLastTenth)
    }

    /// Standard error of the answer of a run, in the same unit, where it is known.
    pub fn error_of(&self, run: &Series) -> Option<f64> {
        if self.has_error() { self.mean_of_contact_area(run)?.standard_error } else { None }
    }

    /// The integral knows every step, the samples only some.
    fn mean_of_contact_area(&self, run: &Series) -> Option<WindowMean> {
        let (from, to) = self.window(run)?;
        Cumulative { time: run.time(), integral: self.integral(run)?, revolutions: revolutions(run) }.mean(from, to)
    }

    fn is_of_contact_area(&self) -> bool {
        self.series == "contact_area" || self.series == "contact_area_mean"
    }

    fn integral<'a>(&self, run: &'a Series) -> Option<&'a [f64]> {
        run.values("contact_area_integral")
    }

    /// From when to when a mean is taken, s.
    fn window(&self, run: &Series) -> Option<(f64, f64)> {
        match self.question {
            Question::Mean(from, to) => Some((from, to)),
            Question::MeanOfLastTenth => last_tenth(run.time(), revolutions(run)),
            _ => None,
        }
    }

    /// The last time, s, that the question names, if it names one.
    pub fn latest_time(&self) -> Option<f64> {
        match self.question {
            Question::At(time) | Question::Mean(_, time) => Some(time),
            _ => None,
        }
    }

    /// SI unit of the answer, given that of the series.
    pub fn unit<'a>(&self, of_series: &'a str) -> &'a str {
        match self.question {
            Question::Reaches(_) => "s",
            Question::Imported(unit) => unit,
            Question::Measured(_) => "1",
            _ => of_series,
        }
    }

    /// Whether its answers come from elsewhere, not from the series of runs.
    pub fn is_imported(&self) -> bool {
        matches!(self.question, Question::Imported(_))
    }
}

/// The SI units that responses have, each once: those of series and events, and what is measured besides.
pub fn units() -> Vec<&'static str> {
    let series = quantities(EXTRAS).map(|quantity| quantity.unit);
    let mut units: Vec<&str> = series
        .chain(EVENT_QUANTITIES.iter().map(|quantity| quantity.unit))
        .chain(["N", "W", "m s-1", "Pa-1"])
        .collect();
    units.sort_unstable();
    units.dedup();
    units
}

/// Simulated revolutions at the samples; nothing where the run was recorded without them.
fn revolutions(run: &Series) -> &[f64] {
    run.values(REVOLUTIONS).unwrap_or_default()
}

/// The value of an event; none where there is no such event, or it has no value.
fn of_event(values: &[f64], which: WhichEvent) -> Option<f64> {
    let value = match which {
        WhichEvent::Number(number) => *values.get(number.checked_sub(1)?)?,
        WhichEvent::Last => *values.last()?,
        WhichEvent::Mean => {
            let there = values.iter().filter(|value| value.is_finite());
            there.clone().sum::<f64>() / there.count() as f64
        }
    };
    value.is_finite().then_some(value)
}

/// Linear between samples; before the first one, that one; none after the last.
fn value_at(time: &[f64], values: &[f64], at: f64) -> Option<f64> {
    let last = *time.last()?;
    // The last step ends at the duration, or is one step short of what rounding makes of it.
    if at > last * (1.0 + 1e-9) {
        return None;
    }
    let after = time.partition_point(|time| *time < at).min(time.len() - 1);
    if after == 0 || time[after] == time[after - 1] {
        return Some(values[after]);
    }
    let share = ((at - time[after - 1]) / (time[after] - time[after - 1])).min(1.0);
    Some(values[after - 1] + share * (values[after] - values[after - 1]))
}

/// The mean of the line through the samples.
fn mean(time: &[f64], values: &[f64], from: f64, to: f64) -> Option<f64> {
    let mut places = vec![(from, value_at(time, values, from)?)];
    let inside = time.iter().zip(values).filter(|(time, _)| (from < **time) && (**time < to));
    places.extend(inside.map(|(time, value)| (*time, *value)));
    places.push((to, value_at(time, values, to)?));
    let area: f64 = places.windows(2).map(|pair| (pair[1].0 - pair[0].0) * (pair[0].1 + pair[1].1) / 2.0).sum();
    Some(area / (to - from))
}

/// The time at which the series first comes so near to its last value, linear between samples.
fn reaches(time: &[f64], values: &[f64], fraction: f64) -> Option<f64> {
    let (first, last) = (*values.first()?, *values.last()?);
    // From below, or from above; then everything is mirrored.
    let sign = if first <= last { 1.0 } else { -1.0 };
    let near = sign * if sign * last > 0.0 { last * fraction } else { last / fraction };
    let after = values.iter().position(|value| sign * value >= near)?;
    if after == 0 {
        return time.first().copied();
    }
    let [low, high] = [after - 1, after].map(|at| sign * values[at]);
    Some(time[after - 1] + (time[after] - time[after - 1]) * (near - low) / (high - low))
}

#[cfg(test)]
mod tests {
    use super::*;
    use plateau_study::fit::MeasuredSeries;

    fn ask(question: Question, values: &[f64]) -> Option<f64> {
        let time: Vec<f64> = (1..=values.len()).map(|at| at as f64).collect();
        let run = Series::new(vec!["time".into(), "pool".into()], vec![time, values.to_vec()]);
        Response { name: "r".into(), series: "pool".into(), question, transform: None, stated_unit: None }.of(&run)
    }

    #[test]
    fn answers_by_hand() {
        let ramp = [0.0, 2.0, 4.0, 4.0];
        assert_eq!(ask(Question::End, &ramp), Some(4.0));
        assert_eq!(ask(Question::At(2.5), &ramp), Some(3.0));
        assert_eq!(ask(Question::At(4.1), &ramp), None);
        // Trapezia: (2 + 4)/2 · 1 + 4 · 1 over 2 s.
        assert_eq!(ask(Question::Mean(2.0, 4.0), &ramp), Some(3.5));
        // 3 is between 2 and 4; 5 is on the way from 0 to 8, whatever comes later.
        assert_eq!(ask(Question::Reaches(0.75), &ramp), Some(2.5));
        assert_eq!(ask(Question::Reaches(0.5), &[0.0, 8.0, 0.0, 10.0]), Some(1.625));
        // It begins nearer than that.
        assert_eq!(ask(Question::Reaches(0.5), &[3.0, 4.0]), Some(1.0));
        // From above: 2/0.5 = 4 is between 6 and 2.
        assert_eq!(ask(Question::Reaches(0.5), &[6.0, 2.0, 2.0]), Some(1.5));
        assert_eq!(ask(Question::Reaches(0.5), &[-4.0, 0.0, -1.0]), Some(1.5));
        assert_eq!(ask(Question::End, &[]), None);
        let series = |times: [f64; 2]| {
            let series = MeasuredSeries::new(times.to_vec(), vec![2.0, 4.5], vec![0.5, 1.0], 0.0).unwrap();
            Question::Measured(Arc::new(SeriesFile {
                path: "t.csv".into(),
                series,
                time_unit: "s".into(),
                last_line: 3,
            }))
        };
        // At 1.5 and 3 s the run has 1 and 4: (−1/0.5)² and (−0.5/1)², of two points.
        assert_eq!(ask(series([1.5, 3.0]), &ramp), Some((4.25_f64 / 2.0).sqrt()));
        assert_eq!(ask(series([1.5, 5.0]), &ramp), None);
    }

    #[test]
    fn events_are_asked_by_number_and_in_the_mean() {
        let columns = vec![vec![3.0, f64::NAN, 5.0]];
        let run = Series::default().with_events(Series::new(vec!["worn".into()], columns));
        let ask = |which| {
            let question = Question::Event(which);
            Response { name: "w".into(), series: "event/worn".into(), question, transform: None, stated_unit: None }
                .of(&run)
        };
        assert_eq!(ask(WhichEvent::Number(1)), Some(3.0));
        assert_eq!([ask(WhichEvent::Number(2)), ask(WhichEvent::Number(4)), ask(WhichEvent::Number(0))], [None; 3]);
        assert_eq!((ask(WhichEvent::Last), ask(WhichEvent::Mean)), (Some(5.0), Some(4.0)));
    }

    #[test]
    fn means_of_the_contact_area_come_from_its_integral() {
        let columns = ["time", "contact_area", "contact_area_integral"].map(String::from).to_vec();
        let run = Series::new(columns, vec![vec![1.0, 2.0], vec![7.0, 7.0], vec![3.0, 8.0]]);
        let mean = |from, to| {
            let question = Question::Mean(from, to);
            Response { name: "a".into(), series: "contact_area".into(), question, transform: None, stated_unit: None }
                .of(&run)
        };
        assert_eq!([mean(0.0, 2.0), mean(1.0, 2.0)], [Some(4.0), Some(5.0)]);
    }

    #[test]
    fn means_of_the_last_tenth_take_in_ten_revolutions() {
        let time: Vec<f64> = (1..=200).map(f64::from).collect();
        // The contact area is 2 t, its integral t²; a revolution takes 1 or 4 s.
        let square: Vec<f64> = time.iter().map(|time| time * time).collect();
        let quick = time.clone();
        let slow: Vec<f64> = time.iter().map(|time| time / 4.0).collect();
        let ask = |series: &str, revolutions: Option<&Vec<f64>>| {
            let names = ["time", "contact_area_integral", "contact_area", "contact_area_mean", "pool", REVOLUTIONS];
            let columns = [Some(&time), Some(&square), Some(&time), Some(&time), Some(&time), revolutions];
            let known =
                names.into_iter().zip(columns).filter_map(|(name, column)| Some((name.into(), column?.clone())));
            let (names, columns) = known.unzip();
            let question = Question::MeanOfLastTenth;
            let response =
                Response { name: "r".into(), series: series.into(), question, transform: None, stated_unit: None };
            let run = Series::new(names, columns);
            (response.of(&run), response.error_of(&run).is_some())
        };
        // Of the contact area from the integral, of another series from its samples, here t.
        assert_eq!(ask("contact_area_mean", Some(&quick)), (Some(380.0), true));
        assert_eq!(ask("contact_area", Some(&slow)), (Some(360.0), true));
        assert_eq!(ask("contact_area", None), (Some(380.0), true));
        assert_eq!(ask("pool", Some(&slow)), (Some(180.0), false));
    }
}
