//! Several lines that are transformed together, with the bits that each gets alone.
//!
//! A transform spends most of its time on getting numbers out of memory. With the numbers of neighbouring lines side by side one
//! root of unity serves all of them, a processor multiplies several at a time, and lines whose numbers lie far apart, as those
//! across a plane, are read where they lie together.

use std::ops::{Add, Mul, Sub};

use super::fft::{Complex, Point};

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
mod tests {
    use super::*;
    use crate::surface::fft::Fft;

    #[test]
    fn each_line_gets_the_bits_that_it_gets_alone() {
        for length in [1, 2, 12, 64, 161] {
            let number = |line: usize, place: usize| {
                let seed = (31 * line + 7 * place * place + 3) as f64;
                Complex { re: (0.7 * seed).sin(), im: (1.3 * seed).cos() }
            };
            let fft = Fft::new(length);
            let mut together = vec![Lines::default(); length];
            for (place, lines) in together.iter_mut().enumerate() {
                (0..LINES).for_each(|line| lines.put(line, number(line, place)));
            }
            fft.forward(&mut together, &mut Vec::new());
            for line in 0..LINES {
                let mut alone: Vec<Complex> = (0..length).map(|place| number(line, place)).collect();
                fft.forward(&mut alone, &mut Vec::new());
                let found: Vec<Complex> = together.iter().map(|lines| lines.get(line)).collect();
                assert_eq!(found, alone, "{length} points, line {line}");
            }
        }
    }
}
