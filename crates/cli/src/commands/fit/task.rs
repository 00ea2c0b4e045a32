//! What a fit is to find: keys with their ranges, and what was measured of the responses; and the fit to what runs gave.

use plateau_io::brief;
use plateau_io::study::Study;
use plateau_io::study::collected::{Collected, CollectedRun, unit_of};
use plateau_io::study::factor::{Factor, Values};
use plateau_io::study::level::Level;
use plateau_io::study::measured::Measured;
use plateau_io::study::plan::Plan;
use plateau_study::design::Setting;
use plateau_study::effects::{EffectsError, Observation};
use plateau_study::fit::{Fit, FitError, Key, Measurement, ObservedSeries};
use plateau_study::surrogate::gaussian_process::GaussianProcessError;

use crate::failure::Failure;
use crate::number;

/// What is fitted: keys, and the responses that were measured.
pub struct Task {
    /// Keys, in SI units.
    pub keys: Vec<Key>,
    /// The responses that were measured, by their place in the study.
    pub responses: Vec<usize>,
    /// What was measured of each.
    pub measurements: Vec<Measurement>,
    /// The responses of which a whole series was measured, by their place in the study.
    pub series: Vec<usize>,
}

impl Task {
    /// What a study is to fit.
    ///
    /// # Errors
    /// [`Failure::Input`] when nothing was measured, or a factor has no range.
    pub fn of(study: &Study) -> Result<Self, Failure> {
        let at = study.path.display();
        let measured = study.fit.measured.iter().enumerate();
        let measured: Vec<(usize, Measured)> = measured.filter_map(|(at, of)| Some((at, (*of)?))).collect();
        let of_series = |at: &usize| study.responses[*at].measured_series().is_some();
        let series: Vec<usize> = (0..study.responses.len()).filter(of_series).collect();
        if measured.is_empty() && series.is_empty() {
            return Err(Failure::input(format!(
                "{at}: nothing was measured: give a [[response]] what was measured of it, such as measured = 0.70, \
                 uncertainty = 0.02, or measured_file = \"FILE.csv\" for a whole series"
            )));
        }
        if let Some((imported, _)) = measured.iter().find(|(at, _)| study.responses[*at].is_imported()) {
            let name = &study.responses[*imported].name;
            return Err(Failure::input(format!(
                "{at}: response \"{name}\" is imported; a fit compares what runs of a scene give with what was measured"
            )));
        }
        let key = |factor: &Factor| match &factor.values {
            Values::Range { low, high, logarithmic } => {
                let (low, high) = low.number.zip(high.number)?;
                Some(Key { name: factor.name.clone(), low, high, logarithmic: *logarithmic })
            }
            Values::Levels(_) => None,
        };
        let keys = study
            .factors
            .iter()
            .map(|factor| key(factor).ok_or_else(|| Failure::input(format!("{at}: {}", not_a_range(factor)))));
        Ok(Self {
            keys: keys.collect::<Result<_, _>>()?,
            responses: measured.iter().map(|(at, _)| *at).collect(),
            measurements: measured
                .iter()
                .map(|(_, of)| Measurement { value: of.value, uncertainty: of.uncertainty })
                .collect(),
            series,
        })
    }

    /// Refuses a series that goes on after the end of the runs.
    ///
    /// # Errors
    /// [`Failure::Input`].
    pub fn check_times(&self, plan: &Plan) -> Result<(), Failure> {
        let study = plan.study();
        let end = plan.scene(&plan.run(1)).map_err(Failure::input)?.duration;
        for file in self.series.iter().filter_map(|at| study.responses[*at].measured_series()) {
            if let Some(late) = file.series.times().last().filter(|last| **last > end * (1.0 + 1e-9)) {
                return Err(Failure::input(format!(
                    "{}:{}: the time is {late} s, and the runs end at {end} s: make them longer, with set = \
                     [\"operation.duration = '{late} s'\"], or leave out the lines after their end",
                    file.path.display(),
                    file.last_line
                )));
            }
        }
        Ok(())
    }

    /// Where a run has the keys.
    fn settings(&self, run: &CollectedRun) -> Vec<Setting> {
        self.keys.iter().zip(&run.run.levels).map(|(key, level)| setting(key, level)).collect()
    }

