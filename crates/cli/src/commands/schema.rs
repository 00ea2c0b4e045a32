//! `plateau schema`: the JSON Schema of scenes.

use plateau_io::scene::schema;

use crate::failure::Failure;
use crate::table;

/// Prints the schema.
pub fn schema() -> Result<(), Failure> {
    table::print(&format!("{:#}\n", schema::json_schema()))
}
