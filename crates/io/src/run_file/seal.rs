//! The last that is written to a run file: how its run ended, and the digests of what it holds.

use std::fs;
use std::io::{self, Write as _};
use std::path::Path;
use std::time::{Duration, SystemTime};

use super::digest::Digests;
use super::layout::{write_number, write_text};
use super::store::{failed, open};
use super::{End, RunFileError};
use crate::temporary::Temporary;
use crate::timestamp::iso_8601;

/// More bytes than the attributes of the end take but for the digests of maps, and for one of these.
const ROOM: [usize; 2] = [128 * 1024, 128];

/// What closes a run file.
pub(super) struct Seal<'a> {
    pub(super) end: &'a End,
    pub(super) end_time: SystemTime,
    pub(super) wall_time: Duration,
    pub(super) digests: Digests,
}

impl Seal<'_> {
    /// Puts it on a file that is closed.
    ///
    /// On a copy that takes the place of the file when it is complete: killed at whatever moment, the program leaves a file
    /// that can be read. Where there is no room for a copy it is put on the file itself, if there is room for that.
    pub(super) fn put_on(&self, path: &Path) -> Result<(), RunFileError> {
        if self.put_on_copy(path).is_ok() {
            return Ok(());
        }
        self.check_room(path).map_err(|error| RunFileError::Write { path: path.into(), reason: error.to_string() })?;
        self.write(path).map_err(failed(path))
    }

    fn put_on_copy(&self, path: &Path) -> hdf5::Result<()> {
        let system = |error: io::Error| hdf5::Error::from(error.to_string());
        let copy = Temporary::beside(path);
        fs::copy(path, copy.path()).map_err(system)?;
        self.write(copy.path())?;
        copy.publish_durably().map_err(system)
    }

    /// Writes it. A file that readers follow takes no new attributes, so it is opened once more without them.
    pub(super) fn write(&self, path: &Path) -> hdf5::Result<()> {
        let file = open(path)?;
        write_text(&file, "end_time", &iso_8601(self.end_time))?;
        write_number(&file, "wall_time", self.wall_time.as_secs_f64())?;
        if let End::Failed(message) = self.end {
            write_text(&file, "error", message)?;
        }
        write_text(&file, "state", self.end.state())?;
        self.digests.write(&file)?;
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
