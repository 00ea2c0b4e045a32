//! What a result is the result of: the scene without what does not show in it, the content of the files that it read, and
//! the generation of the program's numbers.

use std::collections::{BTreeMap, HashMap};
use std::convert::Infallible;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::generation;
use crate::regular::sha256;
use crate::scene::schema::{self, Role};
use crate::scene::{BaseSource, HeightSource, Scene};

/// Digests of files, each read once.
#[derive(Debug, Default)]
pub struct Digests(Mutex<BTreeMap<PathBuf, String>>);

impl Digests {
    /// SHA-256 of a file, 64 hexadecimal digits.
    ///
    /// # Errors
    /// What the system says when the file cannot be read.
    pub fn of(&self, path: &Path) -> io::Result<String> {
        let known = || self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(digest) = known().get(path) {
            return Ok(digest.clone());
        }
        let digest = sha256(path)?;
        known().insert(path.to_owned(), digest.clone());
        Ok(digest)
    }

    /// The files that were asked for.
    pub fn files(&self) -> Vec<PathBuf> {
        self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner).keys().cloned().collect()
    }
}

/// What a result is the result of. Workers, names of files and titles do not count, nor does the revision of the program as long as it
/// computes the same numbers.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Identity {
    /// Generation of the program's numbers: [`crate::generation`]. 0 in records of programs that did not count them.
    pub generation: u32,
    /// SHA-256 of what shows in results of the resolved scene.
    pub scene: String,
    /// SHA-256 of what was read of each file that shows in results, by what it is for.
    pub files: BTreeMap<String, String>,
}

impl Identity {
    /// That of a scene whose surfaces have such `inputs`: files, with the digest of what was read of them. A file that was read twice and
    /// changed in between has both.
    pub fn of(scene: &Scene, inputs: &[(PathBuf, String)]) -> Self {
        let digests = |path: &Path| -> Vec<&str> {
            inputs.iter().filter(|(input, _)| input == path).map(|(_, digest)| digest.as_str()).collect()
        };
        let found = Self::with(scene, |path| Ok::<_, Infallible>(digests(path).join("+")));
        found.unwrap_or_else(|(_, never)| match never {})
    }

    /// That of a scene whose surfaces were not read yet: the files as they are now.
    ///
    /// # Errors
    /// The file that cannot be read, and why.
    pub fn expected(scene: &Scene, digests: &Digests) -> Result<Self, (PathBuf, io::Error)> {
        Self::with(scene, |path| digests.of(path))
    }

    fn with<E>(scene: &Scene, digest: impl Fn(&Path) -> Result<String, E>) -> Result<Self, (PathBuf, E)> {
        let mut hasher = Sha256::new();
        for line in relevant(&scene.resolved) {
            hasher.update(line);
            hasher.update("\n");
        }
        let mut files = BTreeMap::new();
        if let Some((_, digest)) = scene.cycle.as_ref().and_then(|operation| operation.file.as_ref()) {
            files.insert("operation.cycle".to_owned(), digest.clone());
        }
        for (key, path) in surface_files(scene) {
            files.insert(key.to_owned(), digest(path).map_err(|error| (path.to_owned(), error))?);
        }
        Ok(Self { generation: generation::current(), scene: format!("{:x}", hasher.finalize()), files })
    }

    /// Digest of all of it, 64 hexadecimal digits: the name of the result.
    pub fn name(&self) -> String {
        let mut hasher = Sha256::new();
        hasher.update(format!("{}\n{}\n", self.generation, self.scene));
        self.files.iter().for_each(|(key, digest)| hasher.update(format!("{key} {digest}\n")));
        format!("{:x}", hasher.finalize())
    }
}

/// Of each run the place of the first one with the same identity, which is its own unless it repeats another run.
pub fn firsts(identities: &[String]) -> Vec<usize> {
    let mut known = HashMap::new();
    identities.iter().enumerate().map(|(place, identity)| *known.entry(identity).or_insert(place)).collect()
}

/// The lines of a resolved scene, one key each, that show in its results.
fn relevant(resolved: &str) -> impl Iterator<Item = &str> {
    let mut table = "";
    resolved.lines().filter(move |line| {
        if let Some(name) = line.strip_prefix('[') {
            table = name.trim_end_matches(']');
        }
        line.split_once(" = ").is_none_or(|(name, _)| shows(&schema::join(table, name)))
    })
}

/// Whether a key shows in the series of its run. Of files the content counts, not the name.
fn shows(key: &str) -> bool {
    !matches!(schema::role(key), Role::Nothing | Role::Maps | Role::MapTimes) && !schema::is_input(key)
}

/// The files of surfaces whose content shows in results, and what they are for.
fn surface_files(scene: &Scene) -> impl Iterator<Item = (&'static str, &PathBuf)> {
    let base = match &scene.pin_base {
        BaseSource::File { path, .. } | BaseSource::Image { path, .. } => Some(path),
        BaseSource::Synthetic(_) | BaseSource::Uniform(_) => None,
    };
    let all = [
        ("disc.surface", heights(&scene.disc_surface.source)),
        ("pin.surface", heights(&scene.pin_surface.source)),
        ("pin.base", base),
    ];
    all.into_iter().filter_map(|(key, path)| Some((key, path?)))
}

/// The file that heights come from.
fn heights(source: &HeightSource) -> Option<&PathBuf> {
    match source {
        HeightSource::File { path, .. } => Some(path),
        HeightSource::Synthetic(_) | HeightSource::Flat => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_that_repeat_another_are_told() {
        assert_eq!(firsts(&["a", "b", "a", "c", "b", "a"].map(str::to_owned)), [0, 1, 0, 3, 1, 0]);
    }

    #[test]
    fn what_does_not_show_in_results_does_not_count() {
        let text = "\ntitle = \"a\"\n[mesh]\nrows = 80\n\n[numerics]\nworkers = 2\n[disc.surface]\nfile = \"a.sdf\"\n\
                    mirror = false\n[output]\nfile = \"a.h5\"\nsample_every = \"1 s\"\n";
        let kept: Vec<&str> = relevant(text).filter(|line| line.contains(" = ")).collect();
        assert_eq!(kept, ["rows = 80", "mirror = false", "sample_every = \"1 s\""]);
    }
}
