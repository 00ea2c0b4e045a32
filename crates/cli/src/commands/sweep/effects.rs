//! `plateau sweep effects`: what the factors of a study do to its responses.

use crate::arguments::EffectsArguments;
use crate::failure::Failure;

/// Analyses the results.
pub fn effects(_arguments: &EffectsArguments) -> Result<(), Failure> {
    Err(Failure::run("not there yet"))
}
