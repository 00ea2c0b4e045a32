//! `plateau surface`: what measured and prepared surfaces are like.

pub mod data;
mod recorded;

use std::path::{Path, PathBuf};

use plateau_core::surface::{Level, Patch};
use plateau_io::scene;
use plateau_io::surface::{self, Loaded, Measured, WriteError};
use plateau_io::temporary::folder;

use crate::arguments::{SurfaceArguments, SurfaceWord, as_options};
use crate::failure::{Failure, of_scene};
use crate::hand_over::{self, hand_over};
use crate::message;
use crate::output;
use crate::output::print;
use data::Data;
use recorded::NamedHeights;

/// Most surfaces that still make a legible picture.
const MOST_PLOTTED: usize = 12;

/// Describes, converts and draws surfaces.
pub fn surface(arguments: &SurfaceArguments) -> Result<(), Failure> {
    if let Some(SurfaceWord::Convert(handed)) = &arguments.word {
        return hand_over("surface", std::iter::once("convert".into()).chain(handed.arguments.clone()));
    }
    refuse_impossible(arguments)?;
    // Heights are written down one after the other, so that not all are held.
    let temporary;
    let folder = if let Some(folder) = &arguments.figure_data {
        folder
    } else {
        temporary = hand_over::temporary_folder()?;
        temporary.path()
    };
    let mut data = Data::new(folder);
    let level = arguments.level.unwrap_or(Level::Plane);
    for path in &arguments.files {
        let mut found = match recorded::of(path, arguments)? {
            Some(found) => found,
            None => {
                let (name, map) = (path.display().to_string(), String::new());
                vec![NamedHeights { name, map, measured: read(path, arguments)? }]
            }
        };
        if let Some(to) = &arguments.to {
            let [one] = &mut found[..] else { return Err(several(path, &found)) };
            convert(path, one, to, arguments.force)?;
        }
        found.into_iter().try_for_each(|heights| data.add_file(heights, level))?;
    }
    let read = match &arguments.prepare {
        Some(path) => prepared(path, arguments, &mut data)?,
        None => Vec::new(),
    };
    tell(arguments, &read, &data)
}

/// Refuses to convert several maps of a run into one file.
fn several(path: &Path, found: &[NamedHeights]) -> Failure {
    let (count, advice) = (found.len(), "say which with --dataset disc/height and --at TIME");
    Failure::of_file(path, format_args!("--to converts one surface, and these are {count}: {advice}"))
}

/// Refuses what cannot be done, before anything is read.
fn refuse_impossible(arguments: &SurfaceArguments) -> Result<(), Failure> {
    let SurfaceArguments { files, plot, preview, to, prepare, force, .. } = arguments;
    if to.is_some() && (files.len() != 1 || prepare.is_some()) {
        return Err(Failure::input("--to converts one FILE: leave out the others and --prepare"));
    }
    let surfaces = files.len() + 2 * usize::from(prepare.is_some());
    if plot.is_some() {
        refuse_many(surfaces)?;
    }
    for (option, picture) in [("--plot", plot), ("--preview", preview)] {
        let Some(picture) = picture else { continue };
        if hand_over::format_of(picture).is_none() {
            let endings = "expected the ending .png, .svg or .pdf";
            return Err(Failure::input(format!("{option} {}: {endings}", picture.display())));
        }
    }
    let outputs: Vec<&PathBuf> = to.iter().chain(plot).chain(preview).collect();
    for (at, path) in outputs.iter().enumerate() {
        refuse_twice(path, &outputs[..at])?;
    }
    let inputs: Vec<PathBuf> = files.iter().chain(prepare).cloned().collect();
    outputs.into_iter().try_for_each(|path| output::check(path, *force, &inputs))
}

/// Refuses a place that another output has.
fn refuse_twice(path: &Path, others: &[&PathBuf]) -> Result<(), Failure> {
    let place = |path: &Path| Some((folder(path).canonicalize().ok()?, path.file_name()?.to_owned()));
    let own = place(path);
    if others.iter().any(|other| *other == path || (own.is_some() && place(other) == own)) {
        return Err(Failure::input(format!("{} is named for two outputs", path.display())));
    }
    Ok(())
}

/// Reads a file as the arguments say.
fn read(path: &Path, arguments: &SurfaceArguments) -> Result<Measured, Failure> {
    surface::read(path, &arguments.reading.options()).map_err(|reason| {
        let advice = as_options(&reason.to_string());
        Failure::because(&reason, format_args!("{}: {reason}{advice}", path.display()))
    })
}

