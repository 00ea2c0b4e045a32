use super::*;
use crate::design::generators::parse;

fn parsed(factors: usize, texts: &[&str]) -> Result<Vec<Generator>, DesignError> {
    parse(factors, &texts.iter().map(ToString::to_string).collect::<Vec<_>>())
}

#[test]
fn all_ways_of_writing_mean_the_same() {
    let minus = Generator { base: 0b1111, negative: true };
    for text in ["E = -ABCD", "E=-ABCD", "-ABCD", " - DCBA ", "e = −abcd"] {
        assert_eq!(parsed(5, &[text]), Ok(vec![minus]), "{text}");
    }
    let plus = Generator { negative: false, ..minus };
    assert_eq!(parsed(5, &["E=+ABCD"]), Ok(vec![plus]));
    // E is named, so that the word alone is for D.
    let mixed = parsed(5, &["E = AC", "AB"]).unwrap();
    assert_eq!(mixed.iter().map(|each| each.base).collect::<Vec<_>>(), [0b11, 0b101]);
    // J follows H.
    assert_eq!(parsed(9, &["J = ABCDEFGH"]).unwrap()[0].base, 0xff);
}

#[test]
fn what_is_wrong_is_said() {
    let message = |factors, texts: &[&str]| parsed(factors, texts).unwrap_err().0;
    assert_eq!(message(5, &["E = ABCX"]), "generator `E = ABCX`: X is not a factor; expected base factors, A to D");
    assert_eq!(message(5, &["I=ABCE"]), "generator `I=ABCE`: expected E before the =, found I");
    assert_eq!(
        message(6, &["E=ABC", "F=ABE"]),
        "generator `F=ABE`: E is an added factor itself; expected base factors, A to D"
    );
    assert_eq!(
        message(6, &["E=ABC", "F=-ABC"]),
        "factors E and F have the same generator ABC, so could not be told from each other"
    );
    assert_eq!(message(6, &["E=ABC", "E=ABD"]), "two generators for factor E; the second is `E=ABD`");
    assert_eq!(
        message(5, &["E=A"]),
        "generator `E=A` equals base factor A, so the two could not be told from each other"
    );
    assert_eq!(message(5, &["AAB"]), "generator `AAB`: A stands twice");
    assert_eq!(message(5, &["E=-"]), "generator `E=-`: expected the letters of base factors, found none");
    assert_eq!(message(5, &["EF=AB"]), "generator `EF=AB`: expected one letter before the =, found `EF`");
    assert_eq!(message(2, &["AB", "A"]), "too many generators for 2 factors: 2, but 1 at most");
    assert_eq!(message(26, &["AB"]), "a fraction has at most 25 factors, named A to Z without I, not 26");
}

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
