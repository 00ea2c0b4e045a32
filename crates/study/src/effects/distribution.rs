//! Probabilities and quantiles of the t, F and normal distributions.
//!
//! Tails are taken from the incomplete beta function at the argument that is small, so that a p-value of 1e-30 has as
//! many digits as one of 0.1.

use statrs::distribution::{Continuous, ContinuousCDF, Normal, StudentsT};
use statrs::function::beta::beta_reg;

/// Probability that F exceeds a value.
pub(super) fn f_tail(value: f64, numerator: f64, denominator: f64) -> f64 {
    let (above, below) = (numerator * value, denominator);
    let sum = above + below;
    if !sum.is_finite() {
        return 0.0;
    }
    if above <= 0.0 {
        return 1.0;
    }
    let (half_numerator, half_denominator) = (0.5 * numerator, 0.5 * denominator);
    // The beta function is summed for arguments below the mean of its density; of the two tails that is one, which then
    // has all its digits.
    let mean = (half_denominator + 1.0) / (half_denominator + half_numerator + 2.0);
    if below < mean * sum {
        beta_reg(half_denominator, half_numerator, below / sum)
    } else {
        1.0 - beta_reg(half_numerator, half_denominator, above / sum)
    }
}

/// Probability that t lies farther from zero than a value.
pub(super) fn t_tails(value: f64, freedom: f64) -> f64 {
    f_tail(value * value, 1.0, freedom)
}

/// The value that t is beyond with the given probability, in both directions together.
pub(crate) fn t_quantile(both_tails: f64, freedom: f64) -> f64 {
    let Ok(distribution) = StudentsT::new(0.0, 1.0, freedom) else { return f64::NAN };
    let mut quantile = -distribution.inverse_cdf(0.5 * both_tails);
    // With many degrees of freedom that has five digits only: two steps of Newton's rule give the others.
    for _ in 0..2 {
        let next = quantile + (t_tails(quantile, freedom) - both_tails) / (2.0 * distribution.pdf(quantile));
        if next.is_finite() && next > 0.0 {
            quantile = next;
        }
    }
    quantile
}

/// The value that F exceeds with the given probability.
pub(super) fn f_quantile(tail: f64, numerator: f64, denominator: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    while f_tail(high, numerator, denominator) > tail && high < 1e300 {
        (low, high) = (high, 2.0 * high);
    }
    // Each step halves the interval: 60 leave nothing but rounding.
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f_tail(middle, numerator, denominator) > tail { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The value that half-normal deviates lie below with the given probability.
pub(super) fn half_normal_quantile(probability: f64) -> f64 {
    Normal::standard().inverse_cdf(0.5 + 0.5 * probability)
}

/// Where so many normal deviates of unit standard deviation are expected, from the least: the quantiles of (i − ½)/m.
pub fn normal_quantiles(count: usize) -> Vec<f64> {
    (0..count).map(|index| Normal::standard().inverse_cdf((index as f64 + 0.5) / count as f64)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn same(found: f64, expected: f64, what: &str) {
        assert!((found - expected).abs() <= 1e-9 * expected, "{what}: {found:e} is not {expected:e}");
    }

    // Expected numbers: qt, qnorm and pf of R 4.2.2.

    #[test]
    fn quantiles_of_f() {
        // Of one degree of freedom those of t, squared; of two with n: n/2 · (p^(−2/n) − 1), as the tail is a power.
        for freedom in [1.0, 2.0, 5.0, 30.0, 1000.0] {
            same(f_quantile(0.05, 1.0, freedom), t_quantile(0.05, freedom).powi(2), "F of 1");
            let expected = 0.5 * freedom * (0.01_f64.powf(-2.0 / freedom) - 1.0);
            same(f_quantile(0.01, 2.0, freedom), expected, "F of 2");
        }
    }

    #[test]
    fn quantiles_of_t() {
        let expected = [
            (1.0, 0.05, 12.706204736174707),
            (1.0, 2e-6, 318_309.886_182_743_5),
            (1.0, 0.6, 0.726542528005361),
            (2.0, 0.05, 4.302652729749464),
            (2.0, 0.01, 9.924843200918293),
            (7.0 / 3.0, 0.05, 3.7641230720825862),
            (7.0 / 3.0, 0.01, 7.845210508861747),
            (7.0 / 3.0, 2e-6, 306.2648785336764),
            (5.0, 0.01, 4.03214298355523),
            (5.0, 0.6, 0.559429644469361),
            (30.0, 0.05, 2.042272456301238),
            (30.0, 2e-6, 5.871117120418883),
            (1000.0, 0.01, 2.58075469806595),
            (10000.0, 0.05, 1.960201239890626),
            (10000.0, 2e-6, 4.75622968505678),
            (100000.0, 0.05, 1.959987707534609),
            (100000.0, 0.6, 0.5244021842335456),
        ];
        for (freedom, tails, quantile) in expected {
            same(t_quantile(tails, freedom), quantile, &format!("{tails} of {freedom}"));
        }
    }

    #[test]
    fn half_normal_quantiles() {
        let expected =
            [0.12566134685507413, 0.3853204664075676, 0.6744897501960817, 1.0364333894937894, 1.6448536269514715];
        for (index, quantile) in expected.into_iter().enumerate() {
            same(half_normal_quantile(0.2 * index as f64 + 0.1), quantile, "half-normal");
        }
    }

    #[test]
    fn tails_of_f_have_all_digits_however_small_or_large() {
        let expected = [
            (1e-12, 1.0, 10000.0, 0.9999992021353861),
            (1e-4, 1.0, 10000.0, 0.9920214868493558),
            (0.5, 1.0, 10000.0, 0.4795165990456245),
            (3.0, 7.0, 100000.0, 0.0037726369668975566),
            (0.9, 700.0, 100000.0, 0.9721270409235871),
            (1.0, 1000.0, 10000.0, 0.49489653256977817),
            (1.2, 3.0, 5.0, 0.3993489445854567),
            (200.0, 1.0, 56.0, 3.9444388245110894e-20),
            (1e4, 3.0, 20.0, 6.37205408584167e-32),
            (1e9, 1.0, 60.0, 2.267731862396342e-218),
            (1e5, 40.0, 300.0, 0.0),
            (4000.0, 2.0, 3.0, 7.25776090092257e-06),
            (1e-9, 5.0, 5.0, 1.0),
            (1.1, 200.0, 200000.0, 0.1584157639727518),
            (150.0, 1.0, 9990.0, 3.050003006955496e-34),
            (9.0, 1.0, 1e6, 0.0026998625414217923),
            (0.01, 1.0, 1e6, 0.9203443454920432),
            (1.003, 20.0, 1e6, 0.45418337676625803),
            (1.001, 50000.0, 50000.0, 0.4555120166000659),
            (1e12, 1.0, 1.0, 6.366197723673691e-07),
        ];
        for (value, numerator, denominator, tail) in expected {
            same(f_tail(value, numerator, denominator), tail, &format!("{value} of {numerator}, {denominator}"));
        }
    }
}
