//! Notes the revision of the source for the provenance of run files.

use std::process::Command;

fn main() {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
        Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let mut revision = git(&["rev-parse", "HEAD"]).unwrap_or_else(|| "unknown".into());
    if git(&["status", "--porcelain", "--", "../..", ":!../../data", ":!../../docs"]).is_some_and(|s| !s.is_empty()) {
        revision.push_str("-modified");
    }
    println!("cargo::rustc-env=PLATEAU_REVISION={revision}");
    println!("cargo::rerun-if-changed=../core/src");
    println!("cargo::rerun-if-changed=../io/src");
    println!("cargo::rerun-if-changed=../run/src");
    println!("cargo::rerun-if-changed=src");
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]) {
        println!("cargo::rerun-if-changed={log}");
    }
}
