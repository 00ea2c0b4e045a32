//! Report of `plateau check` on a scene: its numbers, in words, and the files that are read and written.

use std::env;
use std::path::{Path, PathBuf};

use plateau_core::engine::parts::{ACCELERATION, Part};
use plateau_core::simulation::Execution;
use plateau_io::claim::lock_of;
use plateau_io::number;
use plateau_io::run_file::{checkpoint, image_estimate, resolve, size_estimate};
use plateau_io::scene::{Scene, Warning, memory_estimate};
use plateau_run::stiffness_warning;
use serde::Serialize;

use super::check_parts::{CycleReport, OutlineReport, PulseReport};
use crate::message;
use crate::table::{list, table};

/// A file that a run reads or writes.
#[derive(Debug, Serialize)]
pub(super) struct File {
    access: &'static str,
    /// As the run uses it.
    path: String,
    /// The path without links and `..`.
    resolved: String,
}

impl File {
    /// Use and place of it, for a table.
    pub(super) fn row(&self) -> (&'static str, String) {
        let Self { access, path, resolved } = self;
        let plain = env::current_dir().is_ok_and(|here| here.join(path) == Path::new(resolved));
        (access, if plain { path.clone() } else { format!("{path}, which is {resolved}") })
    }

    /// Files that are read, and the run file, in one line.
    pub(super) fn in_one_line(files: &[Self]) -> String {
        let of = |access: &str| {
            files.iter().filter(|file| file.access == access).map(|file| &*file.path).collect::<Vec<_>>()
        };
        let written = of("writes").first().map_or(String::new(), |file| format!("; writes {file}"));
        format!("reads {}{written}", of("reads").join(", "))
    }
}

/// Every file that a run of the scene reads, and those that it writes, with where they really are.
pub(super) fn files(scene: &Scene, inputs: &[(PathBuf, String)]) -> Vec<File> {
    let read = scene.files.iter().chain(inputs).map(|(path, _)| path);
    let mut files: Vec<File> = Vec::new();
    for path in read {
        // It was there a moment ago.
        let resolved = path.canonicalize().unwrap_or_else(|_| path.clone()).display().to_string();
        let path = path.display().to_string();
        if files.iter().all(|file| file.path != path) {
            files.push(File { access: "reads", path, resolved });
        }
    }
    let path = &scene.output.file;
    match resolve(path, true) {
        Ok(resolved) => {
            let lists = [path, &resolved].map(|path| {
                let [last, before] = checkpoint::paths(path);
                [path.clone(), last, before, lock_of(path)]
            });
            let [paths, resolved] = lists.map(|list| list.map(|path| path.display().to_string()));
            let written = paths.into_iter().zip(resolved);
            files.extend(written.map(|(path, resolved)| File { access: "writes", path, resolved }));
            if let Err(error) = checkpoint::refuse_foreign(path, false) {
                message::warning(error);
            }
        }
        Err(error) => message::warning(error),
    }
    files
}

/// Report of `plateau check`.
#[derive(Debug, Serialize)]
pub(super) struct CheckReport {
    title: String,
    scene: String,
    files: Vec<File>,
    surfaces: Vec<String>,
    rows: usize,
    disc_columns: usize,
    pin_columns: usize,
    cell_height: f64,
    cell_width: f64,
    /// Of a pin that is no rectangle.
    #[serde(skip_serializing_if = "Option::is_none")]
    outline: Option<OutlineReport>,
    nominal_pressure: f64,
    steps: u64,
    step_time: f64,
    /// Of a scene with a cycle.
    #[serde(skip_serializing_if = "Option::is_none")]
    cycle: Option<CycleReport>,
    revolutions: f64,
    /// Of a scene whose contact area pulses.
    #[serde(skip_serializing_if = "Option::is_none")]
    pulse: Option<PulseReport>,
    samples: u64,
    maps: usize,
    memory: u64,
    run_file: u64,
    checkpoint: u64,
    workers: usize,
    instruction_set: &'static str,
    /// Of the steps and the surfaces, s.
    estimated_time: f64,
    /// Time that making the surfaces has taken, s.
    preparing_time: f64,
    /// Of a run that chooses it.
    largest_acceleration: Option<f64>,
    stiffness_number: f64,
    /// The same where `thermal.wear_rate_factor` is largest.
    #[serde(skip_serializing_if = "Option::is_none")]
    hot_stiffness_number: Option<f64>,
    warns_of_stiffness: bool,
    /// Values of the scene that can hardly be meant.
    warnings: Vec<Warning>,
    needed: Vec<Reasoned>,
    left_out: Vec<Reasoned>,
}

