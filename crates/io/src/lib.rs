//! Everything of Plateau that touches a file: scenes, surfaces, run files.
//!
//! | what | where |
//! |---|---|
//! | a scene, read, checked and resolved | [`scene`] |
//! | quantities with units | [`units`] |
//! | initial surfaces, measured or synthetic | [`surface`] |
//! | input that is legal but cannot be meant | [`plausibility`] |
//! | the run file and its writer | [`run_file`] |
//! | studies: many runs, their results | [`study`] |
//! | what a stopped run goes on from | [`checkpoint`] |
//! | numbers as people read them | [`number`] |
//! | text of numbers, in whatever dialect | [`delimited`] |
//! | HDF5 files of named results | [`dataset_file`] |
//! | who may write a run file and its checkpoints | [`claim`] |
//! | regular files, and nothing else | [`regular`] |
//! | how much is read of a file | [`limits`] |
//! | how much memory there is | [`memory`] |
//! | generations of the numbers of runs, each with its reason | [`generation`] |
//! | lists in messages, as much of them as is read | [`brief`] |
//! | text that others have written, as it can be shown | [`text`] |
//! | files that appear when they are complete | [`temporary`] |
//! | processes: told from later ones, or by the file that they write | [`process`] |

mod archive;
pub mod brief;
pub mod checkpoint;
pub mod claim;
pub mod dataset_file;
pub mod delimited;
pub mod generation;
mod hdf5_file;
pub mod limits;
pub mod machine;
pub mod memory;
pub mod number;
pub mod plausibility;
pub mod process;
mod random;
pub mod regular;
pub mod run_file;
pub mod scene;
pub mod study;
pub mod surface;
mod syntax;
pub mod temporary;
pub mod text;
mod timestamp;
pub mod units;
