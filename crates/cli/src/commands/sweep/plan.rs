//! `plateau sweep plan`: what a study will do and cost.

use std::path::PathBuf;

use plateau_io::number;
use plateau_io::study::factor::{Factor, Level};
use plateau_io::study::journal::Entry;
use plateau_io::study::plan::Plan;
use plateau_io::study::response::Response;
use plateau_run::execution::cores;
use plateau_run::sweep::{Estimate, Resolved, journal, note_short_tenths, say_left_out};
use serde::Serialize;

use crate::arguments::PlanArguments;
use crate::failure::Failure;
use crate::output::{columns, csv_table, list, print, print_json, table};
use crate::terminal::Messages;
use crate::{message, output};

/// Runs that are listed; a table in CSV has all.
const LISTED: usize = 16;

/// Plans a study.
pub fn plan(arguments: &PlanArguments) -> Result<(), Failure> {
    let plan = arguments.study.load()?;
    let check =
        |inputs: &[PathBuf]| arguments.csv.as_ref().map_or(Ok(()), |csv| output::check(csv, arguments.force, inputs));
    check(&plan.study().inputs())?;
    let has_scene = plan.study().base.is_some();
    let estimate = if has_scene { Estimate::of(&plan)? } else { Estimate::default() };
    estimate.warnings.say("runs whose surfaces were made to try", &Messages);
    let jobs = arguments.jobs.map_or_else(cores, |jobs| jobs as usize).min(plan.runs().max(1));
    let (mut ended, mut repeats) = (None, None);
    if plan.runs() <= Resolved::MOST_AT_ONCE && has_scene {
        let (resolved, journal) = (Resolved::of(&plan)?, journal(plan.study())?);
        say_left_out(plan.study(), &resolved, &journal, &Messages);
        check(&resolved.files.iter().cloned().collect::<Vec<_>>())?;
        resolved.refuse_unrecorded(plan.study(), &Messages)?;
        resolved.warn_of_late_questions(plan.study(), &Messages);
        note_short_tenths(plan.study(), &resolved.lengths(), &Messages);
        resolved.warnings.say("runs", &Messages);
        let different = resolved.runs.iter().filter(|(number, _)| !resolved.is_repeat(**number));
        let entries: Vec<&Entry> = different.filter_map(|(_, run)| journal.get(&run.identity)).collect();
        let failed = entries.iter().filter(|entry| entry.failure.is_some()).count();
        ended = Some(Ended { finished: entries.len() - failed, failed });
        repeats = Some(resolved.repeats());
    }
    if plan.runs() > Resolved::MOST_AT_ONCE && has_scene {
        message::note(format_args!(
            "{}: {} runs are more than {}, so that their scenes are not looked at here, nor which of them are there already; \
             `plateau sweep run` looks at all of them before it makes the first",
            plan.study().path.display(),
            number::grouped(plan.runs() as u64),
            number::grouped(Resolved::MOST_AT_ONCE as u64)
        ));
    }
    if let Some(csv) = &arguments.csv {
        output::write(csv, table_of_runs(&plan).as_bytes(), arguments.force)?;
        message::note(format_args!("wrote {}", csv.display()));
    }
    let report = Report::new(&plan, &estimate, jobs, ended, repeats);
    if arguments.json { print_json(&report) } else { print(&report.to_text(&plan)) }
}

/// Report of `plateau sweep plan`.
#[derive(Debug, Serialize)]
struct Report {
    title: String,
    /// Absent where all responses are imported.
    base: Option<String>,
    design: String,
    factors: Vec<FactorReport>,
    points: usize,
    replicates: usize,
    runs: usize,
    /// Runs that are the same as another one and have its result; absent where there are too many runs to look.
    repeats: Option<usize>,
    resolution: Option<u32>,
    defining_words: Vec<String>,
    aliases: Vec<Vec<String>>,
    responses: Vec<String>,
    jobs: usize,
    /// Bytes, of all runs at a time.
    memory: u64,
    /// Bytes, of all run files together, at most, if they are kept.
    run_files: u64,
    /// s, of one run: mean and longest.
    run_time: [f64; 2],
    /// s, of what is left.
    estimated_time: f64,
    /// Absent where there are too many runs to look.
    ended: Option<Ended>,
    directory: String,
}

