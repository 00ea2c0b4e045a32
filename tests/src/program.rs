//! The built program, run as its users run it.

use std::collections::BTreeMap;
use std::env;
use std::ffi::{OsStr, OsString};
use std::fmt::Display;
use std::fs::{self, File};
use std::io::{Read, Seek};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::TempDir;

use crate::run_file::{Content, RunFile, differences};
use crate::scenes::Stream;

/// What messages name the program, wherever it was built.
const CALLED: (&str, &str) = ("PLATEAU_CALLED", "plateau");
/// No command of these tests takes nearly as long; one that does hangs.
const PATIENCE: Duration = Duration::from_secs(300);
/// Time between two looks at what is waited for.
const LOOK: Duration = Duration::from_millis(2);

/// The program under test: the one that `PLATEAU_PROGRAM` names, or the one that cargo built in the same profile.
///
/// # Panics
/// When it is not built.
pub fn program() -> PathBuf {
    if let Some(named) = std::env::var_os("PLATEAU_PROGRAM") {
        return named.into();
    }
    // Tests are in target/PROFILE/deps, the program in target/PROFILE.
    let tests = std::env::current_exe().expect("the path of this test");
    let program = tests.ancestors().nth(2).unwrap_or(&tests).join("plateau");
    let advice = "build it with `cargo build --release -p plateau` and test with --release, or set PLATEAU_PROGRAM";
    assert!(program.is_file(), "the program {} is not built: {advice}", program.display());
    program
}

/// Commands that the program's own help lists.
///
/// # Panics
/// When there is no list in it.
pub fn commands() -> Vec<String> {
    let help = WorkingDirectory::new().plateau(["--help"]).quiet_success();
    let (_, list) = help.split_once("Commands:\n").expect("a list of commands");
    let names = list.lines().take_while(|line| !line.is_empty()).filter_map(|line| line.split_whitespace().next());
    names.filter(|name| *name != "help").map(str::to_owned).collect()
}

/// Those that the program answers itself; the others are the Python package's, whose tests look at them.
pub fn own_commands() -> Vec<String> {
    commands()
        .into_iter()
        .filter(|name| !["cycle", "fit", "compare", "plot", "report", "export"].contains(&name.as_str()))
        .collect()
}

/// The root of the repository.
pub fn repository() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// Where programs are looked for: a stand-in for the Python package comes first.
///
/// # Panics
/// When a folder has a colon in its name.
pub fn path() -> OsString {
    let usual = env::var_os("PATH").unwrap_or_default();
    let folders = [repository().join("tests/stand_in")].into_iter().chain(env::split_paths(&usual));
    env::join_paths(folders).expect("a search path")
}

/// Path of a scene in `data/scenes`.
pub fn scene(name: &str) -> String {
    repository().join("data/scenes").join(name).display().to_string()
}

/// Path of a file of a test vector.
pub fn vector(name: &str, file: &str) -> String {
    repository().join("tests/vectors").join(name).join(file).display().to_string()
}

/// `quick.toml` with pieces of its text replaced, each of which must be there once.
///
/// # Panics
/// When a piece is not there, or more than once.
pub fn quick_scene_with(edits: &[(&str, &str)]) -> String {
    let mut text = fs::read_to_string(scene("quick.toml")).expect("quick.toml");
    for (old, new) in edits {
        assert_eq!(text.matches(old).count(), 1, "{old:?} in quick.toml");
        text = text.replace(old, new);
    }
    text
}

/// Settings as words of a command line: each behind `--set`.
pub fn sets<'a>(settings: &[&'a str]) -> Vec<&'a str> {
    settings.iter().flat_map(|setting| ["--set", setting]).collect()
}

/// Words that run a shipped scene into a file with these settings, and more words.
pub fn run_words(name: &str, file: &str, settings: &[&str], more: &[&str]) -> Vec<String> {
    let scene = scene(name);
    let words = [&["run", &scene, "-o", file], &sets(settings)[..], more].concat();
    words.into_iter().map(str::to_owned).collect()
}

/// The source of the disc's heights in `quick.toml`.
pub const DISC: &str = "synthetic = { seed = 1, rms_height = \"3 um\", correlation_length = \"200 um\" }";

/// What makes a run of `quick.toml` one that does not end by itself while a test goes on.
pub const ENDLESS: (&str, &str) = ("duration = \"60 s\"", "steps = 1000000000");

/// Settings of a mesh so small that its runs take a moment.
pub const SMALL_MESH: [&str; 3] = ["mesh.rows=8", "mesh.disc_columns=160", "mesh.pin_columns=16"];

