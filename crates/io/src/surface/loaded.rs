//! What comes of the surfaces of a scene, and what is to be warned of.

use std::path::PathBuf;

use plateau_core::model::state::InitialSurfaces;
use plateau_core::surface::Patch;

/// With what a line of the report goes on that is a warning, behind the table of the scene.
const MARK: &str = ": warning: ";

/// The surfaces of a scene, ready for the first step.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// Heights and bases of every cell.
    pub surfaces: InitialSurfaces,
    /// Fraction of the points that `disc.prepare.cutoff` cut; none without it.
    pub disc_cut: Option<f64>,
    /// The same of `pin.prepare.cutoff`.
    pub pin_cut: Option<f64>,
    /// Every surface file read, each once, with the SHA-256 of what was read of it, in hexadecimal digits.
    pub inputs: Vec<(PathBuf, String)>,
    /// What was read, made and done, one step a line, for people.
    pub report: Vec<String>,
}

impl Loaded {
    /// The lines of the report that are warnings, without the word.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.report.iter().filter(|line| line.contains(MARK)).map(|line| line.replacen(MARK, ": ", 1))
    }
}

/// The patches from which the heights of a scene come.
#[derive(Debug, Clone, Default)]
pub struct Patches {
    /// That of the disc.
    pub disc: Option<Patch>,
    /// That of the pin.
    pub pin: Option<Patch>,
}
