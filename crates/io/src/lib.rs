//! Everything of Plateau that touches a file: scenes, surfaces, run files.
//!
//! | content | module |
//! |---|---|
//! | a scene, read, checked and resolved | [`scene`] |
//! | quantities with units | [`units`] |
//! | initial surfaces, measured or synthetic | [`surface`] |
//! | input that is legal but cannot be meant | [`plausibility`] |
//! | the run file, its writer, and the checkpoints beside it | [`run_file`] |
//! | studies: many runs, their results | [`study`] |
//! | generations of the numbers of runs, each with its reason | [`generation`] |
//! | HDF5 files of named results | [`dataset_file`] |
//! | text of numbers, in whatever dialect | [`delimited`] |
//! | files of others, opened and read: regular ones, up to a size | [`input`], [`limits`] |
//! | files that appear when they are complete | [`temporary`] |
//! | one writer at a time of a run file and its checkpoints | [`claim`] |
//! | machines and processes, known again | [`process`] |
//! | memory that can be had | [`memory`] |
//! | text and lists in messages, numbers as people read them | [`text`], [`number`] |

pub mod claim;
pub mod dataset_file;
pub mod delimited;
pub mod generation;
mod hdf5_file;
pub mod input;
pub mod memory;
pub mod number;
pub mod plausibility;
pub mod process;
pub mod run_file;
pub mod scene;
pub mod study;
pub mod surface;
pub mod temporary;
pub mod text;
mod timestamp;
pub mod units;

pub use input::limits;
