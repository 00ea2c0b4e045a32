//! Goals and limits of an optimum, as they are given in words: `contact area`, `filled=0.7`, `worn=0.1 mm3..0.3 mm3`.

use plateau_io::brief;
use plateau_io::text::short;
use plateau_study::optimum::{Kept, Limit, Wish};

use super::analysis::{AnalysedResponse, Analysis};
use crate::quantity::Unit;

/// What is between the values of a goal.
const TO: &str = "..";

/// What is wanted of a response.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aim {
    /// As large as can be.
    Maximize,
    /// As small as can be.
    Minimize,
    /// A value.
    Target,
}

impl Aim {
    /// The option of the command line.
    pub fn option(self) -> &'static str {
        match self {
            Self::Maximize => "--maximize",
            Self::Minimize => "--minimize",
            Self::Target => "--target",
        }
    }
}

/// The number of the response of this name.
///
/// # Errors
/// The names that there are.
pub fn response(analysis: &Analysis, name: &str) -> Result<usize, String> {
    let name = name.trim();
    analysis.responses.iter().position(|response| response.name == name).ok_or_else(|| {
        let names = brief::list(analysis.responses.iter().map(|response| format!("\"{}\"", response.name)), ", ");
        format!("\"{}\" is not a response of the study, expected one of {names}", short(name))
    })
}

/// The response that a text begins with, and what stands behind it: nothing, or one of these signs and a value. A name may have signs,
/// too: of several that fit the longest is meant.
fn named<'a>(
    analysis: &Analysis,
    text: &'a str,
    signs: &[&'static str],
) -> Option<(usize, Option<(&'static str, &'a str)>)> {
    let text = text.trim();
    let fits = |(at, response): (usize, &AnalysedResponse)| {
        let rest = text.strip_prefix(response.name.trim())?.trim_start();
        let sign = || signs.iter().find_map(|sign| Some((*sign, rest.strip_prefix(sign)?)));
        let behind = if rest.is_empty() { None } else { Some(sign()?) };
        Some((response.name.len(), (at, behind)))
    };
    let fitting = analysis.responses.iter().enumerate().filter_map(fits);
    fitting.max_by_key(|(length, _)| *length).map(|(_, found)| found)
}

/// A response and what it should be: `NAME`, `NAME=LOW..HIGH`, for targets `NAME=VALUE` or `NAME=LOW..VALUE..HIGH`. Bounds that
/// are not given are the least and the largest response of the runs.
///
/// # Errors
/// What was found and what was expected.
pub fn wish(analysis: &Analysis, aim: Aim, text: &str) -> Result<(usize, Wish), String> {
    let at = |error: String| format!("{} \"{text}\": {error}", aim.option());
    let (number, values) = match named(analysis, text, &["="]) {
        Some((number, behind)) => (number, behind.map(|(_, values)| values)),
        None => {
            let (name, values) = text.rsplit_once('=').map_or((text, None), |(name, values)| (name, Some(values)));
            (response(analysis, name).map_err(at)?, values)
        }
    };
    let values: Vec<&str> = values.map_or_else(Vec::new, |values| values.split(TO).map(str::trim).collect());
    let own = &analysis.responses[number];
    let values =
        values.into_iter().map(|value| self::value(own, value)).collect::<Result<Vec<f64>, _>>().map_err(at)?;
    let [low, high] = observed(analysis, number).ok_or_else(|| at("no run has this response".to_owned()))?;
    let wish = match (aim, &values[..]) {
        (Aim::Maximize, []) => Wish::Maximum([low, high]),
        (Aim::Minimize, []) => Wish::Minimum([low, high]),
        (Aim::Maximize, [low, high]) => Wish::Maximum([*low, *high]),
        (Aim::Minimize, [low, high]) => Wish::Minimum([*low, *high]),
        (Aim::Target, [low, target, high]) => Wish::Target([*low, *target, *high]),
        (Aim::Target, [target]) => {
            if !(low..=high).contains(target) {
                let range = [low, high].map(|end| own.shown_with_unit(end)).join(" to ");
                return Err(at(format!(
                    "the runs have {range}; to aim beyond them give all three values, LOW..VALUE..HIGH"
                )));
            }
            // As far on both sides, so that the target is worth most whichever side it is come from.
            let reach = (high - target).max(target - low);
            Wish::Target([target - reach, *target, target + reach])
        }
        (Aim::Target, _) => return Err(at("expected NAME=VALUE or NAME=LOW..VALUE..HIGH".to_owned())),
        _ => return Err(at("expected NAME or NAME=LOW..HIGH".to_owned())),
    };
    if low >= high && matches!((aim, &values[..]), (Aim::Maximize | Aim::Minimize, [])) {
        let value = own.shown_with_unit(low);
        return Err(at(format!("all runs have {value}, so there is nothing to choose; give NAME=LOW..HIGH to go on")));
    }
    if wish.is_sound() { Ok((number, wish)) } else { Err(at("expected values that ascend".to_owned())) }
}

