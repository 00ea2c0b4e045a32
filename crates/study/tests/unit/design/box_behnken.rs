use super::*;

const PUBLISHED: [usize; 5] = [3, 4, 5, 6, 7];

#[test]
fn designs_have_the_numbers_of_points_of_the_article() {
    // Box and Behnken (1960), table 4: points and centre points.
    let sizes = [(15, 3), (27, 3), (46, 6), (54, 6), (62, 6)];
    for (factors, (points, centre)) in PUBLISHED.into_iter().zip(sizes) {
        let design = box_behnken(centre, &vec![Factor::Range; factors]).unwrap();
        assert_eq!(design.points(), points, "{factors} factors");
    }
}

#[test]
fn every_factor_is_in_as_many_blocks_and_meets_every_other() {
    // The definition of (partially) balanced incomplete blocks with two classes of associates, for which numbers of
    // meetings differ by one at most here; without a meeting an interaction could not be estimated.
    for factors in PUBLISHED {
        let blocks = blocks(factors).unwrap();
        let meetings = |one: usize, other: usize| {
            blocks.iter().filter(|block| block.contains(&one) && block.contains(&other)).count()
        };
        let size = blocks[0].len();
        for one in 1..=factors {
            assert_eq!(meetings(one, one) * factors, blocks.len() * size, "{factors} factors");
            let others: Vec<usize> =
                (1..=factors).filter(|other| *other != one).map(|other| meetings(one, other)).collect();
            let (least, most) = (others.iter().min().unwrap(), others.iter().max().unwrap());
            assert!(*least >= 1 && most - least <= 1, "{factors} factors, factor {one}: {others:?}");
        }
    }
}

#[test]
fn other_numbers_of_factors_are_refused() {
    for factors in [1, 2, 8, 9, 16] {
        let error = box_behnken(3, &vec![Factor::Range; factors]).unwrap_err();
        assert!(error.0.contains("only of 3 to 7 factors"), "{error}");
    }
    assert!(box_behnken(usize::MAX, &[Factor::Range; 3]).is_err());
}
