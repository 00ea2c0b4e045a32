//! A scene from its layers: settings, and what they say together: mesh, steps, memory.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use plateau_core::acceleration::Adaptive;
use plateau_core::model::brake::Brake;
use plateau_core::model::emission::Emission;
use plateau_core::model::friction::{Friction, FrictionLaw};
use plateau_core::model::material::{Material, Materials};
use plateau_core::model::mesh::Mesh;
use plateau_core::model::parameters::{DebrisRule, Parameters, PlateauRules};
use plateau_core::model::thermal::{Coating, Disc, Pin, Substance, Thermal};
use plateau_core::observe::extra::{CONTACT_TEMPERATURE, Extra};
use plateau_core::observe::schedule::SampleEvery;
use plateau_core::observe::{Map, requested};

use crate::memory::refuse_beyond;
use crate::scene::contents::{self, OperationCycle, OutputSettings, Scene, Workers};
use crate::scene::cycle::{
    ConstantLoad, constants_without_effect, late_start, operation, refuse_choice, road_alone, short_events,
};
use crate::scene::error::{Origin, Problem, SceneError, Warning};
use crate::scene::interpret::Setting;
use crate::scene::layers::{self, Layered};
use crate::scene::mesh::{Cells, Refused};
use crate::scene::resolved;
use crate::scene::schema::choices::{self, Shape};
use crate::scene::schema::{self, ACCELERATION, Key, join};
use crate::scene::settings::{self, Settings};
use crate::scene::surfaces::{base, heights};
use crate::{number, text};

/// Reads the scene at `path`, lays it over the scenes it extends, applies the arguments of `--set` (`key.path=value`)
/// and checks everything that can be checked without reading surfaces.
pub fn load(path: &Path, sets: &[String]) -> Result<Scene, SceneError> {
    of_layers(path, None, &[sets])
}

/// Reads a scene as [`load`] does, from a text that is in no file: what it names is looked for as if it were at `path`.
pub fn of_text(path: &Path, text: &str) -> Result<Scene, SceneError> {
    of_layers(path, Some(text), &[])
}

/// Reads a scene as [`load`] or [`of_text`] does, with lists of changes that are laid over each other, as scenes are that extend others: a
/// later one may choose another alternative.
pub fn of_layers(path: &Path, text: Option<&str>, sets: &[&[String]]) -> Result<Scene, SceneError> {
    let Layered { entries, files, mut problems, replaced } = layers::read(path, text, sets)?;
    if problems.is_empty() {
        // A key that is mistyped or was dropped is not missing too.
        settings::refuse_missing(&entries, path, &mut problems);
    }
    settings::refuse_lone_companions(&entries, &mut problems);
    settings::refuse_meaningless(&entries, &mut problems);
    let settings = Settings::read(&entries, path, &mut problems);
    if !problems.is_empty() {
        return Err(SceneError::new(problems));
    }
    let mut scene = build(settings, files, path)?;
    scene.warnings.splice(0..0, replaced);
    Ok(scene)
}

