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

#[test]
fn waiting_and_balance_are_those_of_the_blocks() {
    let exchange = |waited, halo_bytes| Exchange { waited: Duration::from_millis(waited), halo_bytes };
    let (before, after) = ([exchange(5, 100), exchange(5, 0)], [exchange(105, 700), exchange(305, 200)]);
    // Of a second, 0.9 s and 0.7 s of work; 800 bytes in ten steps.
    let shared = Sharing::of(&before, &after, 10, Duration::from_secs(1)).unwrap();
    assert_eq!(shared.halo_bytes_per_step, 80.0);
    assert!((shared.waiting - 0.2).abs() < 1e-12 && (shared.balance - 0.8 / 0.9).abs() < 1e-12, "{shared:?}");
    assert_eq!(Sharing::of(&before[..1], &after[..1], 10, Duration::from_secs(1)), None);
}
