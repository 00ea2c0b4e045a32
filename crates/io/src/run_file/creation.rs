//! Creation of a run file: its groups, datasets and attributes before the first step, or with all that a run has written; and the last
//! that is written to it: the end of the run, its wall time, and the digests of the content.

use std::fs;
use std::io::{self, Write as _};
use std::path::Path;
use std::time::{Duration, SystemTime};

use hdf5::plist::file_create::LinkCreationOrder;
use hdf5::{Dataset, Datatype, Extent, File, Selection, SimpleExtents};
use plateau_core::acceleration::Chosen;
use plateau_core::model::mesh::Mesh;
use plateau_core::observe::event::{EventRecord, event_quantities};
use plateau_core::observe::extra::Extra;
use plateau_core::observe::{CYCLE, Map, quantities};

use super::digest::{self, DIGEST, Digests};
use super::error::{failed, not_anew};
use super::layout::{
    ACCELERATION, CONVENTIONS, EVENT, EVENT_GROUP, FORMAT_VERSION, MAP_TIME, PIN_BASE, STATUS_TYPE, Statuses, TIME,
    TIME_OF_SERIES, copy_map, event_path, map_chunk, map_long_name, map_path, map_unit, series_chunk, series_path,
    stored_base,
};
use super::output::Output;
use super::{End, Header, RunFileError, State};
use crate::hdf5_file::{self, in_words};
use crate::hdf5_file::{Dimensions, EMPTY_FILE, open_for_writing, write_number, write_text};
use crate::input::sha256_of;
use crate::timestamp::iso_8601;

const REFERENCES: &str = "G. Riva, G. Perricone, J. Wahlström, Simulation of Contact Area and Pressure Dependence of \
    Initial Surface Roughness for Cermet-Coated Discs Used in Disc Brakes, Tribology in Industry 41 (2019)";

/// Writes everything that is known before the first step, and makes every other dataset: with no times in it yet, or with
/// all that a `source` has, the file of the same run as it was while the run went on.
///
/// No object of the file is open any more when this returns.
///
/// The events of a cycle come with the source: they are written when a run has ended.
pub(super) fn lay_out(file: &File, header: &Header, start: SystemTime, source: Option<Source>) -> hdf5::Result<()> {
    write_provenance(file, header, start)?;
    let mut layout = Layout::new(file, header, source)?;
    layout.coordinates(!header.maps.is_empty())?;
    for quantity in quantities(&header.extras) {
        layout.series(quantity.name, quantity.unit, quantity.long_name)?;
    }
    for map in Map::ALL.into_iter().filter(|map| header.maps.contains(map)) {
        layout.map(map)?;
    }
    layout.pin_base(header)?;
    let has_events = header.extras.iter().any(|extra| **extra == CYCLE);
    if let Some(source) = source.filter(|_| has_events) {
        layout.events(source.events, &header.extras)?;
    }
    layout.dimensions.finish()
}

/// Source of the file of a run that has ended.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source<'a> {
    /// The file as it was while the run went on.
    pub file: &'a File,
    /// Records of the events of the cycle.
    pub events: &'a [EventRecord],
    /// Digests of what the file holds.
    pub digests: &'a Digests,
}

fn write_provenance(file: &File, header: &Header, start: SystemTime) -> hdf5::Result<()> {
    let seeds: serde_json::Map<_, _> = header.seeds.iter().map(|(key, seed)| (key.clone(), (*seed).into())).collect();
    let inputs = serde_json::to_string(&header.inputs).map_err(in_words)?;

    write_text(file, "title", &header.title)?;
    write_number(file, "format_version", FORMAT_VERSION)?;
    write_text(file, "conventions", CONVENTIONS)?;
    write_text(file, "Conventions", CONVENTIONS)?; // the spelling that netCDF readers look for
    write_text(file, "references", REFERENCES)?;
    write_text(file, "program", &header.program)?;
    write_text(file, "source_revision", &header.source_revision)?;
    write_text(file, "scene", &header.scene)?;
    write_text(file, "inputs", &inputs)?;
    write_text(file, "surfaces", &header.surfaces.join("\n"))?;
    write_text(file, "seeds", &serde_json::Value::from(seeds).to_string())?;
    write_text(file, "host", &header.host)?;
    write_number(file, "workers", header.workers as i64)?;
    write_text(file, "decomposition", &header.decomposition)?;
    write_text(file, "instruction_set", &header.instruction_set)?;
    write_text(file, "start_time", &iso_8601(start))?;
    write_text(file, "state", State::Running.name())
}

