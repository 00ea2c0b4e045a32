//! Responses: one number that a run gives for each question of a study.

use plateau_core::observe::event::EVENT_QUANTITIES;
use plateau_core::observe::running_in::{NotDefined, time_to, time_to_in_contact};
use plateau_core::observe::window_mean::{Cumulative, WindowMean, last_tenth};
use plateau_core::observe::{EXTRAS, quantities};
use thiserror::Error;

use super::record::{CONTACT_TIME, EVENT, REVOLUTIONS, Series};
use crate::number;

/// The series from which means of the contact area are taken: it knows every step.
const INTEGRAL: &str = "contact_area_integral";

/// A question to the series of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Response {
    /// Its name.
    pub name: String,
    /// The series that is asked, by its name in a run file; for a quantity of events with `event/` before it.
    pub series: String,
    /// The question to it.
    pub question: Question,
    /// On which scale an analysis fits the answers: one of [`TRANSFORMS`].
    pub transform: &'static str,
    /// The unit that the study gives an answer from elsewhere, which people fill in; it measures the same as the SI unit.
    pub stated_unit: Option<String>,
}

/// Scales on which an analysis fits answers.
pub const TRANSFORMS: [&str; 4] = ["none", "log", "square root", "logit"];

/// Question to a series.
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
    /// The time, s, after which the series has come to this fraction of its value at the end: see [`time_to`].
    Reaches(f64),
    /// Nothing of a single run: `plateau fit` compares the whole series with one that was measured.
    Measured,
}

/// Choice among the events of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WhichEvent {
    /// The one with this number, from 1.
    Number(usize),
    /// The last.
    Last,
    /// All of them: the mean of those that have a value.
    Mean,
}

/// Reason why a run gives no answer.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NoAnswer {
    /// Its series are not there.
    #[error("its series was not kept")]
    NotKept,
    /// It comes from elsewhere.
    #[error("it comes from elsewhere")]
    Elsewhere,
    /// The question is about a time after its end, s.
    #[error("the run ends at {} s, before {} s", number::rounded(*.end, 6), number::rounded(*.asked, 6))]
    Ended {
        /// The time that is asked for.
        asked: f64,
        /// Time at which it ends.
        end: f64,
    },
    /// There is no number.
    #[error("there is no number then, as where the pin is lifted")]
    NoNumber,
    /// There is no such event.
    #[error("it has no such event, or the event has no value")]
    NoEvent,
    /// It has not come there.
    #[error(transparent)]
    NotDefined(#[from] NotDefined),
}

impl Response {
    /// The answer of a run, in the unit of the series (s for [`Question::Reaches`]).
    ///
    /// # Errors
    /// [`NoAnswer`] where there is none.
    pub fn of(&self, run: &Series) -> Result<f64, NoAnswer> {
        let answer = self.answer(run)?;
        if answer.is_finite() { Ok(answer) } else { Err(NoAnswer::NoNumber) }
    }

    fn answer(&self, run: &Series) -> Result<f64, NoAnswer> {
        if !self.is_of_one_run() {
            return Err(NoAnswer::Elsewhere);
        }
        if let Question::Event(which) = self.question {
            let values = self.series.strip_prefix(EVENT).and_then(|series| run.of_events(series));
            return of_event(values.ok_or(NoAnswer::NotKept)?, which).ok_or(NoAnswer::NoEvent);
        }
        let (time, values) = (run.time(), run.values(&self.series).ok_or(NoAnswer::NotKept)?);
        match self.question {
            Question::At(at) => value_at(time, values, reached(run, at)?),
            Question::Mean(..) | Question::MeanOfLastTenth
                if self.is_of_contact_area() && self.integral(run).is_some() =>
            {
                let (from, to) = self.window(run)?;
                Some(self.mean_of_contact_area(run, from, to).ok_or(NoAnswer::NoNumber)?.mean)
            }
            Question::Mean(..) | Question::MeanOfLastTenth => {
                let (from, to) = self.window(run)?;
                mean(time, values, from, to)
            }
            Question::Reaches(fraction) => return self.time_to(fraction, run, values),
            Question::End | Question::Event(_) | Question::Imported(_) | Question::Measured => values.last().copied(),
        }
        .ok_or(NoAnswer::NoNumber)
    }

