//! How much memory this process can have, and what is refused for want of it.

use std::fmt;
use std::fs;
use std::path::Path;

use rlimit::Resource;
use thiserror::Error;

/// Bytes that the program takes besides what it works on: libraries, what HDF5 keeps of a file, threads with their stacks.
const BESIDES: u64 = 64 << 20;

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
///
/// # Errors
/// [`NoRoom`], with both numbers.
pub fn refuse_beyond(needed: u64) -> Result<(), NoRoom> {
    match available() {
        Some(available) if needed > available => Err(NoRoom { needed, available }),
        _ => Ok(()),
    }
}

/// Refuses to begin where the system gives less memory than any command may need. HDF5 does not come back from every place in
/// which it gets no memory, so it is asked for while there is nothing to lose.
///
/// # Errors
/// [`NoRoom`], with what can be had.
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

/// Whether the system limits the address space of this process (`ulimit -v`).
pub fn is_address_space_limited() -> bool {
    address_space_limit().is_some()
}

fn address_space_limit() -> Option<u64> {
    let (soft, _) = Resource::AS.get().ok()?;
    (soft != rlimit::INFINITY).then_some(soft)
}

/// Bytes that this process can have: of the machine, of its group (cgroup v2), of its address space. `None` where the system
/// does not say.
pub(crate) fn available() -> Option<u64> {
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

/// Bytes of the process's address space, where the system tells.
pub(crate) fn address_space() -> Option<u64> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_what_linux_writes() {
        let meminfo = "MemTotal:       24684084 kB\nMemFree:        23673160 kB\nMemAvailable:   24091248 kB\n";
        assert_eq!(kibibytes(meminfo, "MemAvailable:"), Some(24_091_248 * 1024));
        assert_eq!(kibibytes(meminfo, "VmSize:"), None);
        assert_eq!(unified_group("1:cpu:/\n0::/system.slice/slurmd\n"), Some("system.slice/slurmd"));
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
}
