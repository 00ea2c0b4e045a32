//! A bound on the memory of this process while a library is at work that takes what a damaged file asks for.

use std::sync::Mutex;

use rlimit::Resource;

use crate::memory::address_space;

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
