//! Factorial designs: all combinations of levels, a fraction of those of two levels, and Plackett-Burman designs, which tell main effects
//! of two levels in the least multiple of four points that is more than the factors.
//!
//! R. L. Plackett, J. P. Burman, The design of optimum multifactorial experiments, Biometrika 33, 305–325 (1946),
//! doi:10.1093/biomet/33.4.305.
//!
//! Generators are the rules by which the added factors of a fraction follow from its base factors; aliases the effects that it cannot tell
//! from each other. Factors are named by the letters A to Z without I, for I is the mean. Sets of factors are bits, A being the lowest. Every
//! effect is a product of factors, so by the generators a product of base factors; effects with the same product are aliases, and those
//! whose product is I are the words of the defining relation.

use std::collections::BTreeMap;

use crate::design::definition::{Aliases, Design, DesignError, Factor, Fraction, Setting, counted, only_ends, room};

/// The fraction, in standard order: the first factor changes fastest.
pub(super) fn fractional_factorial(fraction: &Fraction, factors: &[Factor]) -> Result<Design, DesignError> {
    only_ends(factors, "a fractional factorial design")?;
    let generators = match fraction {
        Fraction::Resolution(resolution) => of_resolution(*resolution, factors.len())?,
        Fraction::Generators(texts) => parse(factors.len(), texts)?,
    };
    let settings = combinations(factors.len(), &generators)?;
    Design::from_settings(factors.len(), settings, aliases(factors.len(), &generators))
}

/// Generators of the smallest fraction of at least this resolution; none where only all combinations have it.
pub(super) fn of_resolution(resolution: u32, factors: usize) -> Result<Vec<Product>, DesignError> {
    if resolution < 3 {
        return Err(DesignError(format!(
            "a fraction of resolution {resolution} cannot tell main effects from each other; the least is 3"
        )));
    }
    can_be_named(factors)?;
    match minimum_aberration(factors, resolution) {
        Some(words) => parse(factors, &words),
        None if factors <= COMPLETE || resolution as usize > factors => Ok(Vec::new()),
        None => Err(DesignError(format!(
            "no fraction of resolution {resolution} is tabulated for {factors} factors: it has more than 4096 points; \
             take a lower resolution or give the generators"
        ))),
    }
}

/// The coded settings of all combinations of the base factors, the first changing fastest, and of the added factors.
pub(super) fn combinations(factors: usize, generators: &[Product]) -> Result<Vec<Setting>, DesignError> {
    let columns = columns(factors, generators);
    let points = u32::try_from(factors - generators.len()).ok().and_then(|base| 1_usize.checked_shl(base));
    let points = room(points, factors)?;
    let mut settings = Vec::with_capacity(points * factors);
    // `room` admits fewer than 2³² points.
    for run in 0..points as u32 {
        settings.extend(columns.iter().map(|column| Setting::Coded(column.sign(run))));
    }
    Ok(settings)
}

/// Every combination of the levels, the first factor changing fastest (as in R's `expand.grid` and pyDOE's `fullfact`).
/// The ends of a range are its levels.
pub(super) fn full_factorial(factors: &[Factor]) -> Result<Design, DesignError> {
    let counts: Vec<usize> = factors.iter().map(Factor::levels).collect();
    let points = counts.iter().try_fold(1_usize, |points, count| points.checked_mul(*count));
    let points = room(points, factors.len())?;
    let mut settings = Vec::with_capacity(points * factors.len());
    let mut levels = vec![0; factors.len()];
    for _ in 0..points {
        settings.extend(factors.iter().zip(&levels).map(|(factor, level)| at(factor, *level)));
        for (level, count) in levels.iter_mut().zip(&counts) {
            *level += 1;
            if *level < *count {
                break;
            }
            *level = 0;
        }
    }
    Design::from_settings(factors.len(), settings, None)
}

fn at(factor: &Factor, level: usize) -> Setting {
    match factor {
        Factor::Levels(_) => Setting::Level(level),
        Factor::Range => Setting::Coded(if level == 0 { -1.0 } else { 1.0 }),
    }
}

const MOST_FACTORS: usize = 23;

