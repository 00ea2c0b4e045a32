//! Who has a file open for writing.

use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::Path;

/// Access modes of an open file in `/proc/PID/fdinfo`, where writing is possible: O_WRONLY and O_RDWR.
const WRITING: u32 = 3;

/// A living process of this machine, other than this one, that has a file open for writing, as far as the system tells: only
/// on Linux, and of users whose processes this one may look at.
pub fn writer_of(path: &Path) -> Option<u32> {
    let wanted = fs::metadata(path).ok()?;
    let processes = fs::read_dir("/proc").ok()?.flatten();
    let mut numbers = processes.filter_map(|process| process.file_name().to_str()?.parse::<u32>().ok());
    numbers.find(|&process| process != std::process::id() && writes(process, &wanted))
}

fn writes(process: u32, wanted: &fs::Metadata) -> bool {
    let Ok(files) = fs::read_dir(format!("/proc/{process}/fd")) else { return false };
    files.flatten().any(|file| {
        let same = fs::metadata(file.path()).is_ok_and(|file| (file.dev(), file.ino()) == (wanted.dev(), wanted.ino()));
        same && is_writing(process, &file.file_name().to_string_lossy())
    })
}

fn is_writing(process: u32, file: &str) -> bool {
    let information = fs::read_to_string(format!("/proc/{process}/fdinfo/{file}")).unwrap_or_default();
    let flags = information.lines().find_map(|line| line.strip_prefix("flags:"));
    flags.and_then(|flags| u32::from_str_radix(flags.trim(), 8).ok()).is_some_and(|flags| flags & WRITING != 0)
}

#[cfg(test)]
mod tests {
    use std::fs::File;
    use std::path::Path;
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    use super::writer_of;

    /// Soon the writer is this one. A process that another test starts has the files of this one for a moment.
    fn assert_writer(path: &Path, expected: Option<u32>) {
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
        assert_writer(&path, None);
        let sleep = |file: File| Command::new("sleep").arg("60").stdout(Stdio::from(file)).spawn().unwrap();
        let mut reader = sleep(File::open(&path).unwrap());
        assert_writer(&path, None);
        let mut writer = sleep(own);
        assert_writer(&path, Some(writer.id()));
        for process in [&mut reader, &mut writer] {
            process.kill().unwrap();
            process.wait().unwrap();
        }
        assert_writer(&path, None);
    }
}
