use plateau_core::observe::EXTRAS;

use super::*;

#[test]
fn counts_every_array() {
    // By hand, 2 rows, 10 disc and 3 pin columns (20 and 6 cells): state 20·16 + 6·(32 + 1) + 2·16 = 550,
    // surfaces 20·16 + 6·18 = 428; maps: two snapshots of disc height and pin status 2·(20·8 + 6) = 332.
    let (maps, none) = ([Map::DiscHeight, Map::PinStatus], []);
    assert_eq!(estimate([2, 10, 3], &maps, &none, false), 550 + 428);
    // All seven: disc 20·17, pin 6·(17 + 8), twice.
    assert_eq!(estimate([2, 10, 3], &Map::CHOICES, &none, false), 550 + 2 * (20 * 17 + 6 * 25));
    // With the heights of both and the pressure, and the pressure and temperature of the contact, own and gathered.
    assert_eq!(
        estimate([2, 10, 3], &Map::CHOICES, EXTRAS, false),
        550 + 2 * (20 * 17 + 6 * 25) + 16 * (20 + 6 + 6 + 6 + 6)
    );
    assert_eq!(estimate([u64::MAX; 3], &maps, EXTRAS, true), u64::MAX);
}

#[test]
fn a_field_is_larger_than_its_body() {
    // By hand: 800 rows are padded to 1024; the ring closes, the pin's 100 columns are padded to 128.
    assert_eq!(field(13_800, 800, true), 13_800 * 1024 * 40);
    assert_eq!(field(100, 800, false), 128 * 1024 * 40);
}
