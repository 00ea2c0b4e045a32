//! Text that instruments write in forms of their own, told by how it starts.

mod keyence;
mod wyko;
mod zygo;

use super::block;
use super::error::TextError;
use super::numbers::Numbers;
use super::profile;
use super::table::Table;
use crate::delimited::lines;
use crate::surface::options::ReadOptions;

/// Reads the export of an instrument; none if the text is no such export.
pub(super) fn read(text: &str, options: &ReadOptions) -> Result<Option<Table>, TextError> {
    let Some((_, first)) = lines(text).next() else { return Ok(None) };
    let first = first.trim_start();
    // These have one table of heights, by what their headers state.
    if [wyko::MAGIC, zygo::POINTS, zygo::PHASES].iter().any(|magic| first.starts_with(magic)) {
        block::number(options, 1)?;
    }
    if first.starts_with(wyko::MAGIC) {
        return wyko::read(text, options).map(Some);
    }
    if first.starts_with(zygo::POINTS) {
        return zygo::points(text, options).map(Some);
    }
    if first.starts_with(zygo::PHASES) {
        return zygo::phases(text, options).map(Some);
    }
    if first.starts_with("Scan Parameters") {
        return dektak(text, options);
    }
    keyence::read(text, options)
}

/// A profile of Dektak (Bruker): what was set and what came of it, then below a line "Scan Data" the columns with their
/// names.
fn dektak(text: &str, options: &ReadOptions) -> Result<Option<Table>, TextError> {
    let data = lines(text).skip_while(|(_, line)| line.trim() != "Scan Data").skip(1);
    if data.clone().next().is_none() {
        return Ok(None);
    }
    let numbers = Numbers::read(data, None, options)?;
    if options.profile_lay.is_none() {
        return Err(TextError::IsProfile { columns: numbers.columns, lines: numbers.lines.len() });
    }
    profile::read(&numbers, options).map(|table| Some(named("Dektak CSV", table)))
}

/// The table with the name of its form as first note.
fn named(name: &str, mut table: Table) -> Table {
    table.notes.insert(0, name.to_owned());
    table
}
