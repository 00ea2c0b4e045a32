//! Aliases: the effects that a fraction of the two-level combinations cannot tell from each other.
//!
//! Every effect is a product of factors, so by the generators a product of base factors; effects with the same product
//! are aliases, and those whose product is I are the words of the defining relation.

use std::collections::BTreeMap;

use super::definition::Aliases;
use super::generators::{Generator, columns, letters};

/// Most words that are listed, unless the shortest alone are more. All of twelve generators, of 2¹² − 1 words.
const MOST_WORDS: usize = 4095;

/// Aliases that the generators make; none where there are no generators.
pub(super) fn aliases(factors: usize, generators: &[Generator]) -> Option<Aliases> {
    let base = factors - generators.len();
    let added = (base..).map(|factor| 1 << factor);
    let relations: Vec<Word> = generators
        .iter()
        .zip(added)
        .map(|(generator, added)| Word { factors: generator.base | added, negative: generator.negative })
        .collect();
    let mut word_lengths = vec![0; factors + 1];
    words(&relations).for_each(|word| word_lengths[word.length()] += 1);
    let shortest = word_lengths.iter().position(|count| *count > 0)?;
    let longest = (shortest + 1..=factors)
        .take_while(|length| word_lengths[..=*length].iter().sum::<usize>() <= MOST_WORDS)
        .last()
        .unwrap_or(shortest);
    let mut listed: Vec<(usize, String, bool)> = words(&relations)
        .filter(|word| word.length() <= longest)
        .map(|word| (word.length(), letters(word.factors), word.negative))
        .collect();
    listed.sort();
    Some(Aliases {
        defining_words: listed.into_iter().map(|(_, letters, negative)| signed(&letters, negative)).collect(),
        word_lengths,
        resolution: shortest as u32,
        chains: chains(&columns(factors, generators)),
    })
}

/// A product of factors that is 1 at every point, or −1.
#[derive(Debug, Clone, Copy)]
struct Word {
    factors: u32,
    negative: bool,
}

impl Word {
    fn length(&self) -> usize {
        self.factors.count_ones() as usize
    }
}

/// All products of the words, each once.
fn words(relations: &[Word]) -> impl Iterator<Item = Word> + '_ {
    let mut word = Word { factors: 0, negative: false };
    // In the order of the Gray code, so that each product differs from the one before by one word.
    (1_u64..1 << relations.len()).map(move |number| {
        let relation = relations[number.trailing_zeros() as usize];
        word.factors ^= relation.factors;
        word.negative ^= relation.negative;
        word
    })
}

/// Main effects and two-factor interactions that cannot be told from each other.
fn chains(columns: &[Generator]) -> Vec<Vec<String>> {
    let main = columns.iter().enumerate().map(|(factor, column)| (1 << factor, *column));
    let pairs = columns.iter().enumerate().flat_map(|(one, first)| {
        let others = columns.iter().enumerate().skip(one + 1);
        others.map(move |(other, second)| (1 << one | 1 << other, first.times(*second)))
    });
    let mut sets: BTreeMap<u32, Vec<(u32, bool)>> = BTreeMap::new();
    let mut order = Vec::new();
    for (effect, column) in main.chain(pairs) {
        let set = sets.entry(column.base).or_default();
        if set.is_empty() {
            order.push(column.base);
        }
        set.push((effect, column.negative));
    }
    let chains = order.iter().filter_map(|base| sets.get(base)).filter(|set| set.len() > 1);
    chains
        .map(|set| set.iter().map(|(effect, negative)| signed(&letters(*effect), *negative != set[0].1)).collect())
        .collect()
}

fn signed(letters: &str, negative: bool) -> String {
    format!("{}{letters}", if negative { "-" } else { "" })
}

#[cfg(test)]
#[path = "../../tests/unit/design/aliases.rs"]
mod tests;
