//! Transforms of responses: a scale on which effects add up and errors are alike.

/// What is done to a response before a model is fitted to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Transform {
    /// The natural logarithm: effects are factors.
    Logarithm,
    /// The square root: for counts, and what grows like them.
    SquareRoot,
    /// The natural logarithm of y/(1 − y): for fractions between 0 and 1.
    Logit,
}

impl Transform {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Logarithm, Self::SquareRoot, Self::Logit];

    /// What studies call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Logarithm => "log",
            Self::SquareRoot => "square root",
            Self::Logit => "logit",
        }
    }

    /// The one of this name.
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|transform| transform.name() == name)
    }

    /// Which responses it takes, in words.
    pub fn domain(self) -> &'static str {
        match self {
            Self::Logarithm => "more than 0",
            Self::SquareRoot => "of at least 0",
            Self::Logit => "more than 0 and less than 1",
        }
    }

    /// A response on the scale of the fit; none beyond the domain. NaN stays NaN.
    pub fn of(self, response: f64) -> Option<f64> {
        if response.is_nan() {
            return Some(response);
        }
        let value = match self {
            Self::Logarithm => response.ln(),
            Self::SquareRoot => response.sqrt(),
            // The difference of logarithms has all digits near 0, ln_1p those near 1.
            Self::Logit => response.ln() - (-response).ln_1p(),
        };
        value.is_finite().then_some(value)
    }

    /// The response of a value on the scale of the fit. It never falls as the value grows, so that ends of intervals stay
    /// ends; the square root of a response cannot be negative, and a value below 0 stands for 0.
    pub fn back(self, value: f64) -> f64 {
        match self {
            Self::Logarithm => value.exp(),
            Self::SquareRoot => value.max(0.0).powi(2),
            Self::Logit => 1.0 / (1.0 + (-value).exp()),
        }
    }

    /// The power that it stands for among those of Box and Cox; none for the logit.
    pub fn power(self) -> Option<f64> {
        match self {
            Self::Logarithm => Some(0.0),
            Self::SquareRoot => Some(0.5),
            Self::Logit => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transforms_go_there_and_back() {
        for transform in Transform::ALL {
            assert_eq!(Transform::of_name(transform.name()), Some(transform));
            for response in [1e-12, 0.03, 0.5, 0.97, 1.0 - 1e-9] {
                let back = transform.back(transform.of(response).unwrap());
                // Each way rounds a few times; logarithms of 28 at most carry that many times the rounding.
                assert!((back / response - 1.0).abs() < 100.0 * f64::EPSILON, "{transform:?} {response} {back}");
            }
        }
        // ln 9 by hand: the odds are nine to one.
        assert!((Transform::Logit.of(0.9).unwrap() - 2.197_224_577_336_219_6).abs() < 1e-14);
        assert_eq!(Transform::SquareRoot.back(-0.1), 0.0);
    }

    #[test]
    fn what_is_beyond_the_domain_is_refused() {
        let refused = [
            (Transform::Logarithm, 0.0),
            (Transform::Logarithm, -1.0),
            (Transform::SquareRoot, -1e-300),
            (Transform::Logit, 0.0),
            (Transform::Logit, 1.0),
            (Transform::Logit, 1.5),
            (Transform::Logarithm, f64::INFINITY),
        ];
        for (transform, response) in refused {
            assert_eq!(transform.of(response), None, "{transform:?} {response}");
        }
        assert_eq!(Transform::SquareRoot.of(0.0), Some(0.0));
        assert!(Transform::Logit.of(f64::NAN).unwrap().is_nan());
    }
}
