//! HDF5 files, opened and written.
//!
//! | file | content |
//! |---|---|
//! | `inspection.rs` | refusal of files from which the library would not come back, or that lie in part elsewhere |
//! | `reading.rs` | files of others, and their attributes |
//! | `writing.rs` | files of the program's own, and their attributes |

mod inspection;
mod reading;
pub(crate) mod writing;

pub(crate) use inspection::in_words;
pub(crate) use reading::{
    OpenError, guarded, is_hdf5, is_marked, number_attribute, open, open_with_datasets, refuse_hollow, text_attribute,
    text_of, texts_of,
};
