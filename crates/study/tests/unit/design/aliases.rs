use super::*;
use crate::design::generators::parse;

fn of(factors: usize, texts: &[&str]) -> Aliases {
    let texts: Vec<String> = texts.iter().map(ToString::to_string).collect();
    aliases(factors, &parse(factors, &texts).unwrap()).unwrap()
}

#[test]
fn words_and_chains_are_products_of_the_generators() {
    // By hand: I = ABD = ACE = BCDE; each effect times these words.
    let aliases = of(5, &["D = AB", "E = AC"]);
    assert_eq!(aliases.defining_words, ["ABD", "ACE", "BCDE"]);
    assert_eq!(aliases.resolution, 3);
    let chains: Vec<String> = aliases.chains.iter().map(|chain| chain.join(" = ")).collect();
    assert_eq!(chains, ["A = BD = CE", "B = AD", "C = AE", "D = AB", "E = AC", "BC = DE", "BE = CD"]);
}

#[test]
fn signs_go_through() {
    // By hand: D = −AB is −1 times AB at every point, so A = −BD and B = −AD; with E = BC, ABD · BCE = ACDE.
    let aliases = of(5, &["D = -AB", "E = BC"]);
    assert_eq!(aliases.defining_words, ["-ABD", "BCE", "-ACDE"]);
    let chains: Vec<String> = aliases.chains.iter().map(|chain| chain.join(" = ")).collect();
    assert_eq!(chains, ["A = -BD", "B = -AD = CE", "C = BE", "D = -AB", "E = BC", "AC = -DE", "AE = -CD"]);
}

#[test]
fn many_words_are_counted_and_only_the_shortest_are_listed() {
    // 2^(25-20): of its 2^20 − 1 words the lengths up to 5 are no more than 4095.
    let words = crate::design::minimum_aberration::minimum_aberration(25, 3).unwrap();
    let aliases = of(25, &words.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(aliases.word_lengths.iter().sum::<usize>(), (1 << 20) - 1);
    // Numbers of words in FrF2 2.3-4 for R, catalogue entry 25-20.1.
    assert_eq!(aliases.word_lengths[3..6], [76, 442, 1656]);
    assert_eq!(aliases.defining_words.len(), 76 + 442 + 1656);
    assert!(aliases.defining_words.iter().all(|word| word.len() <= 5));
}