/// Makes the scene; `files` are the scene file and those it extends.
fn build(mut settings: Settings, mut files: Vec<(PathBuf, String)>, path: &Path) -> Result<Scene, Problem> {
    let mut warnings = Vec::new();
    let adaptive = adaptive(&settings)?;
    let brake = if settings.has_table("brake") { Some(brake(&settings)?) } else { None };
    let (parameters, operation) = parameters(&settings, brake.as_ref())?;
    let Length { steps, duration } = length(&settings, &parameters, operation.as_ref())?;
    warnings.extend(debris_by_default(&settings, path));
    if let Some(operation) = &operation {
        refuse_choice(&settings, &operation.cycle, duration)?;
        warnings.extend(constants_without_effect(&settings, operation, path));
        warnings.extend(road_alone(&settings, operation));
        warnings.extend(late_start(&settings, operation));
        warnings.extend(short_events(&settings, &parameters, &operation.cycle, duration));
    }
    files.extend(operation.as_ref().and_then(|operation| operation.file.clone()));
    // From here on it is `debris`.
    settings.remove("plateaus.debris_pool");
    let end = if operation.is_some() { duration } else { parameters.clock().time_at(steps) };
    // Of a mesh in lengths this is not known before.
    let samples = ["output.sample_every", "output.sample_every_steps"];
    if samples.iter().all(|key| settings.get(key).is_none()) {
        let revolution = Setting::Integer(parameters.mesh.disc_columns() as u64);
        settings.insert(samples[1], revolution, &Origin::Default);
    }
    let output = output(&mut settings, end, &mut warnings)?;
    let workers = match settings.get("numerics.workers") {
        // What is too large for this machine is too large in any case, and refused as such later.
        Some(Setting::Integer(count)) => Workers::Count(usize::try_from(*count).unwrap_or(usize::MAX)),
        _ => Workers::Auto,
    };
    let seeds = schema::keys().iter().filter(|key| key.is_seed()).map(Key::path);
    let seeds = seeds.filter_map(|path| settings.integer(&path).ok().map(|seed| (path, seed)));
    Ok(Scene {
        title: settings.text("title")?.to_owned(),
        path: path.to_path_buf(),
        disc_surface: heights(&settings, "disc")?,
        pin_surface: heights(&settings, "pin")?,
        resin_recess: settings.number("pin.surface.resin_recess")?,
        pin_base: base(&settings)?,
        pin_base_mirror: settings.bool("pin.base.mirror")?,
        workers,
        decomposition: settings.optional_choice("numerics.decomposition", &choices::DECOMPOSITION)?.unwrap_or_default(),
        seeds: seeds.collect(),
        resolved: resolved::write(&settings),
        files,
        warnings,
        places: settings.places(),
        cycle: operation,
        brake,
        adaptive,
        duration,
        steps,
        load_tolerance: settings.number("contact.load_tolerance")?,
        parameters,
        output,
    })
}

/// Choice of the acceleration by the run, if it chooses it.
fn adaptive(settings: &Settings) -> Result<Option<Adaptive>, Problem> {
    let [tolerance, max] = ["tolerance", "max"].map(|name| join(ACCELERATION, name));
    let Some(tolerance) = settings.optional_number(&tolerance)? else { return Ok(None) };
    if settings.get("operation.steps").is_some() {
        let message = "a run that chooses its acceleration has no certain number of steps, give operation.duration";
        return Err(settings.problem("operation.steps", message));
    }
    Ok(Some(Adaptive { tolerance, largest: settings.number(&max)? }))
}

/// Parameters of a simulation, and the cycle, if there is one; one that never changes load and speed is taken for constant operation.
fn parameters(settings: &Settings, brake: Option<&Brake>) -> Result<(Parameters, Option<OperationCycle>), Problem> {
    let mesh = mesh(settings)?;
    let sliding_speed = settings.optional_number("operation.sliding_speed")?;
    let speed_key = if sliding_speed.is_some() { "operation.sliding_speed" } else { "operation.rotational_speed" };
    let speed = match sliding_speed {
        Some(speed) => Some(speed / mesh.mean_radius()),
        None => settings.optional_number(speed_key)?,
    };
    let torque = settings.optional_number("operation.braking_torque")?;
    let constant = ConstantLoad {
        value: torque.map_or_else(|| settings.optional_number("operation.normal_force"), |torque| Ok(Some(torque)))?,
        by_torque: torque.is_some(),
    };
    let operation = operation(settings, &mesh, constant, speed, brake)?;
    let by_torque = operation.as_ref().map_or(constant.by_torque, |operation| operation.by_torque);
    let (normal_force, angular_velocity) = match &operation {
        // What is reckoned before the first step is on the safe side with the largest load, and right in the mean with the
        // mean speed.
        Some(OperationCycle { cycle, .. }) => cycle
            .constant()
            .unwrap_or_else(|| (cycle.largest_force(), cycle.angle_at(cycle.duration()) / cycle.active_time())),
        None => (
            constant.value.map_or_else(|| settings.number("operation.normal_force"), Ok)?,
            speed.map_or_else(|| settings.number(speed_key), Ok)?,
        ),
    };
    let cycle = operation.as_ref().map(|operation| operation.cycle.clone());
    let mut parameters = Parameters {
        mesh,
        normal_force,
        by_torque,
        angular_velocity,
        cycle: cycle.filter(|cycle| cycle.constant().is_none()),
        control: None,
        foundation_height: settings.number("contact.foundation_height")?,
        materials: materials(settings)?,
        plateaus: plateaus(settings)?,
        time_acceleration: settings.optional_number(ACCELERATION)?.unwrap_or(1.0),
        integrator: settings.choice("numerics.integrator", &choices::INTEGRATOR)?,
        friction: None,
        thermal: None,
        emission: None,
    };
    add_dissipation(settings, brake, &mut parameters)?;
    if !parameters.step_time().is_normal() {
        let message = format!("a step would last {} s, which cannot be computed with", parameters.step_time());
        return Err(settings.problem(speed_key, message));
    }
    Ok((parameters, operation))
}

