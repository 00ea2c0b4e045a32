//! Damaged and hostile files of every kind: whatever is in them, there is an answer, in bounded time and memory.
//!
//! Good files are changed at random: byte by byte (`bytes.rs`), text line by line and value by value (`lines.rs`), archives entry by
//! entry, and what carries a checksum is sealed again, so that what is behind it is reached. Some hundred changes of each kind are
//! tried by default, always the same; `PLATEAU_FUZZ_SECONDS=600` tries new ones, each kind for ten minutes. A file that fails is kept
//! in `tests/corpus`, so that it is tried first from then on (`harness.rs`).

mod bytes;
mod harness;
mod lines;
mod pictures;
mod results;
mod scenes;
mod states;
mod studies;
mod surfaces;
