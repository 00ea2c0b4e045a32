//! A bound on the memory of this process while a library is at work that takes what a damaged file asks for.

use std::fs;
use std::sync::Mutex;

use rlimit::Resource;

/// What is not done at the same time by two threads.
static LIMITED: Mutex<()> = Mutex::new(());

/// Does `work` with at most `more` bytes beyond what the process has now. Where the system does not tell that, or takes no
/// limits, there is no bound.
pub(super) fn limited<T>(more: u64, work: impl FnOnce() -> T) -> T {
    let _guard = LIMITED.lock();
    let before = Resource::AS.get().ok();
    if let (Some((soft, hard)), Some(now)) = (before, address_space()) {
        let _ = Resource::AS.set(now.saturating_add(more).min(soft), hard);
    }
    let result = work();
    if let Some((soft, hard)) = before {
        let _ = Resource::AS.set(soft, hard);
    }
    result
}

/// Bytes of the process's address space, where the system tells.
fn address_space() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let kilobytes = status.lines().find_map(|line| line.strip_prefix("VmSize:")?.trim().strip_suffix("kB"));
    kilobytes?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Other tests of this process go on meanwhile.
    const MOST_ELSEWHERE: u64 = 1 << 30;

    #[test]
    fn more_than_the_bound_is_not_to_be_had() {
        let bytes = 4 << 30;
        let take = || Vec::<u8>::new().try_reserve_exact(bytes).is_ok();
        assert!(!limited(MOST_ELSEWHERE, take));
        assert!(take());
    }
}
