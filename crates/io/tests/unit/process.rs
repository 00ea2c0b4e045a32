use std::fs::File;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

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

#[test]
fn a_process_is_told_from_a_later_one_and_from_those_elsewhere() {
    let this = Process::this();
    assert_eq!(this.life(), Life::Lives);
    assert_eq!(Process { started: this.started + 1, ..this.clone() }.life(), Life::Ended);
    let elsewhere = Machine { host: "elsewhere".into(), ..this.machine.clone() };
    assert_eq!(Process { machine: elsewhere, ..this.clone() }.life(), Life::Unknown);
    assert_eq!(Process { started: 0, ..this.clone() }.life(), Life::Unknown);
    assert_eq!(Process { numbers: "pid:[1]".into(), ..this }.life(), Life::Unknown);
}

#[test]
fn where_the_system_shows_other_processes_nothing_is_told() {
    let number = std::process::id();
    assert_eq!(own_start(number, Some(Path::new(&number.to_string()))), Process::this().started);
    assert_eq!([own_start(number, Some(Path::new("1"))), own_start(number, None)], [0, 0]);
}

#[test]
fn a_process_that_nobody_has_waited_for_has_ended() {
    let mut child = Command::new("sleep").arg("60").spawn().unwrap();
    let (_, started) = state_and_start(&status_of(child.id()).unwrap()).unwrap();
    let process = Process { number: child.id(), started, ..Process::this() };
    assert_eq!(process.life(), Life::Lives);
    child.kill().unwrap();
    while process.life() == Life::Lives {
        std::thread::yield_now();
    }
    assert!(status_of(child.id()).is_ok(), "it is still listed");
    child.wait().unwrap();
    assert_eq!(process.life(), Life::Ended);
}

#[test]
fn who_cannot_be_looked_at_may_live() {
    let status = |state: char, started: u64| Ok(format!("7 (a) b) {state} {}{started} 0", "0 ".repeat(18)));
    let error = |number: i32| Err(io::Error::from_raw_os_error(number));
    let (enoent, eacces, eperm) = (2, 13, 1);
    for (status, hidden, expected) in [
        (status('S', 9), false, Life::Lives),
        (status('R', 8), false, Life::Ended),
        (status('Z', 9), false, Life::Ended),
        (error(enoent), false, Life::Ended),
        (error(ESRCH), false, Life::Ended),
        (error(enoent), true, Life::Unknown),
        (error(eacces), false, Life::Unknown),
        (error(eperm), true, Life::Unknown),
        (Ok("7 (a".to_owned()), false, Life::Unknown),
    ] {
        assert_eq!(life_by(status, 9, hidden), expected);
    }
}

/// Soon the writer is this one. A process that another test starts has the files of this one for a moment.
fn assert_writer(path: &Path, expected: Writer) {
    let start = Instant::now();
    while writer_of(path) != expected {
        assert!(start.elapsed() < Duration::from_secs(30), "{:?}, expected {expected:?}", writer_of(path));
    }
}

#[test]
fn only_another_process_that_writes_is_found() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("file");
    let own = File::create(&path).unwrap();
    assert_writer(&path, Writer::Nobody);
    let sleep = |file: File| Command::new("sleep").arg("60").stdout(Stdio::from(file)).spawn().unwrap();
    let mut reader = sleep(File::open(&path).unwrap());
    assert_writer(&path, Writer::Nobody);
    let mut writer = sleep(own);
    assert_writer(&path, Writer::Process(writer.id()));
    for process in [&mut reader, &mut writer] {
        process.kill().unwrap();
        process.wait().unwrap();
    }
    assert_writer(&path, Writer::Nobody);
}
