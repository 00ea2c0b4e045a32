//! Ladders: runs of a scene that differ in one of its numerics.

use plateau_core::acceleration::Adaptive;
use plateau_core::model::parameters::{Integrator, Parameters};
use plateau_io::scene::Scene;
use plateau_io::scene::schema::choices;

use super::coarsening::Coarsening;

/// Time accelerations that are tried, besides the scene's own: they have small common multiples, so that there are windows
/// of whole revolutions of all of them.
const TIME_ACCELERATIONS: [f64; 10] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0];
/// A run has at least so many simulated revolutions.
const FEWEST_REVOLUTIONS: f64 = 8.0;
/// How many cells of the scene's mesh go along one of a coarser mesh.
pub const COARSENINGS: [usize; 3] = [2, 4, 8];
/// Tolerances of a run that chooses its acceleration that are tried, besides the scene's own.
const TOLERANCES: [f64; 5] = [0.002, 0.005, 0.01, 0.02, 0.05];
/// Largest acceleration of such a run, unless the scene says another.
const LARGEST: f64 = 1000.0;
/// Parts of themselves by which initial heights are changed.
const PERTURBATIONS: [f64; 3] = [1e-9, 1e-6, 1e-4];

/// What runs differ in whose errors are measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Ladder {
    /// Revolutions that a simulated one stands for.
    TimeAcceleration,
    /// Accelerations that the run chooses itself, by the error that it may make.
    Tolerance,
    /// Coarser meshes, with the initial surfaces averaged.
    Mesh,
    /// The other integrator of wear.
    Integrator,
    /// The reference anew with initial heights that differ a little: how much of the errors is chance.
    Perturbation,
}

impl Ladder {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::TimeAcceleration, Self::Tolerance, Self::Mesh, Self::Integrator, Self::Perturbation];

    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::TimeAcceleration => "time_acceleration",
            Self::Tolerance => "tolerance",
            Self::Mesh => "mesh",
            Self::Integrator => "integrator",
            Self::Perturbation => "perturbation",
        }
    }
}

/// One run of a ladder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rung {
    /// The ladder.
    pub ladder: Ladder,
    /// All numerics of the run.
    pub numerics: Numerics,
}

impl Rung {
    /// What the ladder changes, as a number; an integrator is none.
    pub fn value(&self) -> f64 {
        match self.ladder {
            Ladder::TimeAcceleration => self.numerics.time_acceleration,
            Ladder::Tolerance => self.numerics.adaptive.map_or(f64::NAN, |adaptive| adaptive.tolerance),
            Ladder::Mesh => self.numerics.coarsening as f64,
            Ladder::Integrator => f64::NAN,
            Ladder::Perturbation => self.numerics.perturbation,
        }
    }

    /// What the ladder changes, in words.
    pub fn name(&self) -> String {
        match self.ladder {
            Ladder::TimeAcceleration => format!("time_acceleration = {}", self.value()),
            Ladder::Tolerance => self.numerics.acceleration(),
            Ladder::Mesh => format!("mesh coarsened {} times", self.value()),
            Ladder::Integrator => format!("integrator = \"{}\"", integrator_name(self.numerics.integrator)),
            Ladder::Perturbation => format!("disc heights times 1 + {:e}", self.value()),
        }
    }

    /// The same with the time acceleration, which no ladder but its own names.
    pub fn full_name(&self) -> String {
        match self.ladder {
            Ladder::TimeAcceleration | Ladder::Tolerance => self.name(),
            _ => format!("{}, {}", self.numerics.acceleration(), self.name()),
        }
    }
}

/// The time accelerations of a scene, increasing: 1, the scene's own, and others with which there are enough revolutions.
pub fn time_accelerations(own: f64, revolutions: f64) -> Vec<f64> {
    let room = |acceleration: &f64| *acceleration == 1.0 || revolutions / acceleration >= FEWEST_REVOLUTIONS;
    let mut accelerations: Vec<f64> = TIME_ACCELERATIONS.into_iter().filter(room).chain([own]).collect();
    accelerations.sort_by(f64::total_cmp);
    accelerations.dedup();
    accelerations
}

