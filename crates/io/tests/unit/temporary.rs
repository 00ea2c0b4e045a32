use std::os::unix::fs::symlink;

use super::*;

#[test]
fn only_what_a_dead_process_left_is_removed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.h5");
    let dead = u32::MAX;
    let word = unique_word();
    let left = format!(".run.h5.plateau-{dead}-{word}.tmp");
    let kept = [
        format!(".run.h5.plateau-{}-{word}.tmp", std::process::id()),
        format!(".run.h5.plateau-{dead}-notes.tmp"),
        format!(".run.h5.plateau-{dead}-{word}"),
        format!(".other.h5.plateau-{dead}-{word}.tmp"),
    ];
    for name in kept.iter().chain([&left]) {
        fs::write(folder.path().join(name), "").unwrap();
    }
    let link = folder.path().join(format!(".run.h5.plateau-{dead}-0.tmp"));
    symlink("elsewhere", &link).unwrap();
    Temporary::remove_abandoned(&path);
    assert!(!folder.path().join(left).exists());
    assert!(kept.iter().all(|name| folder.path().join(name).exists()) && link.is_symlink());
}
