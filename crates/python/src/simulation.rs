//! A simulation as an object of Python, between two steps.

use std::mem;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::Instant;

use plateau_core::model::memory::Heights;
use plateau_core::observe::{ABSENT, Map, MapValues, quantities};
use plateau_core::simulation::{self, Engine, Execution, SimulationError};
use plateau_io::{plausibility, scene as scenes, surface};
use plateau_run::{Assembly, Observer, adapted, execution, stiffness_warning};
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::background::{Messages, in_background};
use crate::failure::{Failure, raise};
use crate::scene::Scene;
use crate::state::State;

/// A simulation.
#[pyclass(frozen, module = "plateau._native")]
pub struct Simulation {
    inner: Mutex<Option<Inner>>,
    /// Forks that this process comes of. Where there were more since, the threads are missing.
    forks: u64,
}

/// Forks that this process comes of.
static FORKS: AtomicU64 = AtomicU64::new(0);

/// Counts a fork, in the process that comes of it.
#[pyfunction]
pub fn forked() {
    FORKS.fetch_add(1, Ordering::Relaxed);
}

struct Inner {
    scene: scenes::Scene,
    assembly: Assembly,
    /// Surface files that were read, with their SHA-256.
    inputs: Vec<(PathBuf, String)>,
    /// Why a step failed: nothing follows.
    failed: Option<String>,
}

impl Inner {
    fn new(scene: scenes::Scene, engine: Engine, messages: &Messages) -> Result<Self, Failure> {
        if scene.adaptive.is_some() {
            let message =
                "numerics.time_acceleration: a simulation that is taken step by step does not choose it, give a number";
            return Err(Failure::input(message));
        }
        stiffness_warning(&scene.parameters).iter().for_each(|warning| messages.warning(warning));
        let loaded = surface::load(&scene).map_err(Failure::input)?;
        loaded.warnings().for_each(|warning| messages.warning(&warning));
        plausibility::of_surfaces(&scene, &loaded).iter().for_each(|warning| messages.warning(warning));
        let asked = Execution { engine, ..Execution::default() };
        let execution = execution::decide(&scene, 1, asked, &loaded.surfaces, messages)?;
        let assembly = Assembly::new(&scene, loaded.surfaces, execution)?;
        Ok(Self { scene, assembly, inputs: loaded.inputs, failed: None })
    }

    /// Keeps sample and pressures of the last step, if they were, until there is another one.
    fn keep_contact(&mut self) -> Result<(), SimulationError> {
        if self.assembly.simulation.steps_done() == 0 {
            return Ok(());
        }
        match self.assembly.simulation.keep_contact() {
            Err(SimulationError::NotWatched { .. }) => Ok(()),
            kept => kept,
        }
    }

    /// Goes on from a state.
    fn restore(&mut self, state: &State) -> Result<(), Failure> {
        state.compare(&self.inputs)?;
        Ok(self.assembly.restore(&state.simulation)?)
    }

    /// Takes so many steps, a tenth of a second's worth at a time; if the last is `watched`, the last of each is, so that
    /// a sample may follow wherever it is stopped.
    fn advance(&mut self, py: Python<'_>, steps: u64, watched: bool, tell: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let simulation = &mut self.assembly.simulation;
        let last = simulation.steps_done().saturating_add(steps);
        if let Some(cycle) = &simulation.parameters().cycle {
            let (end, most) = (cycle.duration(), simulation.steps_until(cycle.duration()));
            if last > most {
                return Err(raise(py, &[], Failure::input(format!("the cycle ends at {end} s, after step {most}"))));
            }
        }
        let mut count = 1;
        while simulation.steps_done() < last {
            let next = last.min(simulation.steps_done().saturating_add(count));
            let start = Instant::now();
            let taken = py.detach(|| if watched { simulation.advance_to(next) } else { simulation.pass_to(next) });
            taken.map_err(|error| {
                self.failed = Some(error.to_string());
                raise(py, &[], error.into())
            })?;
            py.check_signals()?;
            if let Some(tell) = tell {
                tell.call1((steps + simulation.steps_done() - last, steps))?;
            }
            count = adapted(count, start.elapsed());
        }
        Ok(())
    }
}

impl Simulation {
    fn of(inner: Inner) -> Self {
        Self { inner: Mutex::new(Some(inner)), forks: FORKS.load(Ordering::Relaxed) }
    }

    /// Gives the simulation to `work`, unless another thread or process has it.
    fn with<T>(&self, py: Python<'_>, work: impl FnOnce(&mut Inner) -> Result<T, Failure>) -> PyResult<T> {
        let done = self.lock().and_then(|mut guard| {
            let inner = guard.as_mut().ok_or_else(|| Failure::run("the simulation has ended"))?;
            match &inner.failed {
                Some(error) => Err(Failure::run(format_args!("the simulation failed: {error}"))),
                None => work(inner),
            }
        });
        done.map_err(|failure| raise(py, &[], failure))
    }