fn mesh(settings: &Settings) -> Result<Mesh, Problem> {
    let path = |name: &str| join("mesh", name);
    let problem = |name: &str, message: String| settings.problem(&path(name), message);
    let refused = |Refused { key, message }: Refused| problem(key, message);
    // A scene that says nothing of it resolves to one that says nothing, as before there was a choice.
    let shape = settings.optional_choice("mesh.shape", &choices::SHAPE)?;
    let cells = Cells::read(
        shape.unwrap_or(Shape::Rectangle),
        |name| settings.optional_number(&path(name)),
        |name| settings.optional_integer(&path(name)),
        |name| problem(name, "it is not given".to_owned()),
        refused,
    )?;
    // The mesh itself takes memory, so this comes first. A pin wider than the ring is a clearer message.
    let [rows, disc_columns, pin_columns] = cells.counts;
    if pin_columns <= disc_columns {
        let maps = match settings.get("output.maps") {
            Some(Setting::Maps(maps)) => maps.as_slice(),
            _ => &[],
        };
        let needed = contents::estimate(cells.counts, maps, &extras(settings)?, adaptive(settings)?.is_some());
        if let Err(no_room) = refuse_beyond(needed) {
            let message = format!(
                "{rows} rows and {disc_columns} columns need {no_room}; make the mesh smaller, or allow more memory"
            );
            let key = if settings.get("mesh.cell_size").is_some() {
                "cell_size"
            } else if rows > disc_columns {
                "rows"
            } else {
                "disc_columns"
            };
            return Err(problem(key, message));
        }
    }
    let mesh = cells.mesh().map_err(refused)?;
    if !mesh.area().first().is_some_and(|area| area.is_normal()) || !mesh.disc_area().is_finite() {
        let key = if settings.get("mesh.cell_size").is_some() { "mean_radius" } else { "outer_radius" };
        return Err(problem(key, "the area of the cells cannot be computed with these radii".to_owned()));
    }
    Ok(mesh)
}

fn materials(settings: &Settings) -> Result<Materials, Problem> {
    let material = |name: &str| {
        let number = |key: &str| settings.number(&format!("materials.{name}.{key}"));
        Ok(Material {
            youngs_modulus: number("youngs_modulus")?,
            poisson_ratio: number("poisson_ratio")?,
            // Resin has none.
            specific_wear_rate: if name == "pin_resin" { 0.0 } else { number("specific_wear_rate")? },
        })
    };
    Ok(Materials {
        disc_primary: material("disc_primary")?,
        disc_secondary: material("disc_secondary")?,
        pin_primary: material("pin_primary")?,
        pin_secondary: material("pin_secondary")?,
        pin_resin: material("pin_resin")?,
        wear_height: settings.number("materials.pin_resin.wear_height")?,
        pin_primary_against_secondary: settings.optional_number("materials.pin_primary.wear_rate_against_secondary")?,
        pin_secondary_against_secondary: settings
            .optional_number("materials.pin_secondary.wear_rate_against_secondary")?,
        strength: settings.optional_number("materials.pin_secondary.strength")?,
    })
}

/// A word to scenes of before local debris that leave the rule open.
fn debris_by_default(settings: &Settings, scene: &Path) -> Option<Warning> {
    let (debris, pool) = (settings.origin("plateaus.debris"), settings.get("plateaus.debris_pool"));
    let is_open = debris == Origin::Default && pool.is_none() && settings.bool("plateaus.formation").unwrap_or(false);
    is_open.then(|| Warning {
        place: Origin::File(scene.into()),
        key: "plateaus.debris".to_owned(),
        found: "not given".to_owned(),
        bound: "so wear debris goes to one pool for the whole contact, as before there was a choice".to_owned(),
        advice: "write debris = \"contact\" to keep that, or \"local\" for the rule of the paper".to_owned(),
    })
}

/// Full path of the key of ℓ.
const TRANSPORT_LENGTH: &str = "plateaus.transport_length";

