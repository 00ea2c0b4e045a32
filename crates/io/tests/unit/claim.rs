//! Claims of processes that live, that have ended, and that meet.

use std::process::Command;
use std::sync::Barrier;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::*;

/// A lock that a process left which was killed.
fn leave(lock: &Path) -> Owner {
    let mut child = Command::new("true").spawn().unwrap();
    let mut owner = Owner::this();
    let numbers = serde_json::to_value(&owner.writer).unwrap()["numbers"].clone();
    owner.writer = serde_json::from_value(serde_json::json!({
        "machine": owner.writer.machine, "process": child.id(), "started": 1, "numbers": numbers, "user": 0,
    }))
    .unwrap();
    child.wait().unwrap();
    write(lock, &owner);
    owner
}

fn place(name: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    (folder, path)
}

/// Writes a lock; its text.
fn write(lock: &Path, owner: &Owner) -> String {
    let text = serde_json::to_string(owner).unwrap() + "\n";
    fs::write(lock, &text).unwrap();
    text
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn a_claim_is_one_process_s_until_it_ends() {
    let (folder, path) = place("run.h5");
    let claim = Claim::of(&path).unwrap();
    assert_eq!(names(folder.path()), ["run.h5.lock"]);
    for refused in [Claim::of(&path).map(drop), Claim::check(&path).map(drop)] {
        let message = refused.unwrap_err().to_string();
        assert!(message.contains(&format!("being written by process {}, since 20", std::process::id())), "{message}");
    }
    assert_eq!(names(folder.path()), ["run.h5.lock"]);
    drop(claim);
    assert!(!Claim::check(&path).unwrap());
    drop(Claim::of(&path).unwrap());
    assert_eq!(names(folder.path()), [""; 0]);
}

#[test]
fn a_link_is_claimed_where_it_points_to() {
    let folder = tempfile::tempdir().unwrap();
    let [real, link] = ["run.h5", "link.h5"].map(|name| folder.path().join(name));
    fs::write(&real, "").unwrap();
    std::os::unix::fs::symlink(&real, &link).unwrap();
    let _claim = Claim::of(&link).unwrap();
    assert!(matches!(Claim::of(&real), Err(ClaimError::Here { .. })));
}

#[test]
fn of_many_that_find_a_lock_left_over_one_has_it_at_a_time() {
    const MANY: usize = 8;
    let (folder, path) = place("run.h5");
    let (holders, taken, start) = (AtomicUsize::new(0), AtomicUsize::new(0), Barrier::new(MANY));
    for round in 0..100 {
        leave(&lock_of(&path));
        thread::scope(|scope| {
            for _ in 0..MANY {
                scope.spawn(|| {
                    start.wait();
                    let Ok(claim) = Claim::of(&path) else { return };
                    assert_eq!(holders.fetch_add(1, Ordering::SeqCst), 0, "round {round}");
                    taken.fetch_add(1, Ordering::SeqCst);
                    thread::yield_now();
                    holders.fetch_sub(1, Ordering::SeqCst);
                    drop(claim);
                });
            }
        });
        assert!(taken.swap(0, Ordering::SeqCst) > 0, "round {round}: nobody got it");
        assert_eq!(names(folder.path()), [""; 0], "round {round}");
    }
}

#[test]
fn who_may_live_elsewhere_is_named_with_the_file_to_remove() {
    let (_folder, path) = place("run.h5");
    let mut owner = leave(&lock_of(&path));
    owner.writer.machine.host = "node17".into();
    let text = write(&lock_of(&path), &owner);
    let message = Claim::of(&path).unwrap_err().to_string();
    assert!(message.contains("of the machine node17"), "{message}");
    assert!(message.ends_with(&format!("remove {}", lock_of(&path).display())), "{message}");
    assert_eq!(fs::read_to_string(lock_of(&path)).unwrap(), text);
}

#[test]
fn a_lock_from_elsewhere_is_taken_over_when_nobody_touches_it() {
    let (folder, path) = place("run");
    assert_eq!(Claim::seen(&path), None);
    let mut owner = leave(&lock_of(&path));
    owner.writer.machine.host = "node17".into();
    write(&lock_of(&path), &owner);
    let first = Claim::seen(&path).unwrap();
    // As its process shows that it lives.
    let later = SystemTime::now() + Duration::from_secs(1);
    File::options().append(true).open(lock_of(&path)).unwrap().set_modified(later).unwrap();
    assert!(matches!(Claim::of_silent(&path, &first), Err(ClaimError::Elsewhere { .. })));
    let seen = Claim::seen(&path).unwrap();
    assert!(matches!(Claim::of(&path), Err(ClaimError::Elsewhere { .. })));
    let claim = Claim::of_silent(&path, &seen).unwrap();
    // Nobody else takes the new one for it.
    assert!(matches!(Claim::of_silent(&path, &seen), Err(ClaimError::Here { .. })));
    let before = Claim::seen(&path).unwrap();
    thread::sleep(Duration::from_millis(20));
    claim.touch();
    assert_ne!(Claim::seen(&path).unwrap(), before);
    drop(claim);
    assert_eq!(names(folder.path()), [""; 0]);
}

#[test]
fn the_lock_of_a_living_process_on_another_machine_of_the_same_name_stays() {
    let (_folder, path) = place("run.h5");
    for boot in ["another", ""] {
        let mut owner = Owner::this();
        let machine = &mut owner.writer.machine;
        // As of a copy of this machine, or of a container that is started again elsewhere.
        (machine.boot, machine.hardware) = (boot.into(), vec!["another".into()]);
        let text = write(&lock_of(&path), &owner);
        for refused in [Claim::of(&path).map(drop), Claim::check(&path).map(drop)] {
            assert!(matches!(refused, Err(ClaimError::Elsewhere { .. })), "{refused:?}");
        }
        assert_eq!(fs::read_to_string(lock_of(&path)).unwrap(), text);
    }
}

#[test]
fn a_lock_left_over_of_a_file_that_is_written_stays() {
    let (_folder, path) = place("run.h5");
    leave(&lock_of(&path));
    let text = fs::read_to_string(lock_of(&path)).unwrap();
    let mut writer = Command::new("sleep").arg("60").stdout(File::create(&path).unwrap()).spawn().unwrap();
    let refused = Claim::of(&path).unwrap_err();
    assert!(matches!(refused, ClaimError::Here(_, process, _) if process == writer.id()), "{refused:?}");
    assert_eq!(fs::read_to_string(lock_of(&path)).unwrap(), text);
    writer.kill().unwrap();
    writer.wait().unwrap();
    drop(Claim::of(&path).unwrap());
}

#[test]
fn a_lock_of_another_version_is_named_and_stays() {
    let (_folder, path) = place("run.h5");
    let lock = lock_of(&path);
    for version in [1, 3] {
        let content = format!("{{\"plateau_lock\":{version},\"writer\":7}}\n");
        fs::write(&lock, &content).unwrap();
        let message = Claim::of(&path).unwrap_err().to_string();
        assert!(message.contains(&format!("(format {version}, expected 2)")), "{message}");
        assert_eq!(fs::read_to_string(&lock).unwrap(), content);
    }
}

#[test]
fn what_is_no_lock_is_named_and_stays() {
    let (_folder, path) = place("run.h5");
    let lock = lock_of(&path);
    for content in [b"notes".as_slice(), b"{}\n", b"\xff\xfe", &[b'a'; 5000], b"{\"plateau_lock\":1,"] {
        fs::write(&lock, content).unwrap();
        let refused = Claim::of(&path).unwrap_err();
        assert!(matches!(refused, ClaimError::Foreign { .. }), "{refused}");
        assert_eq!(fs::read(&lock).unwrap(), content);
    }
    for odd in ["x\n\nplateau: fine", "\u{202e}"] {
        write(&lock, &Owner { since: odd.into(), ..Owner::this() });
        assert!(matches!(Claim::of(&path), Err(ClaimError::Foreign { .. })), "{odd:?}");
    }
    fs::remove_file(&lock).unwrap();
    assert!(Command::new("mkfifo").arg(&lock).status().unwrap().success());
    assert!(matches!(Claim::of(&path), Err(ClaimError::Foreign { .. })));
    fs::remove_file(&lock).unwrap();
    fs::create_dir(&lock).unwrap();
    assert!(matches!(Claim::of(&path), Err(ClaimError::Foreign { .. })));
}

#[test]
fn what_was_left_while_a_lock_was_made_goes_too() {
    let (folder, path) = place("run.h5");
    leave(&lock_of(&path));
    let mut ended = Command::new("true").spawn().unwrap();
    let process = ended.id();
    ended.wait().unwrap();
    let unfinished = |name: &str| format!(".{name}.plateau-{process}-{}.tmp", temporary::unique_word());
    let notes = unfinished("run.h5.lock.notes");
    for name in [&unfinished("run.h5.lock"), &notes] {
        fs::write(folder.path().join(name), "").unwrap();
    }
    drop(Claim::of(&path).unwrap());
    assert_eq!(names(folder.path()), [notes]);
}

#[test]
fn nobody_takes_over_what_another_takes_over() {
    let (_folder, path) = place("run.h5");
    let lock = lock_of(&path);
    let left = leave(&lock);
    let taking_over = File::open(&lock).unwrap();
    taking_over.try_lock().unwrap();
    let other = thread::spawn({
        let path = path.clone();
        move || Claim::of(&path).map(drop)
    });
    thread::sleep(Duration::from_millis(50));
    assert_eq!(read(&path, &lock).unwrap(), Some(left));
    // Killed, it lets go of it.
    drop(taking_over);
    assert!(other.join().unwrap().is_ok());
}
