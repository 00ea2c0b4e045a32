//! Which runs are made within a budget of time, and which of them is the reference.

use super::ladder::Rung;
use super::numerics::Numerics;

/// Part of the budget that is planned for: later steps may take longer than those of the trial.
const PLANNED: f64 = 0.9;

/// The runs that are to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Time acceleration of the reference.
    pub reference: f64,
    /// Numerics from which the rungs differ in one thing.
    pub base: Numerics,
    /// What is run besides the reference.
    pub rungs: Vec<Rung>,
}

/// The budget does not suffice, or there is nothing to run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TooSmall {
    /// Wall time of the quickest plan, s; 0 where there is nothing to run.
    pub needed: f64,
    /// Time acceleration of its reference.
    pub reference: f64,
}

/// The plan with the finest reference of which all runs together fit into the budget (s). `rungs` gives what is run
/// beside a reference of some time acceleration; `seconds` estimates the wall time of a run.
///
/// # Errors
/// [`TooSmall`] when there is none.
pub fn plan(
    accelerations: &[f64],
    own: Numerics,
    rungs: impl Fn(f64) -> (Numerics, Vec<Rung>),
    seconds: impl Fn(&Numerics) -> f64,
    budget: f64,
) -> Result<Plan, TooSmall> {
    let mut quickest = TooSmall { needed: 0.0, reference: own.time_acceleration };
    for reference in accelerations {
        let (base, rungs) = rungs(*reference);
        if rungs.is_empty() {
            continue;
        }
        let beside: f64 = rungs.iter().map(|rung| seconds(&rung.numerics)).sum();
        let needed = (seconds(&own.accelerated(*reference)) + beside) / PLANNED;
        if needed <= budget {
            return Ok(Plan { reference: *reference, base, rungs });
        }
        if quickest.needed == 0.0 || needed < quickest.needed {
            quickest = TooSmall { needed, reference: *reference };
        }
    }
    Err(quickest)
}

/// The plan beside a reference that is there: of its runs at least the quickest fits into the budget (s).
///
/// # Errors
/// As [`plan`].
pub fn plan_beside(
    reference: f64,
    rungs: impl Fn(f64) -> (Numerics, Vec<Rung>),
    seconds: impl Fn(&Numerics) -> f64,
    budget: f64,
) -> Result<Plan, TooSmall> {
    let (base, rungs) = rungs(reference);
    let quickest = rungs.iter().map(|rung| seconds(&rung.numerics)).fold(f64::INFINITY, f64::min);
    match rungs.is_empty() {
        true => Err(TooSmall { needed: 0.0, reference }),
        false if quickest > budget => Err(TooSmall { needed: quickest, reference }),
        false => Ok(Plan { reference, base, rungs }),
    }
}

#[cfg(test)]
mod tests {
    use plateau_core::parameters::Integrator;

    use super::super::ladder::rungs;
    use super::*;
    use crate::arguments::Ladder;

    #[test]
    fn the_finest_reference_that_fits_is_taken() {
        let own = Numerics {
            time_acceleration: 10.0,
            adaptive: None,
            coarsening: 1,
            load_tolerance: 1e-9,
            integrator: Integrator::Explicit,
            perturbation: 0.0,
        };
        let accelerations = [1.0, 2.0, 10.0];
        let seconds = |numerics: &Numerics| 90.0 / numerics.time_acceleration;
        let within = |budget| {
            plan(
                &accelerations,
                own,
                |reference| rungs(&[Ladder::TimeAcceleration], own, &accelerations, &[], reference),
                seconds,
                budget,
            )
        };
        // By hand: 90 + 45 + 9 = 144 s with m = 1, 45 + 9 = 54 s with m = 2; 9 tenths of the budget are planned.
        assert_eq!(within(161.0).unwrap().reference, 1.0);
        let plan = within(159.0).unwrap();
        assert_eq!((plan.reference, plan.rungs.len()), (2.0, 1));
        let too_small = within(59.0).unwrap_err();
        let beside = |reference, budget| {
            let rungs = |reference| rungs(&[Ladder::TimeAcceleration], own, &accelerations, &[], reference);
            plan_beside(reference, rungs, seconds, budget)
        };
        assert_eq!(beside(1.0, 10.0).unwrap().rungs.len(), 2);
        assert_eq!(beside(1.0, 8.0), Err(TooSmall { needed: 9.0, reference: 1.0 }));
        assert_eq!(beside(10.0, 8.0), Err(TooSmall { needed: 0.0, reference: 10.0 }));
        assert!((too_small.needed - 60.0).abs() < 1e-9 && too_small.reference == 2.0, "{too_small:?}");
    }
}
