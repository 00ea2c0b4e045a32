//! Every key of a scene: where it belongs, what it holds, what it defaults to and what it means.
//!
//! One table ([`keys`]) serves for checking, for messages about unknown keys, for the resolved scene and for
//! documentation. The order is that of docs/scenes.md.

pub mod choices;
mod exclusions;
mod key;
mod keys;
mod lookup;

pub use exclusions::{GROUPS, Group, MEANINGLESS, Meaningless, WAYS, Ways};
pub use key::{Choose, Key, Kind, Need, Range, Role};
pub use key::{is_below, join};
pub(crate) use keys::{ACCELERATION, BRAKING_TORQUE, CYCLE, CYCLE_COLUMNS};
pub use lookup::{children, find, is_input, is_table, keys, may_be_none, optional_table, role};
pub(crate) use lookup::{sections, unknown};
