//! A patch reversed along or across the sliding direction.

use super::Patch;

/// In which direction heights are reversed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flip {
    /// Along the sliding direction: the first column becomes the last.
    Along,
    /// Across it: the innermost row becomes the outermost.
    Across,
    /// Both: half a turn.
    Both,
}

impl Flip {
    /// Reverses the patch; says what was done.
    pub(super) fn reverse(self, patch: &mut Patch) -> String {
        let direction = match self {
            Self::Along => {
                reverse_along(patch);
                "along the sliding direction"
            }
            Self::Across => {
                reverse_across(patch);
                "across the sliding direction"
            }
            Self::Both => {
                patch.heights.reverse();
                "along and across the sliding direction"
            }
        };
        format!("flipped {direction}")
    }
}

/// Reverses the order of the columns.
pub(super) fn reverse_along(patch: &mut Patch) {
    let columns: Vec<&[f64]> = patch.heights.chunks_exact(patch.rows).rev().collect();
    patch.heights = columns.concat();
}

/// Reverses the order of the rows.
fn reverse_across(patch: &mut Patch) {
    patch.heights.chunks_exact_mut(patch.rows).for_each(<[f64]>::reverse);
}