/// Writes heights into a file.
fn convert(path: &Path, from: &mut NamedHeights, to: &Path, force: bool) -> Result<(), Failure> {
    let measured = &mut from.measured;
    let Some([column_pitch, row_pitch]) = measured.pitch else {
        return Err(Failure::of_file(path, "the distance of its points is unknown, which --to needs: give --pitch"));
    };
    let heights = std::mem::take(&mut measured.heights);
    let mut patch = Patch { columns: measured.columns, rows: measured.rows, column_pitch, row_pitch, heights };
    // Formats of heights as the model has them.
    let of_model = measured.body.filter(|_| ["npy", "h5"].contains(&output::ending(to).as_str()));
    let turn = |patch: &mut Patch| {
        if let Some(body) = of_model {
            body.turn(&mut patch.heights);
        }
    };
    turn(&mut patch);
    let written = surface::write(to, &patch, force);
    turn(&mut patch);
    measured.heights = patch.heights;
    written.map_err(|error| match error {
        WriteError::System { .. } => Failure::run(error),
        _ => Failure::input(error),
    })
}

/// Adds what a scene makes of its disc and pin; gives the files that it reads.
fn prepared(path: &Path, arguments: &SurfaceArguments, data: &mut Data) -> Result<Vec<PathBuf>, Failure> {
    let scene = scene::load(path, &[]).map_err(of_scene)?;
    for warning in &scene.warnings {
        message::warning(warning);
    }
    let (loaded, patches) = surface::load_with_patches(&scene).map_err(Failure::input)?;
    loaded.warnings().for_each(message::warning);
    let Loaded { surfaces, report, inputs, .. } = loaded;
    let (mesh, level) = (&scene.parameters.mesh, arguments.level.unwrap_or(Level::None));
    if arguments.preview.is_some() || arguments.figure_data.is_some() {
        let micrograph = surface::micrograph(&scene).map_err(Failure::input)?;
        let micrograph = micrograph.as_ref().map(|(map, pixel)| (map, *pixel));
        data.fibre_map(&scene, &surfaces.pin_base, patches.disc.as_ref(), micrograph)?;
    }
    data.add_scene(path, mesh, surfaces, patches, &report, level)?;
    Ok(scene.files.iter().chain(&inputs).map(|(path, _)| path.clone()).collect())
}

/// Refuses to draw more than can be told apart.
fn refuse_many(surfaces: usize) -> Result<(), Failure> {
    if surfaces > MOST_PLOTTED {
        return Err(Failure::input(format!("--plot draws {MOST_PLOTTED} surfaces at most, these are {surfaces}")));
    }
    Ok(())
}

/// Describes, draws and prints.
fn tell(arguments: &SurfaceArguments, read: &[PathBuf], data: &Data) -> Result<(), Failure> {
    // A run file has several.
    if arguments.plot.is_some() {
        refuse_many(data.count())?;
    }
    let folder = data.finish()?;
    // Who only writes a file needs no package.
    let only_writes = arguments.to.is_some() && !arguments.json;
    let described = if only_writes && hand_over::answering("surface").is_none() {
        message::warning("the Python package tells the parameters, and is not here: pip install 'plateau-brake[all]'");
        String::new()
    } else {
        hand_over::described(folder, arguments.json)?
    };
    let mut drawings: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    for (kind, place) in [("surfaces", &arguments.plot), ("fibre-map", &arguments.preview)] {
        let Some(place) = place else { continue };
        let options = if arguments.relief && kind == "surfaces" { &["--relief"][..] } else { &[] };
        let pages = hand_over::draw(kind, folder, hand_over::format_of(place).as_slice(), options)?;
        drawings.extend(pages.into_iter().map(|(name, content)| (of_page(place, kind, &name), content)));
    }
    // Before the first is written: either all are, or none.
    let inputs: Vec<PathBuf> = arguments.files.iter().chain(&arguments.prepare).chain(read).cloned().collect();
    let mut taken: Vec<&PathBuf> = arguments.to.iter().collect();
    for (path, _) in &drawings {
        refuse_twice(path, &taken)?;
        output::check(path, arguments.force, &inputs)?;
        taken.push(path);
    }
    for (path, content) in &drawings {
        output::write(path, content, arguments.force)?;
    }
    if arguments.figure_data.is_some() {
        return Ok(());
    }
    if arguments.json {
        return print(&described);
    }
    let written: String = taken.iter().map(|path| format!("\nwrote {}\n", path.display())).collect();
    print((described + &written).trim_start_matches('\n'))
}

/// Finds the path of a page of a figure of this kind: the named file for the first, one beside it with the end of its name for another.
fn of_page(place: &Path, kind: &str, name: &str) -> PathBuf {
    let stem = place.file_stem().unwrap_or_default().to_string_lossy();
    let own = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
    match own.strip_prefix(kind) {
        Some("") | None => place.to_owned(),
        Some(end) => place.with_file_name(format!("{stem}{end}.{}", output::ending(place))),
    }
}
