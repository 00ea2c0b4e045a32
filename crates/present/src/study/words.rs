//! What is said of a study: how well a model fits, what cannot be told apart, what repeats.

use plateau_io::study::plan::Plan;
use plateau_study::effects::{Advice, BoxCox, Effects, ErrorSource};

use plateau_io::number;

use super::analysis::{AnalysedResponse, Selected};

/// How well the model fits, in a line: shares that it explains, and whether it misses something.
pub fn fit(effects: &Effects) -> String {
    let shares = [("adjusted R²", effects.adjusted_r_squared), ("predicted R²", effects.predicted_r_squared)];
    let shares = shares.into_iter().filter_map(|(name, share)| Some(format!("{name} {:.4}", share?)));
    let mut parts = vec![format!("R² {:.4}", effects.r_squared)];
    parts.extend(shares);
    parts.push(match effects.residual.parts {
        None => "lack of fit not tested: no point has replicates".to_owned(),
        Some(parts) => match parts.test {
            Some(test) => format!("lack of fit p {}", probability(test.p)),
            None => "lack of fit not tested: nothing is left for it".to_owned(),
        },
    });
    parts.join(", ")
}

/// A probability in words: `= 0.012` or `< 0.0001`.
pub fn probability(p: f64) -> String {
    if p < LEAST_PROBABILITY { format!("< {LEAST_PROBABILITY}") } else { format!("= {}", number::significant(p, 2)) }
}

/// Probabilities below this are said to be less.
const LEAST_PROBABILITY: f64 = 1e-4;

/// What the fit was made of and how large its error is, in a line; `shown` makes a text of a value in the response's unit.
pub fn quality(effects: &Effects, shown: impl Fn(f64) -> String) -> String {
    let missing = if effects.missing > 0 { format!(", {} without a response", effects.missing) } else { String::new() };
    let mut parts = vec![
        format!("{}{missing}", number::count(effects.observations, "run")),
        format!("mean {}", shown(effects.mean)),
    ];
    parts.extend(
        effects
            .residual_standard_deviation
            .map(|deviation| format!("error {} (from {})", shown(deviation), effects.error)),
    );
    if effects.residual_standard_deviation.is_none() {
        // It has as many terms as runs.
        let advice = match effects.error {
            ErrorSource::Saturated => {
                ", so no interval can be told: give [replicates] of seeds, such as those of the disc, or a smaller model such as \
                 --model main"
            }
            _ => "",
        };
        parts.push(format!("error {}{advice}", effects.error));
    }
    parts.extend(effects.lenth.map(|lenth| {
        let [margin, simultaneous] = [lenth.margin, lenth.simultaneous_margin].map(&shown);
        format!("margin of error {margin}, simultaneous {simultaneous} (Lenth)")
    }));
    parts.join(", ")
}

/// What centre points say of a curve, in a line; none of designs without them.
pub fn curvature(response: &AnalysedResponse, confidence: f64, shown: impl Fn(f64) -> String) -> Option<String> {
    let found = response.curvature?;
    let [low, high] = found.interval.map(&shown);
    let level = number::rounded(100.0 * confidence, 4);
    let advice = match found.test.p < 1.0 - confidence {
        true => {
            ": the response is curved, and the design does not tell in which factor; axial points would (central-composite)"
        }
        false => ": no curve is seen",
    };
    Some(format!(
        "curvature: centre points differ from the plane of the others by {} ({low} … {high}, {level} %), p {}{advice}",
        shown(found.difference),
        probability(found.test.p)
    ))
}

/// Which power of the response fits best, and what to try; none where the one that was fitted does.
pub fn box_cox(response: &AnalysedResponse) -> Option<String> {
    let found = response.box_cox?;
    let advice = response.advice?;
    let [low, high] = found.interval.map(|end| number::rounded(end, 2));
    let is_at_end = found.interval.iter().any(|end| BoxCox::POWERS.contains(end));
    let at_end = if is_at_end { ", looked for between −5 and 5 alone" } else { "" };
    let advice = match advice {
        Advice::Try(transform) => format!("try transform = \"{}\"", transform.name()),
        Advice::NoTransform => "try it without transform".to_owned(),
        Advice::OtherPower => {
            "none of the transforms is this power; keep the response as it is, and look for a bend in the residuals, \
                                which another --model may explain"
                .to_owned()
        }
    };
    Some(format!("Box-Cox: lambda = {} ({low} to {high}{at_end}): {advice}", number::rounded(found.power, 2)))
}

/// Which terms were left out, and why; none where all are kept.
pub fn selected(response: &AnalysedResponse) -> Option<String> {
    let Selected { left_out, aicc, aicc_of_all } = response.selected.as_ref()?;
    let all = aicc_of_all.map_or_else(String::new, |all| format!(" instead of {} with all", number::rounded(all, 5)));
    let left_out = if left_out.is_empty() { "none".to_owned() } else { left_out.join(", ") };
    let aicc = if aicc.is_finite() { number::rounded(*aicc, 5) } else { "has no value with so few runs".to_owned() };
    Some(format!("terms left out: {left_out}; AICc {aicc}{all}"))
}

/// Sets of effects that are listed.
const CHAINS: usize = 40;

/// A line with the letters of the factors, one with the defining words, and one for each set; none for designs that tell
/// all effects.
pub fn alias_lines(plan: &Plan) -> Option<Vec<String>> {
    let aliases = plan.aliases()?;
    let letters = ('A'..='Z').filter(|letter| *letter != 'I').zip(&plan.study().factors);
    let letters: Vec<String> = letters.map(|(letter, factor)| format!("{letter} = {}", factor.name)).collect();
    let words = aliases.defining_words.join(" = ");
    let mut lines = vec![letters.join(", "), format!("resolution {}: I = {words}", aliases.resolution)];
    lines.extend(aliases.chains.iter().take(CHAINS).map(|chain| chain.join(" = ")));
    if aliases.chains.len() > CHAINS {
        lines.push(format!("and {} more", aliases.chains.len() - CHAINS));
    }
    Some(lines)
}

/// What is to be known of so many runs that repeat another one.
pub fn repeats_in_words(repeats: usize, runs: usize) -> String {
    let (repeat, count) = if repeats == 1 { ("repeats", "counts") } else { ("repeat", "count") };
    format!(
        "{repeats} of {runs} runs {repeat} another one and {count} once with it: the same scene with the same seeds gives the \
         same result. Only [replicates] with several seeds tell the pure error."
    )
}
