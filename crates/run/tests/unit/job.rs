use super::*;

fn done(count: usize, most_failures: Option<usize>, end: impl Fn(usize) -> PieceEnd + Sync) -> Vec<usize> {
    let pieces: Vec<usize> = (1..=count).rev().collect();
    let done = Mutex::new(Vec::new());
    let work = |piece| {
        done.lock().unwrap().push(piece);
        end(piece)
    };
    WorkQueue::new(&pieces, most_failures).share(3, &work).unwrap();
    let mut done = done.into_inner().unwrap();
    done.sort_unstable();
    done
}

#[test]
fn every_piece_is_done_once() {
    assert_eq!(done(1000, None, |_| PieceEnd::Done), (1..=1000).collect::<Vec<_>>());
    assert!(done(0, None, |_| PieceEnd::Done).is_empty());
    assert_eq!(done(100, None, |_| PieceEnd::Failed).len(), 100);
}

#[test]
fn what_is_to_be_later_comes_after_the_others_until_it_is_done() {
    let order = Mutex::new(Vec::new());
    let work = |piece| {
        let mut order = order.lock().unwrap();
        order.push(piece);
        let is_held = piece == 2 && order.len() < 6;
        if is_held { PieceEnd::Later } else { PieceEnd::Done }
    };
    WorkQueue::new(&[1, 2, 3, 4], None).share(1, &work).unwrap();
    assert_eq!(order.into_inner().unwrap(), [1, 2, 3, 4, 2, 2]);
}

#[test]
fn no_thread_is_without_a_piece() {
    let threads = Mutex::new(0);
    let work = |_| {
        *threads.lock().unwrap() = rayon::current_num_threads();
        PieceEnd::Done
    };
    WorkQueue::new(&[1, 2, 3], None).share(10_000, &work).unwrap();
    assert_eq!(threads.into_inner().unwrap(), 3);
}

#[test]
fn no_more_is_begun_after_the_last_straw() {
    assert!((2..=4).contains(&done(1000, Some(2), |_| PieceEnd::Failed).len()));
    assert!(done(1000, None, |_| PieceEnd::Stopped).len() <= 3);
}
