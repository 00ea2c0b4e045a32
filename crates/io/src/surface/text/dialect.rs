//! The numbers of a line: what parts them, their decimal mark, told from all lines or refused where these can be read in two ways, and the
//! words for points without a height.

use crate::delimited::{Decimal, Separator};
use crate::surface::error::{Fault, TextError};

/// The number in a cell; NaN where a point is missing.
pub(super) fn number(cell: &str, decimal: Decimal) -> Result<f64, Fault> {
    let parsed = match decimal {
        Decimal::Point => cell.parse::<f64>().ok(),
        Decimal::Comma => with_comma(cell),
    };
    let number = parsed.or_else(|| missing(cell)).ok_or_else(|| fault(cell, decimal))?;
    if number.is_infinite() { Err(Fault::Infinite) } else { Ok(number) }
}

/// A number with a decimal comma, or with neither comma nor point.
fn with_comma(cell: &str) -> Option<f64> {
    let Some((whole, fraction)) = cell.split_once(',') else {
        return if cell.contains('.') { None } else { cell.parse().ok() };
    };
    // "1, 2" without its blanks must not become 1 and 0.2.
    let between_digits = whole.ends_with(|digit: char| digit.is_ascii_digit())
        && fraction.starts_with(|digit: char| digit.is_ascii_digit());
    if between_digits && !cell.contains('.') { cell.replacen(',', ".", 1).parse().ok() } else { None }
}

/// Finds the reason why a cell is no number.
fn fault(cell: &str, decimal: Decimal) -> Fault {
    if is_grouped(cell) {
        return Fault::Grouped;
    }
    match decimal {
        Decimal::Point if with_comma(cell).is_some() => Fault::Mark(Decimal::Comma),
        Decimal::Comma if cell.parse::<f64>().is_ok() => Fault::Mark(Decimal::Point),
        _ => Fault::NotANumber,
    }
}

/// Tells whether digits stand in groups of three, as in 1,234.5 or 1.234.567: with both marks, or one of them more than once.
fn is_grouped(cell: &str) -> bool {
    let digits = cell.strip_prefix(['+', '-']).unwrap_or(cell);
    let Some(mark) = digits.chars().find(|character| [',', '.'].contains(character)) else { return false };
    let mut groups: Vec<&str> = digits.split(mark).collect();
    let last = groups.pop().unwrap_or_default();
    let other = if mark == ',' { '.' } else { ',' };
    let (group, fraction) = last.split_once(other).map_or((last, None), |(group, fraction)| (group, Some(fraction)));
    let is_digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    is_digits(groups[0])
        && groups[0].len() <= 3
        && groups[1..].iter().chain([&group]).all(|group| group.len() == 3 && is_digits(group))
        && (groups.len() > 1 || fraction.is_some_and(is_digits))
}

/// NaN, or an infinite number, where a cell is what programs write for a point that was not measured; none for another cell.
fn missing(cell: &str) -> Option<f64> {
    let all = |mark: u8| cell.bytes().all(|byte| byte == mark);
    if all(b'*') || all(b'-') || ["bad", "na", "n/a", "no data"].iter().any(|word| cell.eq_ignore_ascii_case(word)) {
        return Some(f64::NAN);
    }
    // What the C library of Windows prints: 1.#QNAN, -1.#IND00, 1.#INF, -nan(ind).
    let unsigned = cell.strip_prefix(['+', '-']).unwrap_or(cell).to_ascii_lowercase();
    if let Some(word) = unsigned.strip_prefix("1.#").or(unsigned.strip_prefix("1,#")) {
        let known = [("qnan", f64::NAN), ("snan", f64::NAN), ("ind", f64::NAN), ("inf", f64::INFINITY)];
        return known.iter().find(|(known, _)| word.starts_with(known)).map(|(_, number)| *number);
    }
    (unsigned.starts_with("nan(") && unsigned.ends_with(')')).then_some(f64::NAN)
}

/// Text of a file as it can stand in a message.
pub(super) fn shown(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut shown: String = text.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if text.chars().nth(LONGEST).is_some() {
        shown.push_str("...");
    }
    shown
}

pub(super) fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with(['#', '%'])
}

/// Tells whether a line has numbers: a number in its first cell that is not empty, or nothing but missing points.
pub(super) fn starts_numbers(line: &str) -> bool {
    let separator = Separator::of(line);
    let mut cells = separator.cells(line, false).filter(|cell| !cell.is_empty());
    // An infinite number and the like are told as such.
    cells.next().is_none_or(|cell| !matches!(number(cell, Decimal::Point), Err(Fault::NotANumber)))
}

/// Separator and decimal mark of the numbers of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Dialect {
    pub(super) separator: Separator,
    pub(super) decimal: Decimal,
}

impl Dialect {
    /// The dialect of these lines of numbers. The file may state its separator, the scene give the decimal mark, the header name so many
    /// `columns`.
    pub(super) fn find<'a>(
        lines: impl Iterator<Item = (usize, &'a str)> + Clone,
        stated: Option<char>,
        given: Option<Decimal>,
        columns: Option<usize>,
    ) -> Result<Self, TextError> {
        let separator = match stated {
            Some(mark) => Separator::Character(mark),
            None => separator(lines.clone(), given, columns)?,
        };
        let decimal = match given {
            Some(decimal) => decimal,
            // Between commas a number has a comma only if it is quoted.
            None if lines.clone().any(|(_, line)| is_mark_in_cells(separator, line)) => decimal(lines, separator)?,
            None => Decimal::Point,
        };
        Ok(Self { separator, decimal })
    }
}

