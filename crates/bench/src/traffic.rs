//! What one step must move between the processor and its caches or memory.

use plateau_core::parameters::Parameters;
use plateau_core::parts::Needs;

/// Size of a height.
const HEIGHT: f64 = size_of::<f64>() as f64;
/// Size of a base.
const BASE: f64 = 1.0;

/// Bytes of one pair of cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellTraffic {
    /// Read in a step.
    pub read: f64,
    /// Written in a step.
    pub written: f64,
    /// Held: what has to stay near for the next step.
    pub held: f64,
}

/// The bytes that a step must move for each pair of a pin cell and the disc cell under it, if it goes over them once:
///
/// | field | read | written |
/// |---|---|---|
/// | z_p, b_p | always | always (wear raises both) |
/// | z_d | always | where plateaus form or the disc wears |
/// | b_d | where the disc wears, or build-up on it differs from the coating | where the disc wears |
/// | base | always (1 byte) | never |
///
/// What belongs to a row (areas, coefficients, sums) stays in the first cache and does not count. Further passes (load
/// evaluations, gaps and stiffness that are kept) move more; that is what a step could save.
pub fn cell_traffic(needs: Needs) -> CellTraffic {
    let when = |needed: bool| if needed { HEIGHT } else { 0.0 };
    let disc_substrate = needs.disc_wears || needs.distinct;
    let held = 3.0 * HEIGHT + when(disc_substrate) + BASE;
    CellTraffic {
        read: held,
        written: 2.0 * HEIGHT + when(needs.forms || needs.disc_wears) + when(needs.disc_wears),
        held,
    }
}

/// The bytes that a step of a simulation must move and hold.
pub fn step_traffic(parameters: &Parameters) -> CellTraffic {
    let CellTraffic { read, written, held } = cell_traffic(Needs::of(parameters));
    let cells = parameters.mesh.pin_cells() as f64;
    CellTraffic { read: read * cells, written: written * cells, held: held * cells }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paper_s_scene_moves_three_heights_each_way_and_a_base() {
        let needs = Needs { distinct: false, disc_wears: false, forms: true, destroys: true };
        assert_eq!(cell_traffic(needs), CellTraffic { read: 25.0, written: 24.0, held: 25.0 });
    }

    #[test]
    fn wear_alone_leaves_the_disc_as_it_is() {
        let needs = Needs { distinct: false, disc_wears: false, forms: false, destroys: false };
        assert_eq!(cell_traffic(needs), CellTraffic { read: 25.0, written: 16.0, held: 25.0 });
    }

    #[test]
    fn a_disc_that_wears_moves_its_substrate_too() {
        let needs = Needs { distinct: true, disc_wears: true, forms: true, destroys: true };
        assert_eq!(cell_traffic(needs), CellTraffic { read: 33.0, written: 32.0, held: 33.0 });
    }
}
