//! The file of a run that was stopped, as its checkpoint knows it.

use std::path::Path;

use super::{Image, ReadError, RunFile, RunFileError, State};
use crate::temporary::Temporary;

/// A run file that is read, or a copy of it as it was at a checkpoint.
pub(super) struct Restored {
    pub(super) run: RunFile,
    /// It goes with its copy.
    _copy: Option<Temporary>,
}

impl Restored {
    /// Opens a file as it is.
    pub(super) fn as_it_is(path: &Path) -> Result<Self, ReadError> {
        Ok(Self { run: RunFile::open(path)?, _copy: None })
    }

    /// Opens a file as it was when an image of it was taken.
    ///
    /// # Errors
    /// [`RunFileError::Anew`] when there is no room for its copy, [`RunFileError::Earlier`] when that is no run file.
    pub(super) fn as_it_was(path: &Path, image: &Image) -> Result<Self, RunFileError> {
        let copy =
            image.restore(path).map_err(|error| RunFileError::Anew { path: path.into(), reason: error.to_string() })?;
        let run = RunFile::open(copy.path())
            .map_err(|error| RunFileError::Earlier { path: path.into(), reason: error.to_string() })?;
        Ok(Self { run: run.known_as(path), _copy: Some(copy) })
    }

    /// Opens the file of a run that is gone on with. One that was not closed may be torn by a loss of power, which does not always
    /// show; as it was at the checkpoint it is whole.
    pub(super) fn to_go_on(path: &Path, images: &[Image]) -> Result<Self, RunFileError> {
        match (Self::as_it_is(path), images.iter().find(|image| image.is_of(path))) {
            (Ok(there), _) if there.run.state() != State::Running => Ok(there),
            (_, Some(image)) => Self::as_it_was(path, image),
            (there, None) => {
                there.map_err(|error| RunFileError::Earlier { path: path.into(), reason: error.to_string() })
            }
        }
    }
}
