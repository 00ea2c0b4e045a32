//! Numbers as few levels between their lowest and their highest.

use super::pack;

/// How finely numbers are told apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fineness {
    /// One byte each: 254 steps.
    Byte,
    /// Two bytes each: 4095 steps, which are shorter when they are deflated than all that two bytes can tell apart.
    Word,
}

impl Fineness {
    /// Steps between the lowest and the highest number; the code above the highest stands for what is no number.
    pub fn steps(self) -> u16 {
        match self {
            Self::Byte => 254,
            Self::Word => 4095,
        }
    }
}

/// Numbers as codes: number = lowest + code · (highest − lowest)/steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantised {
    /// The lowest and the highest number; both 0 where there is none.
    pub range: [f64; 2],
    /// Steps between them.
    pub fineness: Fineness,
    /// A code for each number.
    pub codes: Vec<u16>,
}

impl Quantised {
    /// Numbers, of which those that are not finite get the code above the highest.
    pub fn of(values: &[f64], fineness: Fineness) -> Self {
        let finite = values.iter().copied().filter(|value| value.is_finite());
        let range =
            finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
        let range = if range[0] <= range[1] { range } else { [0.0; 2] };
        let steps = f64::from(fineness.steps());
        let width = range[1] - range[0];
        let code = |value: &f64| match value {
            value if !value.is_finite() => fineness.steps() + 1,
            // All alike, or so wide a range that its width is no number.
            _ if !(width > 0.0 && width.is_finite()) => 0,
            value => ((value - range[0]) / width * steps).round() as u16,
        };
        Self { range, fineness, codes: values.iter().map(code).collect() }
    }

    /// Statuses, which are their own codes.
    pub fn statuses(codes: &[u8]) -> Self {
        let steps = f64::from(Fineness::Byte.steps());
        Self { range: [0.0, steps], fineness: Fineness::Byte, codes: codes.iter().copied().map(u16::from).collect() }
    }

    /// The codes as text: those of the first `cells` as they are, all others as the difference from the code `cells`
    /// before, which is 0 wherever nothing changed from one time to the next.
    pub fn packed(&self, cells: usize) -> String {
        let differences = (0..self.codes.len()).map(|index| {
            let before = index.checked_sub(cells).map_or(0, |index| self.codes[index]);
            self.codes[index].wrapping_sub(before)
        });
        match self.fineness {
            Fineness::Byte => pack::bytes(differences.map(|code| code as u8)),
            Fineness::Word => pack::words(differences),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Fineness, Quantised};

    #[test]
    fn numbers_come_back_within_half_a_step() {
        let values: Vec<f64> = (0..1000).map(|index| (f64::from(index) * 0.37).sin() * 3e-6 - 1e-6).collect();
        for fineness in [Fineness::Byte, Fineness::Word] {
            let quantised = Quantised::of(&values, fineness);
            let step = (quantised.range[1] - quantised.range[0]) / f64::from(fineness.steps());
            for (value, code) in values.iter().zip(&quantised.codes) {
                let back = quantised.range[0] + f64::from(*code) * step;
                assert!((back - value).abs() <= 0.500_001 * step, "{value} came back as {back}");
            }
        }
    }

    #[test]
    fn what_is_no_number_and_what_is_alike() {
        let quantised = Quantised::of(&[1.0, f64::NAN, 3.0, f64::INFINITY], Fineness::Byte);
        assert_eq!((quantised.range, &quantised.codes[..]), ([1.0, 3.0], &[0, 255, 254, 255][..]));
        assert_eq!(Quantised::of(&[2.0; 3], Fineness::Word).codes, [0; 3]);
        assert_eq!(Quantised::of(&[f64::NAN], Fineness::Word).codes, [4096]);
        assert_eq!(Quantised::of(&[-1e308, 1e308], Fineness::Byte).codes, [0, 0]);
    }
}
