//! What is said of a study: how well a model fits, what cannot be told apart, what repeats.

use plateau_io::study::plan::Plan;
use plateau_study::effects::Effects;

use plateau_io::number;

/// How well the model fits, in a line; `shown` makes a text of a value in the response's unit.
pub fn quality(effects: &Effects, shown: impl Fn(f64) -> String) -> String {
    let missing = if effects.missing > 0 { format!(", {} without a response", effects.missing) } else { String::new() };
    let mut parts = vec![
        format!("{}{missing}", number::count(effects.observations, "run")),
        format!("mean {}", shown(effects.mean)),
        format!("R² {:.4}", effects.r_squared),
    ];
    parts.extend(effects.predicted_r_squared.map(|share| format!("predicted R² {share:.4}")));
    parts.extend(
        effects
            .residual_standard_deviation
            .map(|deviation| format!("error {} (from {})", shown(deviation), effects.error)),
    );
    if effects.residual_standard_deviation.is_none() {
        parts.push(format!("error {}", effects.error));
    }
    parts.extend(effects.lenth.map(|lenth| {
        let [margin, simultaneous] = [lenth.margin, lenth.simultaneous_margin].map(&shown);
        format!("margin of error {margin}, simultaneous {simultaneous} (Lenth)")
    }));
    parts.join(", ")
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