/// The datasets of a file while they are made.
struct Layout<'a> {
    file: &'a File,
    mesh: &'a Mesh,
    series_chunk: usize,
    dimensions: Dimensions,
    float: Datatype,
    /// Committed, since netCDF-4 knows enumerations only as named types.
    status: Datatype,
    source: Option<Source<'a>>,
}

impl<'a> Layout<'a> {
    fn new(file: &'a File, header: &'a Header, source: Option<Source<'a>>) -> hdf5::Result<Self> {
        let status = Statuses::of(&header.mesh).datatype()?;
        let dimensions = Dimensions::new(file)?;
        file.commit_datatype(STATUS_TYPE, &status)?;
        for group in ["series", "disc", "pin"] {
            make_group(file, group)?;
        }
        Ok(Self {
            file,
            mesh: &header.mesh,
            series_chunk: series_chunk(header.expected_samples),
            dimensions,
            float: Datatype::from_type::<f64>()?,
            status,
            source,
        })
    }

    /// Radius, angles and times, each the scale of the dimension of its name.
    fn coordinates(&mut self, with_maps: bool) -> hdf5::Result<()> {
        let centres = |columns| (0..columns).map(|c| (c as f64 + 0.5) * self.mesh.column_angle()).collect::<Vec<_>>();
        let disc_angle = centres(self.mesh.disc_columns());
        let pin_angle = centres(self.mesh.pin_columns());
        let radius = self.mesh.radius().to_vec();
        for (name, unit, long_name, values) in [
            ("radius", "m", "radius of the cell centres", &radius),
            ("disc_angle", "rad", "angle of the cell centres on the disc", &disc_angle),
            ("pin_angle", "rad", "angle of the cell centres on the pin, from its leading edge", &pin_angle),
        ] {
            let scale = self.scale(name, unit, long_name)?;
            fixed(&scale, values)?;
            // What cannot be written when a dataset is let go of is not told.
            self.file.flush()?;
        }
        let time = self.scale(TIME, "s", "physical time of the samples")?;
        self.fill(&time, TIME)?;
        if with_maps {
            let map_time = self.scale(MAP_TIME, "s", "physical time of the maps")?;
            self.fill(&map_time, MAP_TIME)?;
        }
        Ok(())
    }

    fn scale(&mut self, name: &'static str, unit: &str, long_name: &str) -> hdf5::Result<Dataset> {
        let scale = self.dataset(name, &self.float, &[name], unit, long_name)?;
        self.dimensions.make_scale(&scale, name)?;
        Ok(scale)
    }

    fn series(&mut self, name: &str, unit: &str, long_name: &str) -> hdf5::Result<()> {
        let series = self.dataset(&series_path(name), &self.float, &[TIME], unit, long_name)?;
        self.fill(&series, &series_path(name))?;
        self.dimensions.attach(&series, &[TIME])
    }

    fn map(&mut self, map: Map) -> hdf5::Result<()> {
        let path = map_path(map);
        let dimensions = [MAP_TIME, if map.on_disc() { "disc_angle" } else { "pin_angle" }, "radius"];
        let datatype = if map.is_status() { &self.status } else { &self.float };
        let dataset = self.dataset(path, datatype, &dimensions, map_unit(map), map_long_name(map))?;
        let statuses = Statuses::of(self.mesh);
        if map.is_status() {
            statuses.write_flags(&dataset, map.on_disc())?;
        }
        if let Some(source) = self.source {
            let from = source.file.dataset(path)?;
            if map.is_status() {
                statuses.copy(&from, &dataset)?
            } else {
                copy_map::<f64>(&from, &dataset)?
            }
            self.file.flush()?;
        }
        self.dimensions.attach(&dataset, &dimensions)
    }

