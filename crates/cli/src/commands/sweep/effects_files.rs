//! Figures and page of `plateau sweep effects`.

use plateau_present::figure::effects::figures;
use plateau_present::figure::{Figure, Format};
use plateau_present::report::{Picture, Pictures, StudyPage, effects_page};

use super::analysed::Analysed;
use crate::failure::Failure;
use crate::output_folder::{OutputFolder, name_of, names_of};
use crate::version;

/// The table.
const TABLE: &str = "effects.csv";
/// The table of single runs.
const RUNS: &str = "residuals.csv";
/// The page.
const PAGE: &str = "effects.html";

/// A figure in the formats of files, and for the page.
pub struct Drawn {
    pub files: Vec<(Format, Vec<u8>)>,
    pub picture: Picture,
}

/// Writes the tables, the figures of all responses and the page with them.
///
/// # Errors
/// [`Failure::Run`] when a figure cannot be drawn, and those of [`OutputFolder`].
pub fn write(folder: &mut OutputFolder, analysed: &Analysed, table: &str, runs: &str) -> Result<(), Failure> {
    let Analysed { plan, collected, analysis, inputs, .. } = analysed;
    let responses = figures(analysis);
    let names = names_of(responses.iter().flat_map(|of_response| &of_response.figures));
    folder.begin(&[&[TABLE.to_owned(), RUNS.to_owned(), PAGE.to_owned()], &names[..]].concat(), inputs)?;
    folder.write(TABLE, table.as_bytes())?;
    folder.write(RUNS, runs.as_bytes())?;
    let mut pictures = Vec::new();
    for of_response in responses {
        let mut drawn = Vec::new();
        for Drawn { files, picture } in draw_all(&of_response.figures)? {
            for (format, content) in files {
                folder.write(&name_of(&picture.name, format), &content)?;
            }
            drawn.push(picture);
        }
        pictures.push(Pictures { pictures: drawn, left_out: of_response.left_out });
    }
    let program = version::program();
    let page = effects_page(&StudyPage { plan, collected, analysis, pictures: &pictures, program: &program });
    folder.write(PAGE, page.as_bytes())
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
