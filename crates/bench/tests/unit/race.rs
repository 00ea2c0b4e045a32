use super::*;

/// Takes 2 µs a step, and three times as long in every other block.
struct Clockwork(u64);

impl Runner for Clockwork {
    fn advance(&mut self, steps: u64) -> Outcome<Duration> {
        self.0 += 1;
        Ok(Duration::from_micros(2 * steps * if self.0.is_multiple_of(2) { 3 } else { 1 }))
    }
}

#[test]
fn entries_alternate_and_are_compared_block_by_block() {
    let entry = |name: &str, mesh, start| Entry {
        name: name.to_owned(),
        against: 0,
        mesh,
        workers: 1,
        runner: Box::new(Clockwork(start)),
    };
    let large = MeshSize::QUICK.times(2);
    let entries = vec![entry("one", MeshSize::QUICK, 0), entry("same", MeshSize::QUICK, 0), entry("large", large, 1)];
    let pace = Pace { repeats: 3, block: Duration::from_micros(60), warm_up: Some(20) };
    let made = race(entries, pace).unwrap();
    // The trial, the second block, takes 6 µs a step, or 2: 10 or 30 steps in 60 µs.
    assert_eq!(made.iter().map(|one| one.steps_per_block).collect::<Vec<_>>(), [10, 10, 30]);
    assert_eq!(made[0].microseconds_per_step, [2.0, 6.0, 2.0]);
    assert_eq!(made[2].microseconds_per_step, [6.0, 2.0, 6.0]);
    assert_eq!(made[1].ratio_to(&made[0]), Spread { minimum: 1.0, median: 1.0, maximum: 1.0 });
    // Ratios 3, 1/3, 3 of a step with four times as many cells.
    assert_eq!(made[2].ratio_to(&made[0]), Spread { minimum: 0.25 / 3.0, median: 0.75, maximum: 0.75 });
}
