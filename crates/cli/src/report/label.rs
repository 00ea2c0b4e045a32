//! What the runs are called on the page.

use plateau_io::run_file::RunFile;

/// A name for every run: its title; where titles are alike, the file's name; where those are, too, the whole path.
pub fn labels(runs: &[RunFile]) -> Vec<String> {
    let title = |run: &RunFile| run.title().trim().to_owned();
    let name =
        |run: &RunFile| run.path().file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let path = |run: &RunFile| run.path().display().to_string();
    let of = |call: &dyn Fn(&RunFile) -> String| runs.iter().map(call).collect::<Vec<_>>();
    [of(&title), of(&name)].into_iter().find(|labels| tell_apart(labels)).unwrap_or_else(|| of(&path))
}

fn tell_apart(labels: &[String]) -> bool {
    labels.iter().enumerate().all(|(at, label)| !label.is_empty() && !labels[..at].contains(label))
}
