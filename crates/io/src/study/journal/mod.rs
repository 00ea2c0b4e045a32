//! Where the results of a study are kept while many processes make them.
//!
//! Every process appends records to a file of its own, a *shard*: there is never a second writer, so no lock is needed and
//! network file systems will do. A record is one line, a checksum (CRC-32, 8 hexadecimal digits) and JSON; a line that is
//! torn or damaged is passed over, and its run is made again. `name.open` is being written, `name.journal` is complete.
//!
//! Shards that nobody writes any more are merged, so that their number stays bounded however often a study is taken up
//! again: [`merge`](fn@merge). Only those of which every line was understood are: what else has such a name may be somebody's notes.
//!
//! ```text
//! line     a record as a line, with its checksum
//! shard    a file of such lines that one process writes
//! index    where each record is -> Journal
//! merge    many shards made one
//! ```

mod index;
mod line;
mod merge;
mod shard;

pub use index::{Entry, Journal};
pub use merge::merge;
pub use shard::Shard;

#[cfg(test)]
mod tests;
