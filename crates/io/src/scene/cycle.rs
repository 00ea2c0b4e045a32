//! Cycle of a scene, made from its rows in the scene or in a file (docs/drive.md).

use std::path::Path;
use std::sync::Arc;

use plateau_core::model::brake::Brake;
use plateau_core::model::cycle::{Cycle, CycleError, Node};
use plateau_core::model::mesh::Mesh;
use plateau_core::model::parameters::Parameters;

use super::contents::OperationCycle;
use super::cycle_table::{self, DiscSpeed, Load};
use super::error::{Origin, Problem, Warning};
use super::interpret::Setting;
use super::schema::{ACCELERATION, CYCLE, CYCLE_COLUMNS, choices, join};
use super::settings::Settings;
use crate::input::digested;
use crate::{limits, number};

#[derive(Debug, Clone, Copy)]
pub(super) struct ConstantLoad {
    /// Normal force F, N, or braking torque T, N m.
    pub value: Option<f64>,
    /// True if it is a braking torque.
    pub by_torque: bool,
}

/// The cycle of a scene, if it has one; `load` (N, or N m of a braking torque) and `speed` (rad/s) take the place of a column
/// that there is not.
pub(super) fn operation(
    settings: &Settings,
    mesh: &Mesh,
    load: ConstantLoad,
    speed: Option<f64>,
    brake: Option<&Brake>,
) -> Result<Option<OperationCycle>, Problem> {
    let key = |name: &str| format!("{CYCLE}.{name}");
    let mut file = None;
    let (source, table) = match settings.get(&key("points")) {
        Some(Setting::Rows(table)) => (key("points"), table.clone()),
        _ if settings.get(&key("file")).is_some() => {
            let path = settings.text(&key("file"))?;
            let path = Path::new(path);
            let failed = |error| Problem::without_key(&Origin::File(path.into()), format!("cannot read it: {error}"));
            let given = CYCLE_COLUMNS.iter().filter(|name| settings.get(&join("operation", name)).is_some());
            let quantity = |name: &'static str| name.rsplit('.').next().unwrap_or(name);
            let headers = given.map(|name| Ok((quantity(name), settings.text(&join("operation", name))?)));
            let headers = headers.collect::<Result<Vec<_>, Problem>>()?;
            let read = digested(path, || cycle_table::read(path, &headers, limits::ROWS), failed);
            let (table, digest) = read.map_err(|problem| named(settings, problem))?;
            file = Some((path.to_owned(), digest));
            (key("file"), table)
        }
        _ => return Ok(None),
    };
    let place = settings.origin(&source);
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
    let has_load = table.loads.is_some();
    // The disc turns as the wheel does.
    let of_road = |road_speeds: &Vec<f64>| {
        let speeds = |brake: &Brake| road_speeds.iter().map(|speed| brake.sliding_speed(*speed)).collect();
        Some((DiscSpeed::Sliding, speeds(brake?)))
    };
    let speeds = table.speeds.or_else(|| table.road_speeds.as_ref().and_then(of_road));
    let has_speed = speeds.is_some();
    let of_brake = |column: &str, missing: &str| {
        let message = format!("its column {column} is of the whole brake, and {missing}");
        Problem::new(&place, &source, message)
    };
    const NO_BRAKE: &str = "there is no [brake]: give it, or the load of the simulated pin";
    let (loads, by_torque) = match table.loads {
        Some((Load::Force, loads)) => (loads, false),
        Some((Load::BrakingTorque, torques)) => (torques, true),
        Some((Load::NominalPressure, pressures)) => {
            (pressures.into_iter().map(|pressure| pressure * mesh.pin_area()).collect(), false)
        }
        Some((Load::BrakeTorque, torques)) => {
            let brake = brake.ok_or_else(|| of_brake("brake_torque", NO_BRAKE))?;
            (torques.into_iter().map(|torque| brake.torque_of_pin(torque, mesh)).collect(), true)
        }
        Some((Load::BrakePressure, pressures)) => {
            let brake = brake.ok_or_else(|| of_brake("brake_pressure", NO_BRAKE))?;
            let force = |pressure| Some(brake.nominal_pressure(pressure)? * mesh.pin_area());
            let forces: Option<_> = pressures.into_iter().map(force).collect();
            let unknown =
                || of_brake("brake_pressure", "brake.piston_area is not given: what presses a pad is not known");
            (forces.ok_or_else(unknown)?, false)
        }
        None => {
            let value = load.value.ok_or_else(|| missing("load", "normal_force or braking_torque"))?;
            (vec![value; rows], load.by_torque)
        }
    };
    let speeds = match speeds {
        Some((DiscSpeed::Rotational, speeds)) => speeds,
        Some((DiscSpeed::Sliding, speeds)) => speeds.into_iter().map(|speed| speed / mesh.mean_radius()).collect(),
        None => vec![speed.ok_or_else(|| missing("speed", "rotational_speed or sliding_speed"))?; rows],
    };
    let has_road = table.road_speeds.is_some();
    let road_speeds = table.road_speeds.unwrap_or_else(|| vec![0.0; rows]);
    let is_road_alone = road_speeds.iter().any(|speed| *speed != road_speeds[0]) && !has_speed;
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
    let start = table.start;
    Ok(Some(OperationCycle {
        cycle: Arc::new(cycle),
        by_torque,
        has_load,
        has_speed,
        has_road,
        is_road_alone,
        start,
        file,
    }))
}

