//! Which effects a study cannot tell from each other, in words.

use plateau_io::study::plan::Plan;

/// Sets of effects that are listed.
const CHAINS: usize = 40;

/// A line with the letters of the factors, one with the defining words, and one for each set; none for designs that tell
/// all effects.
pub fn lines(plan: &Plan) -> Option<Vec<String>> {
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
