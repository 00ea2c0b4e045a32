//! `plateau check`: what a scene resolves to, what it needs and what it will cost, without running it.

use std::env;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use plateau_core::acceleration::scout::{Idle, Smoothness};
use plateau_core::engine::parts::{ACCELERATION, Part, parts};
use plateau_core::model::cycle::Cycle;
use plateau_core::model::mesh::{Mesh, Outline};
use plateau_core::model::parameters::Parameters;
use plateau_core::model::state::Base;
use plateau_core::observe::running_in::pulse_time;
use plateau_core::observe::window_mean::LEAST_REVOLUTIONS;
use plateau_core::observe::{EXTRAS, Map};
use plateau_core::simulation::Simulation;
use plateau_io::claim::lock_of;
use plateau_io::run_file::{checkpoint, image_estimate, resolve, size_estimate};
use plateau_io::scene::{Scene, Warning, memory_estimate};
use plateau_io::surface::{self, Loaded};
use plateau_io::{number, plausibility};
use plateau_run::execution::{decide, time_per_step};
use plateau_run::{idle_warning, stiffness_warning};
use serde::Serialize;

use crate::arguments::CheckArguments;
use crate::commands::run::load_scene;
use crate::failure::Failure;
use crate::output::{list, print, print_json, table};
use crate::terminal::Messages;
use crate::{invocation, message};

/// Time that the trial on which the estimated time rests may take.
const TRIAL: Duration = Duration::from_millis(300);

/// Checks a scene.
pub fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    let mut scene = load_scene(&arguments.scene)?;
    let start = Instant::now();
    let loaded = surface::load(&scene).map_err(Failure::input)?;
    let preparing = start.elapsed().as_secs_f64();
    loaded.warnings().for_each(message::warning);
    let implausible = plausibility::of_surfaces(&scene, &loaded);
    implausible.iter().for_each(message::warning);
    scene.warnings.extend(implausible);
    let parts = parts(&scene.parameters, &loaded.surfaces.pin_base);
    let Loaded { surfaces, inputs, report, .. } = loaded;
    let pulse = PulseReport::of(&scene.parameters, &surfaces.pin_base, scene.steps);
    let files = files(&scene, &inputs);
    if scene.adaptive.is_some() && Smoothness::forbids_from_the_start(&scene.parameters, &surfaces) {
        message::warning(idle_warning(Idle::Smooth(0.0)));
        scene.adaptive = None;
    }
    let asked = arguments.execution.execution();
    let decided = decide(&scene, 1, asked, &surfaces, &Messages).map_err(Failure::run)?;
    let mut simulation =
        Simulation::with_execution(scene.parameters.clone(), surfaces, decided).map_err(Failure::input)?;
    let seconds_per_step = time_per_step(&mut simulation, scene.steps, TRIAL).map_err(Failure::run)?;
    // A ring of few columns has no work for many workers: what there are, the simulation knows.
    let check = CheckReport::new(&scene, files, report, &parts, pulse, &simulation, [preparing, seconds_per_step]);
    stiffness_warning(&scene.parameters).iter().for_each(message::warning);
    if scene.output.file.exists() {
        message::warning(format_args!(
            "{} exists; `{} run` needs --force to replace it, or -o FILE",
            scene.output.file.display(),
            invocation::program()
        ));
    }
    if arguments.scene.json { print_json(&check) } else { print(&check.to_text(arguments.all, message::warnings())) }
}

/// A file that a run reads or writes.
#[derive(Debug, Serialize)]
struct File {
    access: &'static str,
    /// Path as the run uses it.
    path: String,
    /// The path without links and `..`.
    resolved: String,
}

impl File {
    /// Use and place of it, for a table.
    fn row(&self) -> (&'static str, String) {
        let Self { access, path, resolved } = self;
        let plain = env::current_dir().is_ok_and(|here| here.join(path) == Path::new(resolved));
        (access, if plain { path.clone() } else { format!("{path}, which is {resolved}") })
    }

    /// Files that are read, and the run file, in one line.
    fn in_one_line(files: &[Self]) -> String {
        let of = |access: &str| {
            files.iter().filter(|file| file.access == access).map(|file| &*file.path).collect::<Vec<_>>()
        };
        let written = of("writes").first().map_or(String::new(), |file| format!("; writes {file}"));
        format!("reads {}{written}", of("reads").join(", "))
    }
}

