//! What one step must move between the processor and its caches or memory.

use plateau_core::parameters::Parameters;
use plateau_core::parts::Needs;

/// Size of a height.
const HEIGHT: f64 = size_of::<f64>() as f64;
/// Size of a cell's bits: whether it is resin, and whether it is a plateau.
const STATUS: f64 = 0.25;

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
/// | z_p | always | always |
/// | b_p | where plateaus form | where plateaus form |
/// | z_d | always | where plateaus form or the disc wears |
/// | b_d | where plateaus form, if the disc wears or build-up on it differs from the coating | if the disc wears |
/// | statuses | always (2 bits) | seldom |
///
/// What belongs to a row (areas, coefficients, sums) stays in the first cache and does not count.
pub fn cell_traffic(needs: Needs) -> CellTraffic {
    let Needs { distinct, disc_wears, forms, .. } = needs;
    let when = |needed: bool| if needed { HEIGHT } else { 0.0 };
    let held = 2.0 * HEIGHT + when(forms) + when(forms && (disc_wears || distinct)) + STATUS;
    CellTraffic {
        read: held,
        written: HEIGHT + when(forms) + when(forms || disc_wears) + when(forms && disc_wears),
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
    fn the_paper_s_scene_moves_three_heights_each_way() {
        let needs = Needs { distinct: false, disc_wears: false, forms: true, destroys: true, local: false };
        assert_eq!(cell_traffic(needs), CellTraffic { read: 24.25, written: 24.0, held: 24.25 });
    }

    #[test]
    fn wear_alone_leaves_the_disc_as_it_is() {
        let needs = Needs { distinct: false, disc_wears: false, forms: false, destroys: false, local: false };
        assert_eq!(cell_traffic(needs), CellTraffic { read: 16.25, written: 8.0, held: 16.25 });
    }

    #[test]
    fn a_disc_that_wears_moves_its_substrate_too() {
        let needs = Needs { distinct: true, disc_wears: true, forms: true, destroys: true, local: false };
        assert_eq!(cell_traffic(needs), CellTraffic { read: 32.25, written: 32.0, held: 32.25 });
    }
}
