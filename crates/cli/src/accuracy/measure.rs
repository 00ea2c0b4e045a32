//! One run, made and measured.

use std::fmt;
use std::time::Instant;

use plateau_core::acceleration::scout::Scout;
use plateau_core::observe::schedule::{self, SampleEvery, Schedule};
use plateau_core::observe::{Map, MapValues, Sample, Snapshot};
use plateau_core::simulation::{Simulation, SimulationError};
use plateau_io::scene::recipe::OutputRecipe;

use super::history::History;
use super::outcome::{End, Heights, Outcome};
use super::windows::Windows;
use crate::drive::{Sink, drive};
use crate::interrupt::Interrupt;
use crate::progress::Progress;

/// Why a run did not come to its end.
#[derive(Debug)]
pub enum Unfinished {
    /// A step failed.
    Failed(SimulationError),
    /// A quantity became infinite or no number.
    NotFinite {
        /// The step after which that was seen.
        step: u64,
    },
    /// This signal asked the program to stop.
    Stopped(u8),
}

impl From<SimulationError> for Unfinished {
    fn from(error: SimulationError) -> Self {
        Self::Failed(error)
    }
}

impl fmt::Display for Unfinished {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Failed(error) => error.fmt(f),
            Self::NotFinite { step } => write!(f, "contact area or heights were no finite numbers after step {step}"),
            Self::Stopped(signal) => write!(f, "stopped by signal {signal}"),
        }
    }
}

/// Runs a simulation for `duration` (s); `name` is shown meanwhile. With a scout it chooses its acceleration.
///
/// # Errors
/// [`Unfinished`].
pub fn measure(
    simulation: &mut Simulation,
    mut scout: Option<Scout>,
    duration: f64,
    windows: &Windows,
    name: &str,
    interrupt: &Interrupt,
) -> Result<Outcome, Unfinished> {
    let parameters = simulation.parameters().clone();
    let output = OutputRecipe {
        file: std::path::PathBuf::new(),
        sample_every: SampleEvery::Time(windows.width),
        maps_at: Vec::new(),
        maps: vec![Map::DiscHeight, Map::PinHeight],
        extras: Vec::new(),
        checkpoint_every: f64::INFINITY,
    };
    let end = if scout.is_some() {
        schedule::End::Time(duration)
    } else {
        schedule::End::Steps(parameters.steps_of(duration))
    };
    let schedule = Schedule::new(parameters.clock(), end, output.sample_every, &output.maps_at);
    let mut record = Record {
        progress: Progress::named(duration, name),
        interrupt,
        windows: windows.count,
        history: History::start(),
        last: Sample::default(),
        heights: Heights::default(),
    };
    let start = Instant::now();
    let driven = drive(simulation, scout.as_mut(), schedule, &output, &mut record);
    let wall_time = start.elapsed().as_secs_f64();
    record.progress.finish();
    driven?;
    Ok(Outcome {
        steps: simulation.steps_done(),
        wall_time,
        history: record.history,
        end: End::of(&record.last, simulation.course().largest_load_residual),
        heights: record.heights,
    })
}

/// Keeps what is compared.
struct Record<'a> {
    progress: Progress,
    interrupt: &'a Interrupt,
    windows: usize,
    history: History,
    last: Sample,
    heights: Heights,
}

impl Sink for Record<'_> {
    type Error = Unfinished;

    fn sample(&mut self, sample: Sample) -> Result<(), Unfinished> {
        if !(sample.contact_area_integral.is_finite() && sample.filled_fraction.is_finite()) {
            return Err(Unfinished::NotFinite { step: sample.step });
        }
        // What comes after the last window is its end.
        if self.history.moments() < self.windows {
            self.history.record(sample.time, sample.contact_area_integral, sample.filled_fraction);
        }
        self.last = sample;
        Ok(())
    }

    fn snapshot(&mut self, snapshot: Snapshot) -> Result<(), Unfinished> {
        for (map, values) in snapshot.maps {
            let MapValues::Float(heights) = values else { continue };
            match map {
                Map::DiscHeight => self.heights.disc = Some(heights),
                Map::PinHeight => self.heights.pin = Some(heights),
                _ => {}
            }
        }
        Ok(())
    }

    fn look(&mut self, simulation: &Simulation, steps: u64) -> Result<u64, Unfinished> {
        self.progress.show(simulation);
        self.interrupt.signal().map_or(Ok(steps), |signal| Err(Unfinished::Stopped(signal)))
    }
}
