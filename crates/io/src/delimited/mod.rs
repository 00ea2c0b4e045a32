//! Text of numbers that others have written: surfaces, cycles, designs, values that were measured. All of it is read by one rule.
//!
//! | file | content |
//! |---|---|
//! | `file.rs` | the text of a file, decoded; refusal of workbooks and archives |
//! | `dialect.rs` | numbered lines, separators of cells, the decimal mark of numbers, the beginning of a second table |
//! | `named.rs` | a table whose first line names its columns |

mod dialect;
mod file;
mod named;

pub(crate) use dialect::{Kind, Separator, lines, starts, stated_separator};
pub(crate) use file::{is_utf16, read, workbook};
pub(crate) use named::{Fault, Line, Named};

pub use dialect::{Decimal, numbered};
pub use file::decode;