/// Every file that a run of the scene reads, and those that it writes, with where they really are.
fn files(scene: &Scene, inputs: &[(PathBuf, String)]) -> Vec<File> {
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
struct CheckReport {
    title: String,
    scene: String,
    files: Vec<File>,
    surfaces: Vec<String>,
    rows: usize,
    disc_columns: usize,
    pin_columns: usize,
    cell_height: f64,
    cell_width: f64,
    /// Outline of a pin that is no rectangle.
    #[serde(skip_serializing_if = "Option::is_none")]
    outline: Option<OutlineReport>,
    nominal_pressure: f64,
    /// Tells whether the load follows from a braking torque: that is then the least, at the largest coefficient of friction.
    #[serde(skip)]
    by_torque: bool,
    steps: u64,
    step_time: f64,
    /// Cycle of the scene, if it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    cycle: Option<CycleReport>,
    revolutions: f64,
    /// Pulse of the contact area, if it pulses.
    #[serde(skip_serializing_if = "Option::is_none")]
    pulse: Option<PulseReport>,
    samples: u64,
    maps: usize,
    memory: u64,
    run_file: u64,
    checkpoint: u64,
    workers: usize,
    decomposition: String,
    instruction_set: &'static str,
    /// Time that surfaces and steps will take, s.
    estimated_time: f64,
    /// Time that making the surfaces has taken, s.
    preparing_time: f64,
    /// Largest time acceleration of a run that chooses it.
    largest_acceleration: Option<f64>,
    stiffness_number: f64,
    /// Stiffness number where `thermal.wear_rate_factor` is largest.
    #[serde(skip_serializing_if = "Option::is_none")]
    hot_stiffness_number: Option<f64>,
    warns_of_stiffness: bool,
    /// Values of the scene that can hardly be meant.
    warnings: Vec<Warning>,
    needed: Vec<Reasoned>,
    left_out: Vec<Reasoned>,
}

/// A part of the model or of the output, and what in the scene decides over it.
#[derive(Debug, Serialize)]
struct Reasoned {
    part: String,
    reason: String,
}

impl CheckReport {
    /// Makes the report on a scene whose surfaces took the first of these times (s) to make, and of which a step takes the second.
    fn new(
        scene: &Scene,
        files: Vec<File>,
        surfaces: Vec<String>,
        parts: &[Part],
        pulse: Option<PulseReport>,
        simulation: &Simulation,
        [preparing_time, seconds_per_step]: [f64; 2],
    ) -> Self {
        let (parameters, execution) = (&scene.parameters, simulation.execution());
        let mesh = &parameters.mesh;
        let schedule = scene.schedule();
        let (mut needed, mut left_out) = (Vec::new(), Vec::new());
        let mut part = |is_needed: bool, part: String, reason: String| {
            (if is_needed { &mut needed } else { &mut left_out }).push(Reasoned { part, reason });
        };
        for Part { name, needed, reason } in parts {
            match *name {
                ACCELERATION if scene.adaptive.is_some() => {
                    part(true, ACCELERATION.into(), "the run chooses it, by what a scout before it finds".into());
                }
                name => part(*needed, name.into(), (*reason).into()),
            }
        }
        part(execution.workers > 1, "several workers".into(), format!("workers = {}", execution.workers));
        for map in Map::CHOICES {
            let asked = scene.output.maps.contains(&map);
            let reason = if asked { "output.maps asks for it" } else { "not in output.maps" };
            part(asked, format!("map {}", map.name()), reason.into());
        }
        for (extra, request) in EXTRAS.iter().filter_map(|extra| Some((extra, extra.request.as_ref()?))) {
            let asked = scene.output.extras.contains(extra);
            part(asked, format!("{} with every sample", request.what), format!("output.{} = {asked}", extra.name));
        }
        let stiffness_number = parameters.first_stiffness_number();
        let largest_factor = parameters.thermal.as_ref().and_then(|thermal| thermal.wear_rate_factor.largest());
        let extras = scene.extras(scene.adaptive.is_some());
        let maps = if scene.output.maps.is_empty() { 0 } else { schedule.maps() };
        let image = image_estimate(mesh, &scene.output.maps, &extras, schedule.samples(), maps as u64);
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
            by_torque: parameters.by_torque,
            steps: scene.steps,
            step_time: parameters.step_time(),
            cycle: CycleReport::of(scene),
            revolutions: scene.steps as f64 / mesh.disc_columns() as f64,
            pulse,
            samples: schedule.samples(),
            maps,
            memory: memory_estimate(scene),
            run_file: size_estimate(mesh, &scene.output.maps, &extras, schedule.samples(), maps as u64),
            checkpoint: checkpoint::size_estimate(mesh, scene.adaptive.is_some()).saturating_add(image),
            workers: execution.workers,
            decomposition: simulation.decomposition(),
            instruction_set: execution.means(),
            estimated_time: preparing_time + seconds_per_step * scene.steps as f64,
            preparing_time,
            stiffness_number,
            largest_acceleration: scene.adaptive.map(|adaptive| adaptive.largest),
            hot_stiffness_number: largest_factor
                .map(|factor| parameters.with_wear_rate_factor(factor).stiffness_number()),
            warns_of_stiffness: stiffness_warning(parameters).is_some(),
            warnings: scene.warnings.clone(),
            needed,
            left_out,
        }
    }

    /// Time that the run will take, in words: the surfaces, which are not made faster by acceleration, and the steps.
    fn time(&self) -> String {
        let steps = number::duration(self.estimated_time - self.preparing_time);
        let (without, less) = self.largest_acceleration.map_or_else(Default::default, |largest| {
            (" without acceleration", format!(", at best {} times less", number::short(largest)))
        });
        let [all, surfaces] = [self.estimated_time, self.preparing_time].map(number::duration);
        format!(
            "{all}: {surfaces} for the surfaces (as now), {steps} for the steps{without} (from a short trial){less}"
        )
    }

    /// Formats the main rows of the report, or all of them; with the number of warnings that were given.
    fn to_text(&self, all: bool, warnings: usize) -> String {
        let Self { rows, disc_columns, pin_columns, .. } = self;
        let [disc, pin] = [disc_columns, pin_columns].map(|columns| number::grouped((rows * columns) as u64));
        let [height, width] = [self.cell_height, self.cell_width].map(|length| number::short(length * 1e6));
        let cells = format!("{disc} disc and {pin} pin cells of {height} um by {width} um");
        let mesh = format!("{rows} rows, {disc_columns} columns round the ring, {pin_columns} under the pin: {cells}");
        let without = if self.largest_acceleration.is_some() { "without acceleration " } else { "" };
        let mean = if self.cycle.is_some() { " in the mean" } else { "" };
        let duration = self.cycle.as_ref().map_or(self.step_time * self.steps as f64, |cycle| cycle.duration);
        let [step, revolutions, duration] = [self.step_time, self.revolutions, duration].map(number::short);
        let count = number::grouped(self.steps);
        let steps = format!("{without}{count} of {step} s{mean}: {revolutions} revolutions, {duration} s");
        let told = match (warnings, message::is_quiet()) {
            (0, _) => "none".to_owned(),
            (warnings, true) => format!("{warnings}, which -q keeps back"),
            (warnings, false) => format!("{warnings}, on standard error"),
        };
        let pressure = if self.cycle.is_some() { "largest nominal pressure" } else { "nominal pressure" };
        let mut rows = vec![("warnings", told), ("mesh", mesh)];
        rows.extend(self.outline.as_ref().map(|outline| ("outline of the pin", outline.text())));
        let more = if self.by_torque { ", more where friction is not at its largest" } else { "" };
        rows.push((pressure, format!("{} MPa{more}", number::short(self.nominal_pressure * 1e-6))));
        rows.push(("steps", steps));
        rows.extend(self.cycle.iter().flat_map(CycleReport::rows));
        rows.extend(self.pulse.as_ref().map(|pulse| ("contact area pulses", pulse.text())));
        rows.push(("estimated time", self.time()));
        rows.push(("memory for cells and maps", number::bytes(self.memory)));
        let [file, checkpoint] = [self.run_file, self.checkpoint].map(number::bytes);
        let holds = format!("samples: {}, moments with maps: {}", number::grouped(self.samples), self.maps);
        rows.push(("output", format!("{holds}; run file at most {file}, two checkpoints of at most {checkpoint}")));
        let Self { workers, decomposition, instruction_set, .. } = self;
        if all || *workers > 1 {
            let of_workers = format!("{workers}, decomposition {decomposition}, instruction set {instruction_set}");
            rows.push(("workers", of_workers));
        }
        if !all {
            rows.push(("files", File::in_one_line(&self.files)));
            return table(&self.title, &rows) + "\nThe resolved scene and what is left out: --all\n";
        }
        rows.push(("stiffness number", self.stiffness()));
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

/// A cycle as far as the run plays it.
#[derive(Debug, Serialize)]
struct CycleReport {
    /// Stretches with load and speed.
    events: usize,
    /// Time that they last in all, s.
    active_time: f64,
    /// Physical time of the run, s.
    duration: f64,
    /// Distance slid at the mean radius, m.
    distance: f64,
    /// Steps of the event with the fewest, and of that with the most.
    steps_per_event: [u64; 2],
    /// The largest acceleration with which every event has ten simulated revolutions; below 1 none has.
    largest_acceleration_without_warning: f64,
}

impl CycleReport {
    /// Sums up the cycle of a scene, if it has one.
    fn of(scene: &Scene) -> Option<Self> {
        let cycle: &Cycle = &scene.cycle.as_ref()?.cycle;
        let (parameters, until) = (&scene.parameters, scene.duration);
        let events = cycle.events(until);
        let angle = parameters.step_angle();
        let steps = || {
            let step = |at| Cycle::steps_to(at, angle).min(scene.steps);
            events.iter().map(move |event| step(event.start_angle + event.angle) - step(event.start_angle))
        };
        Some(Self {
            events: events.len(),
            active_time: events.iter().map(|event| event.end.time - event.start.time).sum(),
            duration: until,
            distance: cycle.angle_at(until) * parameters.mesh.mean_radius(),
            steps_per_event: [steps().min().unwrap_or(0), steps().max().unwrap_or(0)],
            largest_acceleration_without_warning: cycle.largest_acceleration(until),
        })
    }

    /// Returns the rows for the table of the run.
    fn rows(&self) -> Vec<(&'static str, String)> {
        let [fewest, most] = self.steps_per_event.map(number::grouped);
        let [active, all, distance] = [self.active_time, self.duration, self.distance].map(number::short);
        let events = number::count(self.events, "event");
        let largest = match self.largest_acceleration_without_warning {
            ..1.0 => "none: the shortest event has less than ten revolutions".to_owned(),
            largest => number::short(number::not_above(largest, 4)),
        };
        vec![
            ("cycle", format!("{events}: {active} s of {all} s with load and speed, {distance} m")),
            ("steps per event", if fewest == most { fewest } else { format!("{fewest} to {most}") }),
            ("largest acceleration without a warning", largest),
        ]
    }
}

/// The pin within its outline.
#[derive(Debug, Serialize)]
struct OutlineReport {
    shape: &'static str,
    /// Diameter, m.
    diameter: f64,
    /// Cells of the pin that are there.
    cells: usize,
    /// Area of these cells, m².
    area: f64,
}

impl OutlineReport {
    /// Measures the outline of a mesh; none for a rectangle.
    fn of(mesh: &Mesh) -> Option<Self> {
        match mesh.outline() {
            Outline::Rectangle => None,
            Outline::Disc { radius } => {
                Some(Self { shape: "disc", diameter: 2.0 * radius, cells: mesh.present_cells(), area: mesh.pin_area() })
            }
        }
    }

    /// Describes the pin within its outline.
    fn text(&self) -> String {
        let [diameter, area] = [self.diameter * 1e3, self.area * 1e6].map(number::short);
        format!("a circle of {diameter} mm in diameter: {} cells, {area} mm²", number::grouped(self.cells as u64))
    }
}

/// Pulses that the last tenth of a run should hold (docs/questions.md).
const WANTED: f64 = 5.0;
/// Part that rounding may take off a number of pulses or revolutions.
const ROUNDING: f64 = 1e-9;

/// The last tenth of a run beside a pulse of its contact area.
#[derive(Debug, Serialize)]
struct PulseReport {
    /// Time of a pulse, s, at least.
    pulse_time: f64,
    /// The last tenth of the run, s.
    last_tenth: f64,
    /// Simulated revolutions in it.
    revolutions: f64,
}

impl PulseReport {
    /// Compares the last tenth of a run of so many steps with a pulse; none where nothing pulses, or load and speed change with time.
    fn of(parameters: &Parameters, base: &[Base], steps: u64) -> Option<Self> {
        let run = steps as f64;
        Some(Self {
            pulse_time: pulse_time(parameters, base)?,
            last_tenth: 0.1 * run * parameters.step_time(),
            revolutions: 0.1 * run / parameters.mesh.disc_columns() as f64,
        })
    }

    /// Describes the last tenth of the run beside its pulses.
    fn text(&self) -> String {
        let Self { pulse_time, last_tenth, revolutions } = *self;
        let enough = |found: f64, wanted: f64| found >= wanted * (1.0 - ROUNDING);
        let seconds = |time: f64| format!("{} s", number::rounded(time, 3));
        let pulses = last_tenth / pulse_time;
        let mut text = format!(
            "the shortest pulse takes {}; the last tenth of the run, {}, has at most {}",
            seconds(pulse_time),
            seconds(last_tenth),
            number::rounded(pulses, 2)
        );
        if !enough(pulses, WANTED) {
            let wanted = seconds(10.0 * WANTED * pulse_time);
            text += &format!(", and a mean needs at least {WANTED}: the run must be longer than {wanted}");
            // As long as the mean is that the run will tell, where the run has so many revolutions.
            if !enough(revolutions, LEAST_REVOLUTIONS) && enough(10.0 * revolutions, LEAST_REVOLUTIONS) {
                let window = seconds(last_tenth * LEAST_REVOLUTIONS / revolutions);
                text += &format!("; its mean is over the last {window}, {LEAST_REVOLUTIONS} simulated revolutions");
            }
        } else if !enough(revolutions, LEAST_REVOLUTIONS) {
            let found = number::rounded(revolutions, 2);
            text += &format!(": a mean needs {LEAST_REVOLUTIONS} simulated revolutions, and these are {found}");
            text += ": a smaller time_acceleration gives more";
        }
        text
    }
}

#[cfg(test)]
#[path = "../../tests/unit/commands/check.rs"]
mod tests;
