use super::*;

#[test]
fn a_run_that_another_process_makes_is_not_taken() {
    let folder = tempfile::tempdir().unwrap();
    let take = || UnderWay::take(folder.path(), "a", &Mutex::default(), &());
    let under_way = take().unwrap();
    assert!(take().is_none());
    drop(under_way);
    let under_way = take().unwrap();
    end(folder.path());
    assert!(folder.path().join(FOLDER).exists());
    drop(under_way);
    end(folder.path());
    assert!(!folder.path().join(FOLDER).exists());
}

#[test]
fn what_a_killed_process_left_while_it_asked_for_a_run_goes() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join(FOLDER)).unwrap();
    let left = folder.path().join(FOLDER).join(format!(".a.lock.plateau-{}-0.tmp", u32::MAX));
    fs::write(&left, "").unwrap();
    assert_eq!(tidy(folder.path(), |_| true, |_| false), 0);
    assert!(!left.exists() && !folder.path().join(FOLDER).exists());
}

#[test]
fn who_touches_a_lock_is_not_silent() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a");
    let claim = Claim::of(&path).unwrap();
    let (mut others, short) = (Others::default(), Duration::from_millis(20));
    assert_eq!(others.silent(&path, short), None);
    std::thread::sleep(2 * short);
    claim.touch();
    assert_eq!(others.silent(&path, short), None, "touched");
    assert_eq!(others.silent(&path, Duration::MAX), None);
    std::thread::sleep(2 * short);
    assert_eq!(others.silent(&path, short), Claim::seen(&path));
    drop(claim);
    assert_eq!(others.silent(&path, Duration::ZERO), None, "gone");
}
