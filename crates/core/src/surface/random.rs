//! Random numbers that are the same on every machine.

use rand_chacha::ChaCha12Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Which source of a scene draws the numbers; equal seeds in different sources give unrelated numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u64)]
pub(crate) enum Stream {
    DiscHeight = 1,
    PinHeight = 2,
    PinBase = 3,
    DiscExtension = 4,
    PinExtension = 5,
}

/// One random stream of one seed.
pub(crate) struct Random {
    generator: ChaCha12Rng,
    /// The polar method gives normal numbers in pairs; the second waits here.
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

    /// Uniform in [0, 1), a multiple of 2⁻⁵³.
    pub(crate) fn uniform(&mut self) -> f64 {
        (self.generator.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Standard normal, by Marsaglia's polar method.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_numbers_have_the_moments_of_the_normal_distribution() {
        // Variances of the sample moments of N normal numbers: 1/N, 2/N, 96/N (mean, square, fourth power). Five
        // standard errors.
        let count = 400_000;
        let mut random = Random::new(7, Stream::DiscHeight);
        let mut sums = [0.0; 3];
        for _ in 0..count {
            let x = random.normal();
            for (sum, power) in sums.iter_mut().zip([x, x * x, x * x * x * x]) {
                *sum += power / f64::from(count);
            }
        }
        for (moment, (expected, variance)) in sums.iter().zip([(0.0, 1.0), (1.0, 2.0), (3.0, 96.0)]) {
            assert!((moment - expected).abs() < 5.0 * (variance / f64::from(count)).sqrt(), "{moment} for {expected}");
        }
    }

    #[test]
    fn equal_seeds_in_different_streams_are_uncorrelated() {
        // The correlation of N independent pairs has the standard error 1/√N.
        let count = 100_000;
        let streams =
            [Stream::DiscHeight, Stream::PinHeight, Stream::PinBase, Stream::DiscExtension, Stream::PinExtension];
        for (first, second) in (0..streams.len()).flat_map(|second| (0..second).map(move |first| (first, second))) {
            let mut one = Random::new(1, streams[first]);
            let mut other = Random::new(1, streams[second]);
            let correlation = (0..count).map(|_| one.normal() * other.normal()).sum::<f64>() / f64::from(count);
            assert!(correlation.abs() < 5.0 / f64::from(count).sqrt(), "{correlation}");
        }
    }
}
