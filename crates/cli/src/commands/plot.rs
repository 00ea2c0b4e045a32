//! `plateau plot`: the figures of runs.

use plateau_present::figure::run::{NAMES, Options};
use plateau_present::figure::{Figure, Format};

use crate::arguments::PlotArguments;
use crate::failure::Failure;
use crate::table::print;
use crate::{message, output};

/// Draws the figures of runs, each into a file of its own.
pub fn plot(arguments: &PlotArguments) -> Result<(), Failure> {
    let PlotArguments { runs: paths, output, format, figures: only, at, width, cmap, polar, force } = arguments;
    let runs = super::open_runs(paths)?;
    let options = Options { polar: *polar, only: only.clone(), at: at.clone(), width: *width, colours: (*cmap).into() };
    let figures = super::figures(&runs, &options)?;
    if figures.figures.is_empty() && !only.is_empty() {
        return Err(Failure::input(format!("no run has what {} shows, see above", only.join(" or "))));
    }
    let format = Format::from(*format);
    let directory = output.clone().unwrap_or_else(|| match paths.as_slice() {
        [path] => super::named_like(path, ""),
        _ => "figures".into(),
    });
    output::make_directory(&directory)?;
    let place = |figure: &Figure| directory.join(format!("{}.{}", figure.name, format.ending()));
    // Before the first is written: either all are, or none.
    let inputs = super::runs::inputs_of(&runs);
    let check = |figure: &Figure| output::check(&place(figure), *force, &inputs);
    figures.figures.iter().try_for_each(check).map_err(|failure| failure.but("-o DIR names another folder"))?;
    for figure in &figures.figures {
        let path = place(figure);
        output::write_in_folder(&path, &figure.draw(format).map_err(Failure::run)?, *force)?;
        print(&format!("wrote {}: {}\n", path.display(), figure.title))?;
    }
    for left in NAMES.into_iter().filter_map(|name| page_after_last(&figures.figures, name)) {
        let path = directory.join(format!("{left}.{}", format.ending()));
        if path.is_file() {
            message::warning(format_args!("{} is a page of an earlier call", path.display()));
        }
    }
    Ok(())
}

/// What a page of a figure that is drawn would be called if there were one more.
fn page_after_last(figures: &[Figure], name: &str) -> Option<String> {
    let mut pages = (1..).map(|number| Figure::name_of_page(name, number));
    pages.find(|page| figures.iter().all(|figure| figure.name != *page)).filter(|page| page != name)
}