/// First rows of the designs whose other rows follow by turning it, with a last row of minus signs.
const CYCLIC: &[&str] = &[
    // Not in the article: the smallest, one half of three factors.
    "++-",
    "+++-+--",
    "++-+++---+-",
    "++++-+-++--+---",
    "++--++++-+-+----++-",
    "+++++-+-++--++--+-+----",
];

/// The first columns of the design.
pub(super) fn plackett_burman(factors: &[Factor]) -> Result<Design, DesignError> {
    only_ends(factors, "a Plackett-Burman design")?;
    if factors.len() > MOST_FACTORS {
        let found = factors.len();
        return Err(DesignError(format!(
            "a Plackett-Burman design has at most {MOST_FACTORS} factors here, not {found}"
        )));
    }
    let rows = rows(4 * (factors.len() / 4 + 1));
    let settings = rows.iter().flat_map(|row| &row[..factors.len()]).map(|sign| Setting::Coded(f64::from(*sign)));
    Design::from_settings(factors.len(), settings.collect(), None)
}

/// All columns of the design of so many points, a multiple of four up to 24.
fn rows(points: usize) -> Vec<Vec<i8>> {
    let row = CYCLIC[points / 4 - 1];
    let turn = |by: usize| [&signs(row)[row.len() - by..], &signs(row)[..row.len() - by]].concat();
    (0..row.len()).map(turn).chain([vec![-1; row.len()]]).collect()
}

fn signs(row: &str) -> Vec<i8> {
    row.chars().map(|sign| if sign == '+' { 1 } else { -1 }).collect()
}

/// The names of the factors, in their order.
const LETTERS: &str = "ABCDEFGHJKLMNOPQRSTUVWXYZ";

/// A product of factors, or its negative: what an added factor is of base factors, or a word, which is 1 at every point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Product {
    /// The factors, as bits.
    factors: u32,
    /// Tells whether it is the negative.
    negative: bool,
}

impl Product {
    /// The factor of this index itself.
    fn of_factor(factor: usize) -> Self {
        Self { factors: 1 << factor, negative: false }
    }

    /// The product of both.
    fn times(self, other: Self) -> Self {
        Self { factors: self.factors ^ other.factors, negative: self.negative != other.negative }
    }

    fn length(self) -> usize {
        self.factors.count_ones() as usize
    }

    /// −1 or 1 in a run whose bits are set where a base factor is 1, clear where it is −1.
    fn sign(self, run: u32) -> f64 {
        let odd = (self.factors & !run).count_ones() % 2 == 1;
        if odd == self.negative { 1.0 } else { -1.0 }
    }
}

/// Tells whether there are letters enough for so many factors.
fn can_be_named(factors: usize) -> Result<(), DesignError> {
    let most = LETTERS.len();
    if factors > most {
        return error(format!("a fraction has at most {most} factors, named A to Z without I, not {factors}"));
    }
    Ok(())
}

/// The letters of a set of factors.
fn letters(factors: u32) -> String {
    LETTERS.chars().enumerate().filter(|(bit, _)| factors >> bit & 1 == 1).map(|(_, letter)| letter).collect()
}

