//! From the rows of a cycle, in the scene or in a file, to the cycle itself (docs/cycles.md).

use std::path::{Path, PathBuf};
use std::sync::Arc;

use plateau_core::model::cycle::{self, Cycle, CycleError, Event, Node};
use plateau_core::model::mesh::Mesh;
use plateau_core::model::parameters::Parameters;

use super::build::{ACCELERATION, rounded};
use super::contents::OperationCycle;
use super::document::{Entry, Value};
use super::error::{Origin, Problem, Warning};
use super::interpret::{Setting, quantity};
use super::schema::{Range, choices, join};
use super::settings::Settings;
use crate::cycle_table::{self, CycleTable, Loads, Speeds};
use crate::units::Dimension::{Force, Pressure, RotationalSpeed, Speed, Time};

/// The table of a scene that has the keys of its cycle.
const TABLE: &str = "operation.cycle";

/// The cycle of a scene, if it has one; `force` (N) and `speed` (rad/s) take the place of a column that there is not.
pub(super) fn operation(
    settings: &Settings,
    mesh: &Mesh,
    force: Option<f64>,
    speed: Option<f64>,
) -> Result<Option<OperationCycle>, Problem> {
    let key = |name: &str| format!("{TABLE}.{name}");
    let (source, table) = match settings.get(&key("points")) {
        Some(Setting::Rows(table)) => (key("points"), table.clone()),
        _ if settings.get(&key("file")).is_some() => {
            let path = settings.text(&key("file"))?;
            let table = cycle_table::read(Path::new(path)).map_err(|problem| named(settings, problem))?;
            (key("file"), table)
        }
        _ => return Ok(None),
    };
    let place = settings.origin(&source);
    let file = settings.get(&key("file")).map(|_| settings.text(&key("file")).map(PathBuf::from)).transpose()?;
    let missing = |what: &str, keys: &str| {
        Problem::new(
            &place,
            &source,
            format!("there is no column of {what}, and no {keys} in [operation] in its place"),
        )
    };
    let scale = |name: &str| settings.number(&key(name));
    let (force_scale, speed_scale) = (scale("force_scale")?, scale("speed_scale")?);
    let rows = table.times.len();
    let loads = match table.loads {
        Some(Loads::Force(loads)) => loads,
        Some(Loads::NominalPressure(pressures)) => {
            pressures.into_iter().map(|pressure| pressure * mesh.pin_area()).collect()
        }
        None => vec![force.ok_or_else(|| missing("load", "normal_force"))?; rows],
    };
    let speeds = match table.speeds {
        Some(Speeds::Rotational(speeds)) => speeds,
        Some(Speeds::Sliding(speeds)) => speeds.into_iter().map(|speed| speed / mesh.mean_radius()).collect(),
        None => vec![speed.ok_or_else(|| missing("speed", "rotational_speed or sliding_speed"))?; rows],
    };
    let has_road = table.road_speeds.is_some();
    let road_speeds = table.road_speeds.unwrap_or_else(|| vec![0.0; rows]);
    let nodes: Vec<Node> = (0..rows)
        .map(|row| Node {
            time: table.times[row],
            force: loads[row] * force_scale,
            speed: speeds[row] * speed_scale,
            road_speed: road_speeds[row],
        })
        .collect();
    let interpolation = settings.choice(&key("interpolation"), &choices::INTERPOLATION)?;
    let rounds = settings.integer(&key("repeat"))?;
    let cycle = Cycle::new(&nodes, interpolation, rounds).map_err(|error| {
        let row = match error {
            CycleError::Time { row, .. } | CycleError::Value { row, .. } => table.places.get(row),
            CycleError::Rows { .. } | CycleError::TooMany { .. } | CycleError::Inactive => None,
        };
        Problem::new(row.unwrap_or(&place), &source, error.to_string())
    })?;
    Ok(Some(OperationCycle { cycle: Arc::new(cycle), has_road, file }))
}

/// A file that cannot be read is the fault of the key that names it.
fn named(settings: &Settings, problem: Problem) -> Problem {
    match problem.origin {
        Origin::File(file) => {
            let key = format!("{TABLE}.file");
            Problem::new(&settings.origin(&key), &key, format!("{}: {}", file.display(), problem.message))
        }
        _ => problem,
    }
}

