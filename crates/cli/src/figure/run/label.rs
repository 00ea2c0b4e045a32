//! What runs are called in figures.

use plateau_io::run_file::RunFile;

/// The title of every run's scene; with the name of its file where titles are equal or empty.
pub fn labels(runs: &[RunFile]) -> Vec<String> {
    let titles: Vec<&str> = runs.iter().map(|run| run.title().trim()).collect();
    let label = |(run, title): (&RunFile, &&str)| {
        let file = run.path().file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        match titles.iter().filter(|other| other == &title).count() {
            _ if title.is_empty() => file,
            1 => on_one_line(title),
            _ => format!("{} ({file})", on_one_line(title)),
        }
    };
    runs.iter().zip(&titles).map(label).collect()
}

/// Control characters would move or hide what follows them.
fn on_one_line(text: &str) -> String {
    text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect()
}
