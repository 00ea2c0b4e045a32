//! Very many equal sub-steps of the chain at once: a pause may last for years.
//!
//! A sub-step is a linear map, and the map of twice as many sub-steps is that map applied twice. The map is not of the
//! temperatures but of the stored heat and of the differences from node to node: what hardly changes in a sub-step, as
//! the heat of a chain that nothing cools, then has small coefficients of its own that no rounding of larger ones
//! disturbs.

use super::sub_step::{Excess, NODES, SubStep};

/// The stored heat (J), the differences from node to node (K), heat lost so far (J), and 1 for the power.
const SIZE: usize = NODES + 2;
const LOST: usize = NODES;
const ONE: usize = NODES + 1;

/// What each quantity (row) rises by for a unit of each (column).
type Rises = [[f64; SIZE]; SIZE];

/// Takes so many sub-steps; the heat lost in them, J.
pub(super) fn advance(step: &SubStep, excess: &mut Excess, count: u64) -> f64 {
    let mut quantities = [0.0; SIZE];
    quantities[0] = step.capacity.iter().zip(&*excess).map(|(capacity, excess)| capacity * excess).sum();
    for (difference, pair) in quantities[1..].iter_mut().zip(excess.windows(2)) {
        *difference = pair[0] - pair[1];
    }
    quantities[ONE] = 1.0;
    let (mut rises, mut left) = (rises(step), count);
    loop {
        if left % 2 == 1 {
            let rise = rises.map(|row| row.iter().zip(&quantities).map(|(one, other)| one * other).sum::<f64>());
            quantities.iter_mut().zip(rise).for_each(|(quantity, rise)| *quantity += rise);
        }
        left /= 2;
        if left == 0 {
            break;
        }
        rises = twice(&rises);
    }
    *excess = temperatures(step, &quantities);
    quantities[LOST]
}

/// θ of every node, K, from the stored heat and the differences.
fn temperatures(step: &SubStep, quantities: &[f64; SIZE]) -> Excess {
    let whole: f64 = step.capacity.iter().sum();
    let mut excess = [quantities[0] / whole; NODES];
    let mut before = 0.0;
    for (node, (difference, capacity)) in quantities[1..NODES].iter().zip(&step.capacity).enumerate() {
        // A difference warms all nodes before it and cools the others, so that the stored heat stays.
        before += capacity;
        let share = before / whole;
        for (other, excess) in excess.iter_mut().enumerate() {
            *excess += difference * if other <= node { 1.0 - share } else { -share };
        }
    }
    excess
}

/// The map of a single sub-step.
fn rises(step: &SubStep) -> Rises {
    let mut rises = [[0.0; SIZE]; SIZE];
    for column in (0..NODES).chain([ONE]) {
        let mut unit = [0.0; SIZE];
        unit[column] = 1.0;
        let (excess, heated) = (temperatures(step, &unit), column == ONE);
        let rise = step.rise(&excess, heated);
        let lost = step.lost(&std::array::from_fn(|node| excess[node] + rise[node]));
        let gained = if heated { step.power.iter().sum::<f64>() * step.time } else { 0.0 };
        rises[0][column] = gained - lost;
        rises[LOST][column] = lost;
        for node in 1..NODES {
            rises[node][column] = rise[node - 1] - rise[node];
        }
    }
    rises
}

/// The map of twice as many sub-steps: (1 + D)² − 1 = 2 D + D².
fn twice(rises: &Rises) -> Rises {
    let mut twice = rises.map(|row| row.map(|rise| 2.0 * rise));
    for (row, rises_of_row) in twice.iter_mut().zip(rises) {
        for (rise, other) in rises_of_row.iter().zip(rises) {
            row.iter_mut().zip(other).for_each(|(sum, other)| *sum += rise * other);
        }
    }
    twice
}
