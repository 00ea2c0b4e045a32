//! Sensitivities: which part of a response's variation each factor has, over the whole of all ranges.
//!
//! | what | where |
//! |---|---|
//! | Sobol's indices, of a response that is cheap: a surrogate | [`sobol_indices`] |
//! | Morris's elementary effects, of the runs of a design `morris` | [`elementary_effects`] |

mod morris;
mod sobol;

pub use morris::{ElementaryEffect, elementary_effects};
pub use sobol::{Index, Options, Sample, SensitivityError, SobolIndices, Values, indices, sobol_indices};
