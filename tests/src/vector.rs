//! Test vectors from the model as it is read: initial surfaces, and what every step comes to.
//!
//! They are for those who write the model anew, in this program or elsewhere; `tests/vectors/README.md` has the layout. This is the same
//! few lines of physics that `plateau run --engine plain` takes, without the program around it.

use std::error::Error;
use std::path::Path;

use ndarray::ArrayView2;
use plateau_core::model::accounts::{Accounts, AccountsReport, StepFacts};
use plateau_core::model::state::{Base, InitialSurfaces};
use plateau_core::model::step::advance_under;
use plateau_core::model::{State, Volumes};
use plateau_io::scene::Scene;
use plateau_io::surface;

use crate::run_file::created;

/// What is recorded of a step: name and value.
type Record = Vec<(&'static str, f64)>;

/// Takes a scene's steps one by one and writes `init.h5` and `expected.h5` into a folder.
///
/// # Errors
/// When the surfaces cannot be made, no displacement carries the load, or a file cannot be written.
pub fn write(scene: &Scene, folder: &Path) -> Result<(), Box<dyn Error>> {
    let surfaces = surface::load(scene)?.surfaces;
    let (parameters, mesh) = (&scene.parameters, &scene.parameters.mesh);
    let (disc, pin) = ([mesh.disc_columns(), mesh.rows()], [mesh.pin_columns(), mesh.rows()]);
    write_initial(&surfaces, disc, pin, &folder.join("init.h5"))?;

    let mut state = State::new(parameters, surfaces);
    let mut accounts = Accounts::of(parameters);
    let (mut records, mut moved, mut pressure, mut pm10_mass) = (Vec::new(), Volumes::default(), Vec::new(), None);
    for step in 1..=scene.steps {
        let mut wear_rate_factor = 1.0;
        if let Some(accounts) = &mut accounts {
            accounts.begin(step, parameters.step_angle());
            wear_rate_factor = accounts.wear_rate_factor();
        }
        let friction = accounts.as_ref().and_then(Accounts::friction_coefficient);
        let operation = parameters.operation_by(step, &parameters.clock(), friction)?;
        let done = advance_under(operation.load, &parameters.with_wear_rate_factor(wear_rate_factor), &mut state)?;
        let areas = || mesh.area().iter().cycle();
        let mut record: Record = vec![
            ("time", operation.end),
            ("displacement", done.displacement),
            (
                "contact_area",
                done.contact.iter().zip(areas()).filter(|(touches, _)| **touches).map(|(_, area)| area).sum(),
            ),
            ("load", done.pressure.iter().zip(areas()).map(|(pressure, area)| pressure * area).sum()),
            ("max_pressure", done.pressure.iter().copied().fold(0.0, f64::max)),
            ("pool", state.pools.iter().sum()),
        ];
        if parameters.cycle.is_some() || accounts.is_some() {
            record.push(("normal_force", operation.load));
        }
        if let Some(accounts) = &mut accounts {
            accounts.record(&StepFacts {
                number: step,
                angle: parameters.step_angle(),
                operation: &operation,
                contact: &done.sums(parameters),
                moved: &done.moved,
            });
            let AccountsReport { friction, heat, emission } =
                accounts.report(step, parameters.step_angle(), operation.end, None);
            record.extend(friction.iter().flat_map(|friction| {
                [("friction_coefficient", friction.coefficient), ("friction_work", friction.work)]
            }));
            record.extend(heat.iter().flat_map(|heat| {
                [
                    ("contact_temperature", heat.contact),
                    ("disc_temperature", heat.disc),
                    ("pin_temperature", heat.pin),
                    ("heat_lost", heat.lost),
                ]
            }));
            record.extend(emission.iter().map(|emission| ("particle_number", emission.number)));
            pm10_mass = emission.map(|emission| emission.pm10);
        }
        records.push(record);
        moved = moved + done.moved;
        pressure = done.pressure;
    }

    let file = created(folder.join("expected.h5"));
    for (series, (name, _)) in records.first().iter().flat_map(|record| record.iter()).enumerate() {
        let values: Vec<f64> = records.iter().map(|record| record[series].1).collect();
        file.new_dataset_builder().with_data(&values).create(format!("/series/{name}").as_str())?;
    }
    let maps = [
        ("/disc/height", disc, &state.disc.height),
        ("/pin/height", pin, &state.pin.height),
        ("/pin/pressure", pin, &pressure),
    ];
    for (name, shape, values) in maps {
        file.new_dataset_builder().with_data(ArrayView2::from_shape(shape, values)?).create(name)?;
    }
    let volumes = [
        ("worn_pin", moved.worn_pin),
        ("worn_resin", moved.worn_resin),
        ("worn_disc", moved.worn_disc),
        ("destroyed", moved.returned),
        ("emitted", moved.emitted),
        ("deposited_pin", moved.deposited_pin),
        ("deposited_disc", moved.deposited_disc),
    ];
    for (name, volume) in volumes.into_iter().chain(pm10_mass.map(|mass| ("pm10_mass", mass))) {
        file.new_attr::<f64>().create(name)?.write_scalar(&volume)?;
    }
    Ok(file.close()?)
}

fn write_initial(
    surfaces: &InitialSurfaces,
    disc: [usize; 2],
    pin: [usize; 2],
    path: &Path,
) -> Result<(), Box<dyn Error>> {
    let file = created(path);
    let base: Vec<u8> = surfaces.pin_base.iter().map(|base| u8::from(*base == Base::Primary)).collect();
    let heights = [("/disc/height", disc, &surfaces.disc_height), ("/pin/height", pin, &surfaces.pin_height)];
    for (name, shape, values) in heights {
        file.new_dataset_builder().with_data(ArrayView2::from_shape(shape, values)?).create(name)?;
    }
    file.new_dataset_builder().with_data(ArrayView2::from_shape(pin, &base)?).create("/pin/base")?;
    Ok(file.close()?)
}
