//! Synthetic heights.

/// A Gaussian random field with autocorrelation exp(−(ρ/ℓ)²).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightSynthesis {
    /// Seed of the random stream.
    pub seed: u64,
    /// Realised rms height, m.
    pub rms_height: f64,
    /// ℓ, m.
    pub correlation_length: f64,
    /// Keeps only the harmonics that repeat round the ring a whole number of times nearest to this length, m.
    pub patch: Option<f64>,
}
