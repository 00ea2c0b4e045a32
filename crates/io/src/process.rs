//! Machines and processes: known again, and told from others of the same name or number; and what is known of this machine.
//!
//! A name says little: machines that are copied from one image, those that are called localhost, and containers that are started
//! again elsewhere share it. So a machine is known again after it was started anew only by its hardware. A process is told from later ones
//! of the same number by its start, and found by the file that it writes.

use std::fs;
use std::io::{self, ErrorKind};
use std::os::unix::fs::MetadataExt;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, LazyLock};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// Machine, and one start of it. What the system does not tell is empty.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// Name of the machine.
    pub host: String,
    /// Identifier of that start of it.
    pub(crate) boot: String,
    /// One word for each of its network devices: they stay with a machine, and no two have the same.
    pub(crate) hardware: Vec<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Relation {
    /// Same machine, not started anew since.
    SameStart,
    /// Same machine, started anew since.
    EarlierStart,
    /// Another machine, or one that cannot be known again.
    Unknown,
}

/// Most network devices that are noted: more say nothing more.
const DEVICES: usize = 8;
/// The address that virtual machines of QEMU have unless they are given another one.
const SHARED: &str = "52:54:00:12:34:56";

impl Machine {
    /// Returns this machine, as it was when it was first asked for: each checkpoint says where it was written.
    pub fn this() -> Self {
        static THIS: LazyLock<Machine> = LazyLock::new(|| Machine {
            host: host(),
            boot: first_line(Path::new("/proc/sys/kernel/random/boot_id")),
            hardware: hardware(Path::new("/etc/machine-id"), Path::new("/sys/class/net")),
        });
        THIS.clone()
    }

    fn seen_from(&self, this: &Self) -> Relation {
        if self.host != this.host || self.boot.is_empty() || this.boot.is_empty() {
            return Relation::Unknown;
        }
        if self.boot == this.boot {
            return Relation::SameStart;
        }
        let is_known = self.hardware.iter().any(|device| this.hardware.contains(device));
        if is_known { Relation::EarlierStart } else { Relation::Unknown }
    }

    /// Tells whether this machine may have been started anew since: what it had not handed to the disk may then be gone.
    pub fn may_be_of_earlier_start(&self) -> bool {
        let this = Self::this();
        let are_known = !self.boot.is_empty() && !this.boot.is_empty();
        are_known && self.host == this.host && self.boot != this.boot
    }
}

/// Name of this machine.
pub fn host() -> String {
    Some(first_line(Path::new("/proc/sys/kernel/hostname")))
        .filter(|name| !name.is_empty())
        .or_else(|| std::env::var("HOSTNAME").ok())
        .unwrap_or_else(|| "unknown".into())
}

/// Name of the processor.
pub fn processor() -> String {
    let text = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix("model name"));
    line.map_or(std::env::consts::ARCH, |name| name.trim_matches([' ', '\t', ':'])).to_owned()
}

/// Cores that this process may use.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Reads the number of threads that wanted to run, mean over the last minute; none where the system does not tell.
pub fn load() -> Option<f64> {
    first_line(Path::new("/proc/loadavg")).split_whitespace().next()?.parse().ok()
}

/// One word for each network device, made of its address and of the number of the installed system (machine-id(5), which asks
/// that the number itself is not given away). Devices without hardware, such as those of containers, are left out.
fn hardware(number: &Path, devices: &Path) -> Vec<String> {
    let number = first_line(number);
    let Ok(entries) = fs::read_dir(devices) else { return Vec::new() };
    let devices = entries.flatten().map(|entry| entry.path()).filter(|device| device.join("device").exists());
    let addresses = devices.map(|device| first_line(&device.join("address")));
    let is_own =
        |address: &str| address != SHARED && address.bytes().any(|byte| byte != b'0' && byte.is_ascii_hexdigit());
    let mut addresses: Vec<_> = addresses.filter(|address| is_own(address)).collect();
    addresses.sort();
    addresses.dedup();
    addresses.truncate(DEVICES);
    let word = |address| {
        Sha256::digest(format!("plateau {number} {address}"))[..8].iter().map(|byte| format!("{byte:02x}")).collect()
    };
    addresses.into_iter().map(word).collect()
}

