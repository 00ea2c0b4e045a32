//! The program `plateau`, run as its users run it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use plateau_io::checkpoint;
use plateau_io::run_file::RunFile;
use serde::Deserialize;
use tempfile::TempDir;

use crate::case::Source;
use crate::error::BenchError;

/// The program, and a folder for what it writes.
#[derive(Debug)]
pub struct Program {
    path: PathBuf,
    folder: TempDir,
}

/// What a run tells of itself.
#[derive(Debug, Clone, Copy, Deserialize)]
pub struct Run {
    /// Steps made.
    pub steps: u64,
    /// From before the first step until the run file is complete, s.
    pub wall_time: f64,
    /// Largest memory of the process, bytes; none where the system does not tell.
    pub peak_memory: Option<u64>,
    /// Size of the run file, bytes.
    pub file_size: u64,
}

impl Run {
    /// Wall time over steps.
    pub fn microseconds_per_step(&self) -> f64 {
        self.wall_time * 1e6 / self.steps as f64
    }
}

impl Program {
    /// The program at `path`, or where it is found.
    pub fn find(path: Option<PathBuf>) -> Result<Self, BenchError> {
        let named = path.or_else(|| std::env::var_os("PLATEAU_PROGRAM").map(PathBuf::from));
        let path = match named {
            Some(path) => path,
            None => {
                let name = format!("plateau{}", std::env::consts::EXE_SUFFIX);
                std::env::current_exe().map_err(BenchError::file("this program".as_ref()))?.with_file_name(name)
            }
        };
        if !path.is_file() {
            return Err(BenchError::NoProgram(path));
        }
        let folder = tempfile::tempdir().map_err(BenchError::file(&std::env::temp_dir()))?;
        Ok(Self { path, folder })
    }

    /// Runs a scene.
    pub fn run(&self, source: &Source) -> Result<Run, BenchError> {
        let file = self.run_file();
        let run = self.write(source)?;
        remove(&file)?;
        Ok(run)
    }

    /// The source that the program was built from, as it writes it into run files.
    pub fn revision(&self, source: &Source) -> Result<Option<String>, BenchError> {
        self.write(&source.with(["operation.steps=1".to_owned()]))?;
        let file = self.run_file();
        let revision = RunFile::open(&file).map_err(|error| self.problem(source, error))?.attribute("source_revision");
        remove(&file)?;
        Ok(revision)
    }

    fn run_file(&self) -> PathBuf {
        self.folder.path().join("run.h5")
    }

    fn write(&self, source: &Source) -> Result<Run, BenchError> {
        let mut command = Command::new(&self.path);
        command.arg("run").arg(&source.path).arg("--json").arg("--output").arg(self.run_file());
        for set in &source.sets {
            command.args(["--set", set]);
        }
        let output = command.output().map_err(BenchError::file(&self.path))?;
        if !output.status.success() {
            return Err(self.problem(source, String::from_utf8_lossy(&output.stderr).trim_end()));
        }
        serde_json::from_slice(&output.stdout)
            .map_err(|error| self.problem(source, format!("its summary is none that this program knows: {error}")))
    }

    fn problem(&self, source: &Source, problem: impl ToString) -> BenchError {
        let (program, scene, sets) = (self.path.clone(), source.path.clone(), source.sets.join(" "));
        BenchError::Run { program, scene, sets, problem: problem.to_string() }
    }
}

/// Removes a run file and its checkpoints: the next run shall find what this one found.
fn remove(file: &Path) -> Result<(), BenchError> {
    fs::remove_file(file).map_err(BenchError::file(file))?;
    for path in checkpoint::paths(file).into_iter().filter(|path| path.exists()) {
        fs::remove_file(&path).map_err(BenchError::file(&path))?;
    }
    Ok(())
}
