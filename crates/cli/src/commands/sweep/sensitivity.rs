//! `plateau sweep sensitivity`: which part of a response's variation each factor has.

use plateau_io::study::DesignSource;
use plateau_io::study::collected::Collected;
use plateau_io::study::plan::Plan;
use plateau_present::Unit;
use plateau_present::figure::effects::file_names;
use plateau_present::figure::{Figure, sensitivity as figures};
use plateau_present::study::analysis::{AnalysedResponse, Analysis, Asked, Processes};
use plateau_present::study::cautions::{levels_and_ranges, together};
use plateau_study::design::{Kind, Setting};
use plateau_study::effects::Factor;
use plateau_study::sensitivity::{ElementaryEffect, Index, Options, elementary_effects, sobol_indices};

use super::analysed::analysable;
use super::collect::Found;
use super::sensitivity_document::{self, Known, Told};
use crate::arguments::SensitivityArguments;
use crate::csv_table::csv_table;
use crate::failure::Failure;
use crate::output_folder::{OutputFolder, names_of};
use crate::sweep;
use crate::table::{columns, print, table};
use crate::{message, number};

/// The table.
const TABLE: &str = "sensitivity.csv";

/// Tells the sensitivities of all responses.
pub fn sensitivity(arguments: &SensitivityArguments) -> Result<(), Failure> {
    let plan = sweep::plan(&arguments.study)?;
    let study = plan.study();
    let folder = arguments.output.clone().unwrap_or_else(|| study.directory.join("sensitivity"));
    let mut folder = OutputFolder::new(folder, arguments.force)?;
    let Found { collected, inputs, .. } = analysable(&plan)?;
    let told = Told::new(&plan, &collected, arguments);
    let figures = told.figures();
    folder.begin(&[&[TABLE.to_owned()], &names_of(figures.iter())[..]].concat(), &inputs)?;
    folder.write(TABLE, csv_table(told.lines()).as_bytes())?;
    folder.write_figures(&figures)?;
    let files = folder.files().to_vec();
    if arguments.json {
        let document = sensitivity_document::Document {
            study: &study.title,
            responses: sensitivity_document::reports(&told),
            files,
        };
        return print(&(serde_json::to_string_pretty(&document).map_err(Failure::run)? + "\n"));
    }
    let pictures = files.iter().filter(|file| file.ends_with(".png")).count();
    let rows = [
        ("written", files[0].clone()),
        ("written", format!("{} as PNG, SVG and PDF beside it", number::count(pictures, "figure"))),
    ];
    print(&(told.text() + &table(&study.title, &rows)))
}

impl Told {
    fn new(plan: &Plan, results: &Collected, arguments: &SensitivityArguments) -> Self {
        let confidence = arguments.confidence;
        let is_morris = matches!(plan.study().source, DesignSource::Kind(Kind::Morris { .. }));
        let processes = if is_morris { Processes::None } else { Processes::ForValues };
        let analysis =
            Analysis::of(plan.study(), results, Asked { model: None, by_aicc: false, processes, confidence });
        let said = together(&analysis).into_iter().chain(levels_and_ranges(&analysis));
        said.for_each(|said| message::warning(format_args!("{said}")));
        let factors: Vec<Factor> = analysis.factors.iter().map(|factor| factor.factor.clone()).collect();
        let options = Options { confidence: arguments.confidence, ..Options::default() };
        let known = |at: usize| match is_morris {
            true => {
                let runs = analysis.runs.iter();
                let points: Vec<_> = runs.map(|(settings, responses)| (settings.clone(), responses[at])).collect();
                Known::Effects(elementary_effects(&factors, &means(&points, plan.replicates())))
            }
            false => indices(&factors, &analysis.responses[at], &options),
        };
        let size = |at: usize| {
            let sizes = analysis.runs.iter().map(|(_, responses)| responses[at].abs());
            sizes.filter(|size| size.is_finite()).fold(0.0, f64::max)
        };
        let responses = analysis.responses.iter().enumerate();
        Self {
            responses: responses
                .map(|(at, response)| (response.name.clone(), response.unit, size(at), known(at)))
                .collect(),
            factors: plan.study().factors.iter().map(|factor| factor.name.clone()).collect(),
            confidence: arguments.confidence,
        }
    }

    fn names(&self) -> Vec<&str> {
        self.factors.iter().map(String::as_str).collect()
    }

    fn level(&self) -> String {
        number::confidence(self.confidence)
    }