/// First line of a small file of the system; empty where it cannot be read.
fn first_line(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap_or_default();
    text.lines().next().unwrap_or_default().trim().to_owned()
}

/// Identity of a process. What the system does not tell is empty or 0.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Process {
    /// The machine that it runs on.
    pub machine: Machine,
    /// Number of the process.
    #[serde(rename = "process")]
    pub number: u32,
    /// Time at which it was started, in ticks of the system's clock since the machine was.
    started: u64,
    /// Namespace in which its number holds: a container may have numbers of its own.
    numbers: String,
    user: u32,
}

/// State of a process.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Life {
    /// Process that lives.
    Lives,
    /// Process that has ended.
    Ended,
    /// Process that runs, or ran, elsewhere, so that this machine cannot tell.
    Unknown,
}

impl Process {
    /// Returns this process.
    pub fn this() -> Self {
        let number = std::process::id();
        Self {
            machine: Machine::this(),
            number,
            started: own_start(number, fs::read_link("/proc/self").ok().as_deref()),
            numbers: fs::read_link("/proc/self/ns/pid").unwrap_or_default().to_string_lossy().into_owned(),
            user: fs::metadata("/proc/self").map_or(0, |process| process.uid()),
        }
    }

    /// Tells whether the process lives.
    pub fn life(&self) -> Life {
        let this = Self::this();
        // Where numbers hold elsewhere there may be the same one twice, even on one machine.
        if self.numbers != this.numbers || self.started == 0 || this.started == 0 {
            return Life::Unknown;
        }
        match self.machine.seen_from(&this.machine) {
            Relation::SameStart => {
                let hidden = self.user != this.user && !fs::exists("/proc/1").unwrap_or(false);
                life_by(status_of(self.number), self.started, hidden)
            }
            Relation::EarlierStart => Life::Ended,
            Relation::Unknown => Life::Unknown,
        }
    }
}

/// Time at which this process was started; 0 where `/proc` is of other numbers than its own, as in a namespace that has none of its own:
/// `own` is the name that it has there.
fn own_start(number: u32, own: Option<&Path>) -> u64 {
    let is_seen = own.is_some_and(|own| own.as_os_str() == number.to_string().as_str());
    let status = status_of(number).ok().filter(|_| is_seen);
    status.and_then(|status| state_and_start(&status)).map_or(0, |(_, started)| started)
}

/// Tells whether a process that was started then lives, by what the system tells of the process that has its number now. `hidden`
/// says that the system may not even tell that there is one.
fn life_by(status: io::Result<String>, started: u64, hidden: bool) -> Life {
    match status {
        Ok(status) => match state_and_start(&status) {
            Some((state, found)) if found == started && !['Z', 'X'].contains(&state) => Life::Lives,
            Some(_) => Life::Ended,
            None => Life::Unknown,
        },
        // Not there, or gone while it was looked at: ENOENT and ESRCH.
        Err(error) if error.kind() == ErrorKind::NotFound || error.raw_os_error() == Some(ESRCH) => {
            if hidden {
                Life::Unknown
            } else {
                Life::Ended
            }
        }
        // A system may keep to itself how the processes of other users are, though not that they are (proc(5), hidepid=1).
        Err(_) => Life::Unknown,
    }
}

fn status_of(number: u32) -> io::Result<String> {
    fs::read_to_string(format!("/proc/{number}/stat"))
}

