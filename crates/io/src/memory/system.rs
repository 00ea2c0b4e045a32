//! What the system says of memory: of the machine, of a group of processes, of this one.

use std::fs;
use std::path::Path;

use rlimit::Resource;

/// Bytes that the program takes besides what it works on: libraries, what HDF5 keeps of a file, threads with their stacks.
pub(super) const BESIDES: u64 = 64 << 20;

/// Bytes of the address space that the process may have (`ulimit -v`); none where there is no limit.
pub(super) fn address_space_limit() -> Option<u64> {
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

/// Bytes of the process's address space, where the system tells.
pub(super) fn address_space() -> Option<u64> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_what_linux_writes() {
        let meminfo = "MemTotal:       24684084 kB\nMemFree:        23673160 kB\nMemAvailable:   24091248 kB\n";
        assert_eq!(kibibytes(meminfo, "MemAvailable:"), Some(24_091_248 * 1024));
        assert_eq!(kibibytes(meminfo, "VmSize:"), None);
        assert_eq!(unified_group("1:cpu:/\n0::/system.slice/slurmd\n"), Some("system.slice/slurmd"));
    }
}
