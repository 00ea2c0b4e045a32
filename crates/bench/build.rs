//! Notes what the benchmarks were built from, with and how: results name it.

use std::process::Command;

fn main() {
    let first_line = |program: &str, arguments: &[&str]| {
        let output = Command::new(program).args(arguments).output().ok().filter(|output| output.status.success())?;
        Some(String::from_utf8_lossy(&output.stdout).lines().next().unwrap_or_default().to_owned())
    };
    let variable = |name: &str| std::env::var(name).unwrap_or_else(|_| "unknown".into());
    let unknown = || "unknown".to_owned();

    let mut revision = first_line("git", &["rev-parse", "HEAD"]).unwrap_or_else(unknown);
    let changed = ["status", "--porcelain", "--", "../..", ":!../../data", ":!../../docs"];
    if first_line("git", &changed).is_some_and(|line| !line.is_empty()) {
        revision.push_str("-modified");
    }
    println!("cargo::rustc-env=BENCH_REVISION={revision}");
    println!("cargo::rustc-env=BENCH_COMPILER={}", first_line(&variable("RUSTC"), &["-V"]).unwrap_or_else(unknown));
    println!("cargo::rustc-env=BENCH_PROFILE={}", variable("PROFILE"));
    println!("cargo::rustc-env=BENCH_TARGET={}", variable("TARGET"));
    println!("cargo::rustc-env=BENCH_FLAGS={}", variable("CARGO_ENCODED_RUSTFLAGS").replace('\u{1f}', " "));
    for folder in ["src", "../core/src", "../io/src", "../../Cargo.toml", "../../Cargo.lock"] {
        println!("cargo::rerun-if-changed={folder}");
    }
    if let Some(log) = first_line("git", &["rev-parse", "--git-path", "logs/HEAD"]) {
        println!("cargo::rerun-if-changed={log}");
    }
}