    /// The fit to what the runs gave.
    ///
    /// # Errors
    /// [`Failure::Run`] where too few runs finished, [`Failure::Input`] where what was measured lies too far off.
    pub fn fit(&self, study: &Study, collected: &Collected) -> Result<Fit, Failure> {
        let observe = |response: usize| {
            let observation = |run: &CollectedRun| Observation {
                settings: self.settings(run),
                replicate: run.run.replicate,
                run: run.first,
                response: run.responses[response],
            };
            collected.runs.iter().map(observation).collect::<Vec<_>>()
        };
        let observations: Vec<Vec<Observation>> = self.responses.iter().map(|at| observe(*at)).collect();
        let of_series = |at: &usize| {
            let run = |run: &CollectedRun| ObservedSeries {
                settings: self.settings(run),
                replicate: run.run.replicate,
                run: run.first,
                values: run.at_measured_times[*at].clone(),
            };
            let file = study.responses[*at].measured_series()?;
            Some((file.series.clone(), collected.runs.iter().map(run).collect()))
        };
        let series: Vec<_> = self.series.iter().filter_map(of_series).collect();
        let unfinished = |response: usize, error: &dyn std::fmt::Display| {
            let name = &study.responses[response].name;
            Failure::run(format_args!(
                "response \"{name}\": {error}; {} of {} finished",
                collected.count("finished"),
                number::count(collected.runs.len(), "run")
            ))
        };
        let fit = Fit::with_series(&self.keys, &self.measurements, &observations, &series, study.fit.confidence);
        fit.map_err(|error| match &error {
            FitError::Response { index, error } => unfinished(self.responses[*index], error),
            FitError::Series { index, error: GaussianProcessError::Observations(EffectsError::Response { .. }) } => {
                let file = study.responses[self.series[*index]].measured_series().map(|file| file.path.display());
                let file = file.map_or_else(String::new, |file| format!(" in {file}"));
                Failure::input(format!(
                    "{}: response \"{}\": what was measured and what runs give differ by too many times the uncertainty for a number \
                     to hold; look at units, uncertainties and correlation time{file}",
                    study.path.display(),
                    study.responses[self.series[*index]].name
                ))
            }
            FitError::Series { index, error } => unfinished(self.series[*index], error),
            FitError::NoRun(index) => {
                unfinished(self.series[*index], &"no run has values at all of the measured times")
            }
            FitError::NoLikelihood => Failure::input(format!(
                "{}: {error}: {}; look at the units and the uncertainties",
                study.path.display(),
                self.far_off(study, collected)
            )),
            error => Failure::input(format!("{}: {error}", study.path.display())),
        })
    }

    /// What was measured beside what the runs gave, of the response of which the two are farthest from each other, or the uncertainty
    /// is most unlike what the runs differ by.
    fn far_off(&self, study: &Study, collected: &Collected) -> String {
        let of = |(at, measured): (&usize, &Measurement)| {
            let values = collected.runs.iter().map(|run| run.responses[*at]).filter(|value| value.is_finite());
            let (low, high) =
                values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
            let distance = (low - measured.value).max(measured.value - high).max(0.0);
            let off = (distance / measured.uncertainty).max((high - low) / measured.uncertainty);
            let far = off.max(measured.uncertainty / (high - low));
            let unit = study.responses[*at].unit(unit_of(&study.responses[*at].series));
            let number = |value: f64| with_unit(value, unit);
            let said = format!(
                "response \"{}\" was measured as {} ± {}, and runs give {} to {}",
                study.responses[*at].name,
                number(measured.value),
                number(measured.uncertainty),
                number(low),
                number(high)
            );
            (far, said)
        };
        let all = self.responses.iter().zip(&self.measurements).map(of);
        let series = || self.series.iter().map(|at| format!("response \"{}\"", study.responses[*at].name));
        let worst = all.max_by(|one, other| one.0.total_cmp(&other.0));
        worst.map_or_else(|| brief::list(series(), ", "), |(_, said)| said)
    }
}

/// Why a factor with levels is not fitted, and what to do.
fn not_a_range(factor: &Factor) -> String {
    let (name, keys) = (&factor.name, brief::list(&factor.keys, ", "));
    let said = format!("factor \"{name}\" ({keys}) has levels, and a fit looks for numbers between two ends");
    match &factor.values {
        Values::Levels(levels) if levels.iter().any(|level| level.number.is_none()) => {
            let levels: Vec<&str> = levels.iter().map(|level| level.text.as_str()).collect();
            let first = levels.first().copied().unwrap_or_default().replace('"', "'");
            format!(
                "{said}: these are words, {}. Make one study for each word, with set = [\"{}={first}\"] in place of this \
                 factor, fit each, and compare what they say of the misfit: the word with the least misfit fits best",
                brief::list(&levels, ", "),
                factor.keys[0]
            )
        }
        _ if factor.is_whole() => {
            format!("{said}: this key holds whole numbers; make one study for each number, and compare the misfits")
        }
        _ => format!("{said}: give range = [lower, upper] in place of levels"),
    }
}

/// A number of at most four digits with its unit.
fn with_unit(value: f64, unit: &str) -> String {
    let value = number::rounded(value, 4);
    if ["", "1"].contains(&unit) { value } else { format!("{value} {unit}") }
}

fn setting(key: &Key, level: &Level) -> Setting {
    Setting::Coded(level.number.map_or(0.0, |value| key.coded(value)))
}
