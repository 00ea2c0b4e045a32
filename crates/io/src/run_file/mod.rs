//! Run files: HDF5 with netCDF-4 conventions, as docs/run-file.md has them. [`RunFile`] reads them.
//!
//! [`RunWriter::create`] makes the file and hands it to a writer thread. A simulation sends its samples and maps over
//! a bounded queue and goes on; it waits only when the queue is full. [`RunWriter::finish`] states how the run ended.
//!
//! From the first sample on another process can follow the run in HDF5's single-writer-multiple-reader mode (h5py:
//! `File(path, swmr=True)`). The length of `/time` tells how many samples are complete: every series is written and
//! flushed before the times are. `/map_time` tells the same of the maps.
//!
//! `state` is `running` until the run has ended. It stays so when the program was killed or when the disk was full; such
//! a file is read like one that is still written.
//!
//! About the root attributes: `seeds` is a JSON object, key path in the scene → seed;
//! `inputs` a JSON array of objects with `path` and `sha256`; `workers` the worker count; `instruction_set`, `host`,
//! `start_time` and `end_time` (ISO 8601, UTC) are texts; `wall_time` is in seconds; `error` says why a run is `failed`;
//! `Conventions` repeats `conventions` in the spelling of netCDF. `/map_time` exists where any map does.
//!
//! Every dataset is chunked and filtered with shuffle and deflate, which any HDF5 reader understands; what grows only when the
//! run has ended and the file is made anew, with fixed dimensions.
pub mod checkpoint;
mod creation;
mod digest;
mod error;
mod header;
mod image;
pub(crate) mod layout;
mod output;
mod reader;
mod repair;
mod store;
mod writer;

pub use digest::{Damage, Verification, verify};
pub use error::{ReadError, RunFileError};
pub use header::{Earlier, End, Header, InputFile, State};
pub use image::Image;
pub use layout::{image_estimate, map_path, size_estimate};
pub use output::{KeepError, check_output, keep, names_beside, resolve};
pub use reader::{ContactArea, NoDrift};
pub use reader::{RunFile, Series};
pub use repair::{LeftOut, Repair, RepairError, is_healthy, last_writer, repair};
pub use store::WriterReport;
pub use store::close_abandoned;
pub use writer::{RunWriter, Synced};