#[derive(Debug, Clone, Copy, Serialize)]
struct Ended {
    finished: usize,
    failed: usize,
}

#[derive(Debug, Serialize)]
struct FactorReport {
    name: String,
    keys: Vec<String>,
    #[serde(skip)]
    keys_in_words: String,
    values: String,
}

impl FactorReport {
    fn of(factor: &Factor) -> Self {
        let (name, keys) = (factor.name.clone(), factor.keys.clone());
        Self { name, keys, keys_in_words: factor.keys_in_words(), values: factor.to_string() }
    }
}

impl Report {
    fn new(plan: &Plan, estimate: &Estimate, jobs: usize, ended: Option<Ended>, repeats: Option<usize>) -> Self {
        let study = plan.study();
        let left = plan.runs() - repeats.unwrap_or(0) - ended.map_or(0, |ended| ended.finished);
        let aliases = plan.aliases();
        Self {
            title: study.title.clone(),
            base: study.base.as_ref().map(|base| base.display().to_string()),
            design: study.design.clone(),
            factors: study.factors.iter().map(FactorReport::of).collect(),
            points: plan.points(),
            replicates: plan.replicates(),
            runs: plan.runs(),
            repeats,
            resolution: aliases.map(|aliases| aliases.resolution),
            defining_words: aliases.map_or_else(Vec::new, |aliases| aliases.defining_words.clone()),
            aliases: aliases.map_or_else(Vec::new, |aliases| aliases.chains.clone()),
            responses: study.responses.iter().map(|response| response.name.clone()).collect(),
            jobs,
            memory: estimate.memory * jobs as u64,
            run_files: estimate.file_size.saturating_mul((plan.runs() - repeats.unwrap_or(0)) as u64),
            run_time: [estimate.mean_time, estimate.longest_time],
            estimated_time: (estimate.mean_time * left as f64 / jobs as f64)
                .max(estimate.longest_time.min(left as f64)),
            ended,
            directory: study.directory.display().to_string(),
        }
    }

    fn to_text(&self, plan: &Plan) -> String {
        let replicates =
            if self.replicates > 1 { format!(" × {} replicates", self.replicates) } else { String::new() };
        let mut rows = vec![
            ("base scene", self.base.clone().unwrap_or_else(|| "none: all responses are imported".to_owned())),
            ("design", self.design.clone()),
            ("runs", format!("{} points{replicates} = {}", self.points, number::grouped(self.runs as u64))),
        ];
        if let Some(repeats) = self.repeats.filter(|repeats| *repeats > 0) {
            let different = number::grouped((self.runs - repeats) as u64);
            rows.push(("different runs", format!("{different}; {}", repeats_in_words(repeats, self.runs))));
        }
        if let Some(Ended { finished, failed }) = self.ended {
            let failed = if failed > 0 { format!(", {failed} failed") } else { String::new() };
            rows.push(("ended before", format!("{finished} finished{failed}")));
        }
        if self.base.is_some() {
            let [mean, longest] = self.run_time.map(number::duration);
            let (memory, all) = (number::bytes(self.memory), number::duration(self.estimated_time));
            rows.extend([
                ("memory", format!("{memory} for {} at a time", number::count(self.jobs, "run"))),
                ("time of a run", format!("about {mean}, the longest {longest}")),
                ("estimated time", format!("{all} for what is left, {} at a time", self.jobs)),
            ]);
        }
        rows.push(("results", self.directory.clone()));
        if self.base.is_some() {
            rows.push(("run files", format!("at most {} in all with --keep-files", number::bytes(self.run_files))));
        }
        let mut text = table(&self.title, &rows);
        let values = |factor: &FactorReport| format!("{}  ({})", factor.values, factor.keys_in_words);
        let factors: Vec<_> = self.factors.iter().map(|factor| (factor.name.clone(), values(factor))).collect();
        text.push_str(&format!("\n{}", table("Factors", &factors)));
        if let Some(lines) = alias_lines(plan) {
            text.push_str(&format!("\n{}", list("Effects that cannot be told from each other", &lines)));
        }
        let names = self.factors.iter().map(|factor| factor.name.as_str());
        let replicate = (self.replicates > 1).then_some("replicate");
        let names: Vec<&str> = ["run"].into_iter().chain(names).chain(replicate).collect();
        let rows: Vec<Vec<String>> = plan.order().take(LISTED).map(|number| cells(plan, number, shortened)).collect();
        let more = self.runs.saturating_sub(LISTED);
        let heading = if more > 0 {
            format!("The first {LISTED} runs, in the order in which they are made ({more} more, --csv writes all)")
        } else {
            "Runs, in the order in which they are made".to_owned()
        };
        text.push_str(&format!("\n{}", columns(&heading, &names, &rows)));
        text
    }
}

