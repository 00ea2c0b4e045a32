//! What the crate promises, from outside. One program, for every one that is linked takes time.

mod designs;
