use super::*;

fn of(kind: Fraction, factors: usize) -> Result<Design, DesignError> {
    fractional_factorial(&kind, &vec![Factor::Range; factors])
}

#[test]
fn all_combinations_stand_in_for_a_fraction_that_does_not_exist() {
    for (factors, resolution, points) in [(1, 3, 2), (2, 3, 4), (4, 5, 16), (16, 17, 65_536)] {
        let design = of(Fraction::Resolution(resolution), factors).unwrap();
        assert_eq!(design.points(), points);
        assert_eq!(design.aliases(), None);
    }
    assert_eq!(of(Fraction::Generators(Vec::new()), 3).unwrap().points(), 8);
}

#[test]
fn what_cannot_be_had_is_refused() {
    assert!(of(Fraction::Resolution(2), 5).unwrap_err().0.contains("the least is 3"));
    assert!(of(Fraction::Resolution(12), 20).unwrap_err().0.contains("more than 4096 points"));
    assert!(of(Fraction::Resolution(3), 26).unwrap_err().0.contains("at most 25 factors"));
    let error = fractional_factorial(&Fraction::Resolution(3), &[Factor::Range, Factor::Levels(3)]).unwrap_err();
    assert!(error.0.contains("factor 2 has 3 levels"), "{error}");
}

#[test]
fn columns_of_every_size_are_balanced_and_orthogonal() {
    // The definition: 1 + factors columns, the first all 1, are a Hadamard matrix.
    for points in (4..=24).step_by(4) {
        let rows = rows(points);
        assert_eq!(rows.len(), points);
        assert!(rows.iter().all(|row| row.len() == points - 1));
        for one in 0..points - 1 {
            assert_eq!(rows.iter().map(|row| i32::from(row[one])).sum::<i32>(), 0, "{points} points: {one}");
            for other in 0..one {
                let product: i32 = rows.iter().map(|row| i32::from(row[one] * row[other])).sum();
                assert_eq!(product, 0, "{points} points: {one} and {other}");
            }
        }
    }
}

#[test]
fn any_number_of_factors_up_to_23_has_the_next_multiple_of_four() {
    for factors in 1..=23 {
        let design = plackett_burman(&vec![Factor::Levels(2); factors]).unwrap();
        assert_eq!(design.points(), (factors + 1).next_multiple_of(4));
        assert_eq!(design.point(0).len(), factors);
    }
    assert!(plackett_burman(&[Factor::Range; 24]).unwrap_err().0.contains("at most 23"));
}

fn parsed(factors: usize, texts: &[&str]) -> Result<Vec<Product>, DesignError> {
    parse(factors, &texts.iter().map(ToString::to_string).collect::<Vec<_>>())
}

#[test]
fn all_ways_of_writing_mean_the_same() {
    let minus = Product { factors: 0b1111, negative: true };
    for text in ["E = -ABCD", "E=-ABCD", "-ABCD", " - DCBA ", "e = −abcd"] {
        assert_eq!(parsed(5, &[text]), Ok(vec![minus]), "{text}");
    }
    let plus = Product { negative: false, ..minus };
    assert_eq!(parsed(5, &["E=+ABCD"]), Ok(vec![plus]));
    // E is named, so that the word alone is for D.
    let mixed = parsed(5, &["E = AC", "AB"]).unwrap();
    assert_eq!(mixed.iter().map(|each| each.factors).collect::<Vec<_>>(), [0b11, 0b101]);
    // J follows H.
    assert_eq!(parsed(9, &["J = ABCDEFGH"]).unwrap()[0].factors, 0xff);
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

fn aliases_of(factors: usize, texts: &[&str]) -> Aliases {
    let texts: Vec<String> = texts.iter().map(ToString::to_string).collect();
    aliases(factors, &parse(factors, &texts).unwrap()).unwrap()
}

#[test]
fn many_words_are_counted_and_only_the_shortest_are_listed() {
    // 2^(25-20): of its 2^20 − 1 words the lengths up to 5 are no more than 4095.
    let words = minimum_aberration(25, 3).unwrap();
    let aliases = aliases_of(25, &words.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(aliases.word_lengths.iter().sum::<usize>(), (1 << 20) - 1);
    // Numbers of words in FrF2 2.3-4 for R, catalogue entry 25-20.1.
    assert_eq!(aliases.word_lengths[3..6], [76, 442, 1656]);
    assert_eq!(aliases.defining_words.len(), 76 + 442 + 1656);
    assert!(aliases.defining_words.iter().all(|word| word.len() <= 5));
}
