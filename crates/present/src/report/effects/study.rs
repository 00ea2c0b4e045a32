//! What a study is: its design, its runs, its factors.

use super::StudyPage;
use crate::report::html;
use crate::study::words::alias_lines;
use plateau_io::number;

/// The section about the study.
pub fn html(of: &StudyPage) -> String {
    let (plan, collected) = (of.plan, of.collected);
    let study = plan.study();
    let replicates = match plan.replicates() {
        1 => String::new(),
        several => format!(" × {several} replicates"),
    };
    let points = number::count(plan.points(), "point");
    let runs = format!("{points}{replicates} = {}", number::count(plan.runs(), "run"));
    let states = ["finished", "failed", "missing"].map(|state| (state, collected.count(state)));
    let states: Vec<String> =
        states.into_iter().filter(|(_, count)| *count > 0).map(|(state, count)| format!("{count} {state}")).collect();
    let mut facts = vec![
        ("Study", study.path.display().to_string()),
        ("Design", study.design.clone()),
        ("Runs", format!("{runs}: {}", states.join(", "))),
    ];
    facts.extend(study.base.as_ref().map(|base| ("Base scene", base.display().to_string())));
    if !study.sets.is_empty() {
        facts.push(("Set in all runs", study.sets.join("\n")));
    }
    if let Some(replicates) = &study.replicates {
        facts.push(("Replicates", format!("seeds of {}", replicates.keys.join(", "))));
    }
    let factor = |factor: &plateau_io::study::factor::Factor| {
        vec![factor.name.clone(), factor.to_string(), factor.keys_in_words()]
    };
    let heads = ["Factor", "Set to", "Keys"].map(str::to_owned);
    let factors: Vec<Vec<String>> = study.factors.iter().map(factor).collect();
    let mut text = html::terms(&facts) + &html::table("Factors", &heads, &factors);
    if let Some(lines) = alias_lines(plan) {
        text.push_str("<h3>Effects that cannot be told from each other</h3>\n");
        text.push_str(&html::list(&lines));
    }
    text
}