/// What a command said and how it ended.
#[derive(Debug)]
pub struct Outcome {
    /// The command, so that a failed test names it.
    pub command: String,
    /// Exit status; none if a signal ended it.
    pub status: Option<i32>,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

/// Note to scenes with pooled debris.
const PLAIN_MODEL: &str = "plateau: pooled debris: the plain model takes the steps, cell by cell, on one worker\n";

impl Outcome {
    /// Standard error without the note on what takes the steps.
    pub fn said(&self) -> String {
        self.stderr.replace(PLAIN_MODEL, "")
    }

    /// A success without a word on standard error but for what takes the steps; gives standard output.
    ///
    /// # Panics
    /// When it is no such success.
    pub fn quiet_success(self) -> String {
        assert_eq!((self.status, self.said().as_str()), (Some(0), ""), "standard output: {}", self.stdout);
        self.stdout
    }

    /// Standard output as one JSON document.
    ///
    /// # Panics
    /// When it is none.
    #[track_caller]
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}: {self:?}"))
    }

    /// The outcome, which has this exit status, and all of these texts on standard error.
    ///
    /// # Panics
    /// When it has not.
    #[track_caller]
    pub fn ends(self, status: i32, texts: &[&str]) -> Self {
        let missing: Vec<_> = texts.iter().filter(|text| !self.stderr.contains(**text)).collect();
        assert!(self.status == Some(status) && missing.is_empty(), "expected {status} and {missing:?}: {self:?}");
        self
    }
}

/// A working directory of its own for the program; it is removed in the end.
#[derive(Debug)]
pub struct WorkingDirectory {
    directory: TempDir,
}

impl WorkingDirectory {
    /// An empty directory.
    ///
    /// # Panics
    /// When the system gives none; so do the other functions when the system refuses what they need.
    #[expect(clippy::new_without_default, reason = "it makes a directory")]
    pub fn new() -> Self {
        Self { directory: tempfile::tempdir().expect("a temporary directory") }
    }

    /// A directory with one file.
    pub fn with(name: &str, content: impl AsRef<[u8]>) -> Self {
        let directory = Self::new();
        directory.write(name, content);
        directory
    }

    /// A directory with `scene.toml`, which is `quick.toml` with pieces of its text replaced.
    pub fn with_scene(edits: &[(&str, &str)]) -> Self {
        Self::with("scene.toml", quick_scene_with(edits))
    }

    /// Absolute path of a name in the directory.
    pub fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    /// Writes a file, and the directories that it needs.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a directory")).expect("a directory for the file");
        fs::write(&path, content).expect("the file");
        path
    }

    /// The text of a file.
    #[track_caller]
    pub fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// A run file, or results of a study.
    #[track_caller]
    pub fn run_file(&self, name: &str) -> RunFile {
        RunFile::open(self.path(name))
    }

    /// Every file below the directory, those with a leading dot too, with its content; the content of a link is its
    /// target, and directories have none.
    pub fn content(&self) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
        let mut content = BTreeMap::new();
        let mut directories = vec![self.directory.path().to_path_buf()];
        while let Some(directory) = directories.pop() {
            for entry in fs::read_dir(directory).expect("a directory") {
                let path = entry.expect("an entry").path();
                let bytes = if let Ok(target) = fs::read_link(&path) {
                    Some(target.into_os_string().into_encoded_bytes())
                } else if path.is_dir() {
                    directories.push(path.clone());
                    None
                } else {
                    Some(fs::read(&path).expect("a file"))
                };
                content.insert(path, bytes);
            }
        }
        content
    }

    /// Names in the directory, those with a leading dot too, in order.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.directory.path()).expect("the directory");
        let mut names: Vec<_> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// Removes the files with this in their names: a run file with what is beside it.
    pub fn remove(&self, part: &str) {
        for name in self.names().iter().filter(|name| name.contains(part)) {
            fs::remove_file(self.path(name)).expect("a file");
        }
    }

    /// A text with the path of this directory left out.
    pub fn without_path(&self, text: &str) -> String {
        text.replace(&self.directory.path().display().to_string(), "[directory]")
    }

    /// The program, to be run here.
    pub fn command<A: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = A>) -> Command {
        let mut command = Command::new(program());
        command.current_dir(self.directory.path()).args(arguments).env(CALLED.0, CALLED.1).env("PATH", path());
        command
    }

    /// The program, to be run here by a shell that first obeys `order`.
    pub fn command_after<A: AsRef<OsStr>>(&self, order: &str, arguments: impl IntoIterator<Item = A>) -> Command {
        let mut command = Command::new("sh");
        command.current_dir(self.directory.path()).env(CALLED.0, CALLED.1).env("PATH", path());
        // Files that other tests have open at this moment would count as the program's.
        let alone = "exec 3>&- 4>&- 5>&- 6>&- 7>&- 8>&- 9>&-";
        command.arg("-c").arg(format!("{alone}; {order}; exec \"$0\" \"$@\"")).arg(program()).args(arguments);
        command
    }

    /// The program, to be run here so that it hears SIGHUP, also where the tests were begun behind `nohup`.
    pub fn command_with_hangup<A: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = A>) -> Command {
        let mut command = Command::new("env");
        command.current_dir(self.directory.path()).env(CALLED.0, CALLED.1).env("PATH", path());
        command.arg("--default-signal=HUP").arg(program()).args(arguments);
        command
    }

    /// Runs the program here.
    pub fn plateau<A: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = A>) -> Outcome {
        run(self.command(arguments))
    }

    /// Runs the program here with 1 GB of address space: enough for itself, and not for what some files declare.
    pub fn limited<A: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = A>) -> Outcome {
        run(self.command_after("ulimit -c 0; ulimit -v 1000000", arguments))
    }

    /// Makes a pipe with a name.
    pub fn fifo(&self, name: &str) {
        assert!(Command::new("mkfifo").arg(self.path(name)).status().expect("mkfifo").success());
    }
}

