use super::*;
use crate::case::MeshSize;
use crate::race::Sharing;

#[test]
fn a_row_has_times_ratio_and_efficiency() {
    let measured = |name: &str, workers, times: [f64; 3]| Measurement {
        name: name.to_owned(),
        against: 0,
        mesh: MeshSize::QUICK,
        workers,
        steps_per_block: 1,
        load_evaluations_per_step: (workers == 1).then_some(1.25),
        microseconds_per_step: times.to_vec(),
        sharing: (workers > 1).then_some(Sharing { halo_bytes_per_step: 480.0, waiting: 0.125, balance: 0.9 }),
    };
    let (alone, two) = (measured("strong", 1, [8.0, 16.0, 8.0]), measured("strong", 2, [5.0, 12.0, 6.0]));
    // By hand: 800 cells; ratios 5/8, 12/16, 6/8, and 1/(0.75 · 2).
    assert_eq!(
        row(&two, &alone, true),
        "| strong | 20 x 40 on 691 | 2 | 6.00 | 5.00 – 12.0 | 7.50 | – | strong, 20 x 40 on 691, 1 | 0.750 | 0.625 – 0.750 | 67 % | 480 | 12 % | 90 % |\n"
    );
    assert!(row(&alone, &alone, false).ends_with("| 1.25 | strong, 20 x 40 on 691, 1 | 1.000 | 1.000 – 1.000 |\n"));
}