/// The generators of the added factors, in their order.
///
/// A text is a word of letters of base factors, with a minus before it where meant, alone or after the letter of the
/// added factor and `=`. A word alone is for the first added factor that no other text names.
fn parse(factors: usize, texts: &[String]) -> Result<Vec<Product>, DesignError> {
    can_be_named(factors)?;
    let Some(base) = factors.checked_sub(texts.len()).filter(|base| *base > 0) else {
        let (given, most) = (texts.len(), factors.saturating_sub(1));
        return error(format!("too many generators for {}: {given}, but {most} at most", counted(factors)));
    };
    let mut added: Vec<Option<Product>> = vec![None; texts.len()];
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
    let generators: Vec<Product> = added.into_iter().filter_map(|place| place.or_else(|| unnamed.next())).collect();
    for (index, generator) in generators.iter().enumerate() {
        if let Some(first) = generators[..index].iter().position(|other| other.factors == generator.factors) {
            let (one, other, word) = (letter(base + first), letter(base + index), letters(generator.factors));
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

fn word_of(word: &str, text: &str, base: usize, factors: usize) -> Result<Product, DesignError> {
    let (negative, product) = match word.strip_prefix(['-', '−']) {
        Some(product) => (true, product.trim_start()),
        None => (false, word.strip_prefix('+').unwrap_or(word).trim_start()),
    };
    let mut set = 0_u32;
    for character in product.chars() {
        let bit = match index_of(character) {
            Some(index) if index < base => 1 << index,
            index => {
                let is_added = index.is_some_and(|index| index < factors);
                let why = if is_added { "an added factor itself" } else { "not a factor" };
                let range = span(0, base);
                return error(format!("generator `{text}`: {character} is {why}; expected base factors, {range}"));
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
        _ => Ok(Product { factors: set, negative }),
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
fn columns(factors: usize, generators: &[Product]) -> Vec<Product> {
    let base = factors - generators.len();
    (0..base.min(u32::BITS as usize)).map(Product::of_factor).chain(generators.iter().copied()).collect()
}

/// Most words that are listed, unless the shortest alone are more. All of twelve generators, of 2¹² − 1 words.
const MOST_WORDS: usize = 4095;

/// Aliases that the generators make; none where there are no generators.
fn aliases(factors: usize, generators: &[Product]) -> Option<Aliases> {
    let base = factors - generators.len();
    let relations: Vec<Product> =
        (base..).zip(generators).map(|(added, generator)| generator.times(Product::of_factor(added))).collect();
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

/// All products of the words, each once.
fn words(relations: &[Product]) -> impl Iterator<Item = Product> + '_ {
    let mut word = Product { factors: 0, negative: false };
    // In the order of the Gray code, so that each product differs from the one before by one word.
    (1_u64..1 << relations.len()).map(move |number| {
        word = word.times(relations[number.trailing_zeros() as usize]);
        word
    })
}

/// Main effects and two-factor interactions that cannot be told from each other.
fn chains(columns: &[Product]) -> Vec<Vec<String>> {
    let main = columns.iter().enumerate().map(|(factor, column)| (1 << factor, *column));
    let pairs = columns.iter().enumerate().flat_map(|(one, first)| {
        let others = columns.iter().enumerate().skip(one + 1);
        others.map(move |(other, second)| (1 << one | 1 << other, first.times(*second)))
    });
    let mut sets: BTreeMap<u32, Vec<(u32, bool)>> = BTreeMap::new();
    let mut order = Vec::new();
    for (effect, column) in main.chain(pairs) {
        let set = sets.entry(column.factors).or_default();
        if set.is_empty() {
            order.push(column.factors);
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

/// Up to so many factors every resolution has its fraction.
const COMPLETE: usize = 15;

/// The words of the generators of the smallest fraction of at least this resolution; none if the table has no such.
///
/// Of `factors` letters the first are the base factors, and each word makes one of the others, in their order.
fn minimum_aberration(factors: usize, resolution: u32) -> Option<Vec<String>> {
    let listed = TABLE.iter().find(|row| row.0 == factors && row.1 >= resolution);
    match listed {
        Some((_, _, words)) => Some(words.split(' ').map(String::from).collect()),
        // Half fractions, by the product of all base factors, have one word, of all letters.
        None if factors <= COMPLETE && resolution as usize <= factors => Some(vec![LETTERS[..factors - 1].into()]),
        None => None,
    }
}

/// Fractions of minimum aberration: of all with so many factors and points, those with the fewest short words. Number of factors,
/// resolution, words of the generators; the smallest fractions first.
///
/// For every number of factors up to 25 the table has the smallest fraction of each resolution, up to 4096 points (and
/// beyond that for 15 factors). The generators are those of the published catalogues: J. Chen, D. X. Sun, C. F. J. Wu,
/// A catalogue of two-level and three-level fractional factorial designs with small runs, Int. Stat. Rev. 61, 131–145
/// (1993), doi:10.2307/1403599; R. M. Block, R. W. Mee, Resolution IV designs with 128 runs, J. Qual. Technol. 37,
/// 282–293 (2005), doi:10.1080/00224065.2005.11980329; H. Xu, Algorithmic construction of efficient fractional
/// factorial designs with large run sizes, Technometrics 51, 262–277 (2009), doi:10.1198/tech.2009.07120, as U.
/// Grömping's FrF2 2.3-4 for R lists them. In Xu's catalogue some designs of 256 points and more are the best found,
/// not proven best.
const TABLE: &[(usize, u32, &str)] = &[
    (5, 3, "AB AC"),
    (6, 3, "AB AC BC"),
    (6, 4, "ABC ABD"),
    (7, 3, "AB AC BC ABC"),
    (7, 4, "ABC ABD ACD"),
    (8, 4, "ABC ABD ACD BCD"),
    (8, 5, "ABCD ABEF"),
    (9, 3, "AB AC AD BCD ABCD"),
    (9, 4, "ABC ABD ABE ACDE"),
    (9, 6, "ABCDE ABCFG"),
    (10, 3, "AB AC BC AD BCD ABCD"),
    (10, 4, "ABC ABD ABE ACDE BCDE"),
    (10, 5, "ABCDE ABCFG ABDF"),
    (10, 6, "ABCDEF ABCGH"),
    (11, 3, "AB AC BC AD BD ACD BCD"),
    (11, 4, "ABC ABD ACD ABE ACE ADE"),
    (11, 5, "ABCDE ABCFG ABDF ACEG"),
    (11, 6, "ABCDEFG ABCDH ABEFH"),
    (11, 7, "ABCDEFG ABCDHJ"),
    (12, 3, "AB AC BC AD BD ACD BCD ABCD"),
    (12, 4, "ABC ABD ACD BCD ABE ACE ADE"),
    (12, 6, "ABCDEFG ABCDH ABEFH ACEGH"),
    (12, 8, "ABCDEFG ABCDHJK"),
    (13, 3, "AB AC BC ABC AD BD ABD CD ACD"),
    (13, 4, "ABC ABD ACD BCD ABE ACE BCE ADE"),
    (13, 5, "ABCDEFG ABCDH ABEFH ACEGH ADFG"),
    (13, 6, "ABCDEFG ABCDHJ ABEFH ACEGJ"),
    (13, 7, "ABCDEFG ABCDHJK ABEFHJ"),
    (13, 8, "ABCDEFGH ABCDJKL"),
    (14, 3, "AB AC BC ABC AD BD ABD CD ACD BCD"),
    (14, 4, "ABC ABD ACD BCD ABE ACE BCE ADE BDE"),
    (14, 5, "ABCDEFG ABCDH ABEFH ACEGH ADFG ABDE"),
    (14, 6, "ABCDEFG ABCDHJ ABEFH ACEGJ ADFGHJ"),
    (14, 7, "ABCDEFG ABCDHJK ABEFHJ ACEGHK"),
    (14, 8, "ABCDEFG ABCDHJK ABEFHJL"),
    (14, 9, "ABCDEFGHJ ABCDEKLM"),
    (15, 3, "AB AC BC ABC AD BD ABD CD ACD BCD ABCD"),
    (15, 4, "ABC ABD ACD BCD ABE ACE BCE ADE BDE CDE"),
    (15, 5, "ABCDEFG ABCDH ABEFH ACEGH ADFG ABDE BCDF"),
    (15, 6, "ABCDEFG ABCHJ ABDEH ACDFJ BCDGH ACEFGHJ"),
    (15, 7, "ABCDEFG ABCDHJK ABEFHJ ACEGHK ADFGJK"),
    (15, 8, "ABCDEFG ABCDHJK ABEFHJL ACEGHKL"),
    (15, 10, "ABCDEFGHJ EFGHJKLMN"),
    (16, 4, "ABC ABD ACD BCD ABE ACE BCE ADE BDE CDE ABCDE"),
    (16, 5, "ABCDEFG ABCDH ABEFH ACEG BCEH ABDG CDFG ACDEFH"),
    (16, 6, "ABCDEFG ABCHJ ABDEH ACDFJ BCDGH CDEFH BCFGJ"),
    (16, 8, "ABCDEFG ABCDHJK ABEFHJL ACEGHKL ADFGJKL"),
    (17, 3, "AB AC AD BCD ABCD AE BCE ABCE BDE ABDE CDE ACDE"),
    (17, 4, "ABC ABD ACD BCD ABE ACE ABF ACF ADEF BDEF CDEF"),
    (17, 5, "ABCDEFG ABCDH ABEFH ACEG BCEH ABDG CDFG ACDEFH ACFGH"),
    (17, 6, "ABCDEFG ABCHJ ABDEH ACDFJ BCDGH CDEFH BCFGJ AEFGJ"),
    (17, 7, "ABCDEFG BCEGHJ ABCDHJK ABEFHJL ACEGHKL ADFGJKL"),
    (17, 8, "ABCDEFGH ABCDJKL ABEFJKM ACEGJLM BCEHKLM"),
    (18, 3, "AB AC BC AD BCD ABCD AE BCE ABCE BDE ABDE CDE ACDE"),
    (18, 4, "ABC ABD ACD BCD ABE ACE BCE ABF ACF ADEF BDEF CDEF"),
    (18, 6, "ABCDEFG ABCHJ ABDEH ACDFJ BCDGH CDEFH BCFGJ AEFGJ CEGHJ"),
    (18, 7, "ABCDEFG BCEGHJ ABFGHK ABCDHJK ABEFHJL ACEGHKL ADFGJKL"),
    (18, 8, "ABCDEFGHJKL ABCDEFM ABCGHJM ADEGHKM BDFGJKM CDFGHLM"),
    (19, 3, "AB AC BC AD BD BCD ABCD AE BCE ABCE BDE ABDE CDE ACDE"),
    (19, 4, "ABC ABD ACD BCD ABE ACE BCE ABF ACF BCF ADEF BDEF CDEF"),
    (19, 5, "ABCDEFG ABCDH ABEFJ ACEFH ABEGH ACDEJ ABCGJ ADFG ABDFHJ ADEGHJ"),
    (19, 6, "ABCDEFG ABCDHJK ABEFHJ ACEGHK ADFGJK BCDEH ABCGJ BDFGHJ BEFGK"),
    (19, 7, "ABCDEFG BCEGHJ ABFGHK BDEFJK ABCDHJK ABEFHJL ACEGHKL ADFGJKL"),
    (19, 8, "ABCDEFGHJKL ABCDEFM ABCGHJM ADEGHKM BDFGJKM CEFHJKM CDFGHLM"),
    (20, 3, "AB AC BC AD BD BCD ABCD AE BE BCE ABCE BDE ABDE CDE ACDE"),
    (20, 4, "ABC ABD ACD BCD ABE ACE BCE ABF ACF BCF ADEF BDEF CDEF ABCDEF"),
    (20, 5, "ABCDEFG ABCDH ABEFJ ACEFH ABEGH ACDEJ ABCGJ ADFG ABDFHJ ADEGHJ ACFGHJ"),
    (20, 6, "ABCDEFG ABCDHJK ABEFHJ ACEGHK ADFGJK BCDEH ABCGJ BDFGHJ BEFGK ADEFHK"),
    (20, 7, "ABCDEFG BCEGHJ ABFGHK BDEFJK ABCDHJK DEFGHL ABEFHJL ACEGHKL ADFGJKL"),
    (20, 8, "ABCDEFGHJKL ABCDEFM ABCGHJM ADEGHKM BDFGJKM CEFHJKM CDFGHLM AEFGJLM"),
    (21, 3, "AB AC BC AD BD BCD ABCD AE BE BCE ABCE BDE ABDE CDE ACDE ABCDE"),
    (21, 4, "ABC ABD ACD BCD ABE ACE BCE ADE ABF ADF BDF AEF CEF DEF BCDEF"),
    (21, 5, "ABCDEFG ABCDH ABEFJ ACEFH ABEGH ACDEJ ABCGJ ADFG ABDFHJ ADEGHJ ACFGHJ BCDEFGHJ"),
    (21, 6, "ABCDEFG ABCDHJK ABEFHJ ACEGHK ADFGJK BCDEH ABCGJ BDFGHJ BEFGK ADEFHK CDEGJK"),
    (21, 7, "ABCDEFG BCEGHJ ABFGHK BDEFJK ABCDHJK DEFGHL ACDEJL ABEFHJL ACEGHKL ADFGJKL"),
    (21, 8, "ABCDEFGHJKL ABCDEFM ABCGHJM ADEGHKM BDFGJKM CEFHJKM CDFGHLM AEFGJLM BDEHJLM"),
    (22, 3, "AB AC BC AD BD ACD BCD ABCD AE BE ACE BCE ABCE ADE BDE ACDE BCDE"),
    (22, 4, "ABC ABD ACD BCD ABE ACE BCE ADE ABF ACF ADF BDF AEF CEF DEF BCDEF"),
    (22, 5, "ABCDEFG ABCHJ ABDEH ACDFJ BCDGH CDEFH BCFGJ BCDEGJ ABDEFGHJ ADFG BDFJ ABEJ AEFGJ"),
    (22, 6, "ABCDEFG ABCDHJK ABEFHJ ACEGHK ADFGJK BCDEH ABCGJ BDFGHJ BEFGK ADEFHK CDEGJK CFHJK"),
    (22, 7, "ABCDEFG BCEGHJ ABFGHK BDEFJK ABCDHJK DEFGHL ACDEJL ABEFHJL BCDGKL ACEGHKL ADFGJKL"),
    (22, 8, "ABCDEFGHJKL ABCDEFM ABCGHJM ADEGHKM BDFGJKM CEFHJKM CDFGHLM AEFGJLM BDEHJLM BCEGKLM"),
    (23, 3, "AB AC BC AD BD ACD BCD ABCD AE BE ACE BCE ABCE ADE BDE ABDE CDE ACDE"),
    (23, 4, "ABC ABD ACD BCD ABE ACE BCE ADE BDE ABF ACF ADF CDF AEF CEF DEF BCDEF"),
    (23, 5, "ABCDEFG ABCHJ ABDEH ACDFJ BCDGH CDEFH BCFGJ ABCE CEGJ BCDFHJ ABEFHJ BDEG BGHJ ABFG"),
    (23, 6, "ABCDEFG ABCDHJK ABEFH ACEGJ BCFGK BCDEH DGHJK ABDEJ ACFJK BEGHJ ABDFK CDEFGHJ ABCEK"),
    (23, 7, "ABCDEFG BCEGHJ ABFGHK BDEFJK ABCDHJK DEFGHL ACDEJL ABEFHJL BCDGKL ACEGHKL ADFGJKL CFHJKL"),
    (23, 8, "ABCDEFGHJKL ABCDEFM ABCGHJM ADEGHKM BDFGJKM CEFHJKM CDFGHLM AEFGJLM BDEHJLM BCEGKLM ABFHKLM"),
    (24, 3, "AB AC BC AD BD ACD BCD ABCD AE BE ACE BCE ABCE ADE BDE ABDE CDE ACDE BCDE"),
    (24, 4, "ABC ABD ACD BCD ABE ACE BCE ADE BDE ABF ACF BCF ADF BDF AEF CEF DEF BCDEF"),
    (24, 6, "ABCDEFG ABCDHJK ABEFH ACEGJ BCFGK BCDEH BCEJK DEFHJ CGHJK AEFGK ABFGHJK BDFGH BCDGJ ACDGK"),
    (24, 8, "ABCDEFGHJKL ABCDEFM ABCGHJM ADEGHKM BDFGJKM CEFHJKM CDFGHLM AEFGJLM BDEHJLM BCEGKLM ABFHKLM ACDJKLM"),
    (25, 3, "AB AC BC ABC AD BD ABD CD ACD AE BE ABE CE ACE BDE ABDE CDE ACDE BCDE ABCDE"),
    (25, 4, "ABC ABD ACD BCD ABE ACE BCE ADE BDE CDE ABF ACF BCF ADF BDF AEF CEF DEF BCDEF"),
    (25, 5, "ABCDE ACDFG BCDFH ACEGH BCDEGH ABDFJ ABEGJ ABCEFHJ ABCHK ACDEFHK CDGHK ACFJK ABCDGJK CDEFGJK ADEGHJK"),
    (
        25,
        6,
        "ABCEFGH BCDFGHJ ABDEFGK BCEGJK ADGHJK ABDGHL ABEJL CDGJL BCDEHJL BCDFGKL CEGHKL ABCDJKL CDFHJKL \
     ABCDEFGHJKL",
    ),
];

#[cfg(test)]
#[path = "../../tests/unit/design/factorial.rs"]
mod tests;
