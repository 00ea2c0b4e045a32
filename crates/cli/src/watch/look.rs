//! A look at a run file at one moment, the pace of its run, and whether the run still goes on.

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
    /// Its mean over the last revolution, m².
    pub contact_area_mean: Vec<f64>,
    /// Filled fraction of the last sample.
    pub filled_fraction: Option<f64>,
    /// Wall time from the start of the run to its end, or to what was written last.
    pub elapsed: Option<Duration>,
    /// Wall time since something was written.
    pub age: Duration,
}

impl Look {
    /// Looks at a run file.
    ///
    /// # Errors
    /// [`ReadError`]; a file that is closed at this very moment may look damaged.
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
/// As many usual intervals between samples must pass without one.
const INTERVALS: u32 = 10;

/// Pace of a run, and the time without anything new, from one look to the next.
#[derive(Debug)]
pub struct Pace {
    /// Wall times of looks and the simulated times that they found, s.
    seen: VecDeque<(Instant, f64)>,
    samples: usize,
    news: Instant,
    /// Samples have come while it was watched.
    alive: bool,
}

impl Pace {
    /// Before the first look.
    pub fn new(now: Instant) -> Self {
        Self { seen: VecDeque::new(), samples: 0, news: now, alive: false }
    }

    /// Takes note of a look.
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

    /// Time for which there has been no new sample while it was watched.
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
mod tests {
    use std::f64::consts::TAU;
    use std::time::Duration;

    use plateau_core::model::mesh::Mesh;
    use plateau_io::run_file::State;

    use super::*;

    #[test]
    fn a_finished_run_is_done_however_its_last_time_is_rounded() {
        let look = |state| Look {
            title: "a run".into(),
            state,
            error: None,
            times: vec![60.0 * (1.0 - 1e-15)],
            duration: Some(60.0),
            contact_area: vec![1e-6],
            contact_area_mean: vec![1e-6],
            filled_fraction: None,
            elapsed: None,
            age: Duration::ZERO,
        };
        assert_eq!(look(State::Finished).progress(), Some(1.0));
        assert!(look(State::Interrupted).progress() < Some(1.0));
    }

    fn of(operation: &str) -> Option<f64> {
        let scene = format!("[operation]\n{operation}\n[numerics]\ntime_acceleration = 20.0\n");
        duration(&scene.parse().unwrap(), &Mesh::new(4, 100, 5, 1.0, 3.0).unwrap())
    }

    #[test]
    fn is_given_or_follows_from_the_steps() {
        assert_eq!(of("duration = \"2 ms\""), Some(2e-3));
        // 100 steps are one revolution, at 60 rpm 1 s, and each stands for 20.
        let revolution = of("steps = 100\nrotational_speed = \"60 rpm\"").unwrap();
        assert!((revolution - 20.0).abs() < 1e-12, "{revolution}");
        // One revolution at the mean radius of 2 m is a way of 4 pi m.
        let revolution = of("steps = 100\nsliding_speed = \"2 m/s\"").unwrap();
        assert!((revolution - 20.0 * TAU).abs() < 1e-12, "{revolution}");
        assert_eq!(of("steps = 100"), None);
    }

    fn look(samples: usize, elapsed: u64, age: u64) -> Look {
        Look {
            title: "a run".into(),
            state: State::Running,
            error: None,
            times: (1..=samples).map(|sample| sample as f64).collect(),
            duration: Some(100.0),
            contact_area: vec![1e-6; samples],
            contact_area_mean: vec![1e-6; samples],
            filled_fraction: None,
            elapsed: Some(Duration::from_secs(elapsed)),
            age: Duration::from_secs(age),
        }
    }

    #[test]
    fn speed_is_that_since_the_start_and_later_that_of_the_last_half_minute() {
        let start = Instant::now();
        let mut pace = Pace::new(start);
        pace.note(&look(20, 10, 0), start);
        assert_eq!(pace.speed(&look(20, 10, 0)), Some(2.0));
        pace.note(&look(80, 20, 0), start + Duration::from_secs(10));
        assert_eq!(pace.speed(&look(80, 20, 0)), Some(6.0));
        assert_eq!(Pace::new(start).speed(&look(0, 10, 0)), None);
    }

    #[test]
    fn a_run_without_news_may_have_been_killed() {
        let start = Instant::now();
        let mut pace = Pace::new(start);
        // Written an hour ago, as far as the clocks agree.
        let old = look(20, 10, 3600);
        pace.note(&old, start);
        assert_eq!(pace.silence(&old, start), Some(Duration::from_secs(3600)));
        // It grows after all.
        let grown = look(21, 3610, 3600);
        pace.note(&grown, start + Duration::from_secs(5));
        assert_eq!(pace.silence(&grown, start + Duration::from_secs(6)), None);
        // One sample in 10 min until now: a minute without one says nothing.
        let slow = look(6, 3600, 0);
        let mut pace = Pace::new(start);
        pace.note(&slow, start);
        assert_eq!(pace.silence(&slow, start + Duration::from_secs(300)), None);
        assert_eq!(pace.silence(&slow, start + Duration::from_secs(6000)), Some(Duration::from_secs(6000)));
    }
}
