//! A folder of files that one call of a command makes and that belong together: tables, figures, a page.
//!
//! A list of them, [`LIST`], is among them. So a later call replaces all of them or none, and takes away those that it does not
//! make itself: a figure of a response that is no longer asked for does not stay beside the new ones. A command that goes on
//! where it was, as a fit does, says in the list [`of what`](OutputFolder::of) the files are, and replaces those without being asked.

use std::fs;
use std::path::{Component, Path, PathBuf};

use plateau_io::text::shown_on_one_line;
use plateau_io::{limits, regular};
use plateau_present::figure::{Figure, Format};

use crate::failure::Failure;
use crate::output;

/// The list's name.
const LIST: &str = "files.txt";
/// Its first line, by which it is known.
const HEAD: &str =
    "# plateau wrote these files; a later call with --force replaces them and removes those that it does not write";

/// How the line begins that says what the files are of.
const OF: &str = "# of ";

/// A folder that is written.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    force: bool,
    /// What the files are of, where a later call of the same may replace them.
    of: Option<String>,
    /// Those of an earlier call of the same.
    own: Vec<String>,
    files: Vec<String>,
}

impl OutputFolder {
    /// The folder of a call that has not done any work yet.
    ///
    /// # Errors
    /// [`Failure::Input`] when it has the files of an earlier call, unless `force` is set.
    pub fn new(path: PathBuf, force: bool) -> Result<Self, Failure> {
        if !force && List::read(&path).is_some() {
            return Err(Failure::input(format!(
                "{} has the files of an earlier call; give --force to replace them, or name another folder with -o",
                path.display()
            )));
        }
        Ok(Self { path, force, of: None, own: Vec::new(), files: Vec::new() })
    }

    /// The folder of a call that replaces what an earlier call of the same command for the same `study` wrote, as its list says,
    /// and nothing else unless `force` is set.
    ///
    /// # Errors
    /// [`Failure::Input`] when it has the files of another call.
    pub fn of(command: &str, study: &Path, path: PathBuf, force: bool) -> Result<Self, Failure> {
        let of = format!("{command} {}", shown_on_one_line(&between(&path, study).to_string_lossy()));
        let own = match List::read(&path) {
            Some(list) if list.of.as_ref() == Some(&of) => list.names,
            Some(list) if !force => {
                let other = list.of.map_or_else(String::new, |of| format!(", of {of}"));
                return Err(Failure::input(format!(
                    "{} has the files of another call{other}; give --force to replace them, or name another folder with -o",
                    path.display()
                )));
            }
            _ => Vec::new(),
        };
        Ok(Self { path, force, of: Some(of), own, files: Vec::new() })
    }