    fn is_forked(&self) -> bool {
        FORKS.load(Ordering::Relaxed) != self.forks
    }

    fn lock(&self) -> Result<MutexGuard<'_, Option<Inner>>, Failure> {
        if self.is_forked() {
            let message = "this simulation is of another process, whose threads a fork does not have: save its state there, load it here";
            return Err(Failure::input(message));
        }
        match self.inner.try_lock() {
            Ok(guard) => Ok(guard),
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => Err(Failure::input(
                "another thread uses this simulation: wait until it is done, or make one for each thread",
            )),
        }
    }
}

impl Drop for Simulation {
    fn drop(&mut self) {
        // In a process that was forked nobody answers.
        if self.is_forked() {
            mem::forget(self.inner.get_mut().unwrap_or_else(PoisonError::into_inner).take());
        }
    }
}

#[pymethods]
impl Simulation {
    /// The state at t = 0.
    #[new]
    fn new(py: Python<'_>, scene: &Scene, engine: &str, tell: &Bound<'_, PyAny>) -> PyResult<Self> {
        let engine = engine_of(engine).map_err(|failure| raise(py, &[], failure))?;
        let scene = scene.0.clone();
        in_background(py, tell, &[], move |messages| Inner::new(scene, engine, messages)).map(Self::of)
    }

    /// Goes on from a saved state, with as many workers as asked for.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf, workers: Option<&str>, tell: &Bound<'_, PyAny>) -> PyResult<Self> {
        let about = path.to_string_lossy().into_owned();
        let sets: Vec<_> = workers.iter().map(|workers| format!("numerics.workers={workers}")).collect();
        let work = move |messages: &Messages| {
            let state = State::read(&path)?;
            let scene = scenes::of_layers(Path::new("scene"), Some(&state.scene), &[&sets]).map_err(Failure::input)?;
            let mut inner = Inner::new(scene, state.simulation.run.engine(), messages)?;
            inner.restore(&state).map(|()| inner)
        };
        in_background(py, tell, &[&about], work).map(Self::of)
    }

    /// Writes the state to a file.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        self.with(py, |inner| {
            py.detach(|| {
                inner.keep_contact()?;
                let state = inner.assembly.checkpoint()?;
                State::new(&inner.scene, &inner.inputs, state).write(&path)
            })
        })
    }

    /// Takes so many steps; pressures of the last are kept if it is watched.
    #[pyo3(signature = (steps, watch=true, tell=None))]
    fn advance(&self, py: Python<'_>, steps: u64, watch: bool, tell: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        self.with(py, |inner| Ok(inner.advance(py, steps, watch, tell)))?
    }

    /// Steps that are done when a time (s) is reached.
    fn steps_until(&self, py: Python<'_>, time: f64) -> PyResult<u64> {
        self.with(py, |inner| Ok(inner.assembly.simulation.steps_until(time)))
    }

    /// Steps done.
    #[getter]
    fn steps(&self, py: Python<'_>) -> PyResult<u64> {
        self.with(py, |inner| Ok(inner.assembly.simulation.steps_done()))
    }

    /// t, s.
    #[getter]
    fn time(&self, py: Python<'_>) -> PyResult<f64> {
        self.with(py, |inner| Ok(inner.assembly.simulation.time()))
    }

    /// Load (N, or N m), rotational speed (rad/s), and whether the load is a braking torque.
    #[getter]
    fn operation(&self, py: Python<'_>) -> PyResult<(f64, f64, bool)> {
        self.with(py, |inner| {
            let parameters = inner.assembly.simulation.parameters();
            Ok((parameters.normal_force, parameters.angular_velocity, parameters.by_torque))
        })
    }

    /// Sets load and speed of the coming steps.
    fn operate(&self, py: Python<'_>, load: f64, speed: f64) -> PyResult<()> {
        self.with(py, |inner| Ok(inner.assembly.simulation.operate(load, speed)?))
    }

    /// Rows, disc columns, pin columns, the angle of a column (rad), and the disc column under pin column 0 in the coming step.
    #[getter]
    fn mesh(&self, py: Python<'_>) -> PyResult<(usize, usize, usize, f64, usize)> {
        self.with(py, |inner| {
            let simulation = &inner.assembly.simulation;
            let mesh = &simulation.parameters().mesh;
            let first = mesh.disc_column(0, simulation.steps_done());
            Ok((mesh.rows(), mesh.disc_columns(), mesh.pin_columns(), mesh.column_angle(), first))
        })
    }

    /// Radius (m) and area of a cell (m²) of every row.
    #[getter]
    fn rows(&self, py: Python<'_>) -> PyResult<(Vec<f64>, Vec<f64>)> {
        self.with(py, |inner| {
            let mesh = &inner.assembly.simulation.parameters().mesh;
            Ok((mesh.radius().to_vec(), mesh.area().to_vec()))
        })
    }

    /// Engine and number of workers.
    #[getter]
    fn execution(&self, py: Python<'_>) -> PyResult<(&'static str, usize)> {
        self.with(py, |inner| {
            let execution = inner.assembly.simulation.execution();
            Ok((execution.engine.name(), execution.workers))
        })
    }

    /// The resolved scene.
    #[getter]
    fn scene(&self, py: Python<'_>) -> PyResult<Scene> {
        self.with(py, |inner| Ok(Scene(inner.scene.clone())))
    }

    /// The series after the last step, by name.
    #[pyo3(signature = () -> "dict[str, float]")]
    fn sample<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (sample, quantities) = self.with(py, |inner| {
            let extras = inner.scene.extras(false);
            Ok((
                py.detach(|| inner.assembly.last_sample()).map_err(not_reported)?,
                quantities(&extras).collect::<Vec<_>>(),
            ))
        })?;
        let row = PyDict::new(py);
        row.set_item("step", sample.step)?;
        row.set_item("time", sample.time)?;
        for quantity in quantities {
            row.set_item(quantity.name, quantity.value(&sample))?;
        }
        Ok(row)
    }

    /// Name, unit and meaning of each series.
    fn quantities(&self, py: Python<'_>) -> PyResult<Vec<(&'static str, &'static str, &'static str)>> {
        self.with(py, |inner| {
            let extras = inner.scene.extras(false);
            Ok(quantities(&extras).map(|quantity| (quantity.name, quantity.unit, quantity.long_name)).collect())
        })
    }

    /// Bytes of a field, which are Python's own.
    fn field<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = self.with(py, |inner| py.detach(|| bytes(&mut inner.assembly.simulation, name)))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Takes over heights, m: of disc and its substrate, of pin and its substrate, each unless None.
    fn set_heights(&self, py: Python<'_>, given: [Option<Bound<'_, PyAny>>; 4]) -> PyResult<()> {
        let mut fields = [const { None }; 4];
        for (place, array) in fields.iter_mut().zip(&given) {
            *place = array.as_ref().map(numbers).transpose()?;
        }
        self.with(py, |inner| {
            py.detach(|| {
                inner.keep_contact()?;
                let simulation = &mut inner.assembly.simulation;
                let all = heights(simulation, fields)?;
                Ok(simulation.set_heights(all)?)
            })
        })
    }
}