/// Makes a file that cannot be read a problem with the key that names it.
fn named(settings: &Settings, problem: Problem) -> Problem {
    match problem.origin {
        Origin::File(file) => {
            let key = format!("{CYCLE}.file");
            settings.problem(&key, format!("{}: {}", file.display(), problem.message))
        }
        _ => problem,
    }
}

/// Refuses a cycle where the run chooses its acceleration: a choice would estimate the error of one history, and every event has another.
pub(super) fn refuse_choice(settings: &Settings, cycle: &Cycle, until: f64) -> Result<(), Problem> {
    let tolerance = join(ACCELERATION, "tolerance");
    if settings.get(&tolerance).is_none() {
        return Ok(());
    }
    let largest = cycle.largest_acceleration(until);
    let advice = if largest >= 1.0 {
        format!(
            "write time_acceleration = {} (with it every event has ten simulated revolutions) or less",
            largest.floor()
        )
    } else {
        "write time_acceleration = 1, for an event of the cycle has less than ten revolutions".to_owned()
    };
    let message = format!(
        "a run with a cycle does not choose its acceleration, for every event would need another one; {advice}, and see \
         docs/drive.md for its error"
    );
    Err(settings.problem(&tolerance, message))
}

/// A word to a constant load or speed beside a cycle that has its own: where it is set on the command line, varied by a study, or given
/// by the scene at `path`, which takes its cycle from one that it extends.
pub(super) fn constants_without_effect(settings: &Settings, operation: &OperationCycle, path: &Path) -> Vec<Warning> {
    let keys = [
        ("operation.normal_force", operation.has_load, "force_scale"),
        ("operation.braking_torque", operation.has_load, "force_scale"),
        ("operation.rotational_speed", operation.has_speed, "speed_scale"),
        ("operation.sliding_speed", operation.has_speed, "speed_scale"),
    ];
    let is_own = |key: &str| matches!(settings.origin(key), Origin::Place { file, .. } if *file == *path);
    let has_own_cycle = ["points", "file"].iter().any(|name| is_own(&format!("{CYCLE}.{name}")));
    let is_set = |key: &str| matches!(settings.origin(key), Origin::Set(_)) || is_own(key) && !has_own_cycle;
    keys.into_iter()
        .filter(|(key, has_own, _)| *has_own && is_set(key))
        .map(|(key, _, scale)| Warning {
            place: settings.origin(key),
            key: key.to_owned(),
            found: "set beside a cycle that has a column of its own".to_owned(),
            bound: "so it changes nothing".to_owned(),
            advice: format!("set operation.cycle.{scale} to change all rows"),
        })
        .collect()
}

/// A word to a vehicle that changes its speed while its disc does not.
pub(super) fn road_alone(settings: &Settings, operation: &OperationCycle) -> Option<Warning> {
    let is_given = |key: &String| settings.get(key).is_some();
    let key = ["points", "file"].map(|name| format!("{CYCLE}.{name}")).into_iter().find(is_given)?;
    operation.is_road_alone.then(|| Warning {
        place: settings.origin(&key),
        key,
        found: "road_speed changes while the disc turns at one speed, that of [operation]".to_owned(),
        bound: "and nothing follows from road_speed but the road distance".to_owned(),
        advice: "give the speed of the disc, too, or the wheel in [brake]: sliding_speed is road_speed times mean radius over its rolling radius"
            .to_owned(),
    })
}

/// A word to a table that does not begin with 0.
pub(super) fn late_start(settings: &Settings, operation: &OperationCycle) -> Option<Warning> {
    let key = format!("{CYCLE}.file");
    (operation.start != 0.0).then(|| Warning {
        place: settings.origin(&key),
        found: format!("its first row is at {} s", number::plain(operation.start)),
        bound: "and times of a run begin with 0".to_owned(),
        advice: "the run counts from that row: so do output.maps_at and all times it reports".to_owned(),
        key,
    })
}

/// A word to cycles with events that are too short for the acceleration (model section 9).
pub(super) fn short_events(settings: &Settings, parameters: &Parameters, cycle: &Cycle, until: f64) -> Option<Warning> {
    let largest = cycle.largest_acceleration(until);
    let m = parameters.time_acceleration;
    let (short, all) = (cycle.short_events(until, m), cycle.events(until).len());
    (short > 0).then(|| Warning {
        place: settings.origin(ACCELERATION),
        key: ACCELERATION.to_owned(),
        found: format!(
            "with {m} the shortest of the cycle's events has {} simulated revolutions, {short} of {all} have less than 10",
            number::short(number::not_above(10.0 * largest / m, 4))
        ),
        bound: "expected at least 10 in every event".to_owned(),
        advice: if largest >= 1.0 {
            format!("{} is the largest acceleration with which all have them", number::not_above(largest, 9))
        } else {
            "no acceleration gives them to all: that event is that short".to_owned()
        },
    })
}
