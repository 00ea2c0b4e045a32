use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

use super::*;

#[test]
fn bytes_have_a_readable_unit() {
    assert_eq!(InWords(0).to_string(), "0.0 B");
    assert_eq!(InWords(3 << 29).to_string(), "1.5 GiB");
    assert_eq!(InWords(u64::MAX).to_string(), "16.0 EiB");
}

#[test]
fn what_no_machine_has_is_refused_with_both_numbers() {
    assert_eq!(refuse_beyond(0), Ok(()));
    let refused = refuse_beyond(u64::MAX).unwrap_err();
    assert!(refused.available > 0 && refused.available < u64::MAX);
    assert!(refused.to_string().starts_with("16.0 EiB of memory and "), "{refused}");
}

#[test]
fn reads_what_linux_writes() {
    let meminfo = "MemTotal:       24684084 kB\nMemFree:        23673160 kB\nMemAvailable:   24091248 kB\n";
    assert_eq!(kibibytes(meminfo, "MemAvailable:"), Some(24_091_248 * 1024));
    assert_eq!(kibibytes(meminfo, "VmSize:"), None);
    assert_eq!(unified_group("1:cpu:/\n0::/system.slice/slurmd\n"), Some("system.slice/slurmd"));
}

/// Other tests of this process go on meanwhile.
const MOST_ELSEWHERE: u64 = 1 << 30;

fn is_there(bytes: usize) -> bool {
    Vec::<u8>::new().try_reserve_exact(bytes).is_ok()
}

#[test]
fn more_than_the_bound_is_not_to_be_had_but_by_others() {
    let bytes = 4 << 30;
    assert!(!bounded(MOST_ELSEWHERE, || is_there(bytes)));
    assert!(is_there(bytes));
    let panicked = thread::spawn(|| bounded(MOST_ELSEWHERE, || panic!("a mistake")));
    assert!(panicked.join().is_err());
    assert!(is_there(bytes));
    // Several pieces of work, each of which takes what it needs.
    let _works = [AtWork::begin(), AtWork::begin()];
    let another = bounded(0, || thread::spawn(move || is_there(bytes / 2)).join());
    assert!(another.unwrap(), "this needs a machine with 2 GiB of free memory");
}

#[test]
fn a_bound_is_not_taken_for_what_can_be_had() {
    let (give, take) = channel();
    let ask = move || give.send(refuse_beyond(MOST_ELSEWHERE + 1)).unwrap();
    // The thread would answer at once: that half of a second shows only what is wrong.
    let early = bounded(MOST_ELSEWHERE, || {
        thread::spawn(ask);
        take.recv_timeout(Duration::from_millis(500)).ok()
    });
    assert_eq!(early.unwrap_or_else(|| take.recv().unwrap()), Ok(()));
}
