//! One run of a study, from its scene to its record. After a signal its surfaces are given up while they are made.

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use plateau_core::observe::event::event_quantities;
use plateau_core::observe::running_in::pulse_time;
use plateau_core::observe::{Quantity, Sample, Snapshot, quantities};
use plateau_core::simulation::{Execution, Simulation};
use plateau_io::scene::Scene;
use plateau_io::study::Study;
use plateau_io::study::record::{CONTACT_TIME, Identity, Outcome, REVOLUTIONS, Series};
use plateau_io::study::response::Response;
use plateau_io::surface::{self, Loaded, SurfaceError};

use super::kept_file::KeptFile;
use super::resolved::file_of;
use super::shared_surfaces::SharedSurfaces;
use super::under_way::{Ended, SavedState, UnderWay};
use super::warnings::{SceneWarnings, SweepObserver, of_surfaces};
use crate::assembly::{Assembly, Sink};
use crate::options::SweepOptions;
use crate::recorder::header;

/// Time between two looks at signals.
const SIGNAL_LOOK: Duration = Duration::from_millis(50);

/// Makes a run, unless a signal comes or its run file cannot be kept: how it ended, and its identity by what was read of its files; none
/// if it failed before that was known.
pub fn make(request: &Request<'_>, under_way: &mut UnderWay<'_>) -> Result<(Outcome, Option<Identity>), Ended> {
    let mut of = None;
    // A panic is a mistake of this program; it ends the run, not the study.
    let made = catch_unwind(AssertUnwindSafe(|| request.finish(under_way, &mut of)));
    let outcome = match made {
        Ok(Ok(outcome)) => outcome,
        Ok(Err(Ended::Failed(error))) => Outcome::Failed { error },
        Ok(Err(ended)) => return Err(ended),
        Err(_) => Outcome::Failed { error: "the program panicked: this is a mistake of the program".into() },
    };
    Ok((outcome, of))
}

/// A run that is to be made.
pub struct Request<'a> {
    pub study: &'a Study,
    pub options: &'a SweepOptions,
    pub observer: &'a dyn SweepObserver,
    /// Surfaces of other runs.
    pub shared: &'a SharedSurfaces,
    /// Warnings of the surfaces of the runs.
    pub warnings: &'a Mutex<SceneWarnings>,
    /// Number of the run in the study.
    pub number: usize,
    pub scene: &'a Scene,
    /// Identity that the run is expected to have.
    pub expected: &'a Identity,
    /// Series that are kept besides those that the study wants.
    pub besides: &'a BTreeSet<String>,
}

impl Request<'_> {
    fn finish(&self, under_way: &mut UnderWay<'_>, of: &mut Option<Identity>) -> Result<Outcome, Ended> {
        let Self { options, shared, .. } = self;
        let found = shared.find(self.scene);
        let is_found = found.is_some();
        let loaded = found.map_or_else(|| self.surfaces(under_way).map(Arc::new), Ok)?;
        let warnings = of_surfaces(self.scene, &loaded);
        self.warnings.lock().unwrap_or_else(PoisonError::into_inner).add(warnings);
        let read = of.insert(Identity::of(self.scene, &loaded.inputs));
        if !is_found {
            shared.keep(self.scene, &loaded);
        }
        if read != self.expected {
            under_way.is_another();
        }
        // Of what was read, which may not be what was expected.
        let file = options.keep_files.then(|| file_of(self.study, read, self.number, self.scene));
        let Loaded { surfaces, inputs, report, .. } = Arc::unwrap_or_clone(loaded);
        let mut scene = self.scene.clone();
        if file.is_none() {
            // A journal keeps no maps.
            scene.output.maps.clear();
        }
        let execution =
            Execution { workers: options.workers, decomposition: scene.decomposition, ..Execution::default() };
        let pulse_time = pulse_time(&scene.parameters, &surfaces.pin_base);
        let mut assembly = Assembly::new(&scene, surfaces, execution)?;
        let mut recorder = SeriesRecorder::new(self, &scene, under_way);
        let mut state = recorder.under_way.find(&scene.parameters.mesh, &recorder.program, &recorder.names());
        if let Some(path) = file {
            let header = header(&scene, &assembly, &options.program, &inputs, report);
            recorder.file = Some(KeptFile::open(&path, &header, &mut state, recorder.under_way)?);
        }
        if let Some(state) = state {
            assembly.restore(&state.simulation)?;
            let steps = state.simulation.run.steps();
            self.observer.steps(steps);
            self.observer.note(&format_args!("a run that was stopped goes on from step {steps}"));
            (recorder.columns, recorder.told) = (state.columns, steps);
        }
        let result = assembly.run_to_end(&mut recorder);
        recorder.file.take().map_or(Ok(()), |file| file.close(&result, &assembly))?;
        result?;
        let steps = assembly.simulation.steps_done();
        self.observer.steps(steps - recorder.told);
        let events = (!assembly.events().is_empty()).then(|| {
            let extras = scene.extras(false);
            let quantities = || event_quantities(&extras);
            let columns = quantities().map(|quantity| assembly.events().iter().map(quantity.value).collect());
            Series::new(quantities().map(|quantity| quantity.name.to_owned()).collect(), columns.collect()).pack()
        });
        Ok(Outcome::Finished { steps, until: scene.duration, series: recorder.series().pack(), events, pulse_time })
    }

    /// Tells the observer how many steps were taken since the last time, about ten times a second; true if a signal ends the run.
    fn steps(&self, count: u64) -> bool {
        self.observer.steps(count);
        self.observer.asked_to_stop().is_some()
    }

    /// Reads or makes the surfaces of a scene. Nothing is written meanwhile, so after a signal nobody waits for them: the thread that makes
    /// them ends with the program. Other runs that are made at the same time keep what they have.
    fn surfaces(&self, under_way: &mut UnderWay<'_>) -> Result<Loaded, Ended> {
        let (give, take) = channel();
        let its_own = self.scene.clone();
        let load = move || drop(give.send(surface::load(&its_own)));
        let failed = |error: SurfaceError| Ended::Failed(error.to_string());
        if thread::Builder::new().name("surfaces".into()).spawn(load).is_err() {
            // No thread is to be had: a signal is heard with the first step.
            return surface::load(self.scene).map_err(failed);
        }
        loop {
            match take.recv_timeout(SIGNAL_LOOK) {
                Ok(loaded) => return loaded.map_err(failed),
                Err(RecvTimeoutError::Disconnected) => panic!("the thread that makes surfaces panicked"),
                Err(RecvTimeoutError::Timeout) => under_way.touch(),
            }
            if self.steps(0) {
                return Err(Ended::Stopped);
            }
        }
    }
}

