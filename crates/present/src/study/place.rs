//! A place among the factors of a study: named in words, set in a scene, foretold by a surrogate.

use plateau_io::study::Study;
use plateau_io::study::factor::{Factor, Values};
use plateau_io::study::level::Level;
use plateau_io::text::short;
use plateau_io::{brief, number};
use plateau_study::design::Setting;
use plateau_study::effects::{FactorKind, Model};

use super::analysed_factor::AnalysedFactor;
use super::analysis::Analysis;

/// Coded values that differ by less are the same.
const SAME: f64 = 1e-9;

/// A place.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// What scenes have there, one for each factor.
    pub levels: Vec<Level>,
    /// The same for surrogates.
    pub settings: Vec<Setting>,
    /// Names of factors that were not given: they are in the middle of their range, or at their first level.
    pub assumed: Vec<String>,
    /// What is beyond the runs of the study, in words: `load is beyond 5 to 10 N`.
    pub beyond: Vec<String>,
}

/// The factors of a study, and where places among them may be.
#[derive(Debug, Clone, Copy)]
pub struct Space<'a> {
    study: &'a Study,
    analysis: &'a Analysis,
}

impl<'a> Space<'a> {
    /// That of a study which was analysed.
    pub fn new(study: &'a Study, analysis: &'a Analysis) -> Self {
        Self { study, analysis }
    }

    /// The number of the factor that is called this.
    ///
    /// # Errors
    /// The names that there are.
    pub fn factor(&self, name: &str) -> Result<usize, String> {
        self.study.factors.iter().position(|factor| factor.is_called(name)).ok_or_else(|| {
            let names = brief::list(self.study.factors.iter().map(|factor| &factor.name), ", ");
            format!("\"{}\" is not a factor of the study, expected one of {names}", short(name))
        })
    }

    /// Whether a factor may be anywhere between its ends: it is a number, not a whole one, and the models of all responses
    /// know what is between its levels.
    pub fn is_continuous(&self, factor: usize) -> bool {
        let (own, analysed) = (&self.study.factors[factor], &self.analysis.factors[factor]);
        let fitted = || self.analysis.responses.iter().filter(|response| response.effects.is_ok());
        match &analysed.factor.kind {
            FactorKind::Range { .. } => !own.is_whole(),
            FactorKind::Levels(values) if values.len() == 2 => !own.is_whole(),
            FactorKind::Levels(_) => {
                !own.is_whole() && fitted().all(|response| response.choice.model == Model::Quadratic)
            }
            FactorKind::Categorical(_) => false,
        }
    }

    /// All levels of a factor as settings; empty for ranges.
    pub fn levels(&self, factor: usize) -> Vec<Setting> {
        (0..self.analysis.factors[factor].labels.len()).map(Setting::Level).collect()
    }

    /// The middle of a range, or the first level.
    pub fn middle(&self, factor: usize) -> Setting {
        if self.is_continuous(factor) || self.levels(factor).is_empty() {
            Setting::Coded(0.0)
        } else {
            Setting::Level(0)
        }
    }

    /// The place where factors have these values, given as texts such as `load=7 N`.
    ///
    /// # Errors
    /// A name that no factor has or that is given twice, or a value that its factor cannot have.
    pub fn named(&self, given: &[String]) -> Result<Place, String> {
        let mut levels: Vec<Option<Level>> = vec![None; self.study.factors.len()];
        for text in given {
            let (factor, value) = self.assignment(text)?;
            let level = self.study.factors[factor].parse(value);
            if levels[factor].replace(level).is_some() {
                return Err(format!("{} is given twice", self.study.factors[factor].name));
            }
        }
        self.at(levels)
    }

