//! The search for the best settings of a study, with the models that were fitted to its responses.

use plateau_present::study::goals::observed;
use plateau_study::optimum::{Axis, Goal, Limit, Optimum, Wish, optimum};
use plateau_study::surrogate::{Forecast, Surrogate};

use super::analysed::Analysed;
use crate::failure::Failure;

/// Goals whose best end is that of the runs, with the best that is expected within the ranges where that is better: else all settings
/// that are better than every run would be worth the same.
pub(super) fn beyond_runs(
    analysed: &Analysed,
    goals: &[Goal],
    axes: &[Axis],
    confidence: f64,
) -> Result<Vec<Goal>, Failure> {
    let extended = |goal: &Goal| {
        let ends = observed(&analysed.analysis, goal.response);
        if !ends.is_some_and(|ends| [Wish::Maximum(ends), Wish::Minimum(ends)].contains(&goal.wish)) {
            return Ok(*goal);
        }
        let alone = Goal { wish: goal.wish.without_end(), weight: 1.0, importance: 1.0, ..*goal };
        let (_, forecasts) = search(analysed, &[alone], &[], axes, confidence)?;
        let best = forecasts[goal.response].map(|forecast| forecast.value);
        Ok(Goal { wish: best.map_or(goal.wish, |best| goal.wish.up_to(best)), ..*goal })
    };
    goals.iter().map(extended).collect()
}

/// The best settings, and what is expected of each response there; none of one without a model, of which nothing may be wanted.
pub(super) fn search(
    analysed: &Analysed,
    goals: &[Goal],
    limits: &[Limit],
    axes: &[Axis],
    confidence: f64,
) -> Result<(Optimum, Vec<Option<Forecast>>), Failure> {
    let wanted = |response: usize| {
        goals.iter().any(|goal| goal.response == response) || limits.iter().any(|limit| limit.response == response)
    };
    let mut surrogates: Vec<Box<dyn Surrogate + '_>> = Vec::new();
    let mut places = Vec::new();
    for (at, response) in analysed.analysis.responses.iter().enumerate() {
        match (response.surrogate(), &response.effects) {
            (Some(surrogate), _) => {
                places.push(Some(surrogates.len()));
                surrogates.push(surrogate);
            }
            (None, Err(error)) if wanted(at) => {
                let path = analysed.plan.study().path.display();
                return Err(Failure::input(format!("{path}: response \"{}\": {error}", response.name)));
            }
            _ => places.push(None),
        }
    }
    let known: Vec<&dyn Surrogate> = surrogates.iter().map(AsRef::as_ref).collect();
    let moved = |response: usize| places[response].unwrap_or(0);
    let goals: Vec<Goal> = goals.iter().map(|goal| Goal { response: moved(goal.response), ..*goal }).collect();
    let limits: Vec<Limit> = limits.iter().map(|limit| Limit { response: moved(limit.response), ..*limit }).collect();
    let best = optimum(&known, &goals, &limits, axes, confidence).map_err(Failure::input)?;
    let forecasts = places.iter().map(|place| place.map(|place| best.forecasts[place])).collect();
    Ok((best, forecasts))
}
