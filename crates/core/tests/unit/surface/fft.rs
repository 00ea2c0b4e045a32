use super::*;

fn signal(length: usize) -> Vec<Complex> {
    (0..length).map(|j| Complex { re: ((j * j + 3) % 17) as f64 - 8.0, im: ((5 * j + 1) % 11) as f64 - 5.0 }).collect()
}

#[test]
fn agrees_with_the_sum_that_defines_it() {
    // The direct sum; both have rounding errors of a few ε times the norm of the signal, about 8 √N here.
    for length in [1, 2, 3, 5, 8, 12, 64, 97, 161] {
        let values = signal(length);
        let mut transformed = values.clone();
        Fft::new(length).forward(&mut transformed, &mut Vec::new());
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
