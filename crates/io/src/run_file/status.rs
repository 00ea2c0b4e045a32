//! Statuses as an HDF5 enumeration. Files of scenes whose pin is no rectangle know one more than others.

use hdf5::{Dataset, Datatype, H5Type};
use ndarray::{ArrayView2, s};
use plateau_core::model::material::Status;
use plateau_core::model::mesh::Mesh;
use plateau_core::model::state::Base;
use plateau_core::observe::{ABSENT, Map};

use super::storage::copy_map;
use crate::hdf5_file::writing::write_text;

/// A status with the member names that run files use.
trait Stored: H5Type + Copy {
    /// The status of a discriminant of [`Status`], or of [`ABSENT`], if it is one.
    fn of(value: u8) -> Option<Self>;

    /// All of these.
    fn all(values: &[u8]) -> hdf5::Result<Vec<Self>> {
        let all: Option<Vec<Self>> = values.iter().map(|value| Self::of(*value)).collect();
        all.ok_or_else(|| "a value is not a status".into())
    }
}

/// [`Status`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, H5Type)]
#[repr(u8)]
#[allow(non_camel_case_types)]
enum StoredStatus {
    none = Status::Resin as u8,
    primary = Status::Primary as u8,
    secondary = Status::Secondary as u8,
}

impl Stored for StoredStatus {
    fn of(value: u8) -> Option<Self> {
        [Self::none, Self::primary, Self::secondary].into_iter().find(|status| *status as u8 == value)
    }
}

/// The same with cells beyond the pin's outline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, H5Type)]
#[repr(u8)]
#[allow(non_camel_case_types)]
enum OutlinedStatus {
    none = Status::Resin as u8,
    primary = Status::Primary as u8,
    secondary = Status::Secondary as u8,
    absent = ABSENT,
}

impl Stored for OutlinedStatus {
    fn of(value: u8) -> Option<Self> {
        [Self::none, Self::primary, Self::secondary, Self::absent].into_iter().find(|status| *status as u8 == value)
    }
}

/// The statuses of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Statuses {
    /// Whether there may be cells beyond the pin's outline.
    outlined: bool,
}

impl Statuses {
    /// Those of a file of this mesh.
    pub(super) fn of(mesh: &Mesh) -> Self {
        Self { outlined: !mesh.is_rectangle() }
    }

    /// The enumeration.
    pub(super) fn datatype(self) -> hdf5::Result<Datatype> {
        if self.outlined { Datatype::from_type::<OutlinedStatus>() } else { Datatype::from_type::<StoredStatus>() }
    }

    /// CF `flag_values` and `flag_meanings` of disc or pin.
    fn flags(self, on_disc: bool) -> (&'static [u8], &'static str) {
        const VALUES: [u8; 4] = [Status::Resin as u8, Status::Primary as u8, Status::Secondary as u8, ABSENT];
        if self.outlined && !on_disc {
            (&VALUES, "none primary secondary absent")
        } else {
            (&VALUES[..3], "none primary secondary")
        }
    }

    /// The CF way to say what a status means, for readers that do not show enumerations.
    pub(super) fn write_flags(self, dataset: &Dataset, on_disc: bool) -> hdf5::Result<()> {
        let (values, meanings) = self.flags(on_disc);
        dataset.new_attr_builder().with_data(values).create("flag_values")?;
        write_text(dataset, "flag_meanings", meanings)
    }

    /// The largest value that a map of statuses may have.
    pub(super) fn largest(self, map: Map) -> u8 {
        self.flags(map.on_disc()).0.last().copied().unwrap_or_default()
    }

    /// Writes one map, given column by column, as a level of its dataset, which has it already.
    pub(super) fn write_level(self, dataset: &Dataset, level: usize, values: &[u8], rows: usize) -> hdf5::Result<()> {
        fn write<T: Stored>(dataset: &Dataset, level: usize, values: &[u8], rows: usize) -> hdf5::Result<()> {
            let values = T::all(values)?;
            dataset.write_slice(ArrayView2::from_shape((values.len() / rows, rows), &values)?, s![level, .., ..])
        }
        let write = if self.outlined { write::<OutlinedStatus> } else { write::<StoredStatus> };
        write(dataset, level, values, rows)
    }

    /// Writes the base of a pin, given column by column.
    pub(super) fn write_base(self, dataset: &Dataset, values: &[u8], rows: usize) -> hdf5::Result<()> {
        fn write<T: Stored>(dataset: &Dataset, values: &[u8], rows: usize) -> hdf5::Result<()> {
            let values = T::all(values)?;
            dataset.write(ArrayView2::from_shape((values.len() / rows, rows), &values)?)
        }
        let write = if self.outlined { write::<OutlinedStatus> } else { write::<StoredStatus> };
        write(dataset, values, rows)
    }

    /// Copies the maps of all moments into a dataset of their shape.
    pub(super) fn copy(self, from: &Dataset, to: &Dataset) -> hdf5::Result<()> {
        let copy = if self.outlined { copy_map::<OutlinedStatus> } else { copy_map::<StoredStatus> };
        copy(from, to)
    }
}

/// The bases of a pin as a file has them.
pub(super) fn stored_base(mesh: &Mesh, base: &[Base]) -> Vec<u8> {
    let mut stored: Vec<u8> = base.iter().map(|base| *base as u8).collect();
    mesh.absent_cells().for_each(|cell| stored[cell] = ABSENT);
    stored
}
