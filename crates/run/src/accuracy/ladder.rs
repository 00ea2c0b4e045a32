//! Ladders: runs of a scene with one of its keys set to several values.

use std::path::PathBuf;

use plateau_io::scene::{self, Scene, SceneError};

/// Time accelerations that are tried, besides the scene's own: they have small common multiples, so that there are windows
/// of whole revolutions of all of them.
const TIME_ACCELERATIONS: [f64; 10] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0];
/// Fewest simulated revolutions of a run.
const FEWEST_REVOLUTIONS: f64 = 8.0;
/// Tolerances of a run that chooses its acceleration that are tried, besides the scene's own.
const TOLERANCES: [f64; 5] = [0.002, 0.005, 0.01, 0.02, 0.05];
/// Largest acceleration of such a run, unless the scene says another.
const LARGEST: f64 = 1000.0;
/// Parts of themselves by which initial heights are changed.
const PERTURBATIONS: [f64; 3] = [1e-9, 1e-6, 1e-4];

/// Runs that differ in one key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Ladder {
    /// Revolutions that a simulated one stands for.
    TimeAcceleration,
    /// Accelerations that the run chooses itself, by the error that it may make.
    Tolerance,
    /// The reference anew with initial heights that differ a little: how much of the errors is chance.
    Perturbation,
}

impl Ladder {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::TimeAcceleration, Self::Tolerance, Self::Perturbation];

    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::TimeAcceleration => "time_acceleration",
            Self::Tolerance => "tolerance",
            Self::Perturbation => "perturbation",
        }
    }
}

/// Place of a run on its ladder, with the value of what the ladder changes.
pub type Step = (Ladder, f64);

/// Time accelerations of a scene, increasing: 1, the scene's own, and others with which there are enough revolutions.
pub fn time_accelerations(own: f64, revolutions: f64) -> Vec<f64> {
    let room = |acceleration: &f64| *acceleration == 1.0 || revolutions / acceleration >= FEWEST_REVOLUTIONS;
    sorted(TIME_ACCELERATIONS.into_iter().filter(room).chain([own]))
}