/// State of a process, and when it was started: fields 3 and 22 of `/proc/PID/stat` (proc(5)).
fn state_and_start(status: &str) -> Option<(char, u64)> {
    // Field 2 is the name of the program in parentheses, and may hold anything.
    let (_, fields) = status.rsplit_once(')')?;
    let mut fields = fields.split_whitespace();
    let state = fields.next()?.chars().next()?;
    Some((state, fields.nth(22 - 4)?.parse().ok()?))
}

/// No such process.
const ESRCH: i32 = 3;

/// Access modes of an open file in `/proc/PID/fdinfo`, where writing is possible: O_WRONLY and O_RDWR.
const WRITING: u32 = 3;

/// Process that has a file open for writing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Writer {
    /// No process of this machine that could be found.
    Nobody,
    /// Living process of this machine, which is not this one.
    Process(u32),
    /// Maybe a process of the user to whom the file belongs: this process may not look at those.
    Hidden,
}

/// Process that has a file open for writing, as far as the system tells: only on Linux, and of this machine.
pub fn writer_of(path: &Path) -> Writer {
    let (Ok(wanted), Ok(processes)) = (fs::metadata(path), fs::read_dir("/proc")) else { return Writer::Nobody };
    let user = fs::metadata("/proc/self").map_or(0, |process| process.uid());
    let mut found = match fs::exists("/proc/1") {
        // Only the processes of this user are to be seen.
        Ok(false) if wanted.uid() != user => Writer::Hidden,
        _ => Writer::Nobody,
    };
    let is_of_owner =
        |process: u32| fs::metadata(format!("/proc/{process}")).is_ok_and(|process| process.uid() == wanted.uid());
    let numbers = processes.flatten().filter_map(|process| process.file_name().to_str()?.parse::<u32>().ok());
    for process in numbers.filter(|process| *process != std::process::id()) {
        match written_by(process, (wanted.dev(), wanted.ino())).map(|mut names| names.next()) {
            Ok(Some(_)) => return Writer::Process(process),
            Err(_) if is_of_owner(process) => found = Writer::Hidden,
            _ => {}
        }
    }
    found
}

/// Numbers of the open files with which this process writes a file, given by device and inode.
pub(crate) fn written_here(file: (u64, u64)) -> Vec<i32> {
    let numbers =
        written_by(std::process::id(), file).map(|names| names.filter_map(|name| name.parse().ok()).collect());
    numbers.unwrap_or_default()
}

/// Names in `/proc/PID/fd` with which a process writes a file.
fn written_by(process: u32, wanted: (u64, u64)) -> io::Result<impl Iterator<Item = String>> {
    let files = fs::read_dir(format!("/proc/{process}/fd"))?.flatten();
    Ok(files.filter_map(move |file| {
        let is_same = fs::metadata(file.path()).is_ok_and(|file| (file.dev(), file.ino()) == wanted);
        let name = file.file_name().to_string_lossy().into_owned();
        (is_same && is_writing(process, &name)).then_some(name)
    }))
}

fn is_writing(process: u32, file: &str) -> bool {
    let information = fs::read_to_string(format!("/proc/{process}/fdinfo/{file}")).unwrap_or_default();
    let flags = information.lines().find_map(|line| line.strip_prefix("flags:"));
    flags.and_then(|flags| u32::from_str_radix(flags.trim(), 8).ok()).is_some_and(|flags| flags & WRITING != 0)
}

/// Makes a write beyond the file size limit (`ulimit -f`) an error of that write.
///
/// Without this the system ends the process with the signal SIGXFSZ and nobody is told why. A program calls it once,
/// before it writes files.
pub fn report_file_size_limit() -> io::Result<()> {
    // The flag is of no interest: a handler, whatever it does, makes the system answer the write with EFBIG.
    let noticed = Arc::new(AtomicBool::new(false));
    signal_hook::flag::register(signal_hook::consts::SIGXFSZ, noticed).map(|_| ())
}

#[cfg(test)]
#[path = "../tests/unit/process.rs"]
mod tests;
