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

/// The lowest and the highest of those numbers that are finite; both 0 where there is none.
pub fn range<'a>(values: impl IntoIterator<Item = &'a f64>) -> [f64; 2] {
    let finite = values.into_iter().copied().filter(|value| value.is_finite());
    let range = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
    if range[0] <= range[1] { range } else { [0.0; 2] }
}

/// Numbers as codes: number = lowest + code · (highest − lowest)/steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantised {
    /// The lowest and the highest number.
    pub range: [f64; 2],
    /// Steps between them.
    pub fineness: Fineness,
    /// A code for each number.
    pub codes: Vec<u16>,
}

impl Quantised {
    /// Numbers between `range`, of which those that are not finite get the code above the highest.
    pub fn within(range: [f64; 2], values: &[f64], fineness: Fineness) -> Self {
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

    /// The codes as text: as the difference from the code one time before, which is 0 wherever nothing changed. Those of
    /// the first time are told from the codes `before`, or as they are where there are none.
    ///
    /// A time has `cells` codes.
    pub fn packed(&self, cells: usize, before: &[u16]) -> String {
        let differences = (0..self.codes.len()).map(|index| {
            let first = || before.get(index).copied().unwrap_or(0);
            self.codes[index].wrapping_sub(index.checked_sub(cells).map_or_else(first, |index| self.codes[index]))
        });
        match self.fineness {
            Fineness::Byte => pack::bytes(differences.map(|code| code as u8)),
            Fineness::Word => pack::words(differences),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Fineness, Quantised, range};

    fn of(values: &[f64], fineness: Fineness) -> Quantised {
        Quantised::within(range(values), values, fineness)
    }

    #[test]
    fn numbers_come_back_within_half_a_step() {
        let values: Vec<f64> = (0..1000).map(|index| (f64::from(index) * 0.37).sin() * 3e-6 - 1e-6).collect();
        for fineness in [Fineness::Byte, Fineness::Word] {
            let quantised = of(&values, fineness);
            let step = (quantised.range[1] - quantised.range[0]) / f64::from(fineness.steps());
            for (value, code) in values.iter().zip(&quantised.codes) {
                let back = quantised.range[0] + f64::from(*code) * step;
                assert!((back - value).abs() <= 0.500_001 * step, "{value} came back as {back}");
            }
        }
    }

    #[test]
    fn what_is_no_number_and_what_is_alike() {
        let quantised = of(&[1.0, f64::NAN, 3.0, f64::INFINITY], Fineness::Byte);
        assert_eq!((quantised.range, &quantised.codes[..]), ([1.0, 3.0], &[0, 255, 254, 255][..]));
        assert_eq!(of(&[2.0; 3], Fineness::Word).codes, [0; 3]);
        assert_eq!(of(&[f64::NAN], Fineness::Word).codes, [4096]);
        assert_eq!(of(&[-1e308, 1e308], Fineness::Byte).codes, [0, 0]);
    }
}
