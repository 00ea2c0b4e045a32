//! Figures that the program made, for the page.

/// A figure: a drawing in SVG with what is said below it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// A short name, such as that of its file.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// The drawing.
    pub svg: String,
}
