//! Statuses as an HDF5 enumeration.

use hdf5::H5Type;
use plateau_core::model::material::Status;
use plateau_core::model::state::Base;

/// [`Status`] with the member names that the run file uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, H5Type)]
#[repr(u8)]
#[allow(non_camel_case_types)]
pub(super) enum StoredStatus {
    none = Status::None as u8,
    primary = Status::Primary as u8,
    secondary = Status::Secondary as u8,
}

impl StoredStatus {
    /// CF `flag_meanings`, in the order of `FLAG_VALUES`.
    pub(super) const FLAG_MEANINGS: &'static str = "none primary secondary";
    /// CF `flag_values`.
    pub(super) const FLAG_VALUES: [u8; 3] = [Self::none as u8, Self::primary as u8, Self::secondary as u8];

    /// The status of a discriminant of [`Status`], if it is one.
    pub(super) fn from_discriminant(value: u8) -> Option<Self> {
        [Self::none, Self::primary, Self::secondary].into_iter().find(|status| *status as u8 == value)
    }
}

impl From<Base> for StoredStatus {
    fn from(base: Base) -> Self {
        match base {
            Base::None => Self::none,
            Base::Primary => Self::primary,
        }
    }
}
