//! `plateau accuracy`: error of a scene's runs against their run time.

use std::fs;
use std::path::PathBuf;

use plateau_core::model::parameters::Integrator;
use plateau_io::dataset_file::now;
use plateau_io::number::{self, percent};
use plateau_io::scene::Scene;
use plateau_io::surface::{self, Loaded};
use plateau_run::accuracy::{
    AccuracyError, Advice, Base, COMPARED, Compared, Ladder, Measured, OwnError, PlanError, Reference, Report, Row,
    Wish, measure, read_reference,
};
use plateau_run::execution::{self, decide};
use plateau_run::{input_files, signal_in_words};
use serde_json::{Map, Value, json};

use crate::arguments::AccuracyArguments;
use crate::commands::run::{load_scene, sets};
use crate::failure::{Failure, of_scene};
use crate::output::{columns, csv_table, list, print, table};
use crate::terminal::{Messages, Terminal};
use crate::{hand_over, message, output, program};

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

/// Measures the errors of a scene's runs and writes them to the folder that is there.
fn measure_into(
    arguments: &AccuracyArguments,
    scene: Scene,
    loaded: Loaded,
    reference: Option<Reference>,
) -> Result<(), Failure> {
    let places = places(arguments, &scene, &loaded.inputs)?;
    let start_time = now();
    let asked = arguments.execution.execution();
    let execution = decide(&scene, 1, asked, &loaded.surfaces, &Messages).map_err(Failure::run)?;
    let mut ladders = if arguments.ladders.is_empty() { USUAL.to_vec() } else { arguments.ladders.clone() };
    ladders.sort_unstable();
    ladders.dedup();
    let is_asked = |name: &&str| arguments.quantities.is_empty() || arguments.quantities.contains(name);
    let making = json!({
        "program": program::name(),
        "source_revision": program::REVISION,
        "host": execution::host(),
        "processor": execution::processor(),
        "workers": execution.workers,
        "instruction_set": execution.instructions.name(),
        "budget": arguments.budget,
        "start_time": start_time,
        "inputs": input_files(&scene, &loaded.inputs),
        "scene": scene.resolved,
    });
    let wish = Wish {
        base: Base { path: arguments.scene.scene.clone(), sets: sets(&arguments.scene), scene },
        ladders,
        quantities: COMPARED.iter().map(|one| one.name).filter(is_asked).collect(),
        tolerance: arguments.tolerance,
        budget: arguments.budget,
        reference,
        program: program::this(),
    };
    let terminal = Terminal::listen(true).map_err(Failure::run)?;
    let report = measure(wish, &loaded.surfaces, execution, &terminal).map_err(failure)?;

    let document = json(&report, making);
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
    let Some(signal) = report.stopped else { return Ok(()) };
    let (runs, folder) = (report.rows.len(), arguments.output.display());
    let message = format!("stopped by {}; {folder} has the {runs} runs that were done", signal_in_words(signal));
    Err(Failure::stopped(signal, Some(message)))
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

/// Chooses the exit status, which tells whose fault it is that errors cannot be measured.
fn failure(error: AccuracyError) -> Failure {
    match error {
        AccuracyError::Input(PlanError::Scene(error)) => of_scene(error),
        AccuracyError::Input(error) => Failure::input(error),
        AccuracyError::Run(error) => error.into(),
        AccuracyError::Stopped { signal, .. } => Failure::stopped(signal, Some(error.to_string())),
        AccuracyError::Failed { .. } => Failure::run(error),
    }
}

/// Reference, errors, advice and notes.
fn text(report: &Report) -> String {
    let mut parts = vec![reference(report), errors(report), list("Advice", &[advice(report)])];
    let notes = notes(report);
    if !notes.is_empty() {
        parts.push(list("Notes", &notes));
    }
    parts.join("\n")
}

fn reference(report: &Report) -> String {
    let reference = &report.reference;
    let source = reference.file.as_ref().map_or("run here", |(file, _)| &file.path);
    // A run that had not ended when it became a reference tells no time.
    let wall_time = reference.outcome.wall_time.map_or("not recorded,".to_owned(), number::duration);
    let (steps, workers) =
        (number::grouped(reference.outcome.steps), number::count(reference.workers as usize, "worker"));
    let (count, width) = (report.windows.count, number::short(report.windows.width));
    let rows = [
        ("reference", format!("{}, {source}", reference.setting)),
        ("its own error", own_error(report)),
        ("its wall time", format!("{wall_time} for {steps} steps on {workers}")),
        ("windows", format!("{count} of {width} s, over whose means runs are compared")),
    ];
    table(&report.title, &rows)
}

fn own_error(report: &Report) -> String {
    if report.own == OwnError::NONE {
        return "none, it is the model itself".to_owned();
    }
    let whole = report.own.whole();
    let errors: Vec<String> =
        report.counted().map(|(one, compared)| format!("{} {}", compared.words, percent(whole[one]))).collect();
    let mut sources = Vec::new();
    if report.own.cells != OwnError::NONE.cells {
        sources.push("of its cells, as much as the change from cells twice as long".to_owned());
    }
    if report.own.end > 0.0 {
        let end = number::short(report.own.end);
        sources.push(format!("from a run with 1 over the first {end} s, growing as the other errors do"));
    }
    format!("about {}: {}", errors.join(", "), sources.join("; "))
}

fn errors(report: &Report) -> String {
    let words = COMPARED.map(|compared| compared.words);
    let names = [&["run", "wall time", "steps"], &words[..], &["worst window", ""]].concat();
    let line = |row: &Row| {
        let Ok(run) = &row.result else { return vec![row.rung.setting(), "failed".to_owned()] };
        let worst = report.counted().map(|(one, _)| run.errors[one].largest).fold(0.0, f64::max);
        let mut cells = vec![row.rung.setting(), number::duration(run.wall_time), number::grouped(run.steps)];
        cells.extend(run.errors.iter().map(|error| percent(error.mean_square)));
        cells.extend([percent(worst), if row.on_front { "*" } else { "" }.to_owned()]);
        cells
    };
    let heading = "Errors against the reference, root mean square over the windows (* no other run is both quicker and more exact)";
    columns(heading, &names, &report.rows.iter().map(line).collect::<Vec<_>>())
}

/// Lists notes of the report, runs that failed, and stiffness numbers above 1 of the explicit rule.
fn notes(report: &Report) -> Vec<String> {
    let mut notes = report.notes.clone();
    for row in &report.rows {
        let (setting, parameters) = (row.rung.setting(), &row.rung.scene.parameters);
        if let Err(why) = &row.result {
            notes.push(format!("{setting} failed: {why}"));
        }
        let stiffness = parameters.first_stiffness_number();
        if parameters.integrator == Integrator::Explicit && stiffness > 1.0 {
            let stiffness = number::short(stiffness);
            notes.push(format!(
                "{setting}: the stiffness number is {stiffness}, above 1 the explicit rule overshoots, above 2 it is unstable"
            ));
        }
    }
    notes
}

/// One sentence: the setting for the permitted error, or the least error that there is.
fn advice(report: &Report) -> String {
    let tolerance = percent(report.tolerance);
    let time = report.reference.outcome.wall_time;
    let instead = time.map_or(String::new(), |time| format!(" instead of {}", number::duration(time)));
    let of = |index: usize| {
        let row: &Row = &report.rows[index];
        let time = row.result.as_ref().map_or(f64::NAN, |run| run.wall_time);
        let (error, quantity) = report.worst(row).map_or((f64::NAN, ""), |(error, compared)| (error, compared.words));
        let own = match report.own_error() {
            0.0 => String::new(),
            own => format!(", and the reference's own error is about {}", percent(own)),
        };
        (row.rung.setting(), number::duration(time), format!("{} ({quantity}){own}", percent(error)))
    };
    match report.advice() {
        Advice::Use(index) => {
            let (setting, time, error) = of(index);
            format!("for {tolerance} error use {setting}: {time}{instead}; its largest error is {error}")
        }
        Advice::Missed(index) => {
            let (setting, time, error) = of(index);
            let others = if report.asked.len() > 1 { "; --quantity asks for single quantities" } else { "" };
            format!(
                "no run has at most {tolerance} error: the least is {error}, with {setting}, {time}{instead}{others}"
            )
        }
        Advice::NoChoice => "no setting is advised: no other run is quicker than the reference".to_owned(),
    }
}

/// What a row has: names, texts for a table, in which what is not known is empty, and values for JSON, in which it is null.
fn cells(row: &Row, report: &Report) -> Vec<(String, String, Value)> {
    let words = |name: &str, text: String| (name.to_owned(), text.clone(), text.into());
    // JSON has no NaN: such a number becomes null.
    let numeric = |name: &str, value: f64| (name.to_owned(), number(value), value.into());
    let measured = |value: &dyn Fn(&Measured) -> f64| row.result.as_ref().map_or(f64::NAN, value);
    let parameters = &row.rung.scene.parameters;
    let mut cells = vec![
        words("ladder", row.rung.ladder.name().to_owned()),
        words("setting", row.rung.setting()),
        words("state", if row.result.is_ok() { "finished" } else { "failed" }.to_owned()),
        words("failure", row.result.as_ref().err().cloned().unwrap_or_default()),
        numeric("value", row.rung.value),
        numeric("time_acceleration", parameters.time_acceleration),
        numeric("stiffness_number", parameters.first_stiffness_number()),
        numeric("wall_time", measured(&|run| run.wall_time)),
        numeric("steps", measured(&|run| run.steps as f64)),
        numeric("error", report.worst(row).map_or(f64::NAN, |(error, _)| error)),
    ];
    for (one, Compared { name, .. }) in COMPARED.iter().enumerate() {
        cells.extend([
            numeric(&format!("{name}_error"), measured(&|run| run.errors[one].mean_square)),
            numeric(&format!("{name}_largest_error"), measured(&|run| run.errors[one].largest)),
            numeric(&format!("{name}_end_error"), measured(&|run| run.errors[one].end)),
        ]);
    }
    cells.push(numeric("on_front", f64::from(u8::from(row.on_front))));
    cells
}

/// A line of names and one line for each row.
fn csv(report: &Report) -> String {
    let lines =
        report.rows.iter().map(|row| cells(row, report).into_iter().map(|(name, text, _)| (name, text)).unzip());
    let (names, lines): (Vec<Vec<String>>, Vec<Vec<String>>) = lines.unzip();
    csv_table(names.into_iter().take(1).chain(lines))
}

/// Formats a number as short as reads back as the same; empty for NaN.
fn number(value: f64) -> String {
    if value.is_nan() { String::new() } else { format!("{value:?}") }
}

/// One JSON document, with how the runs were made; what is not known is null.
fn json(report: &Report, making: Value) -> String {
    let reference = &report.reference;
    let file = reference.file.as_ref().map(|(file, _)| file);
    let own = |name: &str, errors: [f64; COMPARED.len()]| {
        let named =
            COMPARED.iter().zip(errors).map(|(compared, error)| (format!("{}_{name}", compared.name), error.into()));
        named.collect::<Map<String, Value>>()
    };
    let of_row = |row| cells(row, report).into_iter().map(|(name, _, value)| (name, value)).collect::<Map<_, _>>();
    let mut document = json!({
        "title": report.title,
        "state": if report.stopped.is_none() { "finished" } else { "interrupted" },
        "reference": {
            "file": file.map(|file| &file.path),
            "sha256": file.map(|file| &file.sha256),
            "setting": reference.setting,
            "time_acceleration": reference.time_acceleration,
            "steps": reference.outcome.steps,
            "wall_time": reference.outcome.wall_time,
            "workers": reference.workers,
            "program": reference.program.name,
            "source_revision": reference.program.revision,
            "host": reference.host,
            "start_time": reference.start_time,
            "error": report.own_error(),
            "opening_end": report.own.end,
        },
        "window_width": report.windows.width,
        "windows": report.windows.count,
        "quantities": report.asked,
        "runs": report.rows.iter().map(of_row).collect::<Vec<_>>(),
        "tolerance": report.tolerance,
        "advice": advice(report),
        "notes": report.notes,
        "end_time": now(),
    });
    if let (Some(document), Value::Object(making)) = (document.as_object_mut(), making) {
        document.extend(making);
    }
    if let Some(reference) = document["reference"].as_object_mut() {
        reference.extend(own("error", report.own.whole()));
        reference.extend(own("opening_error", report.own.opening));
    }
    format!("{document:#}\n")
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn values_read_back() {
        assert_eq!([number(0.1), number(1e-300), number(f64::NAN), number(20.0)], ["0.1", "1e-300", "", "20.0"]);
    }
}