/// The rungs of these ladders that a reference with the time acceleration `reference` judges, or that are the reference with
/// other heights; `own` are the scene's numerics, from which the others differ in one thing.
///
/// The first one is the scene's own run, unless that is the reference.
pub fn rungs(
    ladders: &[Ladder],
    own: Numerics,
    accelerations: &[f64],
    coarsenings: &[usize],
    reference: f64,
) -> Vec<Rung> {
    let rung = |ladder, numerics| Rung { ladder, numerics };
    let mut rungs = Vec::new();
    if own.adaptive.is_some() {
        rungs.push(rung(Ladder::Tolerance, own));
    } else if own.time_acceleration > reference {
        rungs.push(rung(Ladder::TimeAcceleration, own));
    }
    for ladder in ladders {
        match ladder {
            Ladder::TimeAcceleration => rungs.extend(
                accelerations
                    .iter()
                    .filter(|other| **other > reference && (own.adaptive.is_some() || **other != own.time_acceleration))
                    .map(|other| rung(*ladder, own.accelerated(*other))),
            ),
            Ladder::Tolerance => {
                let largest = own.adaptive.map_or(LARGEST, |adaptive| adaptive.largest);
                let wanted = TOLERANCES.iter().map(|tolerance| Adaptive { tolerance: *tolerance, largest });
                let other = wanted.filter(|adaptive| own.adaptive != Some(*adaptive));
                rungs.extend(
                    other.map(|adaptive| rung(*ladder, Numerics { adaptive: Some(adaptive), ..own.accelerated(1.0) })),
                );
            }
            Ladder::Mesh => {
                rungs.extend(coarsenings.iter().map(|factor| rung(*ladder, Numerics { coarsening: *factor, ..own })));
            }
            Ladder::Integrator => {
                let integrator = match own.integrator {
                    Integrator::Explicit => Integrator::Exponential,
                    Integrator::Exponential => Integrator::Explicit,
                };
                rungs.push(rung(*ladder, Numerics { integrator, ..own }));
            }
            Ladder::Perturbation => rungs.extend(PERTURBATIONS.iter().map(|perturbation| {
                rung(*ladder, Numerics { perturbation: *perturbation, ..own.accelerated(reference) })
            })),
        }
    }
    rungs.retain(|rung| rung.ladder == Ladder::Perturbation || rung.numerics.is_judged_by(reference));
    rungs
}

/// The numerics of one run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Numerics {
    /// m: how many revolutions a simulated one stands for; where the run chooses it, at the start.
    pub time_acceleration: f64,
    /// How the run chooses its acceleration, if it does.
    pub adaptive: Option<Adaptive>,
    /// Cells of the scene's mesh along a cell; 1 is the scene's mesh.
    pub coarsening: usize,
    /// How wear follows from contact.
    pub integrator: Integrator,
    /// Initial heights of the disc are changed by this part of themselves; 0 leaves them as they are.
    pub perturbation: f64,
}

impl Numerics {
    /// Those of the scene itself.
    pub fn of(scene: &Scene) -> Self {
        let parameters = &scene.parameters;
        Self {
            time_acceleration: parameters.time_acceleration,
            adaptive: scene.adaptive,
            coarsening: 1,
            integrator: parameters.integrator,
            perturbation: 0.0,
        }
    }

    /// The same with another time acceleration, which never changes.
    pub fn accelerated(self, time_acceleration: f64) -> Self {
        Self { time_acceleration, adaptive: None, ..self }
    }

    /// The time acceleration as a scene gives it.
    pub fn acceleration(&self) -> String {
        match self.adaptive {
            None => format!("time_acceleration = {}", self.time_acceleration),
            Some(Adaptive { tolerance, largest }) => {
                format!("time_acceleration = {{ tolerance = {tolerance}, max = {largest} }}")
            }
        }
    }

