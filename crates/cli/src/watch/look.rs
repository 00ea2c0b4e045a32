//! What a run file says at one moment.

use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime};

use plateau_core::model::mesh::Mesh;
use plateau_io::run_file::{ReadError, RunFile, State};
use plateau_io::text::shown_title;
use plateau_io::units::{self, Dimension};

/// What a run file says at one moment.
#[derive(Debug, Clone)]
pub struct Look {
    /// Title of the scene.
    pub title: String,
    /// How the run ended, if it did.
    pub state: State,
    /// Why it failed, if it did.
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

    /// How much of the run is done, 0 to 1.
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

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use std::time::Duration;

    use plateau_core::model::mesh::Mesh;
    use plateau_io::run_file::State;

    use super::{Look, duration};

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
}