/// A limit: `NAME<=VALUE` or `NAME>=VALUE`, and what has to keep it.
///
/// # Errors
/// What was found and what was expected.
pub fn limit(analysis: &Analysis, text: &str, kept: Kept) -> Result<Limit, String> {
    let at = |error: String| format!("--limit \"{text}\": {error}");
    let (response, bound, is_least) = match named(analysis, text, &["<=", ">="]) {
        Some((response, Some((sign, bound)))) => (response, bound, sign == ">="),
        _ => {
            let (split, is_least) = match (text.split_once("<="), text.split_once(">=")) {
                (Some(split), None) => (split, false),
                (None, Some(split)) => (split, true),
                _ => return Err(at("expected \"NAME<=VALUE\" or \"NAME>=VALUE\"".to_owned())),
            };
            (response(analysis, split.0).map_err(at)?, split.1, is_least)
        }
    };
    let value = value(&analysis.responses[response], bound).map_err(at)?;
    let [low, high] = observed(analysis, response).ok_or_else(|| at("no run has this response".to_owned()))?;
    let scale = if high > low { high - low } else { 1.0 };
    let (least, most) = if is_least { (Some(value), None) } else { (None, Some(value)) };
    Ok(Limit { response, least, most, scale, kept })
}

/// A power of a goal: `NAME=NUMBER`.
///
/// # Errors
/// What was found and what was expected.
pub fn power(analysis: &Analysis, option: &str, text: &str) -> Result<(usize, f64), String> {
    let at = |error: String| format!("{option} \"{text}\": {error}");
    let (response, power) = match named(analysis, text, &["="]) {
        Some((response, Some((_, power)))) => (response, power),
        _ => {
            let (name, power) = text.rsplit_once('=').ok_or_else(|| at("expected NAME=NUMBER".to_owned()))?;
            (response(analysis, name).map_err(at)?, power)
        }
    };
    let power: Option<f64> = power.trim().parse().ok().filter(|power: &f64| (0.01..=100.0).contains(power));
    power.map(|power| (response, power)).ok_or_else(|| at("expected a number between 0.01 and 100".to_owned()))
}

/// The least and the largest response of the runs.
pub fn observed(analysis: &Analysis, response: usize) -> Option<[f64; 2]> {
    let values = analysis.runs.iter().map(|(_, responses)| responses[response]).filter(|value| value.is_finite());
    values.fold(None, |range, value| {
        Some(range.map_or([value; 2], |[low, high]: [f64; 2]| [low.min(value), high.max(value)]))
    })
}

/// A value of a response with its unit, in SI.
fn value(response: &AnalysedResponse, text: &str) -> Result<f64, String> {
    let text = &text.trim().replace('\u{2212}', "-");
    let spaced = text.strip_suffix('%').map_or_else(|| text.clone(), |number| format!("{} %", number.trim()));
    let (number, unit) = spaced.split_once(' ').map_or((spaced.as_str(), ""), |(number, unit)| (number, unit.trim()));
    let known = Unit::known(response.unit);
    let mut names: Vec<String> = known.iter().map(|unit| plain(&unit.symbol)).filter(|name| !name.is_empty()).collect();
    names
        .extend((!names.contains(&response.unit.to_owned()) && response.unit != "1").then(|| response.unit.to_owned()));
    names.extend((response.unit == "1").then(|| "%".to_owned()));
    let found: Option<f64> = number.parse().ok().filter(|number: &f64| number.is_finite());
    let Some(number) = found else { return Err(format!("\"{text}\" is not a number with a unit")) };
    let unit = plain(unit);
    if response.unit == "1" && (unit.is_empty() || unit == "%") {
        return Ok(if unit == "%" { number / 100.0 } else { number });
    }
    if let Some(unit) = known.iter().find(|known| plain(&known.symbol) == unit) {
        return Ok((number - unit.offset) / unit.per_si);
    }
    if unit == plain(response.unit) {
        return Ok(number);
    }
    Err(format!("\"{}\": expected a unit of {}", short(text), names.join(", ")))
}

/// A unit as it is typed: `mm²`, `mm^2` and `mm2` are the same.
fn plain(unit: &str) -> String {
    let letter = |letter: char| match letter {
        '²' => Some('2'),
        '³' => Some('3'),
        '¹' => Some('1'),
        '\u{207b}' | '\u{2212}' => Some('-'),
        'µ' | 'μ' => Some('u'),
        '^' => None,
        other => Some(other),
    };
    unit.chars().filter_map(letter).collect()
}

/// A limit in words: `≤ 0.25 mm³`.
pub fn limit_words(response: &AnalysedResponse, limit: &Limit) -> String {
    let of = match limit.kept {
        Kept::Value => "",
        Kept::Means => " for the interval of means",
        Kept::Runs => " for the interval of runs",
    };
    limit_sides(response, limit) + of
}

/// The same without what has to keep it.
pub fn limit_sides(response: &AnalysedResponse, limit: &Limit) -> String {
    let sides = [("≥", limit.least), ("≤", limit.most)];
    let sides: Vec<String> = sides
        .into_iter()
        .filter_map(|(sign, value)| Some(format!("{sign} {}", response.shown_with_unit(value?))))
        .collect();
    sides.join(" and ")
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn units_are_told_however_they_are_typed() {
        assert_eq!(["mm²", "mm^2", "mm2"].map(plain), ["mm2"; 3]);
        assert_eq!(plain("µm³"), "um3");
        assert_eq!(plain("km⁻¹"), "km-1");
    }
}