fn plateaus(settings: &Settings) -> Result<PlateauRules, Problem> {
    let debris = settings.choice("plateaus.debris", &choices::DEBRIS)?;
    let transport_length = settings.optional_number(TRANSPORT_LENGTH)?;
    let refused = |reason: &str| {
        let message = format!("{reason}; leave one of them out");
        Err(settings.problem(TRANSPORT_LENGTH, message))
    };
    if transport_length.is_some() {
        if debris != DebrisRule::Local {
            return refused("it is of local debris, and debris is pooled: write debris = \"local\"");
        }
        if settings.get("plateaus.captured_resin_fraction").is_some() {
            return refused(
                "with it only what plateaus lose is compacted, so that captured_resin_fraction has no meaning beside it",
            );
        }
    }
    Ok(PlateauRules {
        captured_fraction: settings.number("plateaus.captured_fraction")?,
        captured_resin_fraction: settings.optional_number("plateaus.captured_resin_fraction")?,
        // Local debris has neither.
        pad_share: settings.optional_number("plateaus.pad_share")?.unwrap_or(0.0),
        debris,
        transport_length,
        formation: settings.bool("plateaus.formation")?,
        destruction: settings.get("plateaus.destruction").is_some() && settings.bool("plateaus.destruction")?,
    })
}

fn output(settings: &mut Settings, end: f64, warnings: &mut Vec<Warning>) -> Result<OutputSettings, Problem> {
    let sample_every = match settings.optional_number("output.sample_every")? {
        Some(time) => SampleEvery::Time(time),
        None => SampleEvery::Steps(settings.integer("output.sample_every_steps")?),
    };
    let mut maps = match settings.get("output.maps") {
        Some(Setting::Maps(maps)) => maps.clone(),
        _ => Vec::new(),
    };
    maps.sort_unstable();
    maps.dedup();
    settings.insert("output.maps", Setting::Maps(maps.clone()), &Origin::Default);
    let file = PathBuf::from(settings.text("output.file")?);
    let extras = extras(settings)?;
    if extras.contains(&&CONTACT_TEMPERATURE) {
        maps.push(Map::Temperature);
    }
    let checkpoint_every = settings.number("output.checkpoint_every")?;
    let maps_at = map_times(settings, end, warnings);
    Ok(OutputSettings { file, sample_every, maps_at, maps, extras, checkpoint_every })
}

/// The series on request whose switches are on.
fn extras(settings: &Settings) -> Result<Vec<&'static Extra>, Problem> {
    requested(|name| settings.bool(&join("output", name)))
}

/// Times of maps, increasing; times beyond the end are left out with a warning, because runs are shortened by `--set`.
fn map_times(settings: &mut Settings, end: f64, warnings: &mut Vec<Warning>) -> Vec<f64> {
    let key = "output.maps_at";
    let origin = settings.origin(key);
    let mut times = match settings.get(key) {
        Some(Setting::Times(times)) => times.clone(),
        _ => Vec::new(),
    };
    times.sort_unstable_by(f64::total_cmp);
    times.dedup();
    // The time of a step is rounded; what is nearer to the end than this is the end.
    let (kept, beyond): (Vec<_>, Vec<_>) = times.into_iter().partition(|time| *time <= end * (1.0 + 1e-9));
    if !beyond.is_empty() {
        let beyond: Vec<_> = beyond.iter().map(|time| format!("{} s", number::plain(*time))).collect();
        warnings.push(Warning {
            place: origin.clone(),
            key: key.to_owned(),
            found: format!("maps at {}", text::list(beyond, ", ")),
            // In words for people: the last digits of a time that is a sum of steps say nothing.
            bound: format!("after the run, which ends at {} s", number::to_digits(end, 9)),
            advice: "they are not taken: give earlier times, or a longer operation.duration".to_owned(),
        });
    }
    settings.insert(key, Setting::Times(kept.clone()), &origin);
    kept
}

/// Most steps that a double counts one by one (2^53); with more the time of a step would be wrong.
const MOST_STEPS: u64 = 1 << f64::MANTISSA_DIGITS;

pub(super) struct Length {
    pub steps: u64,
    /// Physical time, s.
    pub duration: f64,
}