    /// Time at which a series has come to a fraction of its last value, s; of the contact area by its integral, and over the time in contact. The time
    /// in which another series has no value is left out, too.
    fn time_to(&self, fraction: f64, run: &Series, values: &[f64]) -> Result<f64, NoAnswer> {
        let time = run.time();
        let samples = |integral| Cumulative { time, integral, revolutions: revolutions(run) };
        if let Some(integral) = self.integral(run).filter(|_| self.is_of_contact_area()) {
            return Ok(match run.values(CONTACT_TIME) {
                Some(contact_time) => time_to_in_contact(fraction, &samples(integral), contact_time)?,
                None => time_to(fraction, &samples(integral), run.pulse_time())?,
            });
        }
        let (integral, known) = integral(time, values);
        if known.last().is_none_or(|known| *known == 0.0) {
            return Err(NoAnswer::NoNumber);
        }
        let pulse_time = run.pulse_time().filter(|_| self.is_of_contact_area());
        Ok(match values.iter().all(|value| value.is_finite()) {
            true => time_to(fraction, &samples(&integral), pulse_time)?,
            false => time_to_in_contact(fraction, &samples(&integral), &known)?,
        })
    }

    /// The series, or the quantity of events, that a run must have kept for an answer; none where it comes from elsewhere.
    pub fn needs(&self) -> impl Iterator<Item = &str> {
        let asked = (!self.is_imported()).then_some(self.series.as_str());
        asked.into_iter().chain(self.is_of_every_step().then_some([INTEGRAL, CONTACT_TIME]).into_iter().flatten())
    }

    /// Tells whether the answer is known with a standard error: a mean of the contact area.
    pub fn has_error(&self) -> bool {
        self.is_of_contact_area() && matches!(self.question, Question::Mean(..) | Question::MeanOfLastTenth)
    }

    /// Tells whether the answer is taken from the integral of the contact area.
    fn is_of_every_step(&self) -> bool {
        self.has_error() || self.is_of_contact_area() && matches!(self.question, Question::Reaches(_))
    }

    /// Standard error of the answer of a run, in the same unit, where it is known.
    pub fn error_of(&self, run: &Series) -> Option<f64> {
        let (from, to) = self.window(run).ok()?;
        if self.has_error() { self.mean_of_contact_area(run, from, to)?.standard_error } else { None }
    }

    /// The integral knows every step, the samples only some. Of a run with a cycle it is the mean over the time in contact.
    fn mean_of_contact_area(&self, run: &Series, from: f64, to: f64) -> Option<WindowMean> {
        let samples = Cumulative { time: run.time(), integral: self.integral(run)?, revolutions: revolutions(run) };
        match run.values(CONTACT_TIME) {
            Some(contact_time) => samples.mean_in_contact(contact_time, from, to),
            None => samples.mean(from, to),
        }
    }

    fn is_of_contact_area(&self) -> bool {
        self.series == "contact_area" || self.series == "contact_area_mean"
    }

    fn integral<'a>(&self, run: &'a Series) -> Option<&'a [f64]> {
        run.values(INTEGRAL)
    }

    /// From when to when a mean is taken, s.
    fn window(&self, run: &Series) -> Result<(f64, f64), NoAnswer> {
        match self.question {
            Question::Mean(from, to) => Ok((reached(run, from)?, reached(run, to)?)),
            Question::MeanOfLastTenth => last_tenth(run.time(), revolutions(run)).ok_or(NoAnswer::NotKept),
            _ => Err(NoAnswer::NotKept),
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
            _ => of_series,
        }
    }

    /// Tells whether a run answers it by itself.
    pub fn is_of_one_run(&self) -> bool {
        !matches!(self.question, Question::Imported(_) | Question::Measured)
    }

    /// Tells whether its answers come from elsewhere, not from the series of runs.
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

