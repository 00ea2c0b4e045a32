//! How much memory this process can have, and what is refused for want of it.

mod bound;
mod system;

use std::fmt;

use thiserror::Error;

use self::bound::unbounded;
use self::system::BESIDES;

pub use self::bound::AtWork;
pub(crate) use self::bound::bounded;
pub(crate) use self::system::of_machine;

/// More memory is needed than this process can have; in words it goes on after "needs".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("{} of memory and {} are available", InWords(*needed), InWords(*available))]
pub struct NoRoom {
    /// Bytes that are needed.
    pub needed: u64,
    /// Bytes that can be had.
    pub available: u64,
}

/// Refuses what needs more memory than this process can have. Where the system tells neither, nothing is refused.
///
/// # Errors
/// [`NoRoom`], with both numbers.
pub fn refuse_beyond(needed: u64) -> Result<(), NoRoom> {
    match unbounded(system::available) {
        Some(available) if needed > available => Err(NoRoom { needed, available }),
        _ => Ok(()),
    }
}

/// Refuses to begin where the system gives less memory than any command may need. HDF5 does not come back from every place in
/// which it gets no memory, so it is asked for while there is nothing to lose.
///
/// # Errors
/// [`NoRoom`], with what can be had.
pub fn refuse_to_begin() -> Result<(), NoRoom> {
    let is_there =
        |bytes: u64| usize::try_from(bytes).is_ok_and(|bytes| Vec::<u8>::new().try_reserve_exact(bytes).is_ok());
    if is_there(BESIDES) {
        return Ok(());
    }
    // What a limit leaves may still lie in pieces.
    let available = (0..BESIDES >> 20).rev().map(|mebibytes| mebibytes << 20).find(|bytes| is_there(*bytes));
    Err(NoRoom { needed: BESIDES, available: available.unwrap_or(0) })
}

/// Whether the system limits the address space of this process (`ulimit -v`).
pub fn is_address_space_limited() -> bool {
    unbounded(system::address_space_limit).is_some()
}

/// A number of bytes as "1.5 GiB".
struct InWords(u64);

impl fmt::Display for InWords {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const UNITS: [&str; 7] = ["B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"];
        let power = self.0.checked_ilog2().unwrap_or(0) as usize / 10;
        let unit = UNITS.get(power).copied().unwrap_or("B");
        write!(f, "{:.1} {unit}", self.0 as f64 / 2_f64.powi(10 * power as i32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_have_a_readable_unit() {
        assert_eq!(InWords(0).to_string(), "0.0 B");
        assert_eq!(InWords(3 << 29).to_string(), "1.5 GiB");
        assert_eq!(InWords(u64::MAX).to_string(), "16.0 EiB");
    }

    #[test]
    fn what_no_machine_has_is_refused_with_both_numbers() {
        assert_eq!(refuse_beyond(0), Ok(()));
        let refused = refuse_beyond(u64::MAX).unwrap_err();
        assert!(refused.available > 0 && refused.available < u64::MAX);
        assert!(refused.to_string().starts_with("16.0 EiB of memory and "), "{refused}");
    }
}
