use super::*;

fn mesh(disc_columns: usize, pin_columns: usize) -> Mesh {
    Mesh::new(3, disc_columns, pin_columns, 1.0, 2.0).unwrap()
}

#[test]
fn segments_cover_the_pin_and_lie_over_the_right_columns() {
    for (disc_columns, pin_columns, workers) in
        [(2764, 161, 2), (40, 40, 3), (17, 5, 8), (9, 9, 1), (30, 1, 5), (7, 4, 5)]
    {
        let mesh = mesh(disc_columns, pin_columns);
        let partition = Partition::new(&mesh, workers, Decomposition::Sectors, 2);
        for step in 0..2 * disc_columns as u64 {
            let mut next = 0;
            for segment in partition.segments(mesh.disc_column(0, step)) {
                assert_eq!(segment.pin.start, next);
                for (offset, pin) in segment.pin.clone().enumerate() {
                    let column = partition.columns(segment.sector).start + segment.over + offset;
                    assert_eq!(column, mesh.disc_column(pin, step));
                    assert_eq!(partition.sector_of(column), segment.sector);
                }
                next = segment.pin.end;
                let is_at_rest = segment.pin.start == 0 && pin_columns < disc_columns;
                assert_eq!(segment.joined, is_at_rest && segment.over > 0);
            }
            assert_eq!(next, pin_columns);
            for entering in partition.entering(mesh.disc_column(0, step)) {
                let column = partition.columns(entering.sector).start + entering.over;
                assert_eq!(column, mesh.disc_column(entering.pin, step + 1));
            }
        }
    }
}

#[test]
fn work_is_shared_as_evenly_as_sectors_can() {
    let mesh = mesh(2764, 161);
    for workers in [2, 3, 4, 8] {
        // Position by position, from the segments themselves.
        let mean_largest_work = |partition: &Partition| {
            let largest = |first| {
                let mut work = vec![0; workers];
                for Segment { sector, pin, .. } in partition.segments(first) {
                    work[partition.group(sector)] += pin.len() + SEGMENT_COST;
                }
                work.into_iter().max().unwrap()
            };
            (0..2764).map(largest).sum::<usize>() as f64 / 2764.0
        };
        let chosen = Partition::new(&mesh, workers, Decomposition::Sectors, 2);
        let least = mean_largest_work(&chosen);
        assert_eq!(chosen.mean_largest_work(), least);
        for rounds in 1..=40 {
            let other = Partition::of_sectors(&mesh, workers, 1, rounds * workers);
            assert!(mean_largest_work(&other) >= least, "{} sectors, not {}", chosen.sectors(), other.sectors());
        }
        // Equal parts in a segment each are not to be had; sectors as long as these give each group them in two, nearly.
        let (even, segment) = (161.0 / workers as f64, SEGMENT_COST as f64);
        assert!((even + segment..even + 4.0 + 2.0 * segment).contains(&least), "{workers} workers: {least} columns");
    }
}

#[test]
fn bands_are_taken_where_the_rows_can_be_shared() {
    let paper = Mesh::new(80, 2764, 161, 20e-3, 24e-3).unwrap();
    let grid = |workers| {
        let partition = Partition::new(&paper, workers, Decomposition::Auto, 2);
        (partition.bands(), partition.groups())
    };
    // Ten strips: halves and fifths are equal, thirds nearly so.
    assert_eq!([grid(1), grid(2), grid(3), grid(5)], [(1, 1), (2, 1), (3, 1), (5, 1)]);
    let partition = Partition::new(&paper, 2, Decomposition::Auto, 2);
    assert_eq!([partition.rows_of(0), partition.rows_of(1)], [0..40, 40..80]);
    let told = |workers, kind| Partition::new(&paper, workers, kind, 2).told();
    assert_eq!(told(1, Decomposition::Auto), "none");
    assert_eq!(told(2, Decomposition::Bands), "2 bands of rows");
    assert!(told(2, Decomposition::Sectors).ends_with(" sectors"));
    // One strip of rows cannot be shared.
    assert_eq!(Partition::new(&mesh(100, 10), 4, Decomposition::Auto, 2).bands(), 1);
}