    /// Whether a reference with this time acceleration is finer than the run, or the model itself. A run that chooses its
    /// acceleration begins with 1, so that nothing but the model is finer.
    pub fn is_judged_by(&self, reference: f64) -> bool {
        reference == 1.0 || (self.adaptive.is_none() && reference < self.time_acceleration)
    }

    /// What a simulation with these numerics is told; `coarsening` is that of the mesh, if there is one.
    pub fn parameters(&self, scene: &Scene, coarsening: Option<&Coarsening>) -> Parameters {
        let mut parameters = Parameters {
            time_acceleration: self.time_acceleration,
            integrator: self.integrator,
            ..scene.parameters.clone()
        };
        if let Some(coarsening) = coarsening {
            parameters.mesh = coarsening.mesh.clone();
        }
        parameters
    }
}

/// Name of an integrator in a scene.
pub fn integrator_name(integrator: Integrator) -> &'static str {
    choices::word(&choices::INTEGRATOR, &integrator)
}

#[cfg(test)]
mod tests {
    use super::*;

    const OWN: Numerics = Numerics {
        time_acceleration: 20.0,
        coarsening: 1,
        integrator: Integrator::Explicit,
        perturbation: 0.0,
        adaptive: None,
    };

    #[test]
    fn a_scene_has_the_accelerations_that_its_revolutions_allow() {
        assert_eq!(time_accelerations(20.0, 850.0), [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0]);
        assert_eq!(time_accelerations(7.5, 16.0), [1.0, 2.0, 7.5]);
        assert_eq!(time_accelerations(1.0, 0.1), [1.0]);
    }

    #[test]
    fn rungs_are_coarser_than_the_reference_and_differ_in_one_thing() {
        let accelerations = [1.0, 5.0, 20.0, 50.0];
        let all = [Ladder::TimeAcceleration, Ladder::Tolerance, Ladder::Mesh, Ladder::Integrator, Ladder::Perturbation];
        let all = rungs(&all, OWN, &accelerations, &[2], 1.0);
        let names: Vec<String> = all.iter().map(Rung::name).collect();
        assert_eq!(
            names,
            [
                "time_acceleration = 20",
                "time_acceleration = 5",
                "time_acceleration = 50",
                "time_acceleration = { tolerance = 0.002, max = 1000 }",
                "time_acceleration = { tolerance = 0.005, max = 1000 }",
                "time_acceleration = { tolerance = 0.01, max = 1000 }",
                "time_acceleration = { tolerance = 0.02, max = 1000 }",
                "time_acceleration = { tolerance = 0.05, max = 1000 }",
                "mesh coarsened 2 times",
                "integrator = \"exponential\"",
                "disc heights times 1 + 1e-9",
                "disc heights times 1 + 1e-6",
                "disc heights times 1 + 1e-4",
            ]
        );
        assert_eq!(all[10].numerics.time_acceleration, 1.0);
        assert_eq!(all[8].full_name(), "time_acceleration = 20, mesh coarsened 2 times");
        // A scene that chooses is run first, and the others with its choice.
        let chosen = Numerics { adaptive: Some(Adaptive { tolerance: 0.02, largest: 300.0 }), ..OWN.accelerated(1.0) };
        let few = rungs(&[Ladder::Tolerance, Ladder::Mesh], chosen, &accelerations, &[2], 1.0);
        assert_eq!(few.iter().map(Rung::value).collect::<Vec<_>>(), [0.02, 0.002, 0.005, 0.01, 0.05, 2.0]);
        assert_eq!(few[5].full_name(), "time_acceleration = { tolerance = 0.02, max = 300 }, mesh coarsened 2 times");
        // A coarser reference judges what is coarser still, and no run that may be finer.
        let few = rungs(&[Ladder::TimeAcceleration, Ladder::Tolerance, Ladder::Mesh], OWN, &accelerations, &[2], 5.0);
        assert_eq!(few.iter().map(Rung::value).collect::<Vec<_>>(), [20.0, 50.0, 2.0]);
        assert!(rungs(&[Ladder::TimeAcceleration], OWN, &accelerations, &[], 50.0).is_empty());
    }
}
