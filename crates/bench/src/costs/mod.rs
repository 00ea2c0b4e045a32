//! What optional parts of the model and of the output cost a run of the program: time, memory and file size.
//!
//! ```text
//! subject   a scene, and for how many steps it runs
//! variant   what is switched on or off, and what that is set against
//! program   the program `plateau`, run as its users run it
//! ```

mod program;
mod subject;
mod variant;

use std::path::PathBuf;

use clap::Args;

use crate::case::Source;
use crate::document::{Benchmark, Document, RunCost, Settings, Spread};
use crate::error::BenchError;
use program::{Program, Run};
use subject::{SHIPPED, Subject, shipped};
use variant::{Variant, variants};

/// Options of `costs`.
#[derive(Debug, Args)]
pub struct CostOptions {
    /// Scene files (TOML); those of data/scenes if none is given
    pub scenes: Vec<PathBuf>,
    /// Set a key of every scene; may be repeated
    #[arg(long = "set", value_name = "KEY.PATH=VALUE")]
    pub sets: Vec<String>,
    /// Runs of every variant; they are made in turn
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub repeats: Option<u32>,
    /// The program to run; unless given the one that PLATEAU_PROGRAM names, or the one beside this program
    #[arg(long, value_name = "FILE")]
    pub program: Option<PathBuf>,
    /// Only look whether it runs: one scene, few steps; the numbers mean nothing
    #[arg(long)]
    pub quick: bool,
    /// Write the results to a file, as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

/// Runs every scene with every variant in turn.
pub fn costs(options: CostOptions) -> Result<Document, BenchError> {
    let CostOptions { scenes, sets, repeats, program, quick, json: _ } = options;
    let program = Program::find(program)?;
    let paths = match (scenes.is_empty(), quick) {
        (false, _) => scenes,
        (true, true) => vec![shipped("quick.toml")],
        (true, false) => SHIPPED.map(shipped).to_vec(),
    };
    let sources = paths.into_iter().map(|path| Source { path, sets: sets.clone(), worn_in: 0.0 });
    let subjects = sources.map(|source| Subject::new(source, quick)).collect::<Result<Vec<_>, _>>()?;
    let settings = Settings {
        scene: subjects.iter().map(Subject::name).collect::<Vec<_>>().join(", "),
        sets,
        worn_in: 0.0,
        time_acceleration: None,
        repeats: repeats.unwrap_or(if quick { 1 } else { 5 }) as usize,
        block_milliseconds: None,
        warm_up_steps: None,
        quick,
    };
    let repeats = settings.repeats;
    let mut document = Document::begin(Benchmark::Costs, settings);
    for subject in &subjects {
        document.runs.extend(race(&program, subject, repeats)?);
    }
    // What is measured is the program: its revision counts.
    if let Some(revision) = program.revision(&subjects[0].source)? {
        document.build.revision = revision;
    }
    Ok(document)
}

/// Runs all variants of a scene in turn.
fn race(program: &Program, subject: &Subject, repeats: usize) -> Result<Vec<RunCost>, BenchError> {
    let variants = variants(subject);
    let run = |variant: &Variant| program.run(&subject.source.with(variant.sets.iter().cloned()));
    eprintln!("{}: {} variants, {} steps", subject.name(), variants.len(), subject.steps);
    // Not measured: afterwards program and inputs are in memory.
    run(&variants[0])?;
    let mut runs = vec![Vec::with_capacity(repeats); variants.len()];
    for repeat in 1..=repeats {
        eprintln!("round {repeat} of {repeats}");
        for (variant, runs) in variants.iter().zip(&mut runs) {
            runs.push(run(variant)?);
        }
    }
    Ok(variants.into_iter().zip(runs).map(|(variant, runs)| cost(subject, variant, &runs)).collect())
}

fn cost(subject: &Subject, variant: Variant, runs: &[Run]) -> RunCost {
    let times: Vec<f64> = runs.iter().map(Run::microseconds_per_step).collect();
    RunCost {
        scene: subject.name(),
        mesh: subject.mesh,
        against: variant.against().to_owned(),
        name: variant.name,
        steps: runs.first().map_or(0, |run| run.steps),
        microseconds_per_step: Spread::of(&times),
        raw_microseconds_per_step: times,
        peak_memory_bytes: runs.iter().filter_map(|run| run.peak_memory).collect(),
        file_bytes: runs.iter().map(|run| run.file_size).max().unwrap_or(0),
    }
}
