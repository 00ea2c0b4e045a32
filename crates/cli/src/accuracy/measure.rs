//! One run, made and measured.

use std::fmt;
use std::time::Instant;

use plateau_core::observe::{Map, MapValues, Sample, Snapshot};
use plateau_core::simulation::{Simulation, SimulationError};
use plateau_run::{Assembly, Observer, RunError, Sink};

use super::history::History;
use super::outcome::{End, Heights, Outcome};

/// Why a run did not come to its end.
#[derive(Debug)]
pub enum Unfinished {
    /// It could not be put together, or a step failed.
    Failed(RunError),
    /// A quantity became infinite or no number.
    NotFinite {
        /// The step after which that was seen.
        step: u64,
    },
    /// This signal asked the program to stop.
    Stopped(u8),
}

impl From<RunError> for Unfinished {
    fn from(error: RunError) -> Self {
        Self::Failed(error)
    }
}

impl From<SimulationError> for Unfinished {
    fn from(error: SimulationError) -> Self {
        Self::Failed(error.into())
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

/// Takes the steps of a run that is compared over so many windows, and keeps what is compared.
///
/// # Errors
/// [`Unfinished`].
pub fn measure(mut assembly: Assembly, windows: usize, observer: &mut dyn Observer) -> Result<Outcome, Unfinished> {
    let (history, last, heights) = (History::start(), Sample::default(), Heights::default());
    let mut record = Record { observer, windows, history, last, heights };
    let start = Instant::now();
    assembly.run_to_end(&mut record)?;
    let wall_time = Some(start.elapsed().as_secs_f64());
    let Record { history, last, heights, .. } = record;
    let end = End::of(&last, assembly.simulation.course().largest_load_residual);
    Ok(Outcome { steps: assembly.simulation.steps_done(), wall_time, history, end, heights })
}

/// Keeps what is compared.
struct Record<'a> {
    observer: &'a mut dyn Observer,
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
        self.observer.progress(simulation);
        self.observer.asked_to_stop().map_or(Ok(steps), |signal| Err(Unfinished::Stopped(signal)))
    }
}
