//! Which program this is.

/// Revision of the source that the program was built from.
pub const REVISION: &str = env!("PLATEAU_REVISION");

/// Name and version.
pub fn program() -> String {
    format!("plateau {}", env!("CARGO_PKG_VERSION"))
}