    /// Takes the values of a dataset with one dimension from the source.
    fn fill(&self, dataset: &Dataset, path: &str) -> hdf5::Result<()> {
        let Some(source) = self.source else { return Ok(()) };
        dataset.write(&source.file.dataset(path)?.read_1d::<f64>()?)?;
        // What cannot be written when a dataset is let go of is not told.
        self.file.flush()
    }

    fn pin_base(&mut self, header: &Header) -> hdf5::Result<()> {
        let dimensions = ["pin_angle", "radius"];
        let dataset =
            self.dataset(PIN_BASE, &self.status, &dimensions, "1", "base of the pin cells: resin or fibre")?;
        Statuses::of(self.mesh).write_flags(&dataset, false)?;
        self.dimensions.attach(&dataset, &dimensions)?;
        let bytes = stored_base(self.mesh, &header.pin_base);
        Statuses::of(self.mesh).write(&dataset, Selection::All, &bytes, self.mesh.rows())?;
        write_text(&dataset, DIGEST, &sha256_of(&bytes))?;
        self.file.flush()
    }

    /// One row for each event of the cycle.
    fn events(&mut self, records: &[EventRecord], extras: &[&Extra]) -> hdf5::Result<()> {
        make_group(self.file, EVENT_GROUP)?;
        let numbers: Vec<f64> = (1..=records.len()).map(|number| number as f64).collect();
        let scale = self.scale(EVENT, "1", "number of the event")?;
        fixed(&scale, &numbers)?;
        for quantity in event_quantities(extras) {
            let values: Vec<f64> = records.iter().map(quantity.value).collect();
            let dataset =
                self.dataset(&event_path(quantity.name), &self.float, &[EVENT], quantity.unit, quantity.long_name)?;
            fixed(&dataset, &values)?;
            self.dimensions.attach(&dataset, &[EVENT])?;
        }
        self.file.flush()
    }

    /// Makes a dataset; its time can grow while the run goes on, and has the length of the source afterwards.
    fn dataset(
        &self,
        path: &str,
        datatype: &Datatype,
        dimensions: &[&str],
        unit: &str,
        long_name: &str,
    ) -> hdf5::Result<Dataset> {
        let shape = dimensions.iter().map(|dimension| self.length(dimension)).collect::<hdf5::Result<Vec<_>>>()?;
        // What has no values yet gets some, or has none: a chunk of no values cannot be made.
        let extents =
            shape.iter().map(|&length| if length == 0 { Extent::resizable(0) } else { Extent::fixed(length) });
        let extents = SimpleExtents::from_vec(extents.collect());
        let chunk = match shape[..] {
            [moments, columns, rows] => {
                let is_constant = self.source.is_some_and(|source| source.digests.is_constant(path));
                map_chunk(if is_constant { moments } else { 1 }, columns, rows, datatype.size()).to_vec()
            }
            [columns, rows] => map_chunk(1, columns, rows, datatype.size())[1..].to_vec(),
            [0] => vec![self.series_chunk],
            [times] if dimensions == [TIME] => vec![self.series_chunk.min(times)],
            _ => shape,
        };
        let mut builder = self.file.new_dataset_builder().chunk(chunk);
        // What is filtered takes a new place in the file whenever it changes, and leaves the old one behind for those who may
        // be reading it: a series changes with every flush. Maps are deflated once, too, and not while a simulation may wait for it.
        let grows = self.source.is_none() && extents.dims()[0] == 0;
        if !grows {
            builder = builder.shuffle().deflate(1);
        }
        let dataset = builder.empty_as(datatype).shape(extents).create(path)?;
        write_text(&dataset, "units", unit)?;
        write_text(&dataset, "long_name", long_name)?;
        Ok(dataset)
    }

    /// Values along a dimension: those of the source of what grows while a run goes on.
    fn length(&self, dimension: &str) -> hdf5::Result<usize> {
        match (dimension, self.source) {
            ("radius", _) => Ok(self.mesh.rows()),
            ("disc_angle", _) => Ok(self.mesh.disc_columns()),
            ("pin_angle", _) => Ok(self.mesh.pin_columns()),
            (EVENT, Some(source)) => Ok(source.events.len()),
            (time, Some(source)) => Ok(source.file.dataset(time)?.size()),
            (_, None) => Ok(0),
        }
    }
}

