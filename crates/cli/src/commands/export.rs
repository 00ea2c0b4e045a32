//! `plateau export`: write a run file in the format of other programs.

use std::fs;
use std::path::{Path, PathBuf};

use plateau_core::surface::Body;
use plateau_io::export::{csv, maps_of, npz, vtk};
use plateau_io::run_file::RunFile;
use plateau_io::text::shown_title;

use crate::arguments::{ExportArguments, ExportFormat};
use crate::failure::Failure;
use crate::table::{print, table};
use crate::{message, number, output};

/// Writes a run file in another format and says what was written.
pub fn export(arguments: &ExportArguments) -> Result<(), Failure> {
    let run = super::open_run(&arguments.run)?;
    let named = |ending| arguments.output.clone().unwrap_or_else(|| super::named_like(&arguments.run, ending));
    let inputs = super::runs::inputs_of(std::slice::from_ref(&run));
    let mut job = Job { run: &run, inputs, force: arguments.force, written: Vec::new() };
    match arguments.to {
        ExportFormat::Csv => job.csv(&named(".csv"), arguments.maps)?,
        ExportFormat::Npz => job.npz(&named(".npz"))?,
        ExportFormat::Vtk => job.vtk(&named("-vtk"))?,
    }
    let heading = format!("{} ({}, {})", shown_title(run.title()), arguments.run.display(), run.state().name());
    print(&table(&heading, &job.written))
}

/// The bodies that have maps, with the names of their files.
const BODIES: [(Body, &str); 2] = [(Body::Disc, "disc"), (Body::Pin, "pin")];

/// What is written of a run file.
struct Job<'a> {
    run: &'a RunFile,
    /// The run file and what its run has read: none of them is replaced.
    inputs: Vec<PathBuf>,
    force: bool,
    /// Path and content of every file.
    written: Vec<(String, String)>,
}

impl Job<'_> {
    fn csv(&mut self, path: &Path, with_maps: bool) -> Result<(), Failure> {
        let name = |name: &str, index: usize| {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            path.with_file_name(format!("{stem}-{name}-{index:04}.csv"))
        };
        let maps = if with_maps { self.maps(name) } else { Vec::new() };
        let events = self.run.events().map_err(Failure::input)?.first().map_or(0, |(_, values)| values.len());
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let of_events = path.with_file_name(format!("{stem}-events.csv"));
        self.check(path)?;
        maps.iter().try_for_each(|map| self.check(&map.path))?;
        if events > 0 {
            self.check(&of_events)?;
        }
        output::fill(path, self.force, |file| csv::write_series(self.run, file))?;
        self.note(path, self.series());
        if events > 0 {
            output::fill_in_folder(&of_events, self.force, |file| csv::write_events(self.run, file))?;
            self.note(&of_events, number::count(events, "event"));
        }
        for map in &maps {
            output::fill_in_folder(&map.path, self.force, |file| csv::write_maps(self.run, map.body, map.index, file))?;
            self.note(&map.path, map.content(self.run));
        }
        Ok(())
    }

    fn npz(&mut self, path: &Path) -> Result<(), Failure> {
        self.check(path)?;
        output::fill(path, self.force, |file| npz::write(self.run, file))?;
        let maps = BODIES.iter().map(|(body, _)| maps_of(self.run, *body).count()).sum::<usize>();
        let (maps, times) = (number::count(maps, "map"), number::count(self.run.map_time().len(), "time"));
        self.note(path, format!("{}, {maps} at {times}", self.series()));
        Ok(())
    }

    fn vtk(&mut self, directory: &Path) -> Result<(), Failure> {
        let file_name = |name: &str, index: usize| format!("{name}-{index:04}.vts");
        let maps = self.maps(|name, index| directory.join(file_name(name, index)));
        let times = self.run.map_time();
        let mut collections = Vec::new();
        for (body, name) in BODIES {
            if maps.iter().any(|map| map.body == body) {
                let moments = times.iter().enumerate().map(|(index, time)| (*time, file_name(name, index)));
                collections.push((directory.join(format!("{name}.pvd")), moments.collect::<Vec<_>>()));
            }
        }
        if collections.is_empty() {
            message::note("nothing is written: this format has maps only");
            return Ok(());
        }
        output::make_directory(directory)?;
        let paths = maps.iter().map(|map| &map.path).chain(collections.iter().map(|(path, _)| path));
        paths.into_iter().try_for_each(|path| self.check(path))?;
        for map in &maps {
            output::fill_in_folder(&map.path, self.force, |file| vtk::write_grid(self.run, map.body, map.index, file))?;
            self.note(&map.path, map.content(self.run));
        }
        for (path, moments) in &collections {
            output::fill_in_folder(path, self.force, |file| Ok(vtk::write_collection(moments, file)?))?;
            self.note(path, format!("{}: open this one", number::count(moments.len(), "time")));
        }
        Ok(())
    }

    /// The maps of every body and moment, each with its file; says what was not recorded.
    fn maps(&self, path: impl Fn(&str, usize) -> PathBuf) -> Vec<MapFile> {
        let mut files = Vec::new();
        for (body, name) in BODIES {
            if maps_of(self.run, body).next().is_none() || self.run.map_time().is_empty() {
                let run = self.run.path().display();
                message::note(format_args!("{run} has no maps of the {name}: they are left out"));
                continue;
            }
            files.extend((0..self.run.map_time().len()).map(|index| MapFile {
                path: path(name, index),
                body,
                name,
                index,
            }));
        }
        files
    }

    fn check(&self, path: &Path) -> Result<(), Failure> {
        output::check(path, self.force, &self.inputs).map_err(|failure| failure.but("-o names another place"))
    }

    fn series(&self) -> String {
        format!("{} of {} series", number::count(self.run.time().len(), "sample"), self.run.series().len())
    }

    fn note(&mut self, path: &Path, content: String) {
        let size = fs::metadata(path).map_or(0, |file| file.len());
        self.written.push((path.display().to_string(), format!("{content} ({})", number::bytes(size))));
    }
}

/// The file of the maps of a body at one time.
struct MapFile {
    path: PathBuf,
    body: Body,
    /// What the body is called.
    name: &'static str,
    /// Which of the times of the maps.
    index: usize,
}

impl MapFile {
    fn content(&self, run: &RunFile) -> String {
        format!("{} at {} s", self.name, number::short(run.map_time()[self.index]))
    }
}
