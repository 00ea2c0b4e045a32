use super::*;
use crate::engine::lanes::Portable;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

fn lanes(values: [f64; LANES]) -> Portable {
    Portable::load(&Chunk(values))
}

fn values(lanes: Portable) -> [f64; LANES] {
    let mut chunk = Chunk([0.0; LANES]);
    lanes.store(&mut chunk);
    chunk.0
}

/// From 0 to 1.
fn part(random: &mut ChaCha8Rng) -> f64 {
    (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// A power of 2 from 2^low to 2^high.
fn power(random: &mut ChaCha8Rng, low: i32, high: i32) -> f64 {
    2.0_f64.powi(low + (random.next_u32() % (high - low + 1) as u32) as i32)
}

/// A height from 2^-6 to 2 on either side of 0, of which every bit may be set.
fn height(random: &mut ChaCha8Rng) -> f64 {
    let of_one = f64::from_bits(1.0_f64.to_bits() | random.next_u64() >> 12);
    of_one * [1.0, -1.0][random.next_u32() as usize % 2] * power(random, -6, 0)
}

/// Debris of all sizes in gaps of down to an ulp of the heights: the deposit is that of model 4L, and no cell touches after it.
#[test]
fn no_cell_touches_after_its_gap_is_filled() {
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let (mut usual_ones, mut at_displacement, mut moved_back) = (0, 0, 0);
    for _ in 0..100_000 {
        let (z_p, z_d) = (height(&mut random), height(&mut random));
        let displacement = match random.next_u32() % 8 {
            0 => z_p - z_d - power(&mut random, -60, 0),
            ulps => (0..ulps).fold(z_p - z_d, |gap, _| gap.next_down()),
        };
        let reference = z_d + power(&mut random, -60, 0);
        let clearance = z_p - z_d - displacement;
        // One for all: a single cell that is nearly full has all eight looked at.
        let share = clearance * [0.25, 0.5, part(&mut random), 1.0][random.next_u32() as usize % 4];
        let height_ahead: [f64; LANES] =
            std::array::from_fn(|_| z_p - clearance * [2.0, part(&mut random)][random.next_u32() as usize % 2]);
        let cells = [z_p, z_d].map(Portable::splat);
        let filled = filled(u8::MAX, cells, [Portable::splat(share), lanes(height_ahead)], [displacement, reference]);
        let [height, disc_height, on_pin, on_disc] =
            [filled.height, filled.disc_height, filled.on_pin, filled.on_disc].map(values);
        for lane in 0..LANES {
            let to_plateau = (z_p - height_ahead[lane]).max(0.0);
            let deposit = clearance.min(to_plateau + (reference - z_d)).min(share);
            let of_pin = deposit.min(to_plateau);
            assert_eq!([on_pin[lane], on_disc[lane]], [of_pin, deposit - of_pin]);
            assert!(height[lane] - disc_height[lane] >= displacement);
            let usual = [(z_p - of_pin).max(z_p.min(height_ahead[lane])), (z_d + (deposit - of_pin)).min(reference)];
            if usual[0] - usual[1] >= displacement {
                assert_eq!([height[lane], disc_height[lane]], usual);
                usual_ones += 1;
                at_displacement += u32::from(usual[0] - usual[1] == displacement);
            } else {
                moved_back += 1;
            }
        }
    }
    // Cases of every kind were among them.
    assert!([usual_ones, at_displacement, moved_back].into_iter().all(|cases| cases > 10_000));
}
