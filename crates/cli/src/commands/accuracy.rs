//! `plateau accuracy`: error of a scene's runs against their run time.

use std::fs;
use std::path::PathBuf;

use plateau_io::dataset_file::now;
use plateau_io::scene::Scene;
use plateau_io::surface::{self, Loaded};
use plateau_run::accuracy::{
    AccuracyError, Base, COMPARED, Found, Ladder, PlanError, ReadReference, Wish, measure, read_reference,
};
use plateau_run::execution::decide;
use plateau_run::{input_files, signal_in_words};

use crate::accuracy::{Making, csv, json, text};
use crate::arguments::AccuracyArguments;
use crate::failure::Failure;
use crate::hand_over;
use crate::message;
use crate::output;
use crate::scene::{load_scene, sets};
use crate::table::print;
use crate::terminal::{Messages, Terminal};
use crate::version;

/// Ladders unless others are asked for.
const USUAL: [Ladder; 3] = [Ladder::TimeAcceleration, Ladder::Mesh, Ladder::Tolerance];

/// Files that are written: tables, and the figure in every format, in the order of those.
const FILES: [&str; 5] = ["accuracy.csv", "accuracy.json", "accuracy.png", "accuracy.svg", "accuracy.pdf"];

/// Measures the errors of a scene's runs.
pub fn accuracy(arguments: &AccuracyArguments) -> Result<(), Failure> {
    let scene = load_scene(&arguments.scene)?;
    let loaded = surface::load(&scene).map_err(Failure::input)?;
    loaded.warnings().for_each(message::warning);
    let path = arguments.reference.as_deref();
    let reference =
        path.map(|path| read_reference(path, &scene, &loaded.inputs)).transpose().map_err(Failure::input)?;
    let is_new = !arguments.output.exists();
    output::make_directory(&arguments.output)?;
    let result = measure_into(arguments, scene, loaded, reference);
    if is_new && result.is_err() {
        // Where nothing was written the folder is empty and goes; where something was it stays.
        let _ = fs::remove_dir(&arguments.output);
    }
    result
}

/// The same, with a folder to write to.
fn measure_into(
    arguments: &AccuracyArguments,
    scene: Scene,
    loaded: Loaded,
    reference: Option<ReadReference>,
) -> Result<(), Failure> {
    let places = places(arguments, &scene, &loaded.inputs)?;
    let start_time = now();
    let options = arguments.execution.options();
    let execution = decide(&scene, 1, &options, &loaded.surfaces, &mut Messages).map_err(Failure::run)?;
    let mut ladders = if arguments.ladders.is_empty() { USUAL.to_vec() } else { arguments.ladders.clone() };
    ladders.sort_unstable();
    ladders.dedup();
    let is_asked = |name: &&str| arguments.quantities.is_empty() || arguments.quantities.contains(name);
    let making = Making {
        scene: scene.resolved.clone(),
        inputs: input_files(&scene, &loaded.inputs),
        workers: execution.workers,
        instruction_set: execution.instructions.name(),
        budget: arguments.budget,
        start_time,
    };
    let wish = Wish {
        base: Base { path: arguments.scene.scene.clone(), sets: sets(&arguments.scene), scene },
        ladders,
        quantities: COMPARED.iter().map(|one| one.name).filter(is_asked).collect(),
        tolerance: arguments.tolerance,
        budget: arguments.budget,
        reference,
        program: version::this(),
    };
    let mut terminal = Terminal::listen(true).map_err(Failure::run)?;
    let Found { report, stopped } = measure(wish, &loaded.surfaces, execution, &mut terminal).map_err(failure)?;

    let state = if stopped.is_none() { "finished" } else { "interrupted" };
    let document = json(&report, &making, state);
    let [csv_file, json_file, drawings @ ..] = &places;
    let mut written = vec![csv_file, json_file];
    let force = arguments.force;
    output::write_in_folder(csv_file, csv(&report).as_bytes(), force)?;
    output::write_in_folder(json_file, document.as_bytes(), force)?;
    // Tables of hours of runs are worth something without figures.
    match hand_over::draw("accuracy", json_file, &hand_over::FORMATS, &[]) {
        Ok(drawn) => {
            for (path, (_, content)) in drawings.iter().zip(&drawn) {
                output::write_in_folder(path, content, force)?;
                written.push(path);
            }
        }
        Err(failure) => message::warning(format_args!("the figure is left out: {failure}")),
    }
    if arguments.scene.json {
        print(&document)?;
    } else {
        let files: String = written.iter().map(|path| format!("wrote {}\n", path.display())).collect();
        print(&format!("{}\n{files}", text(&report)))?;
    }
    match stopped {
        None => Ok(()),
        Some(signal) => {
            let (runs, folder) = (report.rows.len(), arguments.output.display());
            let message =
                format!("stopped by {}; {folder} has the {runs} runs that were done", signal_in_words(signal));
            Err(Failure::Stopped { signal, message: Some(message) })
        }
    }
}

/// The files to write, each of which may be written.
fn places(
    arguments: &AccuracyArguments,
    scene: &Scene,
    surfaces: &[(PathBuf, String)],
) -> Result<[PathBuf; 5], Failure> {
    let read = scene.files.iter().chain(surfaces);
    let mut inputs: Vec<PathBuf> = read.map(|(path, _)| path.clone()).collect();
    inputs.extend(arguments.reference.clone());
    let places = FILES.map(|name| arguments.output.join(name));
    let check = |path: &PathBuf| output::check(path, arguments.force, &inputs);
    places.iter().try_for_each(check).map_err(|failure| failure.but("-o DIR names another folder"))?;
    Ok(places)
}

/// Whose fault it is that errors cannot be measured.
fn failure(error: AccuracyError) -> Failure {
    match error {
        AccuracyError::Input(PlanError::Scene(error)) => Failure::of_scene(error),
        AccuracyError::Input(error) => Failure::input(error),
        AccuracyError::Run(error) => Failure::of(error),
        AccuracyError::Stopped { signal, .. } => Failure::Stopped { signal, message: Some(error.to_string()) },
        AccuracyError::Failed { .. } => Failure::run(error),
    }
}
