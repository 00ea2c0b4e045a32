//! Generators: the rules by which the added factors of a fraction of the two-level combinations follow from its base factors; and aliases:
//! the effects that it cannot tell from each other.
//!
//! Factors are named by the letters A to Z without I, for I is the mean. Sets of factors are bits, A being the lowest. Every effect is a
//! product of factors, so by the generators a product of base factors; effects with the same product are aliases, and those whose product is
//! I are the words of the defining relation.

use std::collections::BTreeMap;

use crate::design::definition::{Aliases, DesignError, counted};

/// The names of the factors, in their order.
pub(super) const LETTERS: &str = "ABCDEFGHJKLMNOPQRSTUVWXYZ";

/// An added factor is the product of some base factors, or its negative.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Generator {
    /// Base factors of the product, as bits.
    pub(super) base: u32,
    /// Tells whether it is the negative.
    pub(super) negative: bool,
}

impl Generator {
    /// The base factor of this index itself.
    pub(super) fn of_base(factor: usize) -> Self {
        Self { base: 1 << factor, negative: false }
    }

    /// The product of both.
    pub(super) fn times(self, other: Self) -> Self {
        Self { base: self.base ^ other.base, negative: self.negative != other.negative }
    }

    /// −1 or 1 in a run whose bits are set where a base factor is 1, clear where it is −1.
    pub(super) fn sign(self, run: u32) -> f64 {
        let odd = (self.base & !run).count_ones() % 2 == 1;
        if odd == self.negative { 1.0 } else { -1.0 }
    }
}

/// Tells whether there are letters enough for so many factors.
pub(super) fn can_be_named(factors: usize) -> Result<(), DesignError> {
    let most = LETTERS.len();
    if factors > most {
        return error(format!("a fraction has at most {most} factors, named A to Z without I, not {factors}"));
    }
    Ok(())
}

/// The letters of a set of factors.
pub(super) fn letters(factors: u32) -> String {
    LETTERS.chars().enumerate().filter(|(bit, _)| factors >> bit & 1 == 1).map(|(_, letter)| letter).collect()
}

/// The generators of the added factors, in their order.
///
/// A text is a word of letters of base factors, with a minus before it where meant, alone or after the letter of the
/// added factor and `=`. A word alone is for the first added factor that no other text names.
pub(super) fn parse(factors: usize, texts: &[String]) -> Result<Vec<Generator>, DesignError> {
    can_be_named(factors)?;
    let Some(base) = factors.checked_sub(texts.len()).filter(|base| *base > 0) else {
        let (given, most) = (texts.len(), factors.saturating_sub(1));
        return error(format!("too many generators for {}: {given}, but {most} at most", counted(factors)));
    };
    let mut added: Vec<Option<Generator>> = vec![None; texts.len()];
    let mut unnamed = Vec::new();
    for text in texts {
        match text.split_once('=') {
            Some((name, word)) => {
                let place = &mut added[named(name.trim(), text, base, factors)?];
                if place.is_some() {
                    return error(format!("two generators for factor {}; the second is `{text}`", name.trim()));
                }
                *place = Some(word_of(word.trim(), text, base, factors)?);
            }
            None => unnamed.push(word_of(text.trim(), text, base, factors)?),
        }
    }
    let mut unnamed = unnamed.into_iter();
    let generators: Vec<Generator> = added.into_iter().filter_map(|place| place.or_else(|| unnamed.next())).collect();
    for (index, generator) in generators.iter().enumerate() {
        if let Some(first) = generators[..index].iter().position(|other| other.base == generator.base) {
            let (one, other, word) = (letter(base + first), letter(base + index), letters(generator.base));
            return error(format!(
                "factors {one} and {other} have the same generator {word}, so could not be told from each other"
            ));
        }
    }
    Ok(generators)
}

/// Index among the added factors of the one that stands before the `=`.
fn named(name: &str, text: &str, base: usize, factors: usize) -> Result<usize, DesignError> {
    let mut characters = name.chars();
    let index = match (characters.next(), characters.next()) {
        (Some(character), None) => index_of(character),
        _ => return error(format!("generator `{text}`: expected one letter before the =, found `{name}`")),
    };
    match index.and_then(|index| index.checked_sub(base)) {
        Some(added) if added < factors - base => Ok(added),
        _ => error(format!("generator `{text}`: expected {} before the =, found {name}", span(base, factors))),
    }
}

fn word_of(word: &str, text: &str, base: usize, factors: usize) -> Result<Generator, DesignError> {
    let (negative, product) = match word.strip_prefix(['-', '−']) {
        Some(product) => (true, product.trim_start()),
        None => (false, word.strip_prefix('+').unwrap_or(word).trim_start()),
    };
    let mut set = 0_u32;
    for character in product.chars() {
        let bit = match index_of(character) {
            Some(index) if index < base => 1 << index,
            Some(index) if index < factors => {
                let range = span(0, base);
                return error(format!(
                    "generator `{text}`: {character} is an added factor itself; expected base factors, {range}"
                ));
            }
            _ => {
                let range = span(0, base);
                return error(format!(
                    "generator `{text}`: {character} is not a factor; expected base factors, {range}"
                ));
            }
        };
        if set & bit != 0 {
            return error(format!("generator `{text}`: {character} stands twice"));
        }
        set |= bit;
    }
    match set.count_ones() {
        0 => error(format!("generator `{text}`: expected the letters of base factors, found none")),
        1 => error(format!(
            "generator `{text}` equals base factor {product}, so the two could not be told from each other"
        )),
        _ => Ok(Generator { base: set, negative }),
    }
}

/// Index of the factor with this letter, small or capital.
fn index_of(character: char) -> Option<usize> {
    LETTERS.find(character.to_ascii_uppercase())
}

fn letter(factor: usize) -> String {
    letters(1 << factor)
}

/// The letters from one factor to before another, as people say it.
fn span(from: usize, to: usize) -> String {
    if to - from == 1 { letter(from) } else { format!("{} to {}", letter(from), letter(to - 1)) }
}

fn error<T>(message: String) -> Result<T, DesignError> {
    Err(DesignError(message))
}

/// Every factor as a product of base factors.
pub(super) fn columns(factors: usize, generators: &[Generator]) -> Vec<Generator> {
    let base = factors - generators.len();
    (0..base.min(u32::BITS as usize)).map(Generator::of_base).chain(generators.iter().copied()).collect()
}

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
#[path = "../../tests/unit/design/generators.rs"]
mod tests;
