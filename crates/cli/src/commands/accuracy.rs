//! `plateau accuracy`: error of a scene's runs against their run time.

use std::fs;
use std::path::PathBuf;

use plateau_io::dataset_file::now;
use plateau_io::run_file::InputFile;
use plateau_io::scene::recipe::Scene;
use plateau_io::surface::{self, Loaded};
use plateau_present::figure::{Figure, Format, accuracy as drawing};

use super::load_scene;
use crate::accuracy::{Found, Making, ReadReference, Report, Row, Wish, csv, json, read_reference, search, text};
use crate::arguments::{AccuracyArguments, Ladder};
use crate::execution::decide;
use crate::failure::Failure;
use crate::output;
use crate::table::print;

/// The ladders that are climbed unless others are asked for.
const USUAL: [Ladder; 3] = [Ladder::TimeAcceleration, Ladder::Tolerance, Ladder::Integrator];

/// Files that are written: tables, and the figure in every format, in the order of those.
const FILES: [&str; 5] = ["accuracy.csv", "accuracy.json", "accuracy.png", "accuracy.svg", "accuracy.pdf"];

/// Measures the errors of a scene's runs.
pub fn accuracy(arguments: &AccuracyArguments) -> Result<(), Failure> {
    let scene = load_scene(&arguments.scene)?;
    let loaded = surface::load(&scene).map_err(Failure::input)?;
    let reference = arguments.reference.as_deref();
    let reference = reference.map(|path| read_reference(path, &scene, &loaded.inputs)).transpose()?;
    let is_new = !arguments.output.exists();
    output::make_directory(&arguments.output)?;
    let result = measure_into(arguments, &scene, loaded, reference);
    if is_new && result.is_err() {
        // Where nothing was written the folder is empty and goes; where something was it stays.
        let _ = fs::remove_dir(&arguments.output);
    }
    result
}

/// The same, with a folder to write to.
fn measure_into(
    arguments: &AccuracyArguments,
    scene: &Scene,
    loaded: Loaded,
    reference: Option<ReadReference>,
) -> Result<(), Failure> {
    let places = places(arguments, scene, &loaded.inputs)?;
    let start_time = now();
    let execution = decide(scene, 1, &arguments.execution, &loaded.surfaces).map_err(Failure::run)?;
    let mut ladders = if arguments.ladders.is_empty() { USUAL.to_vec() } else { arguments.ladders.clone() };
    ladders.sort_unstable();
    ladders.dedup();
    let wish = Wish { ladders, budget: arguments.budget, reference };
    let Found { report, stopped } = search(scene, &loaded.surfaces, execution, wish)?;

    let making = Making {
        scene: scene.resolved.clone(),
        inputs: inputs(scene, &loaded.inputs)?,
        workers: execution.workers,
        instruction_set: execution.instructions.name(),
        budget: arguments.budget,
        start_time,
        state: if stopped.is_none() { "finished" } else { "interrupted" },
    };
    let figure = figure(&report);
    let document = json(&report, &making);
    let [csv_file, json_file, drawings @ ..] = &places;
    let force = arguments.force;
    output::write(csv_file, csv(&report.rows).as_bytes(), force)?;
    output::write(json_file, document.as_bytes(), force)?;
    for (path, format) in drawings.iter().zip(Format::ALL) {
        output::write(path, &figure.draw(format).map_err(Failure::run)?, force)?;
    }
    if arguments.scene.json {
        print(&document)?;
    } else {
        let files: String = places.iter().map(|path| format!("wrote {}\n", path.display())).collect();
        print(&format!("{}\n{files}", text(&report)))?;
    }
    match stopped {
        None => Ok(()),
        Some(signal) => {
            let (runs, folder) = (report.rows.len(), arguments.output.display());
            let message = format!("stopped by signal {signal}; {folder} has the {runs} runs that were done");
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
    let mut inputs = scene.files.clone();
    inputs.extend(surfaces.iter().map(|(path, _)| path.clone()));
    inputs.extend(arguments.reference.clone());
    let places = FILES.map(|name| arguments.output.join(name));
    places.iter().try_for_each(|path| output::check(path, arguments.force, &inputs))?;
    Ok(places)
}

/// Every file that the scene reads with its digest.
fn inputs(scene: &Scene, surfaces: &[(PathBuf, String)]) -> Result<Vec<InputFile>, Failure> {
    let mut inputs = InputFile::read_all(&scene.files)
        .map_err(|(path, error)| Failure::input(format_args!("{}: {error}", path.display())))?;
    inputs.extend(
        surfaces
            .iter()
            .map(|(path, sha256)| InputFile { path: path.to_string_lossy().into_owned(), sha256: sha256.clone() }),
    );
    Ok(inputs)
}

/// The figure of what was found.
fn figure(report: &Report) -> Figure {
    let rung = |row: &Row| {
        let value = row.rung.value();
        let label = match row.rung.ladder {
            Ladder::TimeAcceleration => format!("{value}"),
            Ladder::Tolerance => format!("tolerance {value}"),
            Ladder::Mesh => format!("{value}\u{d7} coarser"),
            Ladder::Integrator | Ladder::Perturbation => String::new(),
        };
        drawing::Rung { time: row.cost().time, error: row.error(), on_front: row.on_front, label }
    };
    let ladder = |rows: &'_ [Row]| {
        let ladder = rows[0].rung.ladder;
        drawing::Ladder {
            name: ladder.name(),
            colour: ladder as usize,
            is_joined: matches!(ladder, Ladder::TimeAcceleration | Ladder::Mesh),
            is_chance: ladder == Ladder::Perturbation,
            rungs: rows.iter().map(rung).collect(),
        }
    };
    let same = |one: &Row, next: &Row| one.rung.ladder == next.rung.ladder;
    let ladders: Vec<drawing::Ladder> = report.rows.chunk_by(same).map(ladder).collect();
    let reference = drawing::Reference {
        time: report.reference.outcome.wall_time,
        error: report.own_error.contact_area(),
        time_acceleration: report.reference.time_acceleration,
    };
    drawing::figure(&reference, &ladders)
}
