//! What libraries read of the environment of a process when it starts, and what must not be there.

use std::env;
use std::os::unix::process::CommandExt;
use std::process::Command;

use plateau_io::memory;

/// Number of pools of memory that the C library makes at most (mallopt(3)).
const POOLS: &str = "MALLOC_ARENA_MAX";
/// How HDF5 gets at files unless a program says otherwise. Files of this program are plain files: with another driver the library
/// finds none of them, or does not start at all.
const DRIVERS: [&str; 3] = ["HDF5_DRIVER", "HDF5_DRIVER_CONFIG", "HDF5_VOL_CONNECTOR"];

/// Begins anew where the environment does not fit: an environment can be changed safely only for a process that starts.
///
/// Under a limit of the address space (`ulimit -v`, h_vmem of a queue) the C library would reserve 64 MiB of it for each thread, and
/// whatever needs memory next would get none.
pub fn fit() {
    let one_pool = memory::is_address_space_limited() && env::var_os(POOLS).is_none();
    let drivers = DRIVERS.into_iter().filter(|name| env::var_os(name).is_some());
    if !one_pool && drivers.clone().next().is_none() {
        return;
    }
    let mut arguments = env::args_os();
    let name = arguments.next().filter(|name| !name.is_empty()).unwrap_or_else(|| "plateau".into());
    // The file of this process, even where another one has its name by now.
    let mut anew = Command::new("/proc/self/exe");
    anew.arg0(name).args(arguments);
    for name in drivers {
        anew.env_remove(name);
    }
    if one_pool {
        anew.env(POOLS, "1");
    }
    // It comes back only with an error, and then all is as it was.
    let _ = anew.exec();
}