    fn figures(&self) -> Vec<Figure> {
        let files = file_names(self.responses.iter().map(|(name, ..)| name.as_str()));
        let figure = |((name, unit, size, known), file): (&(String, &'static str, f64, Known), String)| match known {
            Known::Indices(indices, _) => Some(figures::indices(name, &file, &self.names(), indices, &self.level())),
            Known::Effects(effects) => {
                let unit = Unit::readable_with_differences(unit, *size);
                Some(figures::effects(name, &file, &self.names(), effects, &unit))
            }
            Known::Nothing(_) => None,
        };
        self.responses.iter().zip(files).filter_map(figure).collect()
    }

    /// The table, a line for each response and factor.
    fn lines(&self) -> Vec<Vec<String>> {
        let heads = [
            "response",
            "factor",
            "first_order",
            "first_order_low",
            "first_order_high",
            "total",
            "total_low",
            "total_high",
            "mean_size",
            "mean",
            "deviation",
            "standard_error",
        ];
        let shown = |value: f64| if value.is_finite() { format!("{value:?}") } else { String::new() };
        let of_index = |index: &Index| {
            let [low, high] = index.interval.unwrap_or([f64::NAN; 2]);
            [index.value, low, high]
        };
        let mut lines = vec![heads.map(str::to_owned).to_vec()];
        for (name, .., known) in &self.responses {
            for (at, factor) in self.factors.iter().enumerate() {
                let numbers = match known {
                    Known::Indices(indices, _) => [
                        of_index(&indices.first[at]).to_vec(),
                        of_index(&indices.total[at]).to_vec(),
                        vec![f64::NAN; 4],
                    ]
                    .concat(),
                    Known::Effects(effects) => {
                        let ElementaryEffect { mean_size, mean, deviation, error, .. } = effects[at];
                        [vec![f64::NAN; 6], vec![mean_size, mean, deviation, error]].concat()
                    }
                    Known::Nothing(_) => continue,
                };
                let cells = numbers.into_iter().map(shown);
                lines.push([name.clone(), factor.clone()].into_iter().chain(cells).collect());
            }
        }
        lines
    }

    fn text(&self) -> String {
        self.responses.iter().map(|(name, unit, size, known)| self.text_of(name, unit, *size, known) + "\n").collect()
    }

    fn text_of(&self, name: &str, unit: &str, size: f64, known: &Known) -> String {
        match known {
            Known::Nothing(why) => format!("{name}\n  {why}\n"),
            Known::Indices(indices, reason) => {
                let shown = |index: &Index| {
                    let index = index.possible();
                    let interval = index.interval.map(|[low, high]| format!(" ({low:.3} … {high:.3})"));
                    format!("{:.3}{}", index.value, interval.unwrap_or_default())
                };
                let mut order: Vec<usize> = (0..self.factors.len()).collect();
                order.sort_by(|one, other| indices.total[*other].value.total_cmp(&indices.total[*one].value));
                let row = |at: &usize| {
                    vec![self.factors[*at].clone(), shown(&indices.first[*at]), shown(&indices.total[*at])]
                };
                let rows: Vec<Vec<String>> = order.iter().map(row).collect();
                let names = ["factor", "alone (first order)", "with interactions (total)"];
                let of_sample = format!(
                    "intervals of {} are for the sample of places alone, not for what the function misses",
                    self.level()
                );
                columns(&format!("{name}: parts of the variance\n  {reason}\n  {of_sample}"), &names, &rows)
            }
            Known::Effects(effects) => {
                let unit = Unit::readable_with_differences(unit, size);
                let shown = |value: f64| {
                    if value.is_finite() { number::rounded(unit.difference(value), 4) } else { "–".to_owned() }
                };
                let mut order: Vec<usize> = (0..self.factors.len()).collect();
                order.sort_by(|one, other| effects[*other].mean_size.total_cmp(&effects[*one].mean_size));
                let row = |at: &usize| {
                    let ElementaryEffect { mean_size, mean, deviation, error, count } = effects[*at];
                    let numbers = [mean_size, error, mean, deviation].map(shown);
                    [self.factors[*at].clone()].into_iter().chain(numbers).chain([count.to_string()]).collect()
                };
                let rows: Vec<Vec<String>> = order.iter().map(row).collect();
                let names = ["factor", "mean size μ*", "its error", "mean", "deviation σ", "effects"];
                columns(&format!("{}: elementary effects per whole range", unit.label(name)), &names, &rows)
            }
        }
    }
}

/// Indices from the surrogate that forecasts points best, of a polynomial and a Gaussian process.
fn indices(factors: &[Factor], response: &AnalysedResponse, options: &Options) -> Known {
    let (Some(surrogate), Some(reason)) = (response.surrogate(), response.reason_of_choice()) else {
        let why = response.effects.as_ref().err().map(ToString::to_string);
        return Known::Nothing(why.unwrap_or_else(|| "nothing could be fitted".to_owned()));
    };
    match sobol_indices(factors, surrogate.as_ref(), options) {
        Ok(indices) => Known::Indices(indices, format!("of the {}; {reason}", surrogate.name())),
        Err(error) => Known::Nothing(error.to_string()),
    }
}

/// Points in the order of the design, with the mean over the seeds; NaN where one of them has no response, for its other seeds
/// would be compared with other ones.
fn means(runs: &[(Vec<Setting>, f64)], seeds: usize) -> Vec<(Vec<Setting>, f64)> {
    let mean = |point: &[(Vec<Setting>, f64)]| {
        let sum: f64 = point.iter().map(|(_, response)| response).sum();
        (point[0].0.clone(), sum / point.len() as f64)
    };
    runs.chunks(seeds.max(1)).map(mean).collect()
}