/// Steps of these ladders that a reference with the time acceleration `reference` judges: coarser runs, or the reference with
/// other heights. A run that chooses its acceleration begins with 1, so that nothing but the model itself is finer.
pub fn steps(ladders: &[Ladder], accelerations: &[f64], own_tolerance: Option<f64>, reference: f64) -> Vec<Step> {
    let values = |ladder: Ladder| match ladder {
        Ladder::TimeAcceleration => accelerations.iter().copied().filter(|other| *other > reference).collect(),
        Ladder::Tolerance if reference == 1.0 => sorted(TOLERANCES.into_iter().chain(own_tolerance)),
        Ladder::Tolerance => Vec::new(),
        Ladder::Perturbation => PERTURBATIONS.to_vec(),
    };
    ladders.iter().flat_map(|ladder| values(*ladder).into_iter().map(|value| (*ladder, value))).collect()
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

/// A scene file with changes, from which every run of a ladder differs in the keys that its rung sets.
#[derive(Debug, Clone)]
pub struct Base {
    /// The scene file.
    pub path: PathBuf,
    /// Changes, as after `--set`.
    pub sets: Vec<String>,
    /// What they make together.
    pub scene: Scene,
}

/// One run of a ladder.
#[derive(Debug, Clone)]
pub struct Rung {
    /// The ladder.
    pub ladder: Ladder,
    /// Value of what it changes.
    pub value: f64,
    /// Changes of the base, as after `--set`.
    sets: Vec<String>,
    /// The scene with them.
    pub scene: Scene,
}

impl Rung {
    /// Reads the scene of a step; `reference` is the time acceleration of the reference.
    ///
    /// # Errors
    /// [`SceneError`] when the scene does not take these values.
    pub fn new(base: &Base, (ladder, value): Step, reference: f64) -> Result<Self, SceneError> {
        let accelerated = |acceleration: f64| format!("numerics.time_acceleration = {acceleration}");
        let sets = match ladder {
            Ladder::TimeAcceleration => vec![accelerated(value)],
            Ladder::Tolerance => {
                let largest = base.scene.adaptive.map_or(LARGEST, |adaptive| adaptive.largest);
                vec![format!("numerics.time_acceleration = {{ tolerance = {value}, max = {largest} }}")]
            }
            Ladder::Perturbation => {
                let scale = base.scene.disc_surface.preparation.scale * (1.0 + value);
                vec![accelerated(reference), format!("disc.prepare.scale = {scale}")]
            }
        };
        let scene = scene::load(&base.path, &[&base.sets[..], &sets].concat())?;
        let rung = Self { ladder, value, sets, scene };
        Ok(rung.lasting(base.scene.duration))
    }

    /// The same for so much physical time (s): a number of steps is another time with another acceleration.
    #[must_use]
    pub fn lasting(mut self, duration: f64) -> Self {
        self.scene.duration = duration;
        self.scene.steps = self.scene.parameters.steps_of(duration);
        self
    }

    /// Keys and values that make this run, as a scene has them.
    pub fn setting(&self) -> String {
        self.sets.join(", ").replace("numerics.", "")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn base(sets: &[&str]) -> Base {
        let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/scenes/quick.toml"));
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        let scene = scene::load(&path, &sets).unwrap();
        Base { path, sets, scene }
    }

    #[test]
    fn a_scene_has_the_accelerations_that_its_revolutions_allow() {
        assert_eq!(time_accelerations(20.0, 850.0), [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]);
        assert_eq!(time_accelerations(7.5, 16.0), [1.0, 2.0, 7.5]);
        assert_eq!(time_accelerations(1.0, 0.1), [1.0]);
    }

    #[test]
    fn steps_are_coarser_than_the_reference() {
        let accelerations = [1.0, 5.0, 20.0, 50.0];
        let values = |ladder, own, reference| -> Vec<f64> {
            steps(&[ladder], &accelerations, own, reference).into_iter().map(|(_, value)| value).collect()
        };
        assert_eq!(values(Ladder::TimeAcceleration, None, 1.0), [5.0, 20.0, 50.0]);
        assert_eq!(values(Ladder::TimeAcceleration, None, 7.0), [20.0, 50.0]);
        assert!(values(Ladder::TimeAcceleration, None, 50.0).is_empty());
        assert_eq!(values(Ladder::Tolerance, Some(0.03), 1.0), [0.002, 0.005, 0.01, 0.02, 0.03, 0.05]);
        assert!(values(Ladder::Tolerance, Some(0.03), 2.0).is_empty());
        assert_eq!(values(Ladder::Perturbation, None, 7.0), PERTURBATIONS);
    }

    #[test]
    fn a_rung_is_the_scene_with_some_keys_set() {
        let base = base(&["disc.prepare.scale=0.5", "numerics.time_acceleration={ tolerance = 0.1, max = 30 }"]);
        let rung = |step, reference| Rung::new(&base, step, reference).unwrap();
        let fixed = rung((Ladder::TimeAcceleration, 7.5), 1.0);
        assert_eq!(fixed.setting(), "time_acceleration = 7.5");
        assert!(fixed.scene.adaptive.is_none() && fixed.scene.parameters.time_acceleration == 7.5);
        let chosen = rung((Ladder::Tolerance, 0.02), 1.0);
        assert_eq!(chosen.setting(), "time_acceleration = { tolerance = 0.02, max = 30 }");
        assert_eq!(chosen.scene.adaptive.unwrap().tolerance, 0.02);
        let perturbed = rung((Ladder::Perturbation, 1e-4), 2.0);
        assert_eq!(perturbed.setting(), "time_acceleration = 2, disc.prepare.scale = 0.50005");
        assert_eq!(perturbed.scene.disc_surface.preparation.scale, 0.50005);
    }

    #[test]
    fn runs_with_a_number_of_steps_are_as_long_as_the_scene() {
        let base = base(&["operation.steps=690"]);
        let rung = Rung::new(&base, (Ladder::TimeAcceleration, 10.0), 1.0).unwrap();
        // The scene has 20.
        assert_eq!((rung.scene.duration, rung.scene.steps), (base.scene.duration, 1380));
        let refused = Rung::new(&base, (Ladder::Tolerance, 0.01), 1.0).unwrap_err();
        assert!(refused.to_string().contains("give operation.duration"), "{refused}");
        let half = rung.clone().lasting(0.5 * rung.scene.duration);
        assert!(half.scene.steps.abs_diff(rung.scene.steps / 2) <= 1, "{}", half.scene.steps);
    }
}
