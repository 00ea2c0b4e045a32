//! Random numbers that are the same on every machine.

use rand_chacha::ChaCha12Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Source of a scene that draws the numbers; equal seeds in different sources give unrelated numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u64)]
pub(crate) enum Stream {
    DiscHeight = 1,
    PinHeight = 2,
    PinBase = 3,
    DiscExtension = 4,
    PinExtension = 5,
    PinBaseExtension = 6,
}

/// One random stream of one seed.
pub(crate) struct Random {
    generator: ChaCha12Rng,
    /// Second normal number of a pair, as the polar method gives them; none once it is used.
    spare: Option<f64>,
}

impl Random {
    pub(crate) fn new(seed: u64, stream: Stream) -> Self {
        // The key is spelt out because `seed_from_u64` may change with the version of the crate.
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        let mut generator = ChaCha12Rng::from_seed(key);
        generator.set_stream(stream as u64);
        Self { generator, spare: None }
    }

    /// Number uniform in [0, 1), a multiple of 2⁻⁵³.
    pub(crate) fn uniform(&mut self) -> f64 {
        (self.generator.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Standard normal number, by Marsaglia's polar method.
    pub(crate) fn normal(&mut self) -> f64 {
        if let Some(second) = self.spare.take() {
            return second;
        }
        loop {
            let x = 2.0 * self.uniform() - 1.0;
            let y = 2.0 * self.uniform() - 1.0;
            let square = x * x + y * y;
            if square > 0.0 && square < 1.0 {
                let factor = (-2.0 * libm::log(square) / square).sqrt();
                self.spare = Some(y * factor);
                return x * factor;
            }
        }
    }
}
