//! Which run to choose for an error, in a sentence.

use super::choice::{Advice, judge};
use super::report::Report;
use crate::number::{self, percent};

/// Errors of the contact area for which runs are advised.
const ERRORS: [f64; 3] = [1e-2, 5e-3, 2e-3];

/// A sentence for each of the errors, or one for all of them.
pub fn advice(report: &Report) -> Vec<String> {
    let own = report.own_error;
    if own.comes_late {
        return vec![format!(
            "no setting is advised: on a disc as smooth as this one the error of every time_acceleration above 1 grows late, \
             and the reference has {}",
            report.reference.time_acceleration
        )];
    }
    let costs = report.choices();
    let clear: Vec<bool> = report.rows.iter().map(|row| row.is_clear).collect();
    let found = ERRORS.map(|error| (error, judge(error, &costs, own.contact_area(), &clear)));
    let all_same = found.iter().all(|(_, advice)| *advice == found[0].1);
    let reference = report.reference.outcome.wall_time;
    let instead = reference.map_or(String::new(), |time| format!(" instead of {}", number::duration(time)));
    let of = |index: usize| (report.rows[index].setting(), number::duration(costs[index].time), costs[index].error);
    let sentence = |(error, advice): (f64, Advice)| match advice {
        Advice::Use(index) => {
            let (name, time, _) = of(index);
            format!("for {} error in contact area use {name}: {time}{instead}", percent(error))
        }
        Advice::Missed(index) => {
            let (name, time, least) = of(index);
            let least = percent(least);
            format!("no run reaches {} error in contact area; the best has {least}: {name}, {time}", percent(error))
        }
        Advice::ReferenceInexact => {
            let wanted =
                if all_same { String::new() } else { format!(" for {} error in contact area", percent(error)) };
            let own = percent(own.contact_area());
            format!(
                "no setting is advised{wanted}: the reference's own error, about {own}, is of the size of the errors compared"
            )
        }
        Advice::NoChoice => "no setting is advised: no other run is quicker than the reference".to_owned(),
    };
    let mut advice = found.map(sentence).to_vec();
    advice.dedup();
    advice
}
