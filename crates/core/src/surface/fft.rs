//! Discrete Fourier transform of any length with the same bits on every machine.
//!
//! The roots of unity come from the crate `libm`; FFT crates take them from the C library of the machine, whose last
//! bits differ between versions and processors.

use std::f64::consts::PI;

pub(crate) use rustfft::num_complex::Complex64 as Complex;

/// exp(i π numerator / denominator).
fn root(numerator: usize, denominator: usize) -> Complex {
    let angle = PI * (numerator as f64 / denominator as f64);
    Complex::new(libm::cos(angle), libm::sin(angle))
}

/// Plan of the transform X_k = Σ x_j exp(−2πi jk/N) of one length.
pub(crate) enum Fft {
    /// N is a power of two.
    PowerOfTwo(PowerOfTwo),
    /// Any other N, as a convolution with a chirp (Bluestein 1970).
    Chirp(Chirp),
}

impl Fft {
    /// # Panics
    /// When the length is zero.
    pub(crate) fn new(length: usize) -> Self {
        assert!(length > 0, "a transform has at least one point");
        if length.is_power_of_two() {
            Self::PowerOfTwo(PowerOfTwo::new(length))
        } else {
            Self::Chirp(Chirp::new(length))
        }
    }

    /// Transforms in place.
    pub(crate) fn forward(&mut self, values: &mut [Complex]) {
        match self {
            Self::PowerOfTwo(plan) => plan.forward(values),
            Self::Chirp(plan) => plan.forward(values),
        }
    }

    /// Transforms back in place, times the length: x_j = Σ X_k exp(2πi jk/N).
    pub(crate) fn backward(&mut self, values: &mut [Complex]) {
        // The backward transform is the conjugate of the forward transform of the conjugate.
        values.iter_mut().for_each(|value| *value = value.conj());
        self.forward(values);
        values.iter_mut().for_each(|value| *value = value.conj());
    }
}

/// Radix-2 transform (Cooley and Tukey 1965).
pub(crate) struct PowerOfTwo {
    /// exp(−2πi j/N) for j < N/2.
    roots: Vec<Complex>,
}

impl PowerOfTwo {
    fn new(length: usize) -> Self {
        Self { roots: (0..length / 2).map(|j| root(2 * j, length).conj()).collect() }
    }

    fn forward(&self, values: &mut [Complex]) {
        let length = values.len();
        if length < 2 {
            return;
        }
        let shift = usize::BITS - length.trailing_zeros();
        for index in 0..length {
            let reversed = index.reverse_bits() >> shift;
            if index < reversed {
                values.swap(index, reversed);
            }
        }
        let mut half = 1;
        while half < length {
            let stride = length / (2 * half);
            for block in values.chunks_exact_mut(2 * half) {
                let (lower, upper) = block.split_at_mut(half);
                for ((a, b), root) in lower.iter_mut().zip(upper).zip(self.roots.iter().step_by(stride)) {
                    let turned = *b * *root;
                    *b = *a - turned;
                    *a += turned;
                }
            }
            half *= 2;
        }
    }
}

/// Transform of any length N: with jk = (j² + k² − (k − j)²)/2 it is a convolution with a chirp.
pub(crate) struct Chirp {
    /// exp(−πi j²/N).
    chirp: Vec<Complex>,
    /// Transform of the conjugate chirp, wrapped round, over the length of `inner`.
    kernel: Vec<Complex>,
    inner: PowerOfTwo,
    work: Vec<Complex>,
}

impl Chirp {
    fn new(length: usize) -> Self {
        // j² is reduced modulo 2N in integers, or the angle would lose its digits.
        let period = 2 * length as u128;
        let chirp: Vec<Complex> =
            (0..length).map(|j| root(((j as u128 * j as u128) % period) as usize, length).conj()).collect();
        let padded = (2 * length - 1).next_power_of_two();
        let inner = PowerOfTwo::new(padded);
        let mut kernel = vec![Complex::default(); padded];
        for (j, value) in chirp.iter().enumerate() {
            kernel[j] = value.conj();
            kernel[(padded - j) % padded] = value.conj();
        }
        inner.forward(&mut kernel);
        // Here and in `forward`, the inner transform back is written as a conjugated forward one.
        let scale = 1.0 / padded as f64;
        kernel.iter_mut().for_each(|value| *value = value.scale(scale));
        Self { chirp, kernel, inner, work: vec![Complex::default(); padded] }
    }

    fn forward(&mut self, values: &mut [Complex]) {
        self.work.fill(Complex::default());
        for ((work, value), chirp) in self.work.iter_mut().zip(values.iter()).zip(&self.chirp) {
            *work = *value * *chirp;
        }
        self.inner.forward(&mut self.work);
        for (work, kernel) in self.work.iter_mut().zip(&self.kernel) {
            *work = (*work * *kernel).conj();
        }
        self.inner.forward(&mut self.work);
        for ((value, work), chirp) in values.iter_mut().zip(&self.work).zip(&self.chirp) {
            *value = work.conj() * *chirp;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signal(length: usize) -> Vec<Complex> {
        (0..length)
            .map(|j| Complex { re: ((j * j + 3) % 17) as f64 - 8.0, im: ((5 * j + 1) % 11) as f64 - 5.0 })
            .collect()
    }

    #[test]
    fn agrees_with_the_sum_that_defines_it() {
        // The direct sum; both have rounding errors of a few ε times the norm of the signal, about 8 √N here.
        for length in [1, 2, 3, 5, 8, 12, 64, 97, 161] {
            let values = signal(length);
            let mut transformed = values.clone();
            Fft::new(length).forward(&mut transformed);
            for (k, found) in transformed.iter().enumerate() {
                let mut expected = Complex::default();
                for (j, value) in values.iter().enumerate() {
                    expected += *value * root(2 * (j * k % length), length).conj();
                }
                let difference = *found - expected;
                assert!(difference.re.hypot(difference.im) < 1e-13 * 8.0 * length as f64, "N = {length}, k = {k}");
            }
        }
    }

    #[test]
    fn forward_and_backward_cancel() {
        for length in [1, 4, 100, 691, 2764] {
            let values = signal(length);
            let mut transformed = values.clone();
            let mut fft = Fft::new(length);
            fft.forward(&mut transformed);
            fft.backward(&mut transformed);
            for (found, expected) in transformed.iter().zip(&values) {
                let difference = found.scale(1.0 / length as f64) - *expected;
                assert!(difference.re.hypot(difference.im) < 1e-12, "N = {length}");
            }
        }
    }
}