/// The steps and the time that the keys say.
pub(super) fn length(
    settings: &Settings,
    parameters: &Parameters,
    operation: Option<&OperationCycle>,
) -> Result<Length, Problem> {
    let duration = settings.optional_number("operation.duration")?;
    let given = settings.optional_integer("operation.steps")?;
    let key = match (duration, given) {
        (Some(_), _) => "operation.duration",
        (None, Some(_)) => "operation.steps",
        (None, None) => ACCELERATION,
    };
    let problem = |message: String| settings.problem(key, message);
    let length = match (operation, duration, given) {
        (Some(OperationCycle { cycle, .. }), _, _) => {
            let angle = parameters.step_angle();
            let duration = match (duration, given) {
                (Some(duration), _) => duration,
                (None, Some(steps)) if steps <= cycle.steps_done(cycle.duration(), angle) => cycle.end_of(steps, angle),
                (None, Some(_)) => f64::INFINITY,
                (None, None) => cycle.duration(),
            };
            if duration > cycle.duration() * (1.0 + 1e-12) {
                let (end, steps) = (cycle.duration(), cycle.steps_done(cycle.duration(), angle));
                return Err(problem(format!(
                    "the cycle ends after {end} s and {steps} steps, expected no more; write duration = \"{end} s\" in [operation], also \
                     where a scene that is extended gives another one, or raise operation.cycle.repeat to play it again"
                )));
            }
            // Also one that never changes: no step goes beyond the end.
            let steps = cycle.steps_done(duration, angle);
            if steps == 0 {
                let [duration, turned, step] = [duration, cycle.angle_at(duration), angle].map(number::plain);
                return Err(problem(format!(
                    "until {duration} s the cycle turns the disc by {turned} rad, less than a step of {step} rad, so nothing would \
                     happen; a longer duration, faster speeds or a smaller numerics.time_acceleration help"
                )));
            }
            Length { steps, duration }
        }
        (None, Some(duration), _) => Length { steps: parameters.steps_of(duration), duration },
        (None, None, _) => {
            let steps = settings.integer("operation.steps")?;
            Length { steps, duration: parameters.clock().time_at(steps) }
        }
    };
    if length.steps > MOST_STEPS {
        let message =
            format!("these are more than {MOST_STEPS} steps, which cannot be counted exactly; shorten the run");
        return Err(problem(message));
    }
    Ok(length)
}

/// Puts the parts that a scene asks for into its parameters.
fn add_dissipation(settings: &Settings, brake: Option<&Brake>, parameters: &mut Parameters) -> Result<(), Problem> {
    parameters.friction = if settings.has_table("friction") { Some(friction(settings)?) } else { None };
    // Disc and pads of a brake are given as they are; the pin has its part of them, and its disc turns faster where it is smaller.
    let mesh = &parameters.mesh;
    let share = brake.map_or(1.0, |brake| brake.share(mesh));
    let turns = brake.map_or(1.0, |brake| brake.effective_radius / mesh.mean_radius());
    parameters.thermal =
        if settings.has_table("thermal") { Some(Arc::new(thermal(settings, share, turns)?)) } else { None };
    parameters.emission = if settings.has_table("emission") { Some(emission(settings)?) } else { None };
    let (has_heat, has_friction) = (parameters.thermal.is_some(), parameters.friction.is_some());
    let is_boundless = parameters.friction.is_some_and(|friction| friction.maximum.is_infinite());
    let torques = ["operation.braking_torque", "operation.cycle.points", "operation.cycle.file"];
    let torque = torques.into_iter().find(|key| settings.get(key).is_some()).unwrap_or(torques[0]);
    let [factor, temperature] = ["emission.number_factor", "output.contact_temperature"];
    let is_reported = settings.get(temperature).is_some() && settings.bool(temperature)?;
    let (key, message) = match () {
        () if has_heat && !has_friction => {
            ("thermal.ambient", "heat comes of friction, and there is no [friction]: give it, or leave [thermal] out")
        }
        () if parameters.by_torque && !has_friction => {
            (torque, "a braking torque comes of friction, and there is no [friction]: give it, or give a load")
        }
        () if parameters.by_torque && is_boundless => (
            torque,
            "before the first step friction is at its ceiling, and friction.maximum is not given: give it, 0.6 for example",
        ),
        () if !has_heat && settings.get(factor).is_some() => (
            factor,
            "there is no [thermal], so the temperature of the contact is not known: give it, or leave this key out",
        ),
        () if !has_heat && is_reported => {
            (temperature, "there is no [thermal], so no temperature is reckoned: give it, or leave this key out")
        }
        () => return Ok(()),
    };
    Err(settings.problem(key, message))
}