/// A part of the model or of the output, and what in the scene decides over it.
#[derive(Debug, Clone, Serialize)]
struct Reasoned {
    part: String,
    reason: String,
}

impl CheckReport {
    /// Of a scene, whose surfaces took the first of these times to make, s, and of which a step takes the second.
    pub(super) fn new(
        scene: &Scene,
        files: Vec<File>,
        surfaces: Vec<String>,
        parts: &[Part],
        pulse: Option<PulseReport>,
        execution: Execution,
        [preparing_time, seconds_per_step]: [f64; 2],
    ) -> Self {
        let parameters = &scene.parameters;
        let mesh = &parameters.mesh;
        let schedule = scene.schedule();
        let mut reasoned: Vec<(bool, Reasoned)> = parts
            .iter()
            .map(|part| (part.needed, Reasoned { part: part.name.into(), reason: part.reason.into() }))
            .collect();
        let workers = Reasoned { part: "several workers".into(), reason: format!("workers = {}", execution.workers) };
        reasoned.push((execution.workers > 1, workers));
        reasoned.extend(plateau_core::observe::Map::CHOICES.map(|map| {
            let asked = scene.output.maps.contains(&map);
            let reason = if asked { "output.maps asks for it" } else { "not in output.maps" };
            (asked, Reasoned { part: format!("map {}", map.name()), reason: reason.into() })
        }));
        if scene.adaptive.is_some() {
            let reason = "the run chooses it, by what a scout before it finds".to_owned();
            let chosen = (true, Reasoned { part: ACCELERATION.into(), reason });
            reasoned.iter_mut().filter(|(_, part)| part.part == ACCELERATION).for_each(|part| *part = chosen.clone());
        }
        reasoned.extend(plateau_core::observe::EXTRAS.iter().filter_map(|extra| {
            let asked = scene.output.extras.contains(extra);
            let part = format!("{} with every sample", extra.request.as_ref()?.what);
            Some((asked, Reasoned { part, reason: format!("output.{} = {asked}", extra.name) }))
        }));
        let (needed, left_out): (Vec<_>, Vec<_>) = reasoned.into_iter().partition(|(needed, _)| *needed);
        let stiffness_number = parameters.first_stiffness_number();
        let largest_factor = parameters.thermal.as_ref().and_then(|thermal| thermal.wear_rate_factor.largest());
        let extras = scene.extras(scene.adaptive.is_some());
        let maps = if scene.output.maps.is_empty() { 0 } else { schedule.maps() };
        Self {
            title: scene.title.clone(),
            scene: scene.resolved.clone(),
            files,
            surfaces,
            rows: mesh.rows(),
            disc_columns: mesh.disc_columns(),
            pin_columns: mesh.pin_columns(),
            cell_height: mesh.row_height(),
            cell_width: mesh.column_width(),
            outline: OutlineReport::of(mesh),
            nominal_pressure: parameters.usual_load() / mesh.pin_area(),
            steps: scene.steps,
            step_time: parameters.step_time(),
            cycle: CycleReport::of(scene),
            revolutions: scene.steps as f64 / mesh.disc_columns() as f64,
            pulse,
            samples: schedule.samples(),
            maps,
            memory: memory_estimate(scene),
            run_file: size_estimate(mesh, &scene.output.maps, &extras, schedule.samples(), maps as u64),
            checkpoint: checkpoint::size_estimate(mesh, scene.adaptive.is_some()).saturating_add(image_estimate(
                mesh,
                &scene.output.maps,
                &extras,
                schedule.samples(),
                maps as u64,
            )),
            workers: execution.workers,
            instruction_set: execution.means(),
            estimated_time: preparing_time + seconds_per_step * scene.steps as f64,
            preparing_time,
            stiffness_number,
            largest_acceleration: scene.adaptive.map(|adaptive| adaptive.largest),
            hot_stiffness_number: largest_factor
                .map(|factor| parameters.with_wear_rate_factor(factor).stiffness_number()),
            warns_of_stiffness: stiffness_warning(parameters).is_some(),
            warnings: scene.warnings.clone(),
            needed: needed.into_iter().map(|(_, reasoned)| reasoned).collect(),
            left_out: left_out.into_iter().map(|(_, reasoned)| reasoned).collect(),
        }
    }

