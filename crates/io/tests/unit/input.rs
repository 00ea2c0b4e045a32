use super::*;

#[test]
fn a_name_that_is_mistyped_is_told_with_the_one_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("quick.toml"), "").unwrap();
    let said = |name: &str| open(&folder.path().join(name)).unwrap_err().to_string();
    let meant = folder.path().join("quick.toml");
    assert_eq!(said("quik.toml"), format!("No such file or directory (os error 2); did you mean {}?", meant.display()));
    for like in ["quick", "quick.tml", "qiuck.toml"] {
        assert!(said(like).ends_with("quick.toml?"), "{}", said(like));
    }
    // Neither what has only its beginning nor what has only its ending.
    assert_eq!(said("quick.h5"), "No such file or directory (os error 2)");
    assert_eq!(said("else.toml"), "No such file or directory (os error 2)");
    assert_eq!(said("."), "it is a folder, expected a file");
}

#[test]
fn the_digest_is_that_of_what_was_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("surface");
    fs::write(&path, "0").unwrap();
    // It grows behind the first two readings.
    let mut readings = 0;
    let growing = || {
        let content = read_to_string(&path, 9)?;
        readings += 1;
        let next = "0".repeat(readings.min(2) + 1);
        if content != next { fs::write(&path, next).map(|()| content) } else { Ok(content) }
    };
    let (content, digest) = digested(&path, growing, |error| error).unwrap();
    assert_eq!((content.as_str(), readings, digest), ("000", 3, sha256_of(b"000")));
    let mut count = 0;
    let endless = || {
        count += 1;
        fs::write(&path, "0".repeat(count))
    };
    let said = digested(&path, endless, |error| error).unwrap_err().to_string();
    assert!(said.starts_with("it changes while it is read"), "{said}");
}

#[test]
fn what_is_larger_than_expected_is_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("file");
    fs::write(&path, "12345").unwrap();
    assert_eq!(read_to_string(&path, 5).unwrap(), "12345");
    let error = read(&path, 4).unwrap_err();
    assert_eq!((error.kind(), error.to_string().as_str()), (ErrorKind::FileTooLarge, "5 bytes, expected at most 4"));
    // It takes no room on the disk, and would take all memory.
    File::options().write(true).open(&path).unwrap().set_len(1 << 40).unwrap();
    assert_eq!(read(&path, 1 << 20).unwrap_err().kind(), ErrorKind::FileTooLarge);
}
