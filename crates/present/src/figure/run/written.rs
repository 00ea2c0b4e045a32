//! Run files that the tests of figures make up.

use std::path::Path;

use plateau_core::model::mesh::Mesh;
use plateau_core::model::outline::Outline;
use plateau_core::model::state::Base;
use plateau_core::observe::extra::Extra;
use plateau_core::observe::{EXTRAS, Map, MapValues, Quantity, Sample, Snapshot, quantities};
use plateau_io::run_file::{End, Header, RunFile, RunWriter};
use plotters::style::RGBColor;

use super::{Figures, Options, figures};
use crate::figure::page::{Content, Panel};

/// Cells of the pin.
pub const CELLS: usize = 20;
/// Time of the last of the samples, which are a second from each other, s.
const END: u32 = 10;

/// The value of the series of a name at a time, s.
type Value = dyn Fn(&str, f64) -> f64;

/// A run that is to be written.
pub struct Written {
    title: &'static str,
    /// Names of its series besides those of every run.
    series: Vec<&'static str>,
    value: Box<Value>,
    /// Maps, and their values a second from each other.
    maps: Vec<(Map, Vec<MapValues>)>,
    /// Whether the pin is a circle of 4 mm.
    is_round: bool,
}

impl Written {
    /// A run without maps.
    pub fn new(title: &'static str, series: &[&'static str], value: impl Fn(&str, f64) -> f64 + 'static) -> Self {
        Self { title, series: series.to_vec(), value: Box::new(value), maps: Vec::new(), is_round: false }
    }

    /// The same with a map, or one more at as many moments, a second from each other, from 0 s on.
    pub fn with_maps(mut self, map: Map, values: impl Iterator<Item = MapValues>) -> Self {
        self.maps.push((map, values.collect()));
        self
    }

    /// The same with maps of the temperature, K.
    pub fn with_temperatures(self, maps: impl Iterator<Item = Vec<f64>>) -> Self {
        self.with_maps(Map::Temperature, maps.map(MapValues::Float))
    }

    /// The same with a round pin of 4 mm: of its 5 columns the one in the middle is there.
    pub fn round(self) -> Self {
        Self { is_round: true, ..self }
    }

    /// The figures of runs.
    pub fn figures(runs: &[Self]) -> Figures {
        let folder = tempfile::tempdir().unwrap();
        let open = |(number, run): (usize, &Self)| run.write(&folder.path().join(format!("{number}.h5")));
        let runs: Vec<RunFile> = runs.iter().enumerate().map(open).collect();
        figures(&runs, &Options::default()).unwrap()
    }

    /// What is made of the run file.
    pub fn opened<T>(&self, read: impl Fn(&RunFile) -> T) -> T {
        let folder = tempfile::tempdir().unwrap();
        read(&self.write(&folder.path().join("run.h5")))
    }

    /// Writes the run file and opens it.
    fn write(&self, path: &Path) -> RunFile {
        let mesh = Mesh::new(4, 60, 5, 20e-3, 24e-3).unwrap();
        let (outline, shape) = match self.is_round {
            true => (Outline::Disc { radius: 2e-3 }, "shape = \"disc\"\npin_diameter = \"4 mm\"\n"),
            false => (Outline::Rectangle, ""),
        };
        let mesh = mesh.with_outline(outline).unwrap();
        let quantity = |name: &&'static str| {
            let known = quantities(EXTRAS).find(|quantity| quantity.name == *name).expect("a series of run files");
            Quantity::extra(name, known.unit, known.long_name)
        };
        // Tests end soon.
        let series: &'static [Quantity] = Vec::leak(self.series.iter().map(quantity).collect());
        let extra: &'static Extra =
            Box::leak(Box::new(Extra { name: "made up", quantities: series, request: None, needs: "" }));
        let header = Header {
            title: self.title.into(),
            pin_base: vec![Base::Primary; mesh.pin_cells()],
            mesh,
            maps: self.maps.iter().filter(|(_, moments)| !moments.is_empty()).map(|(map, _)| *map).collect(),
            extras: vec![extra],
            expected_samples: u64::from(END),
            scene: format!(
                "version = 1\n[mesh]\ninner_radius = \"20 mm\"\nouter_radius = \"24 mm\"\nrows = 4\n\
                 disc_columns = 60\npin_columns = 5\n{shape}"
            ),
            program: "plateau".into(),
            source_revision: String::new(),
            host: "bench".into(),
            workers: 1,
            instruction_set: "baseline".into(),
            seeds: Vec::new(),
            inputs: Vec::new(),
            surfaces: Vec::new(),
        };
        let mut writer = RunWriter::create(path, false, &header).unwrap();
        let moments = self.maps.iter().map(|(_, moments)| moments.len()).max().unwrap_or(0);
        for second in 0..moments {
            let maps = self.maps.iter().map(|(map, moments)| (*map, moments[second].clone())).collect();
            writer.snapshot(Snapshot { time: second as f64, maps }).unwrap();
        }
        for second in 1..=END {
            let time = f64::from(second);
            let mean_pressure = (self.value)("mean_pressure", time);
            let value = |name| (self.value)(name, time);
            let mut sample = Sample {
                step: u64::from(second),
                time,
                contact_area: value("contact_area"),
                contact_area_mean: value("contact_area_mean"),
                pin_secondary: value("pin_secondary"),
                mean_pressure,
                ..Sample::default()
            };
            extra.record(&mut sample, series.iter().map(|quantity| (self.value)(quantity.name, time)));
            writer.sample(sample).unwrap();
        }
        writer.finish(&End::Finished, &[], None).unwrap();
        RunFile::open(path).unwrap()
    }
}

/// What was noted to be left out of a figure, run by run.
pub fn notes<'a>(figures: &'a Figures, name: &str) -> Vec<&'a str> {
    let of_figure = figures.left_out.iter().filter(|note| note.figures.contains(&name));
    let mut notes: Vec<_> = of_figure.map(|note| (&note.path, note.missing.as_str())).collect();
    notes.sort_by_key(|(path, _)| *path);
    notes.into_iter().map(|(_, missing)| missing).collect()
}

/// The lines of a colour in a box.
pub fn lines_of(panel: &Panel, wanted: RGBColor) -> Vec<Vec<[f64; 2]>> {
    let line = |content: &Content| match content {
        Content::Line { points, stroke } if stroke.colour == wanted => Some(points.clone()),
        _ => None,
    };
    panel.contents.iter().filter_map(line).collect()
}

/// The marks of a colour in a box.
pub fn marks_of(panel: &Panel, wanted: RGBColor) -> Vec<[f64; 2]> {
    let marks = |content: &Content| match content {
        Content::Dots { points, colour, .. } if *colour == wanted => points.clone(),
        _ => Vec::new(),
    };
    panel.contents.iter().flat_map(marks).collect()
}
