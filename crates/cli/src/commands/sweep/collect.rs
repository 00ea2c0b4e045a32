//! `plateau sweep collect`: all results of a study in one HDF5 file and a table.

use std::path::{Path, PathBuf};

use plateau_io::dataset_file::{Attribute, now};
use plateau_io::study::journal::Journal;
use plateau_io::study::plan::Plan;
use plateau_io::study::results::{self, Collected, RunStatus, is_results_table, table as table_of};
use plateau_io::study::results_file::{finished, is_collected};
use plateau_io::{input, limits, number, scene};
use plateau_run::sweep::{Resolved, SceneWarnings, journal, note_short_tenths, of_questions, say_left_out, say_unkept};
use serde::Serialize;

use crate::arguments::CollectArguments;
use crate::failure::Failure;
use crate::output::{csv_table, list, print, print_json, table};
use crate::terminal::Messages;
use crate::{output, program};

/// Failed runs that are listed.
const LISTED: usize = 10;

pub fn collect(arguments: &CollectArguments) -> Result<(), Failure> {
    let plan = arguments.study.load()?;
    let (collected, inputs, left_out) = collected(&plan)?;
    let folder = arguments.output.clone().unwrap_or_else(|| plan.study().directory.clone());
    output::make_directory(&folder)?;
    let [hdf5, csv] = ["results.h5", "results.csv"].map(|name| folder.join(name));
    // What was collected before is collected anew, as often as there are more results. What others made stays.
    // Of a link it is not asked what it leads to.
    let is_own = |path: &Path, is: fn(&Path) -> bool| !path.is_symlink() && is(path);
    output::check(&hdf5, arguments.force || is_own(&hdf5, is_collected), &inputs)?;
    output::check(&csv, arguments.force || is_own(&csv, is_results_table), &inputs)?;
    let before = [(&hdf5, finished(&hdf5)), (&csv, results::finished(&csv))];
    let fewer =
        before.into_iter().find(|(_, before)| before.is_some_and(|before| before > collected.count("finished")));
    if let (Some((path, Some(before))), false) = (fewer, arguments.force) {
        return Err(Failure::input(format!(
            "{} has {} that finished, of which there are {} now{}; --force replaces it, -o DIR writes elsewhere",
            path.display(),
            number::count(before, "run"),
            collected.count("finished"),
            left_out.iter().map(|reason| format!("; {reason}")).collect::<String>()
        )));
    }
    collected.write(&hdf5, true, &plan, attributes(&plan, &collected)?).map_err(Failure::run)?;
    output::write_in_folder(&csv, csv_table(table_of(&plan, &collected)).as_bytes(), true)?;
    let summary = Summary {
        study: plan.study().title.clone(),
        runs: plan.runs(),
        finished: collected.count("finished"),
        failed: collected.count("failed"),
        missing: collected.count("missing"),
        files: [&hdf5, &csv].map(|path| path.display().to_string()),
    };
    if arguments.json {
        return print_json(&summary);
    }
    print(&summary.to_text(&collected, plan.study().is_imported()))
}

/// The results of a study, as far as there are any; the study, its tables, its scenes and what they read; and why results in the journal
/// are left out.
fn collected(plan: &Plan) -> Result<(Collected, Vec<PathBuf>, Vec<String>), Failure> {
    let mut inputs = plan.study().inputs();
    if plan.study().base.is_none() {
        // Each run is one of its own, for it was measured by itself.
        let numbers: Vec<String> = (1..=plan.runs()).map(|number| number.to_string()).collect();
        let collected = Collected::new(plan, &numbers, &Journal::default()).map_err(Failure::run)?;
        return Ok((collected, inputs, Vec::new()));
    }
    let resolved = Resolved::of(plan)?;
    note_short_tenths(plan.study(), &resolved.lengths(), &Messages);
    let (journal, identities) = (journal(plan.study())?, resolved.identities());
    let collected = Collected::new(plan, &identities, &journal).map_err(Failure::run)?;
    let left_out = say_left_out(plan.study(), &resolved, &journal, &Messages);
    say_unkept(plan.study(), &resolved, &journal, false, &Messages);
    let mut unanswered = SceneWarnings::default();
    for run in collected.runs.iter().filter(|run| run.state == RunStatus::Finished) {
        unanswered.add(of_questions(plan.study(), &run.unanswered));
    }
    unanswered.say("finished runs", &Messages);
    inputs.extend(resolved.files);
    Ok((collected, inputs, left_out))
}

fn attributes(plan: &Plan, collected: &Collected) -> Result<Vec<(&'static str, Attribute)>, Failure> {
    let study = plan.study();
    let text = |text: &str| Attribute::Text(text.to_owned());
    let unread = |error| Failure::because(&error, format_args!("{}: {error}", study.path.display()));
    let state = if collected.count("finished") == collected.runs.len() { "complete" } else { "partial" };
    let mut attributes = vec![
        ("title", text(&study.title)),
        ("state", text(state)),
        ("program", Attribute::Text(program::name())),
        ("source_revision", text(program::REVISION)),
        ("study", Attribute::Text(input::read_to_string(&study.path, limits::STUDY).map_err(unread)?)),
        ("design", text(&study.design)),
        ("collected", Attribute::Text(now())),
    ];
    // With what holds for all runs, and without the factors. It may lack what only they give.
    if let Some(Ok(scene)) = study.base.as_deref().map(|base| scene::load(base, &study.sets)) {
        attributes.push(("base_scene", Attribute::Text(scene.resolved)));
    }
    Ok(attributes)
}

/// Report of `plateau sweep collect`.
#[derive(Debug, Serialize)]
struct Summary {
    study: String,
    runs: usize,
    finished: usize,
    failed: usize,
    missing: usize,
    files: [String; 2],
}

impl Summary {
    fn to_text(&self, collected: &Collected, is_imported: bool) -> String {
        let mut rows = vec![("runs", self.runs.to_string()), ("finished", self.finished.to_string())];
        rows.extend((self.failed > 0).then(|| ("failed", self.failed.to_string())));
        rows.extend((self.missing > 0).then(|| ("missing", self.missing.to_string())));
        rows.extend(self.files.iter().map(|file| ("written", file.clone())));
        let mut text = table(&self.study, &rows);
        let failed = collected.runs.iter().filter_map(|run| match &run.state {
            RunStatus::Failed(error) => Some(format!("run {}: {error}", run.run.number)),
            _ => None,
        });
        let lines: Vec<String> = failed.take(LISTED).collect();
        if !lines.is_empty() {
            text.push_str(&list("Failed", &lines));
        }
        let missing = collected.runs.iter().filter(|run| run.state == RunStatus::Missing);
        let missing: Vec<String> = missing.map(|run| run.run.number.to_string()).collect();
        if !missing.is_empty() {
            let shown = missing[..missing.len().min(2 * LISTED)].join(", ");
            let more = if missing.len() > 2 * LISTED { ", …" } else { "" };
            let remedy = match is_imported {
                true => "plateau sweep import takes in their responses",
                false => "plateau sweep run makes them",
            };
            text.push_str(&list("Missing", &[format!("runs {shown}{more}: {remedy}")]));
        }
        text
    }
}
