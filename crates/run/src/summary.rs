//! Results of a finished run, in numbers.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Instant;

use plateau_core::acceleration::Chosen;
use plateau_core::model::accounts::AccountsReport;
use plateau_core::observe::Sample;
use plateau_core::observe::extra::{Extra, OF_BRAKES};
use plateau_core::observe::running_in::{Drift, NotDefined};
use plateau_core::observe::window_mean::WindowMean;
use plateau_io::memory;
use plateau_io::run_file::{NoDrift, ReadError, RunFile, WriterReport};
use plateau_io::scene::{Scene, Warning};
use serde::{Serialize, Serializer};

use crate::assembly::Assembly;

/// Results of a finished run. Quantities of the contact are those of the last step unless said otherwise.
#[derive(Debug, Serialize)]
pub struct RunSummary {
    /// Title of the scene.
    pub title: String,
    /// Steps of reading, making and preparing the surfaces, one a line.
    pub surfaces: Vec<String>,
    /// The run file.
    pub file: PathBuf,
    /// Size of the run file, bytes.
    pub file_size: u64,
    /// Steps of the run.
    pub steps: u64,
    /// Simulated time, s.
    pub time: f64,
    /// Wall time in this process, s.
    pub wall_time: f64,
    /// Steps of this process over that time, 1/s.
    pub steps_per_second: f64,
    /// Number of times that the load was looked for in a step, mean.
    pub load_evaluations_per_step: f64,
    /// Time for which the simulation waited for the run file, s.
    pub writer_wait: f64,
    /// Largest memory that this process held, bytes, where the system tells.
    pub peak_memory: Option<u64>,
    /// Contact area, m².
    pub contact_area: f64,
    /// Contact area, mean over the last simulated revolution, m².
    pub contact_area_mean: f64,
    /// Contact area, mean over the last tenth of the run, m², where there are enough samples.
    pub contact_area_last_tenth: Option<WindowMean>,
    /// Change of the mean contact area in the second half of the run, where that can be told.
    pub contact_area_drift: Option<Drift>,
    /// Time at which the contact area has come to 90 % of its value at the end of the run, s, where that is defined.
    pub running_in_time: Option<f64>,
    /// The same two, or why there are none.
    #[serde(skip)]
    pub running_in: (Result<Drift, NoDrift>, Result<f64, NotDefined>),
    /// Time acceleration, where the run chose it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_acceleration: Option<Chosen>,
    /// Contact area as a part of the pin's, 1.
    pub contact_ratio: f64,
    /// Mean pressure in contact, Pa.
    pub mean_pressure: f64,
    /// Largest pressure, Pa.
    pub max_pressure: f64,
    /// Filled fraction of the disc, 1.
    pub filled_fraction: f64,
    /// Area fraction of the disc with any build-up.
    pub disc_secondary: f64,
    /// Area fraction of the pin with any build-up.
    pub pin_secondary: f64,
    /// Area of the simulated pin, m²: all volumes, work, heat, masses and particles are of it, not of a brake.
    pub pin_area: f64,
    /// Worn volume of both bodies, m³.
    pub worn: f64,
    /// Worn volume of the whole pin, plateaus and resin, m³.
    pub worn_whole_pin: f64,
    /// Part of it that was worn off plateaus, m³.
    pub worn_pin: f64,
    /// Volume that the whole pin has lost, m³: what a balance tells, for build-up is weighed with the pin.
    pub lost_pin: f64,
    /// The same per load and sliding distance at the mean radius, 1/Pa; none before the first step.
    pub specific_wear_rate_whole_pin: Option<f64>,
    /// Debris that left the contact, m³.
    pub emitted: f64,
    /// Friction, heat and emission.
    #[serde(flatten)]
    pub accounts: AccountsSummary,
    /// Quantities of the whole brake at the end, by their series; of a scene with a brake.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub brake: BTreeMap<&'static str, f64>,
    /// Largest load residual of any step, relative.
    pub load_residual: f64,
    /// Load residual that the scene allows, relative.
    pub load_tolerance: f64,
    /// Residual of the debris balance, relative.
    pub balance_residual: f64,
    /// Values of the scene that can hardly be meant.
    pub warnings: Vec<Warning>,
}

/// Friction, heat and emission at the end of a run, where the scene asks for them.
#[derive(Debug, Clone, Copy)]
pub struct AccountsSummary {
    /// The accounts of the last sample.
    pub last: AccountsReport,
    /// Largest mean temperature of the disc at a sample, K.
    pub largest_disc_temperature: Option<f64>,
}

