//! The preparation chain of a surface.

/// What is taken out of a surface before anything else.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// Nothing.
    None,
    /// The mean height.
    Mean,
    /// The least-squares plane.
    Plane,
}

/// The preparation chain; a step that is absent is not done. Applied in the order of the fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Preparation {
    /// Levelling; missing points do not take part.
    pub level: Level,
    /// Whether missing points get the levelled surface's mean; without it they are an error.
    pub fill_missing: bool,
    /// Reinterprets the distance of the points, m.
    pub pixel: Option<f64>,
    /// Cuts what stands higher than this above the mean, m (along the Abbott-Firestone curve).
    pub cutoff: Option<f64>,
    /// Tiles the patch along the sliding direction without a step at the seams.
    pub repeat: bool,
    /// Multiplies the heights.
    pub scale: f64,
}
