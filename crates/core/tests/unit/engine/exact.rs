use super::*;

#[test]
fn terms_are_whole_quanta() {
    for bound in [1e-3, 1.0, 3.7e-9, 4e5] {
        let quantum = Quantum::of(bound, (1 << 13) - 1);
        for term in [0.0, bound, bound / 3.0, -bound / 7.0, quantum.value(), 0.4 * quantum.value()] {
            let quanta = quantum.count_difference(term, 0.0);
            assert_eq!(quanta as f64, (term / quantum.value()).round_ties_even(), "{term} of {bound}");
            assert_eq!(quantum.nearest(term), quanta as f64 * quantum.value());
            assert!(quanta.abs() <= 1 << 50);
            assert_eq!(Quantum::of(bound, (4 << 13) + 1).value(), 8.0 * quantum.value());
        }
    }
}

#[test]
fn sums_of_anchored_terms_split_into_their_number_and_their_sum() {
    for (bound, terms) in [(1.0, 161), (3e-7, 8191), (1e-12, 8192), (1e5, 1 << 16)] {
        let quantum = Quantum::of(bound, terms);
        // Terms that just leave room for their number.
        let largest = libm::ldexp(1.0, quantum.exponent + quantum.room as i32) / (terms + 1) as f64;
        assert!(quantum.holds(largest, terms) && !quantum.holds(2.0 * largest, terms));
        let mut sum = 0i64;
        let mut expected = 0;
        for number in 0..=terms {
            assert_eq!(quantum.split()(sum), (number as i64, expected), "{number} of {terms}");
            let term = largest * ((number * 7919 % 1000) as f64 / 1000.0);
            sum = sum.wrapping_add((quantum.anchor() + term).to_bits() as i64);
            expected += (term / quantum.value()).round_ties_even() as i64;
        }
        for largest in [largest, 64.0 * largest, 1e-3 * largest] {
            let fine = Quantum::of_sum(largest, terms);
            assert!(fine.holds(7.9 * largest, terms) && !fine.holds(16.1 * largest, terms));
        }
    }
}

#[test]
fn exact_sums_do_not_depend_on_order() {
    let unit = Unit::new(-140, 0.0);
    let terms = [1e-9, 3.3e-22, -1e-9, 7.25e-5, 1e-15, -7.25e-5];
    let sum = |terms: &mut dyn Iterator<Item = &f64>| {
        let mut sum = ExactSum::default();
        terms.for_each(|term| sum.add(unit.exact(*term)));
        sum
    };
    let (forward, backward) = (sum(&mut terms.iter()), sum(&mut terms.iter().rev()));
    assert_eq!(forward, backward);
    // The exact sum of the terms is 1e-15 + 3.3e-22.
    assert!((unit.value(forward) / (1e-15 + 3.3e-22) - 1.0).abs() < 1e-14);
    let mut negative = ExactSum::default();
    negative.subtract(forward);
    assert_eq!(ExactSum::of_integer(negative.integer()), negative);
    assert_eq!(unit.value(negative), -unit.value(forward));
}

#[test]
fn values_are_cut_to_whole_units() {
    for value in [0.0, 1.0, -1.0, 3.25e-5, -7.1e-19, 1.9e-36, 1e-50, f64::MIN_POSITIVE, 0.5 * f64::MIN_POSITIVE] {
        let unit = libm::ldexp(1.0, -110);
        assert_eq!(Unit::new(-110, 0.0).exact(value).integer(), (value / unit).trunc() as i128, "{value:e}");
    }
}

#[test]
fn the_range_of_a_sum_follows_the_scene() {
    for size in [0.0, 1e-30, 1e-9, 3e-4, 1.0, 7e25, 1e200, 1e240] {
        let unit = Unit::new(-140, size);
        // 2^12 of what is there at the start, in some terms that powers of two are not.
        let mut sum = ExactSum::default();
        (0..4095).for_each(|_| sum.add(unit.exact(size)));
        // Each term is cut to a whole unit.
        let cut = 4095.0 * libm::ldexp(1.0, unit.exponent);
        assert!((unit.value(sum) - 4095.0 * size).abs() <= 1e-15 * 4095.0 * size + cut, "{size:e}");
        assert_eq!(unit == Unit::new(-140, 0.0), size < 7e-9, "{size:e}");
    }
}

#[test]
fn a_sum_that_leaves_its_range_is_infinite_and_stays_so() {
    let unit = Unit::new(-140, 0.0);
    // 2^-14 m³ each, of which one is the largest power of two in the range.
    let term = unit.exact(libm::ldexp(1.0, -14));
    let mut sum = term;
    assert_eq!(unit.value(sum), libm::ldexp(1.0, -14));
    sum.add(term);
    assert_eq!(unit.value(sum), f64::INFINITY);
    sum.subtract(term);
    sum.subtract(term);
    assert_eq!(unit.value(sum), f64::INFINITY);
    for value in [1.0, -1.0, f64::INFINITY, f64::NAN, 1e300] {
        assert_eq!(unit.value(unit.exact(value)), f64::INFINITY, "{value}");
    }
}

#[test]
fn weighted_sums_are_those_of_the_definition() {
    // Closed form: Σ i² = n (n + 1) (2n + 1) / 6 for i up to 20.
    let weights = Weights::new(&(0..24).map(f64::from).collect::<Vec<_>>());
    let mut counts = RowIntegers::new(3);
    counts.0.as_flattened_mut().iter_mut().zip(0..).for_each(|(count, row)| *count = row);
    assert_eq!(float(weights.sum(0..21, counts.rows(0..21))) * weights.unit(), 20.0 * 21.0 * 41.0 / 6.0);
    assert_eq!(float(weights.sum(20..21, counts.rows(20..21))) * weights.unit(), 400.0);
}

#[test]
fn exact_sums_become_the_nearest_numbers() {
    for sum in [0, 1, -1, 3 << 70, -(3 << 70), i128::from(i64::MIN), i128::MAX, (1 << 100) + 1] {
        // One rounding of the low part, one of the sum.
        assert!((float(sum) / sum as f64 - 1.0).abs() <= 2.0 * f64::EPSILON || sum == 0, "{sum}");
    }
}
