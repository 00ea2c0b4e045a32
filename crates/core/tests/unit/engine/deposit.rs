use super::*;
use crate::engine::lanes::{Chunk, Portable};
use crate::surface::random::{Random, Stream};

/// A whole number from 0 to this, but not it.
fn below(random: &mut Random, number: usize) -> usize {
    (random.uniform() * number as f64) as usize
}

/// A power of 2 from 2^low to 1.
fn power(random: &mut Random, low: i32) -> f64 {
    2.0_f64.powi(low + below(random, 1 + low.unsigned_abs() as usize) as i32)
}

/// A height from 2^-6 to 2 on either side of 0, of which every bit may be set.
fn height(random: &mut Random) -> f64 {
    (1.0 + random.uniform()) * [1.0, -1.0][below(random, 2)] * power(random, -6)
}

/// Debris of all sizes in gaps of down to an ulp of the heights: the deposit is that of model 4L, and no cell touches after it.
#[test]
fn no_cell_touches_after_its_gap_is_filled() {
    let mut random = Random::new(4, Stream::DiscHeight);
    let (mut usual_ones, mut at_displacement, mut moved_back) = (0, 0, 0);
    for _ in 0..100_000 {
        let (z_p, z_d) = (height(&mut random), height(&mut random));
        let displacement = match below(&mut random, 8) {
            0 => z_p - z_d - power(&mut random, -60),
            ulps => (0..ulps).fold(z_p - z_d, |gap, _| gap.next_down()),
        };
        let reference = z_d + power(&mut random, -60);
        let clearance = z_p - z_d - displacement;
        // One for all: a single cell that is nearly full has all eight looked at.
        let share = clearance * [0.25, 0.5, random.uniform(), 1.0][below(&mut random, 4)];
        let height_ahead: [f64; LANES] =
            std::array::from_fn(|_| z_p - clearance * [2.0, random.uniform()][below(&mut random, 2)]);
        let cells = [z_p, z_d].map(Portable::splat);
        let filled = filled(
            u8::MAX,
            cells,
            [Portable::splat(share), Portable::load(&Chunk(height_ahead))],
            [displacement, reference],
        );
        let [height, disc_height, on_pin, on_disc] =
            [filled.height, filled.disc_height, filled.on_pin, filled.on_disc].map(|lanes| lanes.chunk().0);
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
