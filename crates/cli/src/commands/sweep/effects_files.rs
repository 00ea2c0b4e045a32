//! Figures and page of `plateau sweep effects`.

use std::path::Path;

use plateau_io::study::collected::Collected;
use plateau_io::study::plan::Plan;
use plateau_present::figure::effects::figures;
use plateau_present::figure::{Figure, Format};
use plateau_present::report::{Picture, Pictures, StudyPage, effects_page};
use plateau_present::study::analysis::Analysis;

use crate::failure::Failure;
use crate::{output, version};

/// A figure in the formats of files, and for the page.
pub struct Drawn {
    pub files: Vec<(Format, Vec<u8>)>,
    pub picture: Picture,
}

/// Writes the figures of all responses and the page with them; their paths.
///
/// # Errors
/// [`Failure::Run`] when a figure cannot be drawn, and those of [`output::write()`].
pub fn write(folder: &Path, plan: &Plan, collected: &Collected, analysis: &Analysis) -> Result<Vec<String>, Failure> {
    let mut files = Vec::new();
    let mut add = |name: &str, content: &[u8]| {
        let path = folder.join(name);
        files.push(path.display().to_string());
        output::write(&path, content, true)
    };
    let mut pictures = Vec::new();
    for of_response in figures(analysis) {
        let mut drawn = Vec::new();
        for Drawn { files, picture } in draw_all(&of_response.figures)? {
            for (format, content) in files {
                add(&format!("{}.{}", picture.name, format.ending()), &content)?;
            }
            drawn.push(picture);
        }
        pictures.push(Pictures { pictures: drawn, left_out: of_response.left_out });
    }
    let program = version::program();
    let page = effects_page(&StudyPage { plan, collected, analysis, pictures: &pictures, program: &program });
    add("effects.html", page.as_bytes())?;
    Ok(files)
}

/// Draws figures, each in a thread of its own: there are as many as a response has, and most of the time is theirs.
pub fn draw_all(figures: &[Figure]) -> Result<Vec<Drawn>, Failure> {
    std::thread::scope(|scope| {
        let threads: Vec<_> = figures.iter().map(|figure| scope.spawn(|| draw(figure))).collect();
        let drawn = |thread: std::thread::ScopedJoinHandle<'_, Result<Drawn, Failure>>| {
            thread.join().unwrap_or_else(|_| Err(Failure::run("a figure cannot be drawn: its thread ended early")))
        };
        threads.into_iter().map(drawn).collect()
    })
}

fn draw(figure: &Figure) -> Result<Drawn, Failure> {
    let svg = figure.svg().map_err(Failure::run)?;
    let content = |format| match format {
        Format::Svg => Ok(svg.clone().into_bytes()),
        format => figure.draw(format).map_err(Failure::run),
    };
    let files = Format::ALL.into_iter().map(|format| Ok((format, content(format)?))).collect::<Result<_, Failure>>()?;
    let picture = Picture { name: figure.name.clone(), caption: figure.caption.clone(), svg };
    Ok(Drawn { files, picture })
}
