use super::shuffle;

fn shuffled(count: usize, seed: u64) -> Vec<usize> {
    let mut items: Vec<usize> = (0..count).collect();
    shuffle(&mut items, seed);
    items
}

#[test]
fn every_order_is_as_likely_as_another() {
    // Each of 6 orders 1000 times in 6000, to five standard deviations of a binomial count, √(6000 · 1/6 · 5/6).
    let mut counts = std::collections::BTreeMap::new();
    (0..6000).for_each(|seed| *counts.entry(shuffled(3, seed)).or_insert(0) += 1);
    assert!(counts.len() == 6 && counts.values().all(|count: &i32| (1000 - count).abs() < 145), "{counts:?}");
    assert_eq!(shuffled(100, 7), shuffled(100, 7));
    assert_eq!((shuffled(0, 1), shuffled(1, 1)), (Vec::new(), vec![0]));
}
