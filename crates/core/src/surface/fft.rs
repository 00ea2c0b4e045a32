//! Discrete Fourier transform of any length with the same bits on every machine.
//!
//! The roots of unity come from the crate `libm`; FFT crates take them from the C library of the machine, whose last
//! bits differ between versions and processors.

use std::f64::consts::PI;
use std::ops::{Add, Mul, Sub};

pub(crate) use num_complex::Complex64 as Complex;

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

/// Point of a transform: one complex number, or one of each of several lines.
pub(crate) trait Point:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<Complex, Output = Self>
{
    fn conjugate(self) -> Self;
}

impl Point for Complex {
    fn conjugate(self) -> Self {
        self.conj()
    }
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

    /// Transforms in place. `work` is room that calls one after the other share; what is in it does not matter.
    pub(crate) fn forward<T: Point>(&self, values: &mut [T], work: &mut Vec<T>) {
        match self {
            Self::PowerOfTwo(plan) => plan.forward(values),
            Self::Chirp(plan) => plan.forward(values, work),
        }
    }

    /// Transforms back in place, times the length: x_j = Σ X_k exp(2πi jk/N).
    pub(crate) fn backward<T: Point>(&self, values: &mut [T], work: &mut Vec<T>) {
        // The backward transform is the conjugate of the forward transform of the conjugate.
        values.iter_mut().for_each(|value| *value = value.conjugate());
        self.forward(values, work);
        values.iter_mut().for_each(|value| *value = value.conjugate());
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

    fn forward<T: Point>(&self, values: &mut [T]) {
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
                    let (sum, turned) = (*a, *b * *root);
                    *b = sum - turned;
                    *a = sum + turned;
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
        Self { chirp, kernel, inner }
    }

    fn forward<T: Point>(&self, values: &mut [T], work: &mut Vec<T>) {
        work.clear();
        work.extend(values.iter().zip(&self.chirp).map(|(value, chirp)| *value * *chirp));
        work.resize(self.kernel.len(), T::default());
        self.inner.forward(work);
        for (work, kernel) in work.iter_mut().zip(&self.kernel) {
            *work = (*work * *kernel).conjugate();
        }
        self.inner.forward(work);
        for ((value, work), chirp) in values.iter_mut().zip(work.iter()).zip(&self.chirp) {
            *value = work.conjugate() * *chirp;
        }
    }
}

/// Lines that are transformed together.
pub(crate) const LINES: usize = 8;

/// The numbers of several lines at one place.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Lines {
    re: [f64; LINES],
    im: [f64; LINES],
}

impl Lines {
    /// Puts the number of one line.
    pub(crate) fn put(&mut self, line: usize, value: Complex) {
        (self.re[line], self.im[line]) = (value.re, value.im);
    }

    /// The number of one line.
    pub(crate) fn get(&self, line: usize) -> Complex {
        Complex { re: self.re[line], im: self.im[line] }
    }

    fn each(self, number: impl Fn(Complex, usize) -> Complex) -> Self {
        let mut lines = self;
        (0..LINES).for_each(|line| lines.put(line, number(self.get(line), line)));
        lines
    }
}

impl Add for Lines {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.each(|number, line| number + other.get(line))
    }
}

impl Sub for Lines {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self.each(|number, line| number - other.get(line))
    }
}

impl Mul<Complex> for Lines {
    type Output = Self;

    fn mul(self, factor: Complex) -> Self {
        self.each(|number, _| number * factor)
    }
}

impl Point for Lines {
    fn conjugate(self) -> Self {
        self.each(|number, _| number.conj())
    }
}

#[cfg(test)]
#[path = "../../tests/unit/surface/fft.rs"]
mod tests;
