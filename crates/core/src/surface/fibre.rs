//! Synthetic fibre maps.

/// Fibres as capsules at random places and angles, up to a given area fraction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FibreSynthesis {
    /// Seed of the random stream.
    pub seed: u64,
    /// Area fraction of the pin that is fibre.
    pub fibre_fraction: f64,
    /// Length of a fibre from end to end, m.
    pub fibre_length: f64,
    /// Width of a fibre, m.
    pub fibre_width: f64,
}