/// Number, levels and replicate of a run; how a level is written.
fn cells(plan: &Plan, number: usize, written: impl Fn(&Level) -> String) -> Vec<String> {
    let run = plan.run(number);
    let replicate = (plan.replicates() > 1).then(|| (run.replicate + 1).to_string());
    let levels = run.levels.iter().map(written);
    [number.to_string()].into_iter().chain(levels).chain(replicate).collect()
}

/// Every run in the order in which it is made, in CSV, with empty columns for responses that `plateau sweep import` is to take in.
fn table_of_runs(plan: &Plan) -> String {
    let imported: Vec<_> = plan.study().responses.iter().filter(|response| response.is_imported()).collect();
    let names = plan.study().factors.iter().map(|factor| factor.name.clone());
    let replicate = (plan.replicates() > 1).then(|| "replicate".to_owned());
    let unit = |response: &Response| response.stated_unit.clone().unwrap_or_else(|| response.unit("").to_owned());
    let filled_in = imported.iter().map(|response| with_unit(&response.name, &unit(response)));
    let header = ["run".to_owned()].into_iter().chain(names).chain(replicate).chain(filled_in).collect();
    let row = |number| [cells(plan, number, |level| level.label.clone()), vec![String::new(); imported.len()]].concat();
    csv_table(std::iter::once(header).chain(plan.order().map(row)))
}

/// The head of a column: the name, and the unit in brackets if there is one.
fn with_unit(name: &str, unit: &str) -> String {
    if ["", "1"].contains(&unit) { name.to_owned() } else { format!("{name} [{unit}]") }
}

/// A level for people: a quantity with at most five digits, a word as it is.
fn shortened(level: &Level) -> String {
    match level.split() {
        Some((value, unit)) => format!("{} {unit}", number::rounded(value, 5)).trim_end().to_owned(),
        None => level.label.clone(),
    }
}

/// Sets of effects that are listed.
const CHAINS: usize = 40;

/// A line with the letters of the factors, one with the defining words, and one for each set; none for designs that tell
/// all effects.
fn alias_lines(plan: &Plan) -> Option<Vec<String>> {
    let aliases = plan.aliases()?;
    let letters = ('A'..='Z').filter(|letter| *letter != 'I').zip(&plan.study().factors);
    let letters: Vec<String> = letters.map(|(letter, factor)| format!("{letter} = {}", factor.name)).collect();
    let words = aliases.defining_words.join(" = ");
    let mut lines = vec![letters.join(", "), format!("resolution {}: I = {words}", aliases.resolution)];
    lines.extend(aliases.chains.iter().take(CHAINS).map(|chain| chain.join(" = ")));
    if aliases.chains.len() > CHAINS {
        lines.push(format!("and {} more", aliases.chains.len() - CHAINS));
    }
    Some(lines)
}

/// Remark on so many runs that repeat another one.
fn repeats_in_words(repeats: usize, runs: usize) -> String {
    let (repeat, count) = if repeats == 1 { ("repeats", "counts") } else { ("repeat", "count") };
    format!(
        "{repeats} of {runs} runs {repeat} another one and {count} once with it: the same scene with the same seeds gives the \
         same result. Only [replicates] with several seeds tell the pure error."
    )
}
