//! Text of numbers that others have written: surfaces, cycles, designs, values that were measured. All of it is read by one rule.
//!
//! | file | what is in it |
//! |---|---|
//! | `file.rs` | the text of a file, and what is told instead of a workbook or an archive |
//! | `encoding.rs`, `lines.rs` | from bytes to numbered lines |
//! | `separator.rs`, `decimal.rs` | what parts the cells of a line, and the decimal mark of numbers |
//! | `block.rs` | where another table begins below the first |
//! | `named.rs` | a table whose first line names its columns |

mod block;
mod decimal;
mod encoding;
mod file;
mod lines;
mod named;
mod separator;

pub(crate) use block::{Kind, starts};
pub use decimal::Decimal;
pub use encoding::decode;
pub(crate) use encoding::is_utf16;
pub(crate) use file::{read, workbook};
pub use lines::numbered;
pub(crate) use lines::{lines, stated_separator};
pub(crate) use named::{Fault, Line, Named};
pub(crate) use separator::Separator;
