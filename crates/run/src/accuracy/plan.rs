//! Which runs are made within a budget of wall time, and which of them is the reference.

use super::history::{LEAST_WINDOW, Windows, common_multiple};
use super::ladder::{Ladder, Numerics, Rung, rungs};

/// Part of the budget that is planned for: later steps may take longer than those of the trial.
const PLANNED: f64 = 0.9;
/// Part of what is planned that the reference gets, as long as there is one for it.
const FOR_REFERENCE: f64 = 0.5;
/// Part of what is planned that goes into the opening, as long as more than one window can be had for it.
const FOR_OPENING: f64 = 0.1;

/// What is to be planned for.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a> {
    /// Numerics of the scene, from which the rungs differ in one thing.
    pub own: Numerics,
    /// Time accelerations, increasing, from 1 on.
    pub accelerations: &'a [f64],
    /// Ladders.
    pub ladders: &'a [Ladder],
    /// Coarser meshes that there are.
    pub coarsenings: &'a [usize],
    /// Physical time of every run, s.
    pub duration: f64,
    /// Time of a revolution, s.
    pub revolution: f64,
    /// Wall time for everything, s.
    pub budget: f64,
}

/// The runs that are to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Time acceleration of the reference.
    pub reference: f64,
    /// Windows from the start in which the reference is held against the model itself; none where it is the model.
    pub opening: Option<Windows>,
    /// What is held against the reference: the quickest first, so that a budget that runs out has the most of them.
    pub rungs: Vec<Rung>,
    /// Budget for which the model itself would be the reference, s.
    pub budget_of_model: f64,
}

/// Why there is no plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Refusal {
    /// The reference that was read is not finer than the scene.
    NotFiner,
    /// There is nothing to run beside a reference with this time acceleration.
    NothingToRun {
        /// Time acceleration of the reference.
        reference: f64,
    },
    /// The budget does not suffice for any reference that is finer than the scene, and the scene's own run.
    TooSmall {
        /// Time acceleration of the reference that is finer than the scene and needs the smallest budget.
        reference: f64,
        /// Budget with it, s.
        needed: f64,
        /// Budget with the model itself as the reference, s.
        budget_of_model: f64,
    },
}

/// The runs beside one reference, and their wall times, s.
#[derive(Debug)]
struct Draft {
    reference: f64,
    rungs: Vec<Rung>,
    /// The shortest opening.
    opening: Option<Windows>,
    opening_time: f64,
    /// Of the reference, 0 where it is there already.
    reference_time: f64,
    /// Of the rungs up to the scene's own run.
    least_beside: f64,
}

impl Draft {
    fn new(task: &Task, reference: f64, is_read: bool, seconds: &impl Fn(&Numerics) -> f64) -> Self {
        let own = task.own;
        let mut rungs = rungs(task.ladders, own, task.accelerations, task.coarsenings, reference);
        // Of runs that take as long, the scene's own is the first: the order is stable, and so it was.
        rungs.sort_by(|one, other| seconds(&one.numerics).total_cmp(&seconds(&other.numerics)));
        let needed = rungs.iter().position(|rung| rung.numerics == own).unwrap_or(0) + 1;
        let least_beside = rungs.iter().take(needed).map(|rung| seconds(&rung.numerics)).sum();
        let with = |time_acceleration: f64| seconds(&own.accelerated(time_acceleration));
        let opening = (reference > 1.0).then(|| {
            let unit = common_multiple(&[reference, own.time_acceleration]) * task.revolution;
            let windows = Windows::new(task.duration, unit, LEAST_WINDOW);
            Windows { count: 1, ..windows }
        });
        let part = opening.map_or(0.0, |opening| opening.width / task.duration);
        Self {
            reference,
            rungs,
            opening,
            opening_time: part * (with(1.0) + with(reference) + seconds(&own)),
            reference_time: if is_read { 0.0 } else { with(reference) },
            least_beside,
        }
    }

    fn least(&self) -> f64 {
        self.opening_time + self.reference_time + self.least_beside
    }

    /// What is to be planned, so that the reference has no more than its part.
    fn comfortable(&self) -> f64 {
        self.least().max((self.opening_time + self.reference_time) / FOR_REFERENCE)
    }

    /// The opening with as many windows as there is time for.
    fn opening(&self, task: &Task, planned: f64) -> Option<Windows> {
        let opening = self.opening?;
        let room = (planned - self.least()).min(FOR_OPENING * planned - self.opening_time).max(0.0);
        let most = (task.duration / opening.width + 1e-9).floor().max(1.0);
        let count = (1.0 + (room / self.opening_time).floor()).min(most);
        Some(Windows { count: count as usize, ..opening })
    }
}

