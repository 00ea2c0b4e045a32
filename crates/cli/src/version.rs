//! Which program this is.

/// Revision of the source that the program was built from.
pub const REVISION: &str = env!("PLATEAU_REVISION");

/// Name, version and revision of the source: what tells results of different programs apart.
pub fn build() -> String {
    format!("{} {REVISION}", program())
}

/// Name and version.
pub fn program() -> String {
    format!("plateau {}", env!("CARGO_PKG_VERSION"))
}
