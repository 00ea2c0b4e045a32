//! What the crate promises, from outside. One program, for every one that is linked takes time.

mod bad_scenes;
mod checkpoints;
mod fixtures;
mod fuzz;
mod good_scenes;
mod heights;
mod hostile_tables;
mod mesh_scenes;
mod micrograph;
mod plausibility;
mod profiles;
mod read_run_file;
mod run_file;
mod run_file_processes;
mod scene_layers;
mod sdf;
mod sdf_dialects;
#[expect(dead_code, reason = "other tests need more of it")]
mod studies;
mod surfaces;
mod tables;
mod text;
mod writing;

/// How much of a test that repeats itself is done: `few` as it goes without saying, `all` with `PLATEAU_LONG=1`.
fn few_or_all<T: std::fmt::Debug>(few: T, all: T) -> T {
    if std::env::var_os("PLATEAU_LONG").is_some() {
        return all;
    }
    println!("{few:?}, with PLATEAU_LONG=1 {all:?}");
    few
}