    /// Time that the run will take, in words: the surfaces, which are not made faster by acceleration, and the steps.
    fn time(&self) -> String {
        let steps = number::duration(self.estimated_time - self.preparing_time);
        let trial = match self.largest_acceleration {
            None => format!("{steps} for the steps (from a short trial)"),
            Some(largest) => format!(
                "{steps} for the steps without acceleration (from a short trial), at best {} times less",
                number::short(largest)
            ),
        };
        let [all, surfaces] = [self.estimated_time, self.preparing_time].map(number::duration);
        format!("{all}: {surfaces} for the surfaces (as now), {trial}")
    }

    /// What matters first, as text, or all of it; with the number of warnings that were given.
    pub(super) fn to_text(&self, all: bool, warnings: usize) -> String {
        let micrometres = |length: f64| format!("{} um", number::short(length * 1e6));
        let mesh = format!(
            "{} rows, {} columns round the ring, {} under the pin: {} disc and {} pin cells of {} by {}",
            self.rows,
            self.disc_columns,
            self.pin_columns,
            number::grouped((self.rows * self.disc_columns) as u64),
            number::grouped((self.rows * self.pin_columns) as u64),
            micrometres(self.cell_height),
            micrometres(self.cell_width)
        );
        let steps = format!(
            "{}{} of {} s{}: {} revolutions, {} s",
            if self.largest_acceleration.is_some() { "without acceleration " } else { "" },
            number::grouped(self.steps),
            number::short(self.step_time),
            if self.cycle.is_some() { " in the mean" } else { "" },
            number::short(self.revolutions),
            number::short(self.cycle.as_ref().map_or(self.step_time * self.steps as f64, CycleReport::duration))
        );
        let told = if warnings == 0 {
            "none".to_owned()
        } else {
            format!("{warnings}, {}", if message::is_quiet() { "which -q keeps back" } else { "on standard error" })
        };
        let pressure = if self.cycle.is_some() { "largest nominal pressure" } else { "nominal pressure" };
        let mut rows = vec![("warnings", told), ("mesh", mesh)];
        rows.extend(self.outline.as_ref().map(|outline| ("outline of the pin", outline.text())));
        rows.push((pressure, format!("{} MPa", number::short(self.nominal_pressure * 1e-6))));
        rows.push(("steps", steps));
        rows.extend(self.cycle.iter().flat_map(CycleReport::rows));
        rows.extend(self.pulse.as_ref().map(|pulse| ("contact area pulses", pulse.text())));
        rows.push(("estimated time", self.time()));
        rows.push(("memory for cells and maps", number::bytes(self.memory)));
        let [file, checkpoint] = [self.run_file, self.checkpoint].map(number::bytes);
        rows.push((
            "output",
            format!(
                "samples: {}, moments with maps: {}; run file at most {file}, two checkpoints of at most {checkpoint}",
                number::grouped(self.samples),
                self.maps
            ),
        ));
        if !all {
            rows.push(("files", File::in_one_line(&self.files)));
            return table(&self.title, &rows) + "\nThe resolved scene and what is left out: --all\n";
        }
        rows.push(("stiffness number", self.stiffness()));
        rows.push(("workers", format!("{}, instruction set {}", self.workers, self.instruction_set)));
        [
            table(&self.title, &rows),
            table("Files", &self.files.iter().map(File::row).collect::<Vec<_>>()),
            list("Surfaces", &self.surfaces),
            table("Needed", &reasons(&self.needed)),
            table("Left out", &reasons(&self.left_out)),
            format!("# The resolved scene\n\n{}", self.scene.trim_start()),
        ]
        .join("\n")
    }

    fn stiffness(&self) -> String {
        let hot = self.hot_stiffness_number.map_or(String::new(), |number| {
            format!(", {} where thermal.wear_rate_factor is largest", number::short(number))
        });
        let large = if self.warns_of_stiffness { " (large, see the warning)" } else { "" };
        format!("Π = {}{hot}{large}", number::short(self.stiffness_number))
    }
}

/// Rows of a table.
fn reasons(parts: &[Reasoned]) -> Vec<(&str, String)> {
    parts.iter().map(|part| (part.part.as_str(), part.reason.clone())).collect()
}
