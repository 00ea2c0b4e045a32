//! Machines, told from others of the same name.
//!
//! A name says little: machines that are copied from one image, those that are called localhost, and containers that are started
//! again elsewhere share it. So a machine is known again after it was started anew only by its hardware.

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// Which machine, and which start of it. What the system does not tell is empty.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// Its name.
    pub host: String,
    /// Which start of it that is.
    pub(crate) boot: String,
    /// One word for each of its network devices: they stay with a machine, and no two have the same.
    pub(crate) hardware: Vec<String>,
}

/// What one machine is to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Relation {
    /// The same, not started anew since.
    SameStart,
    /// The same, which was started anew since.
    EarlierStart,
    /// Another one, or one that cannot be known again.
    Unknown,
}

/// More network devices say nothing more.
const DEVICES: usize = 8;
/// The address that virtual machines of QEMU have unless they are given another one.
const SHARED: &str = "52:54:00:12:34:56";

impl Machine {
    /// This machine, as it was when it was first asked for: each checkpoint says where it was written.
    pub fn this() -> Self {
        static THIS: LazyLock<Machine> = LazyLock::new(|| Machine {
            host: host(),
            boot: first_line(Path::new("/proc/sys/kernel/random/boot_id")),
            hardware: hardware(Path::new("/etc/machine-id"), Path::new("/sys/class/net")),
        });
        THIS.clone()
    }

    /// What it is to `this` one.
    pub fn seen_from(&self, this: &Self) -> Relation {
        if self.host != this.host || self.boot.is_empty() || this.boot.is_empty() {
            return Relation::Unknown;
        }
        if self.boot == this.boot {
            return Relation::SameStart;
        }
        let is_known = self.hardware.iter().any(|device| this.hardware.contains(device));
        if is_known { Relation::EarlierStart } else { Relation::Unknown }
    }

    /// Whether this machine may have been started anew since: what it had not handed to the disk may then be gone.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn machine(host: &str, boot: &str, hardware: &[&str]) -> Machine {
        Machine { host: host.into(), boot: boot.into(), hardware: hardware.iter().map(|&word| word.into()).collect() }
    }

    #[test]
    fn a_machine_is_known_again_by_its_hardware_alone() {
        let this = machine("a", "2", &["x", "y"]);
        for (other, expected) in [
            (machine("a", "2", &[]), Relation::SameStart),
            (machine("a", "1", &["y", "z"]), Relation::EarlierStart),
            // Another one of the same name, such as a copy, or a container without devices.
            (machine("a", "1", &["z"]), Relation::Unknown),
            (machine("a", "1", &[]), Relation::Unknown),
            (machine("b", "1", &["x"]), Relation::Unknown),
            (machine("a", "", &["x"]), Relation::Unknown),
        ] {
            assert_eq!(other.seen_from(&this), expected, "{other:?}");
        }
        assert_eq!(machine("a", "", &[]).seen_from(&machine("a", "", &[])), Relation::Unknown);
        assert_eq!(machine("a", "1", &[]).seen_from(&machine("a", "2", &[])), Relation::Unknown);
    }

    #[test]
    fn what_an_earlier_start_left_may_be_gone() {
        let this = Machine::this();
        assert!(!this.may_be_of_earlier_start());
        let before = Machine { boot: "before".into(), ..this };
        assert!(before.may_be_of_earlier_start());
        assert!(!Machine { boot: String::new(), ..before.clone() }.may_be_of_earlier_start());
        assert!(!Machine { host: "elsewhere".into(), ..before }.may_be_of_earlier_start());
    }

    #[test]
    fn hardware_is_that_of_devices_and_of_the_installed_system() {
        let folder = tempfile::tempdir().unwrap();
        let (number, devices) = (folder.path().join("machine-id"), folder.path().join("net"));
        assert!(hardware(&number, &devices).is_empty());
        fs::write(&number, "0123\n").unwrap();
        for (name, address, has_hardware) in [
            ("eth1", "02:00:00:00:00:02", true),
            ("eth0", "02:00:00:00:00:01", true),
            ("veth", "02:00:00:00:00:03", false),
            ("ib", "00:00", true),
            ("qemu", SHARED, true),
        ] {
            let device = devices.join(name);
            fs::create_dir_all(if has_hardware { device.join("device") } else { device.clone() }).unwrap();
            fs::write(device.join("address"), format!("{address}\n")).unwrap();
        }
        let words = hardware(&number, &devices);
        assert_eq!(words.len(), 2);
        assert!(words.iter().all(|word| word.len() == 16 && !word.contains(':')), "{words:?}");
        fs::write(&number, "4567\n").unwrap();
        assert!(hardware(&number, &devices).iter().all(|word| !words.contains(word)));
    }
}