/// Tells whether a comma can be part of a cell of the line.
fn is_mark_in_cells(separator: Separator, line: &str) -> bool {
    line.contains(',') && (separator != Separator::Character(',') || line.contains('"'))
}

/// Finds the separator of the numbers: what the first line has, where that cannot be a decimal comma.
fn separator<'a>(
    lines: impl Iterator<Item = (usize, &'a str)> + Clone,
    given: Option<Decimal>,
    columns: Option<usize>,
) -> Result<Separator, TextError> {
    const COMMA: Separator = Separator::Character(',');
    let Some((line, first)) = lines.clone().next() else { return Ok(Separator::Blanks) };
    let separator = Separator::of(first);
    if separator != COMMA || first.contains('"') {
        return Ok(separator);
    }
    // What parts the numbers if commas are decimal.
    let other =
        if lines.clone().any(|(_, line)| has_both_commas(line)) { Separator::CommaAndBlank } else { Separator::Blanks };
    match given {
        Some(Decimal::Point) => return Ok(COMMA),
        Some(Decimal::Comma) => return Ok(other),
        None => {}
    }
    if lines.clone().any(|(_, line)| line.contains('.')) {
        return Ok(COMMA);
    }
    if let Some((line, part)) = comma_twice(lines.clone()) {
        return Err(TextError::CommaTwice { line, found: shown(first.trim()), part: shown(part) });
    }
    if !fits(other, first) {
        return Ok(COMMA);
    }
    let all_fit = |separator: Separator| {
        let count = separator.cells(first, false).count();
        lines.clone().all(|(_, line)| fits(separator, line) && separator.cells(line, false).count() == count)
    };
    if !fits(COMMA, first) || !all_fit(COMMA) {
        return Ok(other);
    }
    if !all_fit(other) {
        return Ok(COMMA);
    }
    let named = |separator: &Separator| Some(separator.cells(first, false).count()) == columns;
    [COMMA, other].into_iter().find(named).ok_or_else(|| TextError::CommaOrColumns { line, found: shown(first.trim()) })
}

/// Tells whether a line has commas within numbers and commas between them, as `1,5, 2,5`.
fn has_both_commas(line: &str) -> bool {
    line.contains(", ") && line.split(", ").any(|cell| cell.trim_end_matches(',').contains(','))
}

/// Finds what can only be a part of a number, where all lines are of pairs of digits, as in `-0,0469,0,0192`: a whole number -0, or a
/// fraction with a zero in front.
fn comma_twice<'a>(lines: impl Iterator<Item = (usize, &'a str)>) -> Option<(usize, &'a str)> {
    let are_digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let has_zero = |digits: &str| digits.len() > 1 && digits.starts_with('0');
    let mut found = None;
    for (line, text) in lines {
        let cells: Vec<&str> = text.trim().trim_end_matches(',').split(',').collect();
        for pair in cells.chunks(2) {
            let &[whole, fraction] = pair else { return None };
            let digits = whole.trim_start_matches(['+', '-']);
            if !are_digits(digits) || !are_digits(fraction) || has_zero(digits) {
                return None;
            }
            if whole == "-0" || has_zero(fraction) {
                found.get_or_insert((line, if whole == "-0" { whole } else { fraction }));
            }
        }
    }
    found
}

/// Tells whether every cell of a line is a number, with a decimal comma unless commas part them.
fn fits(separator: Separator, line: &str) -> bool {
    separator.cells(line, false).all(|cell| matches!(number(cell, Decimal::Comma), Ok(_) | Err(Fault::Infinite)))
}

/// The decimal mark, from the first number that can have only one of them.
fn decimal<'a>(lines: impl Iterator<Item = (usize, &'a str)>, separator: Separator) -> Result<Decimal, TextError> {
    // The first number such as 1,234, which may have a fraction or a group of digits.
    let mut ambiguous = None;
    let mut has_long_number = false;
    for (line, text) in lines {
        for (column, cell) in separator.cells(text, false).enumerate() {
            if cell.contains('#') || number(cell, Decimal::Point).is_ok_and(f64::is_nan) {
                continue;
            }
            if number(cell, Decimal::Point) == Err(Fault::Grouped) {
                let (column, found) = (column + 1, shown(cell));
                return Err(TextError::Cell { line, column, found, fault: Fault::Grouped, beside: None });
            }
            if cell.contains('.') && number(cell, Decimal::Point).is_ok() {
                return Ok(Decimal::Point);
            }
            has_long_number |= is_long(cell);
            if cell.contains(',') && number(cell, Decimal::Comma).is_ok() {
                if !may_be_group(cell) {
                    return Ok(Decimal::Comma);
                }
                ambiguous.get_or_insert((line, column + 1, cell));
            }
        }
    }
    match ambiguous {
        Some((line, column, cell)) if !has_long_number => {
            Err(TextError::AmbiguousComma { line, column, found: shown(cell) })
        }
        Some(_) => Ok(Decimal::Comma),
        None => Ok(Decimal::Point),
    }
}

/// Tells whether the comma of a number may part a group of digits, as in 1,234: one to three digits, of which the first is not
/// 0, before it and three after it.
fn may_be_group(cell: &str) -> bool {
    let digits = cell.strip_prefix(['+', '-']).unwrap_or(cell);
    digits.split_once(',').is_some_and(|(whole, group)| {
        whole.len() <= 3
            && !whole.starts_with('0')
            && group.len() == 3
            && group.bytes().all(|byte| byte.is_ascii_digit())
    })
}

/// Tells whether a number has more than three digits before a comma, which shows that digits are not grouped.
fn is_long(cell: &str) -> bool {
    let digits = cell.strip_prefix(['+', '-']).unwrap_or(cell);
    digits.bytes().take_while(u8::is_ascii_digit).count() > 3
}
