//! Memory that this process can have, refusal of what needs more, and a bound while a library is at work that takes what a damaged file
//! asks for.
//!
//! The system bounds a process, not a thread. So there is one bound at a time, what can be had is not asked meanwhile, and where several
//! runs are made at once, a bound leaves what the others may need.

use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::{fmt, fs};

use rlimit::Resource;
use thiserror::Error;

/// More memory is needed than this process can have; in words it goes on after "needs".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("{} of memory and {} are available", InWords(*needed), InWords(*available))]
pub struct NoRoom {
    /// Bytes that are needed.
    pub needed: u64,
    /// Bytes that can be had.
    pub available: u64,
}

/// Refuses what needs more memory than this process can have. Where the system tells neither, nothing is refused.
pub fn refuse_beyond(needed: u64) -> Result<(), NoRoom> {
    match unbounded(available) {
        Some(available) if needed > available => Err(NoRoom { needed, available }),
        _ => Ok(()),
    }
}

/// Refuses to begin where the system gives less memory than any command may need. HDF5 does not come back from every place in
/// which it gets no memory, so it is asked for while there is nothing to lose.
pub fn refuse_to_begin() -> Result<(), NoRoom> {
    let is_there =
        |bytes: u64| usize::try_from(bytes).is_ok_and(|bytes| Vec::<u8>::new().try_reserve_exact(bytes).is_ok());
    if is_there(BESIDES) {
        return Ok(());
    }
    // What a limit leaves may still lie in pieces.
    let available = (0..BESIDES >> 20).rev().map(|mebibytes| mebibytes << 20).find(|bytes| is_there(*bytes));
    Err(NoRoom { needed: BESIDES, available: available.unwrap_or(0) })
}

/// Tells whether the system limits the address space of this process (`ulimit -v`).
pub fn is_address_space_limited() -> bool {
    unbounded(address_space_limit).is_some()
}

/// A number of bytes as "1.5 GiB".
struct InWords(u64);

impl fmt::Display for InWords {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const UNITS: [&str; 7] = ["B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"];
        let power = self.0.checked_ilog2().unwrap_or(0) as usize / 10;
        let unit = UNITS.get(power).copied().unwrap_or("B");
        write!(f, "{:.1} {unit}", self.0 as f64 / 2_f64.powi(10 * power as i32))
    }
}

/// Bytes that the program takes besides what it works on: libraries, what HDF5 keeps of a file, threads with their stacks.
pub(super) const BESIDES: u64 = 64 << 20;

/// Bytes of the address space that the process may have (`ulimit -v`); none where there is no limit.
fn address_space_limit() -> Option<u64> {
    let (soft, _) = Resource::AS.get().ok()?;
    (soft != rlimit::INFINITY).then_some(soft)
}

/// Bytes that this process can have: of the machine, of its group (cgroup v2), of its address space. `None` where the system
/// does not say.
pub(super) fn available() -> Option<u64> {
    let read = |path: &Path| fs::read_to_string(path).ok();
    let machine = read(Path::new("/proc/meminfo")).as_deref().and_then(|text| kibibytes(text, "MemAvailable:"));
    let group = read(Path::new("/proc/self/cgroup")).as_deref().and_then(|text| {
        let path = Path::new("/sys/fs/cgroup").join(unified_group(text)?);
        path.ancestors()
            .take_while(|folder| folder.starts_with("/sys/fs/cgroup"))
            .filter_map(|folder| read(&folder.join("memory.max"))?.trim().parse().ok())
            .min()
    });
    machine.into_iter().chain(group).chain(of_address_space()).min()
}

/// Bytes of memory of this machine; none where the system does not tell.
pub(crate) fn of_machine() -> Option<u64> {
    kibibytes(&fs::read_to_string("/proc/meminfo").ok()?, "MemTotal:")
}

/// Largest memory that this process held so far, bytes; none where the system does not tell.
pub fn peak() -> Option<u64> {
    kibibytes(&fs::read_to_string("/proc/self/status").ok()?, "VmHWM:")
}

/// Bytes of the process's address space, where the system tells.
fn address_space() -> Option<u64> {
    kibibytes(&fs::read_to_string("/proc/self/status").ok()?, "VmSize:")
}

/// Bytes that a limit of the address space (`ulimit -v`) leaves for what the program works on; none where there is no limit.
fn of_address_space() -> Option<u64> {
    Some(address_space_limit()?.saturating_sub(address_space()?).saturating_sub(BESIDES))
}

/// A number of kibibytes in a file of the system (proc(5)), in bytes.
fn kibibytes(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

/// Path below the root of the cgroup v2 hierarchy (cgroups(7)): the line with hierarchy 0 and no controllers.
fn unified_group(cgroup: &str) -> Option<&str> {
    cgroup.lines().find_map(|line| line.strip_prefix("0::/"))
}

/// Pieces of work that are being done. Who holds this also holds the bound.
static AT_WORK: Mutex<usize> = Mutex::new(0);

fn hold() -> MutexGuard<'static, usize> {
    // It is a count, which a panic of another thread cannot leave half done.
    AT_WORK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A piece of work with memory of its own, such as a run of a study, as long as it lives. Where there are several in this process, the
/// bound of one is no tighter than what the system has left, for beyond it the program would end in all of them.
#[derive(Debug)]
pub struct AtWork(());

impl AtWork {
    /// One more piece of work; waits while there is a bound that does not know of it.
    pub fn begin() -> Self {
        *hold() += 1;
        Self(())
    }
}

impl Drop for AtWork {
    fn drop(&mut self) {
        *hold() -= 1;
    }
}

/// The limits of the address space before they were made tighter: put back at the end, also after a panic.
struct Before(u64, u64);

impl Drop for Before {
    fn drop(&mut self) {
        let _ = Resource::AS.set(self.0, self.1);
    }
}

/// Does `work` with at most `more` bytes beyond what the process has now. Where the system does not tell that, or takes no
/// limits, there is no bound. `work` must not ask for what can be had, and begin no piece of work.
pub(crate) fn bounded<T>(more: u64, work: impl FnOnce() -> T) -> T {
    let at_work = hold();
    let others = if *at_work > 1 { available().unwrap_or(u64::MAX) } else { 0 };
    let _before = Resource::AS.get().ok().zip(address_space()).map(|((soft, hard), now)| {
        let bound = now.saturating_add(more).saturating_add(others);
        let _ = Resource::AS.set(bound.min(soft), hard);
        Before(soft, hard)
    });
    work()
}

/// Asks the system while there is no bound, so that it says what all of the process may have.
fn unbounded<T>(ask: impl FnOnce() -> T) -> T {
    let _none = hold();
    ask()
}

#[cfg(test)]
#[path = "../tests/unit/memory.rs"]
mod tests;
