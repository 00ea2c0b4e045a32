//! Wear of build-up with properties of its own, and of what is below it (model 4.2), eight cells at a time; [`kernel`](crate::engine::kernel)
//! has the other cells.

use std::ops::Sub;

use crate::engine::lanes::Lanes;

/// Cells after wear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SurfaceLoss<L> {
    /// New surface height, m.
    pub height: L,
    /// Height that was really lost, m.
    pub lost: L,
}

/// Wears cells of the pin by their raw loss (m, 0 where nothing wears): the build-up t first, then what lies below.
///
/// A build-up is worn through where the raw loss Δh reaches it; the substrate then loses (1 − t/Δh) Δh_sub =
/// (Δh − t) `below`, with `below` = Δh_sub/Δh, and surface and substrate coincide.
#[inline(always)]
pub(crate) fn pin<L: Lanes>(height: L, substrate: L, raw: L, below: L) -> SurfaceLoss<L> {
    let build_up = substrate - height;
    let through = height.below(substrate) & !raw.below(build_up);
    let deeper = (raw - build_up) * below;
    SurfaceLoss {
        height: L::select(through, substrate + deeper, height + raw),
        lost: L::select(through, build_up + deeper, raw),
    }
}

/// Wears cells of the disc by their raw loss (m), which lowers them; else as [`pin`].
#[inline(always)]
pub(crate) fn disc<L: Lanes>(height: L, substrate: L, raw: L, below: L) -> SurfaceLoss<L> {
    // The disc is the pin upside down.
    let worn = pin(upside_down(height), upside_down(substrate), raw, below);
    SurfaceLoss { height: upside_down(worn.height), lost: worn.lost }
}

/// Subtracts heights from 0, and does not negate them, so that the height 0 stays 0 and does not become −0, which has other bits.
#[inline(always)]
fn upside_down<L: Lanes + Sub>(heights: L) -> L {
    L::splat(0.0) - heights
}

#[cfg(test)]
#[path = "../../tests/unit/engine/wear.rs"]
mod tests;