    /// A factor and the text of its value. Both may have `=` in them: it is the first one with a name before it that parts them.
    fn assignment<'t>(&self, text: &'t str) -> Result<(usize, &'t str), String> {
        let parts = |(at, _): (usize, &str)| (text[..at].trim(), text[at + 1..].trim());
        let found = text.match_indices('=').map(parts).find_map(|(name, value)| Some((self.factor(name).ok()?, value)));
        found.map_or_else(
            || self.factor(text.split('=').next().unwrap_or_default().trim()).map(|factor| (factor, "")),
            Ok,
        )
    }

    /// The place where factors have these levels; those that have none are in the middle.
    ///
    /// # Errors
    /// A level that its factor cannot have.
    pub fn at(&self, given: Vec<Option<Level>>) -> Result<Place, String> {
        let mut settings = Vec::new();
        let mut assumed = Vec::new();
        for (factor, level) in given.iter().enumerate() {
            settings.push(match level {
                Some(level) => self.setting(factor, level)?,
                None => {
                    assumed.push(self.study.factors[factor].name.clone());
                    self.middle(factor)
                }
            });
        }
        let levels = given.into_iter().zip(&settings).enumerate();
        let levels = levels.map(|(factor, (level, setting))| level.map_or_else(|| self.level(factor, *setting), Ok));
        let levels = levels.collect::<Result<_, _>>()?;
        Ok(Place { levels, beyond: self.beyond(&settings), settings, assumed })
    }

    /// The place of settings.
    ///
    /// # Errors
    /// A setting without a value in a scene.
    pub fn of(&self, settings: Vec<Setting>) -> Result<Place, String> {
        let levels = settings.iter().enumerate().map(|(factor, setting)| self.level(factor, *setting));
        let levels = levels.collect::<Result<_, _>>()?;
        Ok(Place { levels, beyond: self.beyond(&settings), settings, assumed: Vec::new() })
    }

    /// Where a level lies along its factor.
    fn setting(&self, factor: usize, level: &Level) -> Result<Setting, String> {
        let (own, analysed) = (&self.study.factors[factor], &self.analysis.factors[factor]);
        let refused = |why: &str| format!("{} = {}: {why}", own.name, level.label);
        let labels = || brief::list(&analysed.labels, ", ");
        let number = level.number.filter(|number| number.is_finite());
        if let FactorKind::Categorical(_) = analysed.factor.kind {
            let found = analysed.labels.iter().position(|label| *label == level.label);
            return found.map(Setting::Level).ok_or_else(|| refused(&format!("expected one of {}", labels())));
        }
        let unit = own.unit();
        // A scene takes no quantity without its unit.
        let has_unit = ["", "1"].contains(&unit) || level.text.starts_with(['"', '\'']);
        let Some(number) = number.filter(|_| has_unit) else {
            let example = analysed.factor.range().map_or(0.0, |[low, _]| low);
            let unit = if unit == "1" {
                "a plain number".to_owned()
            } else {
                format!("a quantity such as \"{}\"", self.text(factor, example))
            };
            return Err(refused(&format!("expected {unit}")));
        };
        match &analysed.factor.kind {
            FactorKind::Levels(values) => {
                let size = values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
                let found = values.iter().position(|value| (value - number).abs() <= SAME * size);
                let between = || self.is_continuous(factor).then(|| self.coded(factor, number)).flatten();
                let setting = found.map(Setting::Level).or_else(|| between().map(Setting::Coded));
                let advice = if own.is_whole() { "" } else { "; --model quadratic tells what lies between them" };
                setting.ok_or_else(|| refused(&format!("the model knows the levels {} alone{advice}", labels())))
            }
            _ => {
                let coded = own.coded(level).or_else(|| self.coded(factor, number)).filter(|coded| coded.is_finite());
                coded.map(Setting::Coded).ok_or_else(|| match own.values {
                    Values::Range { logarithmic: true, .. } if number <= 0.0 => {
                        refused("expected a value above 0, for the range is logarithmic")
                    }
                    _ => refused(&format!("too far from the range, {own}, for numbers to tell how far")),
                })
            }
        }
    }

    /// A value, SI, in coded units of an analysed factor that is no logarithm.
    fn coded(&self, factor: usize, number: f64) -> Option<f64> {
        let [low, high] = self.analysis.factors[factor].factor.range()?;
        Some((2.0 * number - (low + high)) / (high - low))
    }

    /// What a scene has at a setting.
    fn level(&self, factor: usize, setting: Setting) -> Result<Level, String> {
        let (own, analysed) = (&self.study.factors[factor], &self.analysis.factors[factor]);
        let found = match setting {
            Setting::Level(level) => analysed.labels.get(level).map(|label| own.parse(label)),
            Setting::Coded(_) if matches!(own.values, Values::Range { .. }) => own.at(setting),
            Setting::Coded(coded) => analysed.factor.range().map(|[low, high]| {
                let value = 0.5 * ((1.0 - coded) * low + (1.0 + coded) * high);
                own.parse(&self.text(factor, value))
            }),
        };
        found.ok_or_else(|| format!("{} has no value there", own.name))
    }

    /// A value of the analysis, which may be a logarithm, in the unit of the study.
    fn text(&self, factor: usize, value: f64) -> String {
        let reading = &self.analysis.factors[factor].reading;
        let value = reading.value(value);
        let value = if reading.is_logarithmic() { 10_f64.powf(value) } else { value };
        format!("{} {}", number::to_nine_digits(value), reading.unit).trim_end().to_owned()
    }

    /// Which factors are beyond the runs of the study, in words.
    fn beyond(&self, settings: &[Setting]) -> Vec<String> {
        let said = settings.iter().enumerate().filter_map(|(factor, setting)| {
            let analysed = &self.analysis.factors[factor];
            let coded = analysed.factor.coded(*setting).or(match setting {
                Setting::Coded(coded) => Some(*coded),
                Setting::Level(_) => None,
            })?;
            let [least, most] = ends(self.analysis, factor);
            let is_beyond = coded < least - SAME || coded > most + SAME;
            is_beyond
                .then(|| format!("{} is beyond {}", self.study.factors[factor].name, self.range(factor, [least, most])))
        });
        said.collect()
    }

    /// A coded value, in words.
    pub fn shown(&self, factor: usize, coded: f64) -> String {
        let [low, high] = self.analysis.factors[factor].factor.range().unwrap_or([-1.0, 1.0]);
        with_five_digits(&self.text(factor, 0.5 * ((1.0 - coded) * low + (1.0 + coded) * high)))
    }

    /// The range between two coded values, in words.
    pub fn range(&self, factor: usize, coded: [f64; 2]) -> String {
        let [low, high] = self.analysis.factors[factor].factor.range().unwrap_or([-1.0, 1.0]);
        let text =
            |coded: f64| with_five_digits(&self.text(factor, 0.5 * ((1.0 - coded) * low + (1.0 + coded) * high)));
        let (from, to) = (text(coded[0]), text(coded[1]));
        // The unit once.
        let plain = from.split_once(' ').map_or(from.as_str(), |(number, _)| number);
        format!("{plain} to {to}")
    }

    /// Settings in words: `load = 7.5 N, fibres = 0.3`, with what was not given.
    pub fn words(&self, place: &Place) -> String {
        let word = |(factor, level): (&Factor, &Level)| {
            let assumed = if place.assumed.contains(&factor.name) { " (not given)" } else { "" };
            format!("{} = {}{assumed}", factor.name, shortened(level))
        };
        self.study.factors.iter().zip(&place.levels).map(word).collect::<Vec<_>>().join(", ")
    }
}

/// Coded values of a factor between which there are runs, at least from −1 to 1.
fn ends(analysis: &Analysis, factor: usize) -> [f64; 2] {
    let of: &AnalysedFactor = &analysis.factors[factor];
    let coded = analysis.runs.iter().filter_map(|(settings, _)| of.factor.coded(settings[factor]));
    coded.fold([-1.0, 1.0], |[low, high], coded| [low.min(coded), high.max(coded)])
}

/// A level for people: a quantity with at most five digits, a word as it is.
pub fn shortened(level: &Level) -> String {
    if level.number.is_some() { with_five_digits(&level.label) } else { level.label.clone() }
}

/// A quantity with at most five digits.
fn with_five_digits(label: &str) -> String {
    match super::reading::split(label) {
        (Some(value), unit) => format!("{} {unit}", number::rounded(value, 5)).trim_end().to_owned(),
        (None, _) => label.to_owned(),
    }
}
