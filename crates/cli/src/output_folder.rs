//! A folder of files that one call of a command makes and that belong together: tables, figures, a page.
//!
//! A list of them, [`LIST`], is among them. So a later call replaces all of them or none, and takes away those that it does not
//! make itself: a figure of a response that is no longer asked for does not stay beside the new ones.

use std::fs;
use std::path::{Path, PathBuf};

use plateau_present::figure::{Figure, Format};

use crate::failure::Failure;
use crate::output;

/// The list's name.
const LIST: &str = "files.txt";
/// Its first line, by which it is known.
const HEAD: &str =
    "# plateau wrote these files; a later call with --force replaces them and removes those that it does not write";

/// A folder that is written.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    force: bool,
    files: Vec<String>,
}

impl OutputFolder {
    /// The folder of a call that has not done any work yet.
    ///
    /// # Errors
    /// [`Failure::Input`] when it has the files of an earlier call, unless `force` is set.
    pub fn new(path: PathBuf, force: bool) -> Result<Self, Failure> {
        if !force && listed(&path).is_some() {
            return Err(Failure::input(format_args!(
                "{} has the files of an earlier call; give --force to replace them, or name another folder with -o",
                path.display()
            )));
        }
        Ok(Self { path, force, files: Vec::new() })
    }

    /// Makes sure that files of these names may be written, makes the folder, and takes away what an earlier call wrote and this
    /// one does not. `inputs` are not touched.
    ///
    /// # Errors
    /// Those of [`output::check`] and [`output::make_directory`], before anything is changed.
    pub fn begin(&self, names: &[String], inputs: &[PathBuf]) -> Result<(), Failure> {
        output::make_directory(&self.path)?;
        let all = names.iter().map(String::as_str).chain([LIST]);
        all.clone().try_for_each(|name| output::check(&self.path.join(name), self.force, inputs))?;
        for name in listed(&self.path).unwrap_or_default().iter().filter(|name| !names.contains(name)) {
            let path = self.path.join(name);
            let is_input = inputs.iter().any(|input| input.canonicalize().ok() == path.canonicalize().ok());
            if path.is_file() && !is_input {
                let removed = fs::remove_file(&path);
                removed.map_err(|error| Failure::run(format_args!("cannot remove {}: {error}", path.display())))?;
            }
        }
        let list = std::iter::once(HEAD).chain(names.iter().map(String::as_str)).map(|line| format!("{line}\n"));
        output::write(&self.path.join(LIST), list.collect::<String>().as_bytes(), true)
    }

    /// Writes one of the files.
    ///
    /// # Errors
    /// Those of [`output::write()`].
    pub fn write(&mut self, name: &str, content: &[u8]) -> Result<(), Failure> {
        let path = self.path.join(name);
        output::write(&path, content, self.force)?;
        self.files.push(path.display().to_string());
        Ok(())
    }

    /// Writes figures in all formats; their names are those of [`names_of`].
    ///
    /// # Errors
    /// [`Failure::Run`] when one cannot be drawn, and those of [`output::write()`].
    pub fn write_figures(&mut self, figures: &[Figure]) -> Result<(), Failure> {
        for figure in figures {
            for format in Format::ALL {
                let content = figure.draw(format).map_err(Failure::run)?;
                self.write(&name_of(&figure.name, format), &content)?;
            }
        }
        Ok(())
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Paths of what was written, but for the list.
    pub fn files(&self) -> &[String] {
        &self.files
    }
}

/// Names of the files of figures.
pub fn names_of<'a>(figures: impl Iterator<Item = &'a Figure>) -> Vec<String> {
    figures.flat_map(|figure| Format::ALL.map(|format| name_of(&figure.name, format))).collect()
}

/// Name of the file of a figure of this name.
pub fn name_of(figure: &str, format: Format) -> String {
    format!("{figure}.{}", format.ending())
}

/// Names of the files that an earlier call wrote; none where there is no list of them.
fn listed(folder: &Path) -> Option<Vec<String>> {
    let text = fs::read_to_string(folder.join(LIST)).ok()?;
    let mut lines = text.lines();
    // Whoever edits the list cannot make it name a file elsewhere.
    let is_plain = |name: &&str| Path::new(name).file_name().is_some_and(|own| own == *name);
    (lines.next() == Some(HEAD)).then(|| lines.filter(is_plain).map(str::to_owned).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn write(folder: &Path, force: bool, files: &[&str], inputs: &[PathBuf]) -> Result<(), Failure> {
        let mut output = OutputFolder::new(folder.to_owned(), force)?;
        let all: Vec<String> = files.iter().map(|name| (*name).to_owned()).collect();
        output.begin(&all, inputs)?;
        files.iter().try_for_each(|name| output.write(name, name.as_bytes()))
    }

    #[test]
    fn files_of_an_earlier_call_are_replaced_and_removed_with_force_only() {
        let directory = tempfile::tempdir().unwrap();
        let folder = directory.path().join("effects");
        write(&folder, false, &["a.png", "b.png"], &[]).unwrap();
        fs::write(folder.join("mine.txt"), "mine").unwrap();
        let Err(Failure::Input(said)) = write(&folder, false, &["b.png", "c.png"], &[]) else { panic!("not refused") };
        assert!(said.ends_with("give --force to replace them, or name another folder with -o"), "{said}");
        assert_eq!(names(&folder), ["a.png", "b.png", "files.txt", "mine.txt"]);
        write(&folder, true, &["b.png", "c.png"], &[]).unwrap();
        assert_eq!(names(&folder), ["b.png", "c.png", "files.txt", "mine.txt"]);
    }

    #[test]
    fn a_file_of_someone_else_and_an_input_stay() {
        let directory = tempfile::tempdir().unwrap();
        let folder = directory.path().to_owned();
        fs::write(folder.join("effects.csv"), "mine").unwrap();
        assert!(matches!(write(&folder, false, &["effects.csv"], &[]), Err(Failure::Input(_))));
        let input = folder.join("effects.csv");
        assert!(matches!(write(&folder, true, &["effects.csv"], std::slice::from_ref(&input)), Err(Failure::Input(_))));
        assert_eq!(names(&folder), ["effects.csv"]);
        // A list that was edited does not reach beyond the folder, and does not take away an input.
        fs::create_dir(folder.join("in")).unwrap();
        fs::write(folder.join("in").join(LIST), format!("{HEAD}\n../effects.csv\npoints.csv\n")).unwrap();
        fs::write(folder.join("in/points.csv"), "points").unwrap();
        write(&folder.join("in"), true, &["a.png"], &[folder.join("in/points.csv")]).unwrap();
        assert_eq!(names(&folder.join("in")), ["a.png", "files.txt", "points.csv"]);
        assert_eq!(fs::read_to_string(&input).unwrap(), "mine");
    }
}