/// A time (s) that is asked for, as a time that there are samples of: the last sample stands for what is left of a run after it, less than
/// a step.
fn reached(run: &Series, asked: f64) -> Result<f64, NoAnswer> {
    let last = *run.time().last().ok_or(NoAnswer::NotKept)?;
    let end = run.until().max(last);
    // A number of steps may end one rounding before the time that is meant.
    if asked > end * (1.0 + 1e-9) { Err(NoAnswer::Ended { asked, end }) } else { Ok(asked.min(last)) }
}

/// Linear between samples; before the first one, that one; none after the last.
fn value_at(time: &[f64], values: &[f64], at: f64) -> Option<f64> {
    if at > *time.last()? {
        return None;
    }
    let after = time.partition_point(|time| *time < at).min(time.len() - 1);
    if after == 0 || time[after] == time[after - 1] {
        return Some(values[after]);
    }
    let share = (at - time[after - 1]) / (time[after] - time[after - 1]);
    // A sample has its value even where the one before it has none.
    Some(if share == 1.0 { values[after] } else { values[after - 1] + share * (values[after] - values[after - 1]) })
}

/// The mean of the line through the samples, over the time in which there is one: while the pin is lifted, a series may have no
/// value.
fn mean(time: &[f64], values: &[f64], from: f64, to: f64) -> Option<f64> {
    let mut places = vec![(from, value_at(time, values, from)?)];
    let inside = time.iter().zip(values).filter(|(time, _)| (from < **time) && (**time < to));
    places.extend(inside.map(|(time, value)| (*time, *value)));
    places.push((to, value_at(time, values, to)?));
    let pieces = places.windows(2).map(|pair| (pair[1].0 - pair[0].0, (pair[0].1 + pair[1].1) / 2.0));
    let (area, duration) = pieces
        .filter(|(_, mean)| mean.is_finite())
        .fold((0.0, 0.0), |(area, duration), (length, mean)| (area + length * mean, duration + length));
    (duration > 0.0).then_some(area / duration)
}