    /// Refuses names that are taken by what is not to be replaced, before any work is done for them.
    ///
    /// # Errors
    /// Those of [`output::check`].
    pub fn check<'a>(&self, names: impl IntoIterator<Item = &'a str>, inputs: &[PathBuf]) -> Result<(), Failure> {
        names.into_iter().chain([LIST]).try_for_each(|name| {
            let path = self.path.join(name);
            // A folder that is still to be made has nothing.
            if self.path.is_dir() { output::check(&path, self.replaces(name), inputs) } else { Ok(()) }
        })
    }

    /// Whether a file of this name is replaced if there is one. What has become of a file since, such as a link, is not its own.
    fn replaces(&self, name: &str) -> bool {
        let is_own = (name == LIST && !self.own.is_empty()) || self.own.iter().any(|own| own == name);
        let is_file = || fs::symlink_metadata(self.path.join(name)).is_ok_and(|there| there.is_file());
        self.force || (is_own && is_file())
    }

    /// Makes sure that files of these names may be written, makes the folder, and takes away what an earlier call wrote and this
    /// one does not. `inputs` are not touched.
    ///
    /// # Errors
    /// Those of [`output::check`] and [`output::make_directory`], before anything is changed.
    pub fn begin(&self, names: &[String], inputs: &[PathBuf]) -> Result<(), Failure> {
        output::make_directory(&self.path)?;
        self.check(names.iter().map(String::as_str), inputs)?;
        let before = List::read(&self.path).map_or_else(Vec::new, |list| list.names);
        for name in before.iter().filter(|name| !names.contains(name) && self.replaces(name)) {
            let path = self.path.join(name);
            if path.is_file() && !regular::is_one_of(&path, inputs) {
                let removed = fs::remove_file(&path);
                removed.map_err(|error| Failure::run(format_args!("cannot remove {}: {error}", path.display())))?;
            }
        }
        let of = self.of.as_ref().map(|of| format!("{OF}{of}\n"));
        let names: String = names.iter().map(|name| format!("{name}\n")).collect();
        let list = format!("{HEAD}\n{}{names}", of.unwrap_or_default());
        output::write_in_folder(&self.path.join(LIST), list.as_bytes(), self.replaces(LIST))
    }

    /// Writes one of the files.
    ///
    /// # Errors
    /// Those of [`output::write()`].
    pub fn write(&mut self, name: &str, content: &[u8]) -> Result<(), Failure> {
        let path = self.path.join(name);
        output::write_in_folder(&path, content, self.replaces(name))?;
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

/// What an earlier call says in its list.
struct List {
    /// What the files are of.
    of: Option<String>,
    /// Names of the files.
    names: Vec<String>,
}

impl List {
    /// None where there is no list.
    fn read(folder: &Path) -> Option<Self> {
        let text = regular::read_to_string(&folder.join(LIST), limits::STUDY).ok()?;
        let mut lines = text.lines();
        // Whoever edits the list cannot make it name a file elsewhere.
        let is_plain = |name: &&str| Path::new(name).file_name().is_some_and(|own| own == *name);
        let is_list = lines.next() == Some(HEAD);
        let (said, names): (Vec<&str>, Vec<&str>) = lines.partition(|line| line.starts_with('#'));
        let of = said.into_iter().find_map(|line| line.strip_prefix(OF)).map(str::to_owned);
        is_list.then(|| Self { of, names: names.into_iter().filter(is_plain).map(str::to_owned).collect() })
    }
}

/// The way from a folder, which need not be there yet, to a file: the same wherever both are moved together.
fn between(folder: &Path, file: &Path) -> PathBuf {
    let real = |path: &Path| {
        let known = path.ancestors().find_map(|ancestor| {
            let there = if ancestor.as_os_str().is_empty() { Path::new(".") } else { ancestor };
            Some((there.canonicalize().ok()?, path.strip_prefix(ancestor).ok()?))
        });
        known.map_or_else(|| path.to_owned(), |(known, rest)| known.join(rest))
    };
    let (folder, file) = (real(folder), real(file));
    let common = folder.components().zip(file.components()).take_while(|(one, other)| one == other).count();
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    up.chain(file.components().skip(common)).collect()
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
    fn what_goes_on_replaces_its_own_files_and_no_others() {
        let directory = tempfile::tempdir().unwrap();
        let (folder, study) = (directory.path().join("results/fit"), directory.path().join("s.toml"));
        let write = |study: &Path, force: bool, files: &[&str]| {
            let mut output = OutputFolder::of("fit", study, folder.clone(), force)?;
            let all: Vec<String> = files.iter().map(|name| (*name).to_owned()).collect();
            output.begin(&all, &[])?;
            files.iter().try_for_each(|name| output.write(name, name.as_bytes()))
        };
        fs::write(&study, "").unwrap();
        write(&study, false, &["a.png", "b.png"]).unwrap();
        assert!(fs::read_to_string(folder.join(LIST)).unwrap().contains("\n# of fit ../../s.toml\n"));
        write(&study, false, &["b.png"]).unwrap();
        assert_eq!(names(&folder), ["b.png", "files.txt"]);
        // Of another study, of somebody else, and what is no file any more.
        assert!(write(&directory.path().join("t.toml"), false, &["b.png"]).is_err());
        fs::write(folder.join("c.png"), "mine").unwrap();
        assert!(write(&study, false, &["b.png", "c.png"]).is_err());
        fs::remove_file(folder.join("b.png")).unwrap();
        std::os::unix::fs::symlink("c.png", folder.join("b.png")).unwrap();
        assert!(write(&study, false, &["b.png"]).is_err());
        write(&study, true, &["b.png"]).unwrap();
        assert_eq!(fs::read_to_string(folder.join("c.png")).unwrap(), "mine");
        assert!(!folder.join("b.png").is_symlink());
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
