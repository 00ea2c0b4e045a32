//! The files that a run of a scene reads and writes, with where they really are.

use std::env;
use std::path::{Path, PathBuf};

use plateau_io::checkpoint;
use plateau_io::claim::lock_of;
use plateau_io::run_file::resolve;
use plateau_io::scene::Scene;
use serde::Serialize;

use crate::message;

/// A file that a run reads or writes.
#[derive(Debug, Serialize)]
pub(super) struct File {
    access: &'static str,
    /// As the run uses it.
    path: String,
    /// What that is without links and `..`.
    resolved: String,
}

impl File {
    /// What is done with it and where it is, for a table.
    pub(super) fn row(&self) -> (&'static str, String) {
        let Self { access, path, resolved } = self;
        let plain = env::current_dir().is_ok_and(|here| here.join(path) == Path::new(resolved));
        (access, if plain { path.clone() } else { format!("{path}, which is {resolved}") })
    }

    /// What is read and the run file, in one line.
    pub(super) fn in_one_line(files: &[Self]) -> String {
        let of = |access: &str| {
            files.iter().filter(|file| file.access == access).map(|file| &*file.path).collect::<Vec<_>>()
        };
        let written = of("writes").first().map_or(String::new(), |file| format!("; writes {file}"));
        format!("reads {}{written}", of("reads").join(", "))
    }
}

/// Every file that a run of the scene reads, and those that it writes, with where they really are.
pub(super) fn files(scene: &Scene, inputs: &[(PathBuf, String)]) -> Vec<File> {
    let read = scene.files.iter().chain(inputs).map(|(path, _)| path);
    let mut files: Vec<File> = Vec::new();
    for path in read {
        // It was there a moment ago.
        let resolved = path.canonicalize().unwrap_or_else(|_| path.clone()).display().to_string();
        let path = path.display().to_string();
        if files.iter().all(|file| file.path != path) {
            files.push(File { access: "reads", path, resolved });
        }
    }
    let path = &scene.output.file;
    match resolve(path, true) {
        Ok(resolved) => {
            let lists = [path, &resolved].map(|path| {
                let [last, before] = checkpoint::paths(path);
                [path.clone(), last, before, lock_of(path)]
            });
            let [paths, resolved] = lists.map(|list| list.map(|path| path.display().to_string()));
            let written = paths.into_iter().zip(resolved);
            files.extend(written.map(|(path, resolved)| File { access: "writes", path, resolved }));
            if let Err(error) = checkpoint::refuse_foreign(path, false) {
                message::warning(error);
            }
        }
        Err(error) => message::warning(error),
    }
    files
}