/// Starts a command, whose output is kept.
///
/// # Panics
/// When it does not start.
pub fn start(mut command: Command) -> Child {
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the command")
}

/// What a command said that was started, and how it ended.
///
/// # Panics
/// When it said what is no text.
pub fn ended(child: Child) -> Outcome {
    let output = child.wait_with_output().expect("its end");
    let text = |bytes| String::from_utf8(bytes).expect("output in UTF-8");
    let command = "started before".to_owned();
    Outcome { command, status: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
}

/// Sends a signal, such as `TERM`, to a process.
///
/// # Panics
/// When there is no such process.
pub fn send(signal: &str, process: impl Display) {
    let sent = Command::new("kill").args(["-s", signal, &process.to_string()]).status();
    assert!(sent.expect("kill").success(), "{signal} to {process}");
}

/// Runs a command to its end; standard output and standard error are no terminal.
///
/// # Panics
/// When it does not end.
pub fn run(mut command: Command) -> Outcome {
    // Files and not pipes: nobody has to read them while the command runs.
    let mut output = [tempfile::tempfile().expect("a temporary file"), tempfile::tempfile().expect("another one")];
    let [stdout, stderr] = output.each_ref().map(|file| file.try_clone().expect("a second handle"));
    let mut child = command.stdin(Stdio::null()).stdout(stdout).stderr(stderr).spawn().expect("the command");
    let mut status = None;
    let ended = wait_until(|| {
        status = child.try_wait().expect("the state of the command");
        status.is_some()
    });
    if !ended {
        kill(child);
        panic!("{command:?} did not end within {PATIENCE:?}");
    }
    let [stdout, stderr] = output.each_mut().map(read_all);
    Outcome { command: format!("{command:?}"), status: status.and_then(|status| status.code()), stdout, stderr }
}

/// Kills a process (SIGKILL: it gets no chance to tidy up) and waits for its end.
///
/// # Panics
/// When it has ended by itself.
pub fn kill(mut child: Child) {
    child.kill().expect("a process that runs");
    child.wait().expect("its end");
}

/// Makes an undisturbed run, `whole.h5`, and the same as `run.h5`, which is killed again and again after a random time of at most
/// so many seconds, goes on from where it was, and comes to its end; what both hold, and how many
/// times it was killed.
///
/// # Panics
/// When a run does not end well.
pub fn go_on_through_kills<A: AsRef<OsStr>>(
    directory: &WorkingDirectory,
    arguments: impl Fn(&'static str, &'static [&'static str]) -> Vec<A>,
    kills: usize,
    seconds: f64,
    mut random: Stream,
) -> (BTreeMap<String, Content>, usize) {
    directory.plateau(arguments("whole.h5", &[])).ends(0, &[]);
    let arguments = arguments("run.h5", &["--resume"]);
    let mut killed = 0;
    while killed < kills {
        let mut child = start(directory.command(&arguments));
        thread::sleep(Duration::from_secs_f64(seconds * random.uniform()));
        if child.try_wait().unwrap().is_some() {
            break;
        }
        kill(child);
        killed += 1;
    }
    assert_eq!(directory.plateau(&arguments).status, Some(0));
    let [whole, run] = ["whole.h5", "run.h5"].map(|name| directory.run_file(name).content());
    assert_eq!(differences(&whole, &run), [""; 0], "after {killed} kills");
    (whole, killed)
}

/// Waits until something holds; whether it did in time.
pub fn wait_until(mut holds: impl FnMut() -> bool) -> bool {
    let start = Instant::now();
    while !holds() {
        if start.elapsed() > PATIENCE {
            return false;
        }
        std::thread::sleep(LOOK);
    }
    true
}

fn read_all(file: &mut File) -> String {
    let mut bytes = Vec::new();
    file.rewind().expect("the start of the output");
    file.read_to_end(&mut bytes).expect("the output");
    String::from_utf8(bytes).expect("output in UTF-8")
}