fn friction(settings: &Settings) -> Result<Friction, Problem> {
    let law = |table: &str| {
        let number = |key: &str| settings.number(&format!("{table}.{key}"));
        let [pressure_coefficient, shear_strength] = ["pressure_coefficient", "shear_strength"].map(number);
        Ok::<_, Problem>(FrictionLaw { pressure_coefficient: pressure_coefficient?, shear_strength: shear_strength? })
    };
    let primary = law("friction")?;
    let is_given = |table: &str| {
        ["pressure_coefficient", "shear_strength"]
            .iter()
            .any(|key| settings.origin(&format!("{table}.{key}")) != Origin::Default)
    };
    if !["friction", "friction.secondary", "friction.resin"].into_iter().any(is_given) {
        let message = "this table gives no coefficient of friction: expected pressure_coefficient = 0.33, \
                       shear_strength = \"0.75 MPa\" or both, for example; or leave [friction] out";
        return Err(settings.problem("friction", message));
    }
    let other = |table: &str| if settings.has_table(table) { law(table) } else { Ok(primary) };
    Ok(Friction {
        primary,
        secondary: other("friction.secondary")?,
        resin: other("friction.resin")?,
        maximum: settings.optional_number("friction.maximum")?.unwrap_or(f64::INFINITY),
    })
}

fn brake(settings: &Settings) -> Result<Brake, Problem> {
    let number = |key: &str| settings.number(&join("brake", key));
    Ok(Brake {
        pad_area: number("pad_area")?,
        pads: settings.integer("brake.pads")?,
        pad_thickness: number("pad_thickness")?,
        effective_radius: number("effective_radius")?,
        wheel_radius: number("wheel_radius")?,
        piston_area: settings.optional_number("brake.piston_area")?,
        efficiency: number("efficiency")?,
    })
}

/// Heat, of so large a part of the disc and the pin that the scene gives, the disc turning so many times as fast as the scene's.
fn thermal(settings: &Settings, share: f64, turns: f64) -> Result<Thermal, Problem> {
    let number = |key: &str| settings.number(key);
    let substance = |table: &str| {
        let [conductivity, density, specific_heat] =
            ["conductivity", "density", "specific_heat"].map(|key| settings.number(&format!("{table}.{key}")));
        Ok::<_, Problem>(Substance { conductivity: conductivity?, density: density?, specific_heat: specific_heat? })
    };
    let coating = |table: &str| {
        Ok::<_, Problem>(Coating { thickness: number(&format!("{table}.thickness"))?, substance: substance(table)? })
    };
    let table = "thermal.disc.coating";
    Ok(Thermal {
        ambient: number("thermal.ambient")?,
        disc: Disc {
            substance: substance("thermal.disc")?,
            area: share * number("thermal.disc.area")?,
            thickness: number("thermal.disc.thickness")?,
            cooling: share * number("thermal.disc.cooling")?,
            cooling_per_speed: share / turns * number("thermal.disc.cooling_per_speed")?,
            coating: settings.has_table(table).then(|| coating(table)).transpose()?,
        },
        pin: Pin {
            substance: substance("thermal.pin")?,
            area: share * number("thermal.pin.area")?,
            length: number("thermal.pin.length")?,
            cooling: share * number("thermal.pin.cooling")?,
        },
        wear_rate_factor: settings.factor("thermal.wear_rate_factor")?,
        friction_factor: settings.factor("thermal.friction_factor")?,
    })
}

fn emission(settings: &Settings) -> Result<Emission, Problem> {
    let number = |key: &str| settings.number(&format!("emission.{key}"));
    let (pm10_fraction, pm25_fraction) = (number("pm10_fraction")?, number("pm25_fraction")?);
    if pm25_fraction > pm10_fraction {
        let message = format!("{pm25_fraction} is more than pm10_fraction = {pm10_fraction}, of which it is a part");
        return Err(settings.problem("emission.pm25_fraction", message));
    }
    Ok(Emission {
        pm10_fraction,
        pm25_fraction,
        number_per_mass: number("number_per_mass")?,
        pin_density: number("pin_density")?,
        disc_density: number("disc_density")?,
        number_factor: settings.factor("emission.number_factor")?,
    })
}