impl Serialize for AccountsSummary {
    /// Gives each quantity a name of its own, and leaves out what the scene does not ask for.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let AccountsReport { friction, heat, emission } = self.last;
        let values = [
            ("friction_coefficient_mean", friction.map(|friction| friction.coefficient_mean)),
            ("friction_work", friction.map(|friction| friction.work)),
            ("contact_temperature", heat.map(|heat| heat.contact)),
            ("disc_temperature", heat.map(|heat| heat.disc)),
            ("largest_disc_temperature", self.largest_disc_temperature),
            ("pin_temperature", heat.map(|heat| heat.pin)),
            ("heat_residual", heat.map(|heat| heat.residual)),
            ("pm10_mass", emission.map(|emission| emission.pm10)),
            ("pm25_mass", emission.map(|emission| emission.pm25)),
            ("particle_number", emission.map(|emission| emission.number)),
        ];
        serializer.collect_map(values.into_iter().filter_map(|(name, value)| Some((name, value?))))
    }
}

/// Collects the values of a sample for those series of a brake that a run has.
fn of_brake(extras: &[&Extra], last: &Sample) -> BTreeMap<&'static str, f64> {
    let extras = extras.iter().copied().filter(|extra| OF_BRAKES.contains(extra));
    extras.flat_map(|extra| extra.quantities).map(|quantity| (quantity.name, quantity.value(last))).collect()
}

impl RunSummary {
    /// Puts together what was done for the surfaces and what the run file, the last sample, the simulation and the writer tell; this
    /// process `began` at such a time and step.
    pub(crate) fn new(
        scene: &Scene,
        surfaces: Vec<String>,
        file: PathBuf,
        last: &Sample,
        assembly: &Assembly,
        report: WriterReport,
        began: (Instant, u64),
    ) -> Result<Self, ReadError> {
        let made = RunFile::open(&file)?;
        let ended = made.contact_area()?;
        let largest_disc_temperature =
            made.values("disc_temperature")?.and_then(|all| all.into_iter().reduce(f64::max));
        let (course, wall_time) = (assembly.simulation.course(), began.0.elapsed().as_secs_f64());
        // With a cycle, the distance at the end counts also what of the last pause's angle no step has turned.
        let distance = scene.parameters.angle_turned(last.step, last.time) * scene.parameters.mesh.mean_radius();
        // Of a braking torque the load is known from the steps alone.
        let work = match last.accounts.friction {
            Some(friction) if scene.parameters.by_torque => friction.load_work,
            _ => scene.parameters.mean_load(last.step) * distance,
        };
        Ok(Self {
            title: scene.title.clone(),
            surfaces,
            file,
            file_size: report.bytes,
            steps: last.step,
            time: last.time,
            wall_time,
            steps_per_second: (course.steps - began.1) as f64 / wall_time,
            load_evaluations_per_step: 1.0 + course.extra_readings as f64 / course.steps as f64,
            writer_wait: report.waited.as_secs_f64(),
            peak_memory: memory::peak(),
            contact_area: last.contact_area,
            contact_area_mean: last.contact_area_mean,
            contact_area_last_tenth: ended.last_tenth,
            contact_area_drift: ended.drift.ok(),
            running_in_time: ended.running_in.ok(),
            running_in: (ended.drift, ended.running_in),
            time_acceleration: assembly.chosen_acceleration(),
            contact_ratio: last.contact_ratio,
            mean_pressure: last.mean_pressure,
            max_pressure: last.max_pressure,
            filled_fraction: last.filled_fraction,
            disc_secondary: last.disc_secondary,
            pin_secondary: last.pin_secondary,
            pin_area: scene.parameters.mesh.pin_area(),
            worn: last.worn_pin + last.worn_resin + last.worn_disc,
            worn_whole_pin: last.worn_whole_pin(),
            worn_pin: last.worn_pin,
            lost_pin: last.lost_pin(),
            specific_wear_rate_whole_pin: (work > 0.0).then(|| last.lost_pin() / work),
            emitted: last.emitted,
            accounts: AccountsSummary { last: last.accounts, largest_disc_temperature },
            brake: of_brake(&scene.extras(false), last),
            load_residual: course.largest_load_residual,
            load_tolerance: scene.load_tolerance,
            balance_residual: last.balance_residual,
            warnings: scene.warnings.clone(),
        })
    }

    /// Says where the load balance was not as exact as the scene asks for.
    pub(crate) fn inexact_load(&self) -> Option<String> {
        let (reached, asked) = (self.load_residual, self.load_tolerance);
        (reached > asked).then(|| {
            format!("the load balance reached {reached:.1e}, not {asked:.1e}: rounding of the heights allows no better")
        })
    }
}