/// The plan with the finest reference that leaves half of the time to the runs beside it, or else with the quickest, if the
/// runs up to the scene's own fit into the budget with it. `read` is the time acceleration of a reference that is there;
/// `seconds` estimates the wall time of a run.
///
/// The reference is finer than the scene. Only a scene without time acceleration, the model itself, is its own reference;
/// a run that chooses its acceleration begins with 1, and has that reference, too.
///
/// # Errors
/// [`Refusal`].
pub fn plan(task: &Task, read: Option<f64>, seconds: impl Fn(&Numerics) -> f64) -> Result<Plan, Refusal> {
    let references = read.map_or_else(|| task.accelerations.to_vec(), |read| vec![read]);
    let finer = references.into_iter().filter(|reference| task.own.is_judged_by(*reference));
    let drafts: Vec<Draft> = finer.map(|reference| Draft::new(task, reference, read.is_some(), &seconds)).collect();
    let quickest = drafts.iter().min_by(|one, other| one.least().total_cmp(&other.least()));
    let (Some(finest), Some(quickest)) = (drafts.first(), quickest) else { return Err(Refusal::NotFiner) };
    if finest.rungs.is_empty() {
        return Err(Refusal::NothingToRun { reference: finest.reference });
    }
    let planned = PLANNED * task.budget;
    let budget_of_model = if drafts.len() == 1 { finest.least() } else { finest.comfortable() } / PLANNED;
    let chosen = drafts.iter().find(|draft| draft.comfortable() <= planned);
    let Some(chosen) = chosen.or(Some(quickest).filter(|draft| draft.least() <= planned)) else {
        let needed = quickest.least() / PLANNED;
        return Err(Refusal::TooSmall { reference: quickest.reference, needed, budget_of_model });
    };
    Ok(Plan {
        reference: chosen.reference,
        opening: chosen.opening(task, planned),
        rungs: chosen.rungs.clone(),
        budget_of_model,
    })
}

#[cfg(test)]
mod tests {
    use plateau_core::acceleration::Adaptive;
    use plateau_core::model::parameters::Integrator;

    use super::*;

    const ACCELERATIONS: [f64; 8] = [1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0];

    fn own(time_acceleration: f64) -> Numerics {
        Numerics {
            time_acceleration,
            adaptive: None,
            coarsening: 1,
            integrator: Integrator::Explicit,
            perturbation: 0.0,
        }
    }

