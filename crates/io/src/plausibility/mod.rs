//! Input that is legal but cannot be meant: a wrong unit, a slip of the pen.
//!
//! | known | rules |
//! |---|---|
//! | from the scene alone | [`of_scene`] |
//! | with its surfaces | [`of_surfaces`] |
//! | from what a run recorded | [`Recorded`] |
//!
//! Each is a list of rules. A rule belongs to the key that is most likely wrong; it looks, and tells what it found, the
//! bound and what to do. `docs/scenes.md` lists them all.

mod rule;
mod scene;
mod surfaces;

pub use scene::of_scene;
pub use surfaces::{Recorded, of_surfaces};
