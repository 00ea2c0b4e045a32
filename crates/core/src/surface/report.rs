//! Sentences that the report of a preparation has in common.

use super::Length;
use super::level::rms;

/// What a step made of the rms height.
pub(super) fn change(before: f64, heights: &[f64]) -> String {
    format!("rms {} -> {}", Length(before), Length(rms(heights)))
}