/// The integral of that line over time since t = 0 and the time in which there is one, s; the first sample stands for what is before it.
fn integral(time: &[f64], values: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (mut sum, mut known) = (0.0, 0.0);
    let mut before = (0.0, values.first().copied().unwrap_or(0.0));
    let added = |(time, value): (&f64, &f64)| {
        let (length, mean) = (time - before.0, 0.5 * (value + before.1));
        if mean.is_finite() {
            (sum, known) = (sum + length * mean, known + length);
        }
        before = (*time, *value);
        (sum, known)
    };
    time.iter().zip(values).map(added).unzip()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::record::Outcome;

    fn of_pool(question: Question, values: &[f64], until: f64) -> Result<f64, NoAnswer> {
        let time: Vec<f64> = (1..=values.len()).map(|at| at as f64).collect();
        let run = Series::new(vec!["time".into(), "pool".into()], vec![time, values.to_vec()]).that_ended(until);
        Response { name: "r".into(), series: "pool".into(), question, transform: "none", stated_unit: None }.of(&run)
    }

    fn ask(question: Question, values: &[f64]) -> Option<f64> {
        of_pool(question, values, 0.0).ok()
    }

    #[test]
    fn answers_by_hand() {
        let ramp = [0.0, 2.0, 4.0, 4.0];
        assert_eq!(ask(Question::End, &ramp), Some(4.0));
        assert_eq!(ask(Question::At(2.5), &ramp), Some(3.0));
        assert_eq!(ask(Question::At(4.1), &ramp), None);
        // Trapezia: (2 + 4)/2 · 1 + 4 · 1 over 2 s.
        assert_eq!(ask(Question::Mean(2.0, 4.0), &ramp), Some(3.5));
        assert_eq!(ask(Question::End, &[]), None);
        // Lifted at 3 s: by hand, (2 + 4)/2 over 1 s, (6 + 8)/2 over 1 s; then the window with no value at all.
        let lifted = [2.0, 4.0, f64::NAN, 6.0, 8.0];
        assert_eq!(
            [ask(Question::Mean(1.0, 5.0), &lifted), ask(Question::Mean(4.0, 5.0), &lifted)],
            [Some(5.0), Some(7.0)]
        );
        assert_eq!([ask(Question::Mean(2.2, 3.8), &lifted), ask(Question::At(4.0), &lifted)], [None, Some(6.0)]);
    }

    #[test]
    fn the_last_sample_stands_for_the_step_that_a_run_did_not_take_any_more() {
        // A run of 30 s whose last step ends at 4 s, and one that ends there.
        let ramp = [0.0, 2.0, 4.0, 5.0];
        assert_eq!(of_pool(Question::At(30.0), &ramp, 30.0), Ok(5.0));
        assert_eq!(of_pool(Question::Mean(3.0, 30.0), &ramp, 30.0), Ok(4.5));
        let early = NoAnswer::Ended { asked: 30.0, end: 4.0 };
        assert_eq!(early.to_string(), "the run ends at 4 s, before 30 s");
        assert_eq!(of_pool(Question::At(30.0), &ramp, 4.0), Err(early.clone()));
        assert_eq!(of_pool(Question::Mean(3.0, 30.0), &ramp, 4.0), Err(early));
        assert!(of_pool(Question::At(30.1), &ramp, 30.0).is_err());
        assert_eq!(of_pool(Question::At(2.0), &[0.0, f64::NAN, 4.0], 3.0), Err(NoAnswer::NoNumber));
    }

    #[test]
    fn a_series_reaches_its_end_as_the_contact_area_runs_in() {
        // Half of 8 from the fourth of sixty samples on: each is a window, whose middle is half a second before its sample. What the first
        // stands for is before it.
        let step =
            |before: f64, after: f64| -> Vec<f64> { (0..60).map(|at| if at < 4 { before } else { after }).collect() };
        assert_eq!(of_pool(Question::Reaches(0.9), &step(0.0, 8.0), 60.0), Ok(5.5));
        // From above, and below 0.
        assert_eq!(of_pool(Question::Reaches(0.9), &step(16.0, 8.0), 60.0), Ok(5.5));
        assert_eq!(of_pool(Question::Reaches(0.9), &step(0.0, -8.0), 60.0), Ok(5.5));
        // What falls and rises, and what still rises.
        let dip: Vec<f64> = (0..60).map(|at| if (10..20).contains(&at) { 2.0 } else { 8.0 }).collect();
        let line: Vec<f64> = (0..60).map(f64::from).collect();
        let undefined = |values: &[f64]| of_pool(Question::Reaches(0.9), values, 60.0).unwrap_err().to_string();
        assert_eq!(
            undefined(&dip),
            "not defined: neither rises nor falls all along, it goes back by 75.0 % of its last value"
        );
        assert!(undefined(&line).starts_with("not defined: still rises at the end, by "), "{}", undefined(&line));
        assert!(
            undefined(&line[..10]).starts_with("not defined: too few samples or simulated revolutions; 20 in the run")
        );
    }

    #[test]
    fn a_series_with_gaps_reaches_its_end_over_the_time_in_which_it_has_a_value() {
        // As above, 0 until 4 s and 8 from 5 s on, but with ten samples without a value; the pieces beside them have no mean either. So there are 69 s
        // and windows of 1.15 s. By hand, the fifth has (0.4 · 4 + 0.75 · 8)/1.15 = 6.6, and the sixth is the first of 8.
        let values: Vec<f64> = (0..80)
            .map(|at| match at {
                0..4 => 0.0,
                20..30 => f64::NAN,
                _ => 8.0,
            })
            .collect();
        let found = of_pool(Question::Reaches(0.9), &values, 80.0).unwrap();
        assert!((found - 5.5 * 69.0 / 60.0).abs() < 1e-9, "{found}");
        assert_eq!(of_pool(Question::Reaches(0.9), &[f64::NAN; 80], 80.0), Err(NoAnswer::NoNumber));
    }

    #[test]
    fn reaches_of_the_contact_area_needs_its_integral_and_knows_its_pulses() {
        let of = |series: &str, question: Question| Response {
            name: "r".into(),
            series: series.into(),
            question,
            transform: "none",
            stated_unit: None,
        };
        let area = of("contact_area", Question::Reaches(0.9));
        assert_eq!(area.needs().collect::<Vec<_>>(), ["contact_area", INTEGRAL, CONTACT_TIME]);
        assert_eq!(of("pool", Question::Reaches(0.9)).needs().collect::<Vec<_>>(), ["pool"]);
        assert_eq!(of("contact_area", Question::End).needs().collect::<Vec<_>>(), ["contact_area"]);
        // 1 − exp(−t/40 s): in 600 s a quarter is two pulses of 75 s.
        let time: Vec<f64> = (1..=600).map(f64::from).collect();
        let integral: Vec<f64> = time.iter().map(|time| time - 40.0 * (1.0 - (-time / 40.0).exp())).collect();
        let names = ["time", "contact_area", INTEGRAL].map(String::from).to_vec();
        let run = Series::new(names, vec![time.clone(), time, integral]);
        let answer = |pulse_time| {
            let packed = run.pack();
            let outcome = Outcome::Finished { steps: 600, until: 600.0, series: packed, events: None, pulse_time };
            area.of(&outcome.series().unwrap())
        };
        // ln 10 · 40 s is 92.1 s: the mean of the window from 90 s on, 1 − 4 e^(−90/40) (1 − e^(−1/4)), is 0.9068.
        assert_eq!([answer(None), answer(Some(50.0))], [Ok(95.0), Ok(95.0)]);
        assert_eq!(
            answer(Some(75.0)).unwrap_err().to_string(),
            "not defined: a quarter of the run has at most 2.0 pulses of the contact area, 3 are needed"
        );
    }

    #[test]
    fn means_of_the_contact_area_of_a_cycle_are_over_the_time_in_contact() {
        // 3 m2 for 2 s, lifted for 2 s.
        let columns = ["time", "contact_area", "contact_area_integral", CONTACT_TIME].map(String::from).to_vec();
        let values = [[1.0, 2.0, 3.0, 4.0], [3.0, 3.0, 0.0, 0.0], [3.0, 6.0, 6.0, 6.0], [1.0, 2.0, 2.0, 2.0]];
        let run = Series::new(columns, values.map(Vec::from).to_vec());
        let question = Question::Mean(0.0, 4.0);
        let response = Response {
            name: "a".into(),
            series: "contact_area".into(),
            question,
            transform: "none",
            stated_unit: None,
        };
        assert_eq!(response.of(&run), Ok(3.0));
    }

    #[test]
    fn events_are_asked_by_number_and_in_the_mean() {
        let columns = vec![vec![3.0, f64::NAN, 5.0]];
        let run = Series::default().with_events(Series::new(vec!["worn".into()], columns));
        let ask = |which| {
            let question = Question::Event(which);
            Response { name: "w".into(), series: "event/worn".into(), question, transform: "none", stated_unit: None }
                .of(&run)
                .ok()
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
            Response { name: "a".into(), series: "contact_area".into(), question, transform: "none", stated_unit: None }
                .of(&run)
                .ok()
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
                Response { name: "r".into(), series: series.into(), question, transform: "none", stated_unit: None };
            let run = Series::new(names, columns);
            (response.of(&run).ok(), response.error_of(&run).is_some())
        };
        // Of the contact area from the integral, of another series from its samples, here t.
        assert_eq!(ask("contact_area_mean", Some(&quick)), (Some(380.0), true));
        assert_eq!(ask("contact_area", Some(&slow)), (Some(360.0), true));
        assert_eq!(ask("contact_area", None), (Some(380.0), true));
        assert_eq!(ask("pool", Some(&slow)), (Some(180.0), false));
    }
}