    fn task(own: Numerics, accelerations: &[f64], budget: f64) -> Task<'_> {
        const LADDERS: &[Ladder] = &[Ladder::TimeAcceleration];
        Task { own, accelerations, ladders: LADDERS, coarsenings: &[], duration: 600.0, revolution: 1.0, budget }
    }

    /// The model itself takes 90 s: 1 000 000 steps at 11 111 steps/s.
    fn seconds(numerics: &Numerics) -> f64 {
        90.0 / if numerics.adaptive.is_some() { 20.0 } else { numerics.time_acceleration }
    }

    fn accelerations(plan: &Plan) -> Vec<f64> {
        plan.rungs.iter().map(|rung| rung.numerics.time_acceleration).collect()
    }

    #[test]
    fn the_finest_reference_is_taken_that_leaves_time_for_the_rest() {
        let within = |budget| plan(&task(own(10.0), &[1.0, 2.0, 10.0], budget), None, seconds);
        // By hand, 9 tenths of the budget being planned. Reference 1: 90 s, half of 180 s, a budget of 200 s.
        let model = within(200.1).unwrap();
        assert_eq!((model.reference, model.opening, accelerations(&model)), (1.0, None, vec![10.0, 2.0]));
        // Reference 2: a window is a revolution with 10, 10 s, and takes 1.5 s with 1, 0.75 s with 2 and 0.15 s with 10. With
        // the reference's 45 s that is 47.4 s, half of a budget of 105.3 s; with the scene's 9 s it is 56.4 s, and 62.67 s.
        for budget in [199.9, 105.4, 62.7] {
            let plan = within(budget).unwrap();
            assert_eq!((plan.reference, accelerations(&plan)), (2.0, vec![10.0]), "{budget}");
            assert!((plan.budget_of_model - 200.0).abs() < 1e-9);
        }
        // A tenth of 179.91 s has room for 7 windows of 2.4 s; 56.43 s leave none beside the first.
        assert_eq!(within(199.9).unwrap().opening, Some(Windows { width: 10.0, count: 7 }));
        assert_eq!(within(62.7).unwrap().opening, Some(Windows { width: 10.0, count: 1 }));
        let Err(Refusal::TooSmall { reference, needed, budget_of_model }) = within(62.6) else { panic!("too small") };
        assert!(reference == 2.0 && (needed - 56.4 / 0.9).abs() < 1e-9 && (budget_of_model - 200.0).abs() < 1e-9);
    }

    #[test]
    fn no_budget_has_a_reference_that_is_not_finer_than_what_it_judges() {
        for own in [1.0, 2.0, 7.0, 50.0, 200.0].map(own) {
            let mut coarsest = f64::INFINITY;
            for budget in (1..400).map(f64::from) {
                let mut all = ACCELERATIONS.to_vec();
                all.push(own.time_acceleration);
                all.sort_by(f64::total_cmp);
                all.dedup();
                match plan(&task(own, &all, budget), None, seconds) {
                    Ok(plan) => {
                        let (reference, judged) = (plan.reference, accelerations(&plan));
                        assert!(reference < own.time_acceleration || reference == 1.0, "{budget}: {plan:?}");
                        assert!(judged.iter().all(|other| *other > reference), "{budget}: {plan:?}");
                        assert_eq!(plan.opening.is_none(), reference == 1.0);
                        assert!(judged.is_sorted_by(|one, next| one > next), "not the cheapest first: {plan:?}");
                        assert!(judged.contains(&own.time_acceleration) || own.time_acceleration == 1.0);
                        // All up to the scene's own fit in.
                        let up_to_own = judged.iter().filter(|other| **other >= own.time_acceleration);
                        let least = up_to_own.map(|m| 90.0 / m).fold(90.0 / reference, |sum, time| sum + time);
                        assert!(own.time_acceleration == 1.0 || least <= budget, "{budget}: {plan:?}");
                        assert!(reference <= coarsest, "a larger budget has a coarser reference: {plan:?}");
                        coarsest = reference;
                    }
                    Err(Refusal::TooSmall { reference, needed, budget_of_model }) => {
                        assert!(reference < own.time_acceleration || reference == 1.0);
                        assert!(budget < needed && needed <= budget_of_model, "{budget}: {needed}, {budget_of_model}");
                        assert!(coarsest.is_infinite(), "a larger budget is too small");
                    }
                    other => panic!("{other:?}"),
                }
            }
            assert_eq!(coarsest, 1.0);
        }
    }

    #[test]
    fn the_budget_that_is_asked_for_is_enough() {
        for own in [1.0, 5.0, 200.0].map(own) {
            let at = |budget| plan(&task(own, &ACCELERATIONS, budget), None, seconds);
            let Err(Refusal::TooSmall { reference, needed, budget_of_model }) = at(0.1) else { panic!("too small") };
            assert_eq!(at(1.001 * needed).unwrap().reference, reference);
            assert_eq!(at(1.001 * budget_of_model).unwrap().reference, 1.0);
        }
    }

    #[test]
    fn a_run_that_chooses_its_acceleration_is_held_against_the_model_itself() {
        let chosen = Numerics { adaptive: Some(Adaptive { tolerance: 0.01, largest: 100.0 }), ..own(1.0) };
        let at = |budget, read| plan(&task(chosen, &ACCELERATIONS, budget), read, seconds);
        assert_eq!(at(200.0, None).unwrap().reference, 1.0);
        assert!(matches!(at(60.0, None), Err(Refusal::TooSmall { reference: 1.0, .. })));
        assert_eq!(at(60.0, Some(2.0)), Err(Refusal::NotFiner));
        // Nor is it run beside a coarser reference of another scene.
        let both = [Ladder::TimeAcceleration, Ladder::Tolerance];
        let beside = |budget| {
            let task = Task { ladders: &both, ..task(own(10.0), &ACCELERATIONS, budget) };
            let plan = plan(&task, None, seconds).unwrap();
            (plan.reference, plan.rungs.iter().filter(|rung| rung.ladder == Ladder::Tolerance).count())
        };
        assert_eq!((beside(300.0), beside(150.0)), ((1.0, 5), (2.0, 0)));
    }

    #[test]
    fn a_reference_that_was_read_costs_nothing_but_the_opening() {
        let at = |read, budget| plan(&task(own(10.0), &ACCELERATIONS, budget), Some(read), seconds);
        // By hand: 2.4 s, and 0.45 + 0.9 + 1.8 + 4.5 + 9 s with 200 to 10: 19.05 s, 9 tenths of 21.17 s.
        let plan = at(2.0, 21.2).unwrap();
        assert_eq!(accelerations(&plan), [200.0, 100.0, 50.0, 20.0, 10.0, 5.0]);
        assert!(plan.opening.is_some());
        assert!(at(1.0, 20.0).unwrap().opening.is_none());
        assert!(matches!(at(2.0, 21.1), Err(Refusal::TooSmall { reference: 2.0, .. })));
        for coarse in [10.0, 20.0] {
            assert_eq!(at(coarse, 1e6), Err(Refusal::NotFiner));
        }
    }

    #[test]
    fn a_reference_alone_is_no_plan() {
        let alone = plan(&task(own(1.0), &[1.0], 1e6), None, seconds);
        assert_eq!(alone, Err(Refusal::NothingToRun { reference: 1.0 }));
    }
}
