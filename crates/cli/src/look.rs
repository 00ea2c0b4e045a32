//! A run file at one moment, and the pace of its run.

use std::collections::VecDeque;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant, SystemTime};

use plateau_core::model::mesh::Mesh;
use plateau_io::run_file::{ReadError, RunFile, State};
use plateau_io::text::shown_title;
use plateau_io::units::{self, Dimension};

/// Content of a run file at one moment.
#[derive(Debug, Clone)]
pub struct Look {
    /// Title of the scene.
    pub title: String,
    /// End of the run, if it has ended.
    pub state: State,
    /// Reason why it failed, if it did.
    pub error: Option<String>,
    /// Simulated times of the samples, s.
    pub times: Vec<f64>,
    /// Simulated time at which the run will be finished, s.
    pub duration: Option<f64>,
    /// Contact area of every sample, m².
    pub contact_area: Vec<f64>,
    /// Contact area of every sample, mean over the last revolution, m².
    pub contact_area_mean: Vec<f64>,
    /// Filled fraction of the last sample, 1.
    pub filled_fraction: Option<f64>,
    /// Wall time from the start of the run to its end, or to what was written last.
    pub elapsed: Option<Duration>,
    /// Wall time since something was written.
    pub age: Duration,
}

impl Look {
    /// Looks at a run file.
    pub fn at(path: &Path) -> Result<Self, ReadError> {
        let run = RunFile::open(path)?;
        let values = |name| run.values(name).map(Option::unwrap_or_default);
        let written = fs::metadata(path).and_then(|file| file.modified()).unwrap_or_else(|_| SystemTime::now());
        let wall_time = run.number("wall_time").and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
        let since_start = || written.duration_since(run.start_time()?).ok();
        Ok(Self {
            title: shown_title(run.title()).into_owned(),
            state: run.state(),
            error: run.attribute("error"),
            times: run.time().to_vec(),
            duration: duration(run.scene(), run.mesh()),
            contact_area: values("contact_area")?,
            contact_area_mean: values("contact_area_mean")?,
            filled_fraction: values("filled_fraction")?.last().copied(),
            elapsed: wall_time.or_else(since_start),
            age: SystemTime::now().duration_since(written).unwrap_or_default(),
        })
    }

    /// Simulated time of the last sample, s.
    pub fn time(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// Part of the run that is done, 0 to 1.
    pub fn progress(&self) -> Option<f64> {
        let duration = self.duration.filter(|duration| *duration > 0.0)?;
        // The time of the last step may be rounded to a little less than was asked for.
        Some(if self.state == State::Finished { 1.0 } else { (self.time() / duration).clamp(0.0, 1.0) })
    }
}

/// Simulated time of the whole run, s, from its scene: given, or as a number of steps.
fn duration(scene: &toml::Table, mesh: &Mesh) -> Option<f64> {
    let value = |section: &str, key: &str| scene.get(section)?.get(key);
    let quantity = |key, dimension| units::parse(value("operation", key)?.as_str()?, dimension).ok();
    if let Some(duration) = quantity("duration", Dimension::Time) {
        return Some(duration);
    }
    let steps = value("operation", "steps")?.as_integer()? as f64;
    let angular_velocity = quantity("rotational_speed", Dimension::RotationalSpeed)
        .or_else(|| Some(quantity("sliding_speed", Dimension::Speed)? / mesh.mean_radius()))?;
    let acceleration = match value("numerics", "time_acceleration") {
        Some(number) => number.as_float().or_else(|| number.as_integer().map(|number| number as f64))?,
        None => 1.0,
    };
    Some(steps * acceleration * mesh.column_angle() / angular_velocity)
}

/// Wall time over which the speed is taken.
const WINDOW: Duration = Duration::from_secs(30);
/// Wall time between two looks that tells a speed, at least.
const SHORTEST: Duration = Duration::from_secs(2);
/// Wall time without a sample after which a run may have been killed, at least.
const PATIENCE: Duration = Duration::from_secs(60);
/// Number of usual intervals between samples that must pass without one.
const INTERVALS: u32 = 10;

/// Pace of a run, and the time without anything new, from one look to the next.
#[derive(Debug)]
pub struct Pace {
    /// Wall times of looks and the simulated times that they found, s.
    seen: VecDeque<(Instant, f64)>,
    samples: usize,
    news: Instant,
    /// True if samples have come while it was watched.
    alive: bool,
}

impl Pace {
    /// Starts the pace before the first look.
    pub fn new(now: Instant) -> Self {
        Self { seen: VecDeque::new(), samples: 0, news: now, alive: false }
    }

    pub fn note(&mut self, look: &Look, now: Instant) {
        if self.seen.back().is_some_and(|(_, time)| look.time() < *time) {
            // Another run has taken the place of the file.
            *self = Self::new(now);
        }
        if look.times.len() != self.samples {
            self.alive |= self.samples > 0;
            self.samples = look.times.len();
            self.news = now;
        }
        self.seen.push_back((now, look.time()));
        while self.seen.len() > 2 && self.seen.front().is_some_and(|(then, _)| now - *then > WINDOW) {
            self.seen.pop_front();
        }
    }

    /// Simulated seconds per second of wall time: lately, or since the run began; none before the first sample.
    pub fn speed(&self, look: &Look) -> Option<f64> {
        let lately = || {
            let ((start, from), (end, to)) = (*self.seen.front()?, *self.seen.back()?);
            (self.alive && end - start >= SHORTEST).then(|| (to - from) / (end - start).as_secs_f64())
        };
        let over_all = || Some(look.time() / look.elapsed?.as_secs_f64());
        lately().or_else(over_all).filter(|speed| *speed > 0.0 && speed.is_finite())
    }

    /// Time for which no new sample came while it was watched.
    pub fn idle(&self, now: Instant) -> Duration {
        now - self.news
    }

    /// Time for which there has been no new sample, where that is so long that the run may have been killed.
    pub fn silence(&self, look: &Look, now: Instant) -> Option<Duration> {
        // Clocks of two machines differ: the age of a file that is seen to grow says nothing.
        let silence = if self.alive { self.idle(now) } else { self.idle(now).max(look.age) };
        let samples = u32::try_from(look.times.len()).unwrap_or(u32::MAX).max(1);
        let usual = look.elapsed.unwrap_or_default() / samples;
        (silence >= PATIENCE.max(usual.saturating_mul(INTERVALS))).then_some(silence)
    }
}

#[cfg(test)]
#[path = "../tests/unit/look.rs"]
mod tests;
