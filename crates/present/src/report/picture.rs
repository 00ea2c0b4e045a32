//! Figures that the program made, for the page.

use crate::figure::run::Figures;
use crate::figure::{Figure, FigureError};

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

/// The pictures of a page, and what was left out of them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Pictures {
    /// The pictures, in the order of the page.
    pub pictures: Vec<Picture>,
    /// In words, what is missing and why.
    pub left_out: Vec<String>,
}

impl Pictures {
    /// Draws figures.
    ///
    /// # Errors
    /// [`FigureError`] when one cannot be drawn.
    pub fn draw(figures: &Figures) -> Result<Self, FigureError> {
        let picture = |figure: &Figure| {
            let svg = figure.svg()?;
            Ok(Picture { name: figure.name.clone(), caption: figure.caption.clone(), svg })
        };
        let pictures = figures.figures.iter().map(picture).collect::<Result<_, FigureError>>()?;
        Ok(Self { pictures, left_out: figures.left_out.iter().map(|reason| format!("Figures: {reason}.")).collect() })
    }
}
