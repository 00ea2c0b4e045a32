//! Every key of a scene: where it belongs, what it holds, what it defaults to and what it means.
//!
//! One table ([`keys`]) serves for checking, for messages about unknown keys, for the resolved scene and for
//! documentation. The order is that of docs/scenes.md.

pub mod choices;
mod example;
mod exclusions;
mod heights;
mod json_schema;
mod key;
mod keys;
mod lookup;
mod mesh;
mod optional_parts;
mod range;
mod straightening;
mod suggest;
mod table;
mod tables;
mod ways;

pub use exclusions::{GROUPS, Group, MEANINGLESS, Meaningless};
pub use json_schema::document as json_schema;
pub use key::{Choose, Key, Kind, Need, Role};
pub(crate) use key::{is_below, join};
pub(crate) use keys::{ACCELERATION, CYCLE};
pub use lookup::{find, is_input, is_table, keys, role};
pub(crate) use lookup::{may_be_none, optional_table, sections};
pub use range::Range;
pub(crate) use suggest::{nearest, unknown};
pub use tables::table_meaning;
pub use ways::{WAYS, Ways};