/// Rows of time, load and speed as a scene gives them.
pub(super) fn rows(list: &[Entry]) -> Result<Setting, (Origin, String)> {
    let (mut forces, mut pressures, mut rotations, mut slides) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let (mut times, mut places) = (Vec::new(), Vec::new());
    for entry in list {
        let fail = |message: String| (entry.origin.clone(), message);
        let Value::Array(row) = &entry.value else {
            return Err(fail(format!("{}, expected a row such as [\"0 s\", \"47 N\", \"850 rpm\"]", entry.value)));
        };
        let [time, load, speed] = row.as_slice() else {
            return Err(fail(format!("a row of {} values, expected three: time, load, speed", row.len())));
        };
        let value = |entry: &Entry, dimension| quantity(&entry.value, dimension, Range::NOT_NEGATIVE);
        let at = |entry: &Entry| {
            let origin = entry.origin.clone();
            move |message: String| (origin, message)
        };
        times.push(value(time, Time).map_err(at(time))?);
        match (value(load, Force), value(load, Pressure)) {
            (_, Ok(pressure)) => pressures.push(pressure),
            (force, Err(_)) => forces.push(force.map_err(at(load))?),
        }
        match (value(speed, RotationalSpeed), value(speed, Speed)) {
            (_, Ok(slide)) => slides.push(slide),
            (rotation, Err(_)) => rotations.push(rotation.map_err(at(speed))?),
        }
        let mixed = |one: usize, other: usize| one > 0 && other > 0;
        if mixed(forces.len(), pressures.len()) {
            return Err(at(load)("a load of another kind than in the rows above: give forces or pressures".to_owned()));
        }
        if mixed(rotations.len(), slides.len()) {
            let message = "a speed of another kind than in the rows above: give rotational speeds or sliding speeds";
            return Err(at(speed)(message.to_owned()));
        }
        places.push(entry.origin.clone());
    }
    let loads = if forces.is_empty() { Loads::NominalPressure(pressures) } else { Loads::Force(forces) };
    let speeds = if rotations.is_empty() { Speeds::Sliding(slides) } else { Speeds::Rotational(rotations) };
    Ok(Setting::Rows(CycleTable { times, loads: Some(loads), speeds: Some(speeds), road_speeds: None, places }))
}

/// The largest acceleration with which every event of a run has simulated revolutions enough.
fn largest_acceleration(cycle: &Cycle, until: f64) -> f64 {
    cycle
        .events(until)
        .iter()
        .map(|event| cycle::largest_acceleration(cycle.angle_of(event)))
        .fold(f64::INFINITY, f64::min)
}

/// The error that a choice would estimate is that of a history; a cycle has another one in every event.
pub(super) fn refuse_choice(
    settings: &Settings,
    parameters: &Parameters,
    cycle: &Cycle,
    until: f64,
) -> Result<(), Problem> {
    let tolerance = join(ACCELERATION, "tolerance");
    if settings.get(&tolerance).is_none() {
        return Ok(());
    }
    let largest = largest_acceleration(cycle, until).floor().max(parameters.time_acceleration);
    let message = format!(
        "a run with a cycle does not choose its acceleration, for every event would need another one; write time_acceleration = {largest} \
         (with it every event has ten simulated revolutions) or less, and see docs/cycles.md for its error"
    );
    Err(Problem::new(&settings.origin(&tolerance), &tolerance, message))
}

/// A word to cycles with events that are too short for the acceleration (model section 9).
pub(super) fn short_events(settings: &Settings, parameters: &Parameters, cycle: &Cycle, until: f64) -> Option<Warning> {
    let largest = largest_acceleration(cycle, until);
    let m = parameters.time_acceleration;
    let is_short = |event: &&Event| cycle::largest_acceleration(cycle.angle_of(event)) < m * (1.0 - 1e-9);
    let events = cycle.events(until);
    let short = events.iter().filter(is_short).count();
    (short > 0).then(|| Warning {
        place: settings.origin(ACCELERATION),
        key: ACCELERATION.to_owned(),
        found: format!(
            "with {m} the shortest of the cycle's events has {:.2} simulated revolutions, {short} of {} have less than 10",
            10.0 * largest / m,
            events.len()
        ),
        bound: "expected at least 10 in every event".to_owned(),
        advice: if largest >= 1.0 {
            format!("{} is the largest acceleration with which all have them", rounded(largest))
        } else {
            "no acceleration gives them to all: that event is that short".to_owned()
        },
    })
}
