use super::*;

/// Runs the same on every thread and returns what each says.
fn on_threads<T: Send>(workers: usize, work: impl Fn(Threads) -> T + Sync) -> Vec<T> {
    let ends = Threads::connect(workers, workers, 3);
    std::thread::scope(|scope| {
        let handles: Vec<_> = ends.into_iter().map(|end| scope.spawn(|| work(end))).collect();
        handles.into_iter().map(|handle| handle.join().unwrap()).collect()
    })
}

#[test]
fn messages_of_any_length_are_gathered_in_order() {
    let words = |rank: usize, round: usize| -> Vec<u64> {
        let length = [0, 5, WORDS_AT_A_TIME, WORDS_AT_A_TIME + 1, 3 * WORDS_AT_A_TIME + 7][(rank + round) % 5];
        (0..length).map(|index| (index * 31 + rank * 7 + round) as u64).collect()
    };
    on_threads(3, |mut end| {
        for round in 0..50 {
            let mut seen = 0;
            end.all_gather(&words(end.rank, round), &mut |from, message| {
                assert_eq!(from, seen);
                assert_eq!(message, words(from, round), "worker {from}, round {round}");
                seen += 1;
            })
            .unwrap();
            assert_eq!(seen, 3);
        }
    });
}

#[test]
fn columns_cross_boundaries() {
    on_threads(4, |mut end| {
        let (rank, size) = (end.rank(), end.size());
        for round in 0..2000 {
            end.send_halo(rank, (rank + size - 1) % size, &[rank as u64, round, 1]).unwrap();
            let from = (rank + 1) % size;
            let mut words = [0; 3];
            end.receive_halo(from, from, &mut words).unwrap();
            assert_eq!(words, [from as u64, round, 1]);
            end.all_gather(&[], &mut |_, _| ()).unwrap();
        }
        assert_eq!(end.alarm().exchange().halo_bytes, 2000 * 3 * 8);
    });
}

#[test]
fn time_asleep_is_time_waited() {
    let waited = on_threads(2, |mut end| {
        end.all_gather(&[], &mut |_, _| ()).unwrap();
        if end.rank() == 1 {
            // Much longer than a worker spins, and a few sleeps.
            std::thread::sleep(Duration::from_millis(100));
        }
        end.all_gather(&[], &mut |_, _| ()).unwrap();
        end.alarm().exchange().waited
    });
    assert!(waited[0] > Duration::from_millis(30), "{waited:?}");
}

#[test]
fn who_waits_for_a_failed_worker_is_told() {
    let results = on_threads(3, |mut end| {
        if end.rank() == 1 {
            end.alarm().raise("out of paper".into());
            return Ok(());
        }
        end.all_gather(&[], &mut |_, _| ())
    });
    let failure = Err(CommError::Worker { worker: 1, message: "out of paper".into() });
    assert_eq!(results, [failure.clone(), Ok(()), failure]);
}