/// Makes a group that keeps the order in which links are made.
fn make_group(file: &File, name: &str) -> hdf5::Result<()> {
    let builder = file.create_group_builder().with_gcpl(|list| list.link_creation_order(LinkCreationOrder::Indexed));
    builder.create(name).map(drop)
}

/// Writes values that never change, with their digest.
fn fixed(dataset: &Dataset, values: &[f64]) -> hdf5::Result<()> {
    dataset.write_raw(values)?;
    write_text(dataset, DIGEST, &digest::of_floats(values))
}

/// More bytes than the attributes of the end take but for the digests of maps, and for one of these.
const ROOM: [usize; 2] = [128 * 1024, 128];

/// End of a run file: state, wall time, digests, events, acceleration.
pub(super) struct Seal<'a> {
    pub(super) header: &'a Header,
    pub(super) start_time: SystemTime,
    pub(super) end: &'a End,
    pub(super) end_time: SystemTime,
    pub(super) wall_time: Duration,
    pub(super) digests: Digests,
    pub(super) events: &'a [EventRecord],
    pub(super) acceleration: Option<Chosen>,
}

impl Seal<'_> {
    /// Puts it on a file that is closed.
    ///
    /// The file is made anew, series compressed and nothing left over, and takes the place of the old one when it is complete:
    /// killed at whatever moment, the program leaves a file that can be read. Where there is no room for a second file, it is
    /// put on the file itself, if there is room for that; such a file has no events.
    pub(super) fn put_on(&self, path: &Path) -> Result<(), RunFileError> {
        let anew = Output::prepare(path, true, EMPTY_FILE).and_then(|place| {
            self.make(path, &place).map_err(not_anew(path))?;
            place.publish_durably()
        });
        if anew.is_ok() {
            return Ok(());
        }
        self.check_room(path).map_err(|error| RunFileError::Write(path.into(), error.to_string()))?;
        // A file that readers follow takes no new attributes, so it is opened once more without them.
        open_for_writing(path).and_then(|file| self.write(file)).map_err(failed(path))?;
        let synced = fs::File::open(path).and_then(|file| file.sync_all());
        synced.map_err(|error| RunFileError::Write(path.into(), error.to_string()))
    }

    /// Makes the file of a run that has ended, at `place`, of the one that was written while it went on.
    pub(super) fn make(&self, path: &Path, place: &Output) -> hdf5::Result<()> {
        let old = hdf5_file::open(path).map_err(in_words)?;
        let new = open_for_writing(place.temporary())?;
        let source = Source { file: &old, events: self.events, digests: &self.digests };
        lay_out(&new, self.header, self.start_time, Some(source))?;
        self.write(new)
    }

    fn write(&self, file: File) -> hdf5::Result<()> {
        write_text(&file, "end_time", &iso_8601(self.end_time))?;
        write_number(&file, "wall_time", self.wall_time.as_secs_f64())?;
        if let End::Failed(message) = self.end {
            write_text(&file, "error", message)?;
        }
        if let Some(chosen) = &self.acceleration {
            let text = serde_json::to_string(chosen).map_err(in_words)?;
            write_text(&file, ACCELERATION, &text)?;
        }
        write_text(&file, "state", self.end.state().name())?;
        file.link_soft(&format!("/{TIME}"), TIME_OF_SERIES)?;
        self.digests.write(&file)?;
        digest::write_attribute_digests(&file)?;
        file.flush()?;
        file.close()
    }

    /// Checks that all this will find room behind the end of the file.
    ///
    /// A file in which the library could write only half of it would be damaged; like this it stays as it is.
    fn check_room(&self, path: &Path) -> io::Result<()> {
        let room = ROOM[0] + self.digests.maps() * ROOM[1];
        let mut file = fs::OpenOptions::new().append(true).open(path)?;
        let length = file.metadata()?.len();
        let written = file.write_all(&vec![0; room]);
        file.set_len(length)?;
        written
    }
}
