//! Which surrogate a response gets.

use super::Surrogate;

/// A surrogate, and why it is that one.
pub struct Choice<'a> {
    /// The surrogate.
    pub surrogate: Box<dyn Surrogate + 'a>,
    /// A sentence that names the leave-one-out errors of all candidates, each in the unit of the response.
    pub reason: String,
}

/// The surrogate with the smallest leave-one-out error; the first of those without one where no other is there. `shown` makes
/// a text of an error, with its unit. None of no candidates.
pub fn choose<'a>(candidates: Vec<Box<dyn Surrogate + 'a>>, shown: impl Fn(f64) -> String) -> Option<Choice<'a>> {
    let errors: Vec<Option<f64>> = candidates.iter().map(|candidate| candidate.leave_one_out_error()).collect();
    let mut told = Vec::new();
    for (candidate, error) in candidates.iter().zip(&errors) {
        let error = error.map_or_else(|| "not known".to_owned(), &shown);
        told.push(format!("{} {error}", candidate.name()));
    }
    let size = |at: &usize| errors[*at].unwrap_or(f64::INFINITY);
    let best = (0..candidates.len()).min_by(|one, other| size(one).total_cmp(&size(other)))?;
    let known = errors.iter().flatten().count();
    let taken = match (told.len(), known) {
        (1, _) => "",
        (_, 0) => "; nothing tells which one is better, and the first one is taken",
        (count, known) if known < count => {
            "; what is not known cannot be compared, for a term depends on single points, and the other one is taken"
        }
        _ => "; the smaller one is taken",
    };
    let reason = format!("leave-one-out error: {}{taken}", told.join(", "));
    let surrogate = candidates.into_iter().nth(best)?;
    Some(Choice { surrogate, reason })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::Setting;
    use crate::effects::EffectsError;
    use crate::surrogate::Forecast;

    struct Known(&'static str, Option<f64>);

    impl Surrogate for Known {
        fn name(&self) -> String {
            self.0.to_owned()
        }

        fn forecast(&self, _: &[Setting], _: f64) -> Result<Forecast, EffectsError> {
            Ok(Forecast { value: 0.0, mean_interval: None, run_interval: None })
        }

        fn leave_one_out_error(&self) -> Option<f64> {
            self.1
        }
    }

    #[test]
    fn the_smaller_error_is_taken_and_both_are_named() {
        let candidates: Vec<Box<dyn Surrogate>> =
            vec![Box::new(Known("a", Some(3.0))), Box::new(Known("b", Some(2.0))), Box::new(Known("c", Some(0.5)))];
        let choice = choose(candidates, |error| format!("{error} mm")).unwrap();
        assert_eq!(choice.surrogate.name(), "c");
        assert_eq!(choice.reason, "leave-one-out error: a 3 mm, b 2 mm, c 0.5 mm; the smaller one is taken");
        let candidates: Vec<Box<dyn Surrogate>> = vec![Box::new(Known("a", None)), Box::new(Known("b", Some(2.0)))];
        let choice = choose(candidates, |error| error.to_string()).unwrap();
        assert!(choice.surrogate.name() == "b" && !choice.reason.contains("smaller"), "{}", choice.reason);
        assert!(choose(Vec::new(), |error| error.to_string()).is_none());
    }
}
