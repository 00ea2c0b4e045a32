//! What a run file says of the events of its cycle.

use plateau_core::observe::event::{EVENT_QUANTITIES, EventQuantity};

use super::layout::event_path;
use super::opening::reason;
use super::{ReadError, RunFile};
use crate::hdf5_file;

impl RunFile {
    /// The quantities of the events, each with its value in every event; none in a run without a cycle, or that has not ended.
    ///
    /// # Errors
    /// [`ReadError::Damaged`] when they cannot be read.
    pub fn events(&self) -> Result<Vec<(&'static EventQuantity, Vec<f64>)>, ReadError> {
        let there = EVENT_QUANTITIES.iter().filter(|quantity| self.file.link_exists(&event_path(quantity.name)));
        there
            .map(|quantity| {
                let path = event_path(quantity.name);
                let values = self.file.dataset(&path).and_then(|dataset| {
                    hdf5_file::refuse_hollow(&dataset)?;
                    dataset.read_1d::<f64>()
                });
                let damaged = |error| ReadError::Damaged {
                    path: self.path().into(),
                    reason: format!("/{path}: {}", reason(&error)),
                };
                Ok((quantity, values.map_err(damaged)?.to_vec()))
            })
            .collect()
    }
}
