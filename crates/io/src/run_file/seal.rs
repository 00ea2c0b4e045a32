//! The last that is written to a run file: how its run ended, the time of its series, and the digests of what it holds.

use std::fs;
use std::io::{self, Write as _};
use std::path::Path;
use std::time::{Duration, SystemTime};

use hdf5::File;
use plateau_core::acceleration::Chosen;
use plateau_core::observe::event::EventRecord;

use super::attribute_digests;
use super::creation::{Source, lay_out};
use super::digest::Digests;
use super::dimension::EMPTY_FILE;
use super::error::{failed, not_anew};
use super::layout::{ACCELERATION, TIME, TIME_OF_SERIES};
use super::place::Place;
use super::{End, Header, RunFileError};
use crate::hdf5_file;
use crate::hdf5_file::writing::{open_for_writing, write_number, write_text};
use crate::timestamp::iso_8601;

/// More bytes than the attributes of the end take but for the digests of maps, and for one of these.
const ROOM: [usize; 2] = [128 * 1024, 128];

/// What closes a run file.
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
        let anew = Place::prepare(path, true, EMPTY_FILE).and_then(|place| {
            self.make(path, &place).map_err(not_anew(path))?;
            place.publish_durably()
        });
        if anew.is_ok() {
            return Ok(());
        }
        self.check_room(path).map_err(|error| RunFileError::Write { path: path.into(), reason: error.to_string() })?;
        // A file that readers follow takes no new attributes, so it is opened once more without them.
        open_for_writing(path).and_then(|file| self.write(file)).map_err(failed(path))?;
        let synced = fs::File::open(path).and_then(|file| file.sync_all());
        synced.map_err(|error| RunFileError::Write { path: path.into(), reason: error.to_string() })
    }

    /// Makes the file of a run that has ended, at `place`, of the one that was written while it went on.
    pub(super) fn make(&self, path: &Path, place: &Place) -> hdf5::Result<()> {
        let old = hdf5_file::open(path).map_err(|error| hdf5::Error::from(error.to_string()))?;
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
            let text = serde_json::to_string(chosen).map_err(|error| hdf5::Error::from(error.to_string()))?;
            write_text(&file, ACCELERATION, &text)?;
        }
        write_text(&file, "state", self.end.state().name())?;
        file.link_soft(&format!("/{TIME}"), TIME_OF_SERIES)?;
        self.digests.write(&file)?;
        attribute_digests::write(&file)?;
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