/// Keeps the series that the study wants.
struct SeriesRecorder<'a, 'o> {
    kept: Vec<&'static Quantity>,
    disc_columns: usize,
    /// Time and simulated revolutions, then the series.
    columns: Vec<Vec<f64>>,
    request: &'a Request<'a>,
    /// Steps that the observer was told of.
    told: u64,
    under_way: &'a mut UnderWay<'o>,
    program: String,
    file: Option<KeptFile>,
    /// Tells whether a signal came.
    is_stopped: bool,
}

impl<'a, 'o> SeriesRecorder<'a, 'o> {
    fn new(request: &'a Request<'_>, scene: &Scene, under_way: &'a mut UnderWay<'o>) -> Self {
        let study = request.study;
        let asked: BTreeSet<&str> = study.responses.iter().flat_map(Response::needs).collect();
        let is_kept = |name: &str| {
            let is_wanted = study.series.as_ref().is_none_or(|series| series.iter().any(|wanted| wanted == name));
            // Means of the contact area are taken from its integral, and over the time in contact.
            let of_area = ["contact_area_integral", CONTACT_TIME].contains(&name)
                && asked.iter().any(|series| series.starts_with("contact_area"));
            is_wanted || of_area || asked.contains(name) || request.besides.contains(name)
        };
        let extras = scene.extras(scene.adaptive.is_some());
        let kept: Vec<_> = quantities(&extras).filter(|quantity| is_kept(quantity.name)).collect();
        let disc_columns = scene.parameters.mesh.disc_columns();
        Self {
            columns: vec![Vec::new(); 2 + kept.len()],
            kept,
            disc_columns,
            request,
            told: 0,
            under_way,
            program: request.options.program.build(),
            file: None,
            is_stopped: false,
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

impl Sink for SeriesRecorder<'_, '_> {
    type Error = Ended;

    fn sample(&mut self, sample: Sample) -> Result<(), Ended> {
        let revolutions = sample.step as f64 / self.disc_columns as f64;
        let values =
            [sample.time, revolutions].into_iter().chain(self.kept.iter().map(|quantity| quantity.value(&sample)));
        self.columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
        Ok(self.file.as_mut().map_or(Ok(()), |file| file.writer.sample(sample))?)
    }

    fn snapshot(&mut self, snapshot: Snapshot) -> Result<(), Ended> {
        Ok(self.file.as_mut().map_or(Ok(()), |file| file.snapshot(snapshot))?)
    }

    fn look(&mut self, simulation: &Simulation, steps: u64) -> Result<u64, Ended> {
        self.under_way.touch();
        let done = simulation.steps_done();
        self.is_stopped = self.request.steps(done - self.told);
        self.told = done;
        self.file.as_mut().map_or(Ok(()), |file| file.writer.check())?;
        Ok(steps)
    }

    fn rest(&mut self, assembly: &mut Assembly) -> Result<(), Ended> {
        if self.is_stopped || self.under_way.is_due() {
            let (program, names, columns) = (self.program.clone(), self.names(), self.columns.clone());
            let file = self.file.as_mut().map(KeptFile::state).transpose()?;
            self.under_way.keep(&SavedState { program, simulation: assembly.checkpoint()?, columns, names, file });
        }
        if self.is_stopped { Err(Ended::Stopped) } else { Ok(()) }
    }
}