/// The engine of a name.
pub fn engine_of(name: &str) -> Result<Engine, Failure> {
    let found = [Engine::Fast, Engine::Plain].into_iter().find(|engine| engine.name() == name);
    found.ok_or_else(|| Failure::input(format!("engine {name:?}: expected \"fast\" or \"plain\"")))
}

/// Failure to report a step, in words of Python where it was not watched.
fn not_reported(error: SimulationError) -> Failure {
    match error {
        SimulationError::NotWatched { step } => {
            Failure::input(format!("the pressures of step {step} were not kept: advance with watch=True"))
        }
        error => error.into(),
    }
}

/// Bytes of a field, column by column: doubles, or of statuses and bases one byte each.
fn bytes(simulation: &mut simulation::Simulation, name: &str) -> Result<Vec<u8>, Failure> {
    if name == "pin_base" {
        let mut base: Vec<u8> = simulation.pin_base().iter().map(|base| *base as u8).collect();
        simulation.parameters().mesh.absent_cells().for_each(|cell| base[cell] = ABSENT);
        return Ok(base);
    }
    let map = Map::ALL.into_iter().find(|map| map.name() == name);
    let map = map.ok_or_else(|| Failure::input(format!("there is no field {name}")))?;
    let found = simulation.snapshot(&[map]).map_err(not_reported)?.maps.into_iter().next();
    Ok(match found.map(|(_, values)| values) {
        Some(MapValues::Float(values)) => values.iter().flat_map(|value| value.to_ne_bytes()).collect(),
        Some(MapValues::Status(statuses)) => statuses,
        None => Vec::new(),
    })
}

/// The heights of a simulation, some of them replaced by those that Python gives: disc and substrate, pin and substrate.
fn heights(simulation: &mut simulation::Simulation, given: [Option<Vec<f64>>; 4]) -> Result<Heights, SimulationError> {
    let (disc, pin) = (simulation.disc()?, simulation.pin()?);
    let [disc_height, disc_substrate, pin_height, pin_substrate] = given;
    Ok(Heights {
        disc_height: disc_height.unwrap_or(disc.height),
        disc_substrate: disc_substrate.unwrap_or(disc.substrate),
        pin_height: pin_height.unwrap_or(pin.height),
        pin_substrate: pin_substrate.unwrap_or(pin.substrate),
    })
}

/// Numbers of an array of doubles of Python, in the order of C.
fn numbers(array: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    PyBuffer::get(array)?.to_vec(array.py())
}
