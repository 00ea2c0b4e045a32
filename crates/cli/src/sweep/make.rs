//! One run of a study, from its scene to what is kept of it.

use std::panic::{AssertUnwindSafe, catch_unwind};

use plateau_core::observe::event::event_quantities;
use plateau_core::observe::{Quantity, Sample, quantities};
use plateau_core::simulation::{Execution, Simulation};
use plateau_io::scene::Scene;
use plateau_io::study::Study;
use plateau_io::study::record::{CONTACT_TIME, Outcome, REVOLUTIONS, Series};
use plateau_run::{Assembly, Sink};

use super::surfaces::surfaces;
use super::under_way::UnderWay;
use super::watcher::{Ended, Stopped, Watcher};

/// Makes a run.
///
/// # Errors
/// [`Stopped`] when it was not to be ended; what fails is an outcome.
pub fn make(
    study: &Study,
    scene: &Scene,
    workers: usize,
    watcher: &dyn Watcher,
    under_way: &mut UnderWay,
) -> Result<Outcome, Stopped> {
    // A panic is a mistake of this program; it ends the run, not the study.
    let made = catch_unwind(AssertUnwindSafe(|| finish(study, scene, workers, watcher, under_way)));
    match made {
        Ok(Ok(outcome)) => Ok(outcome),
        Ok(Err(Ended::Stopped(signal))) => Err(Stopped(signal)),
        Ok(Err(Ended::Failed(error))) => Ok(Outcome::Failed { error }),
        Err(_) => Ok(Outcome::Failed { error: "the program panicked: this is a mistake of the program".into() }),
    }
}

fn finish(
    study: &Study,
    scene: &Scene,
    workers: usize,
    watcher: &dyn Watcher,
    under_way: &mut UnderWay,
) -> Result<Outcome, Ended> {
    let loaded = surfaces(scene, watcher)?;
    watcher.surfaces(scene, &loaded);
    let surfaces = loaded.surfaces;
    // A study keeps no maps.
    let mut scene = scene.clone();
    scene.output.maps.clear();
    let mut assembly = Assembly::new(&scene, surfaces, Execution { workers, ..Execution::default() })?;
    let mut recorder = Recorder::new(study, &scene, watcher, under_way);
    if let Some(state) = recorder.under_way.find(&scene.parameters.mesh, &recorder.names()) {
        assembly.restore(&state.simulation)?;
        let steps = state.simulation.run.steps();
        watcher.goes_on(steps);
        (recorder.columns, recorder.told) = (state.columns, steps);
    }
    assembly.run_to_end(&mut recorder)?;
    let steps = assembly.simulation.steps_done();
    recorder.watcher.steps(steps - recorder.told);
    let events = (!assembly.events().is_empty()).then(|| {
        let extras = scene.extras(false);
        let quantities = || event_quantities(&extras);
        let columns = quantities().map(|quantity| assembly.events().iter().map(quantity.value).collect());
        Series::new(quantities().map(|quantity| quantity.name.to_owned()).collect(), columns.collect()).pack()
    });
    Ok(Outcome::Finished { steps, until: scene.duration, series: recorder.series().pack(), events })
}

/// Keeps the series that the study wants.
struct Recorder<'a> {
    kept: Vec<&'static Quantity>,
    disc_columns: usize,
    /// Time and simulated revolutions, then the series.
    columns: Vec<Vec<f64>>,
    watcher: &'a dyn Watcher,
    /// Steps that the watcher was told of.
    told: u64,
    under_way: &'a mut UnderWay,
    signal: Option<u8>,
}

impl<'a> Recorder<'a> {
    fn new(study: &Study, scene: &Scene, watcher: &'a dyn Watcher, under_way: &'a mut UnderWay) -> Self {
        let asked = |name: &str| {
            let responses = &study.responses;
            // Means of the contact area are taken from its integral, and over the time in contact.
            let of_area = ["contact_area_integral", CONTACT_TIME].contains(&name)
                && responses.iter().any(|other| other.series.starts_with("contact_area"));
            of_area || responses.iter().any(|response| response.series == name)
        };
        let kept: Vec<_> = quantities(&scene.extras(scene.adaptive.is_some()))
            .filter(|quantity| {
                study.series.as_ref().is_none_or(|series| series.iter().any(|name| name == quantity.name))
                    || asked(quantity.name)
            })
            .collect();
        let disc_columns = scene.parameters.mesh.disc_columns();
        Self {
            columns: vec![Vec::new(); 2 + kept.len()],
            kept,
            disc_columns,
            watcher,
            told: 0,
            under_way,
            signal: None,
        }
    }

    fn names(&self) -> Vec<String> {
        let names = ["time", REVOLUTIONS].into_iter().chain(self.kept.iter().map(|quantity| quantity.name));
        names.map(str::to_owned).collect()
    }

    fn series(self) -> Series {
        Series::new(self.names(), self.columns)
    }
}

impl Sink for Recorder<'_> {
    type Error = Ended;

    fn sample(&mut self, sample: Sample) -> Result<(), Ended> {
        let revolutions = sample.step as f64 / self.disc_columns as f64;
        let values =
            [sample.time, revolutions].into_iter().chain(self.kept.iter().map(|quantity| quantity.value(&sample)));
        self.columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
        Ok(())
    }

    fn look(&mut self, simulation: &Simulation, steps: u64) -> Result<u64, Ended> {
        let done = simulation.steps_done();
        self.signal = self.watcher.steps(done - self.told);
        self.told = done;
        Ok(steps)
    }

    fn rest(&mut self, assembly: &mut Assembly) -> Result<(), Ended> {
        if self.signal.is_some() || self.under_way.is_due() {
            self.under_way.keep(assembly, &self.columns, self.names())?;
        }
        self.signal.map_or(Ok(()), |signal| Err(Ended::Stopped(signal)))
    }
}
